//! What is to be thought of an identification: findings about the data, as far as they need the
//! estimates, and a verdict on each case in words.

use std::fmt::Write as _;

use overact::{Model, StandardParameter};

use super::{
    dataset::Dataset,
    prepare::Prepared,
    result::{CrossValidation, Estimate},
    stage::Stage,
    verdict::Verdict,
};
use crate::{
    assessment::torques,
    data::Log,
    error::Error,
    finding::{Finding, FindingKind, Thresholds},
    regression::projection::ModelKind,
    settings::Settings,
    significant,
};

/// Relative error of the base parameters (percent) above which faults of the data are looked for.
const SUSPICIOUS_PERCENT: f64 = 5.0;

/// Beginning of each run in which they are looked for, s.
const BEGINNING_SECONDS: f64 = 5.0;

/// A parameter that can't be negative is worth a word where it is so by this many deviations.
const CLEARLY_NEGATIVE: f64 = 5.0;

/// Findings that need the estimates.
///
/// # Errors
/// A log that can't be read any more.
pub(super) fn findings(
    model: &dyn Model,
    dataset: &Dataset<'_>,
    prepared: &Prepared,
    estimates: &[(usize, Estimate)],
    settings: &Settings,
) -> Result<Vec<Finding>, Error> {
    let mut findings = Vec::new();
    let base = || {
        estimates
            .iter()
            .map(|(_, one)| one)
            .filter(|one| one.stage == Stage::Base)
    };
    let Some(first) = base().next() else {
        return Ok(findings);
    };
    if first.relative_error_percent > SUSPICIOUS_PERCENT {
        let beginning = |log: &Log| {
            let samples = (BEGINNING_SECONDS * log.sampling_frequency()) as usize;
            log.beginning(samples.max(settings.samples_needed()))
        };
        let runs: Vec<Log> = dataset
            .runs
            .iter()
            .map(beginning)
            .collect::<Result<_, _>>()?;
        findings.extend(torques::explanation(model, &runs, settings)?);
    }
    let negative: Vec<&str> = first
        .parameters
        .iter()
        .filter(|one| is_positive(prepared, one.column))
        .filter(|one| one.value < -CLEARLY_NEGATIVE * one.correlated_standard_deviation)
        .map(|one| one.name.as_str())
        .collect();
    if !negative.is_empty() && findings.is_empty() {
        findings.push(Finding {
            kind: FindingKind::NegativeParameter,
            run: None,
            actuator: None,
            message: format!(
                "{} can't be negative, but {} estimated so: check the signs of positions and torques, and whether the runs excite {}",
                quoted(&negative),
                if negative.len() == 1 { "is" } else { "are" },
                if negative.len() == 1 { "it" } else { "them" },
            ),
        });
    }
    Ok(findings)
}

/// `a`, `b` and so on.
fn quoted(names: &[&str]) -> String {
    let quoted: Vec<String> = names.iter().map(|name| format!("`{name}`")).collect();
    quoted.join(", ")
}

/// Whether a base parameter is a sum of things that can't be negative.
fn is_positive(prepared: &Prepared, place: usize) -> bool {
    let columns = prepared.columns.as_slice();
    let positive = |column: usize| {
        columns.get(column).is_some_and(|column| {
            matches!(
                column.symbol,
                StandardParameter::M
                    | StandardParameter::Ia
                    | StandardParameter::Fv
                    | StandardParameter::Fs
                    | StandardParameter::Xx
                    | StandardParameter::Yy
                    | StandardParameter::Zz
            )
        })
    };
    let base = &prepared.base;
    base.columns.get(place).is_some_and(|&kept| positive(kept))
        && base.regroupings.get(place).is_some_and(|terms| {
            terms
                .iter()
                .all(|&(column, coefficient)| positive(column) && coefficient > 0.0)
        })
}

/// One verdict for the data, if there are findings, and one for each model.
pub(super) fn verdicts(
    estimates: &[(usize, Estimate)],
    cross_validation: &[CrossValidation],
    findings: &[Finding],
    thresholds: &Thresholds,
) -> Vec<Verdict> {
    let mut verdicts = Vec::new();
    let mut models: Vec<ModelKind> = estimates.iter().map(|(_, one)| one.model).collect();
    models.dedup();
    for model in models {
        verdicts.push(of_model(
            model,
            estimates,
            cross_validation,
            findings,
            thresholds,
        ));
    }
    if !findings.is_empty() {
        verdicts.push(Verdict {
            subject: String::from("data"),
            trusted: !findings.iter().any(is_serious),
            reasons: findings.iter().map(located).collect(),
        });
    }
    verdicts
}

/// Whether a finding spoils what is identified from the data.
fn is_serious(finding: &Finding) -> bool {
    finding.kind != FindingKind::Standstill
}

/// A finding with its place.
pub(super) fn located(finding: &Finding) -> String {
    let place = finding.run.iter().chain(&finding.actuator);
    let mut text = String::new();
    for part in place {
        let _ = write!(text, "{part}: ");
    }
    text + &finding.message
}

/// The verdict on one model.
fn of_model(
    model: ModelKind,
    estimates: &[(usize, Estimate)],
    cross_validation: &[CrossValidation],
    findings: &[Finding],
    thresholds: &Thresholds,
) -> Verdict {
    let own = |stage: Stage| {
        let mut all = estimates.iter().map(|(_, one)| one);
        all.find(|one| one.model == model && one.stage == stage)
    };
    let mut trusted = true;
    let mut reasons = Vec::new();
    if let Some(base) = own(Stage::Base) {
        let error = base.relative_error_percent;
        let limit = thresholds.relative_error_percent;
        let good = error <= limit;
        trusted &= good;
        reasons.push(format!(
            "the base parameters leave {} % of the inputs unexplained, {} than {limit} %",
            significant(error, 3),
            if good { "less" } else { "more" },
        ));
        if let Some(text) = partition(base, estimates, thresholds) {
            trusted &= text.0;
            reasons.push(text.1);
        }
    }
    if let Some(essential) = own(Stage::Essential) {
        reasons.push(format!(
            "{} essential parameters leave {} %",
            essential.parameters.len(),
            significant(essential.relative_error_percent, 3)
        ));
    }
    let held_out = cross_validation.iter().filter(|one| one.model == model);
    let errors = held_out.map(|one| one.relative_error_percent);
    if let Some(worst) = errors.reduce(f64::max) {
        let good = worst <= thresholds.relative_error_percent;
        trusted &= good;
        reasons.push(format!(
            "of runs that were held out, at most {} % are left unexplained",
            significant(worst, 3)
        ));
    }
    if findings.iter().any(is_serious) {
        trusted = false;
        reasons.push(String::from("the data are suspicious, see there"));
    }
    Verdict {
        subject: model.case().to_owned(),
        trusted,
        reasons,
    }
}

/// Whether the kept actuators of case 2 are well conditioned, in words.
fn partition(
    base: &Estimate,
    estimates: &[(usize, Estimate)],
    thresholds: &Thresholds,
) -> Option<(bool, String)> {
    let partition = base.partition.as_ref()?;
    if base.model != ModelKind::Actuators {
        return None;
    }
    let kept = base.kept_actuators.join(", ");
    let good = partition.crossings == 0 && partition.largest <= thresholds.partition_condition;
    if good {
        return Some((
            true,
            format!(
                "the condition number of the kept actuators {kept} stays below {}, at most {}",
                thresholds.partition_condition,
                significant(partition.largest, 3)
            ),
        ));
    }
    let mut text = if partition.crossings > 0 {
        format!(
            "the trajectory crosses a singularity of the kept actuators {kept}, {} ({}, t = {:.3} s among them), which the robot itself does not have",
            match partition.crossings {
                1 => String::from("once"),
                2 => String::from("twice"),
                count => format!("{count} times"),
            },
            partition.run,
            partition.time
        )
    } else {
        format!(
            "the condition number of the kept actuators {kept} reaches {} ({}, t = {:.3} s), above {}",
            significant(partition.largest, 3),
            partition.run,
            partition.time,
            thresholds.partition_condition
        )
    };
    if let Some((case_1, case_2)) = lower_error(estimates) {
        let _ = write!(
            text,
            "; that its relative error of {} % is lower than the {} % of case 1 does not speak for it: near the singularity a few samples outweigh all others, and they are fitted first",
            significant(case_2, 3),
            significant(case_1, 3)
        );
    }
    Some((false, text))
}

/// The relative errors (percent) of both cases where that of case 2 is lower: of the essential
/// parameters, else of all.
fn lower_error(estimates: &[(usize, Estimate)]) -> Option<(f64, f64)> {
    let error = |model: ModelKind, stage: Stage| {
        let mut all = estimates.iter().map(|(_, one)| one);
        all.find(|one| one.model == model && one.stage == stage)
            .map(|one| one.relative_error_percent)
    };
    [Stage::Essential, Stage::Base]
        .into_iter()
        .filter_map(|stage| {
            Some((
                error(ModelKind::Platform, stage)?,
                error(ModelKind::Actuators, stage)?,
            ))
        })
        .find(|(case_1, case_2)| case_2 < case_1)
}
