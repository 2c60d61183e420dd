//! How wrong the parameters of an identification get, and what its verdict says.

use super::Trap;
use crate::{Failure, Subject};
use overact_identification::{
    Check, CheckKind, Dataset, Detectable, Estimate, Grade, Identification, LineError, Log, Stage,
    identify,
};
use overact_simulation::{Experiment, Record, simulate};
use serde::Serialize;

/// By how much the half width of a 95 % interval exceeds a deviation.
const HALF_WIDTH: f64 = 1.96;

/// Errors beyond so many deviations are to be told.
const LARGEST_ERROR: f64 = 3.0;

/// The level of a test of its own family: a hundredth of the reports may have a false alarm, and ten
/// families share it (`identification/src/assessment/checks/level.rs`).
const LEVEL: f64 = 0.01 / 10.0;

/// A fault that a test sees less often than this is invisible.
const INVISIBLE: f64 = 0.1;

/// What an identification of data with a known fault says.
#[derive(Debug, Clone, Serialize)]
pub struct Outcome {
    /// The robot.
    pub robot: String,
    /// The fault.
    pub trap: String,
    /// The largest error of a recommended parameter of the first model by its deviation, and the
    /// parameter; none where there is no estimate.
    pub worst: Option<(f64, String)>,
    /// The largest error of those parameters that the verdict allows to use.
    pub worst_listed: Option<(f64, String)>,
    /// By how many deviations a test would see the fault that knew it beforehand: the root of what it adds
    /// to the squared residual, by the deviation of the residual; none for the faultless data themselves.
    pub oracle: Option<f64>,
    /// The size of the fault by its deviation in faultless data, where every report looks for such faults.
    pub honest: Option<f64>,
    /// How often a test at the level of the report would see it: by the deviation in faultless data where
    /// there is one, else by white noise and all else known.
    pub power: Option<f64>,
    /// The grade; none where the data are refused with an error.
    pub grade: Option<Grade>,
    /// The checks that found something.
    pub found: Vec<String>,
    /// The first reason, or the error.
    pub words: String,
    /// Whether an assumption of every report says that no data can show it, or this report that so much may be hidden.
    pub assumed: bool,
}

/// How an outcome stands to what is asked of a verdict: no parameter that may be used is wrong by more than
/// three deviations unless the fault is named or can't be seen.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize)]
#[serde(rename_all = "kebab-case")]
pub enum Standing {
    /// No parameter that may be used is wrong by more than three deviations.
    Right,
    /// One is, and a check that found something says why.
    Named,
    /// One is, and no test of these data could know.
    Invisible,
    /// One is, and an assumption of the report says why.
    Assumed,
    /// One is, and nothing tells.
    Missed,
}

impl Outcome {
    /// How it stands.
    #[must_use]
    pub fn standing(&self) -> Standing {
        match &self.worst_listed {
            Some((size, _)) if *size > LARGEST_ERROR => {}
            _ => return Standing::Right,
        }
        if !self.found.is_empty() {
            Standing::Named
        } else if self.power.is_some_and(|power| power < INVISIBLE) {
            Standing::Invisible
        } else if self.assumed {
            Standing::Assumed
        } else {
            Standing::Missed
        }
    }
}

impl Standing {
    /// In a word.
    #[must_use]
    pub const fn name(self) -> &'static str {
        match self {
            Self::Right => "",
            Self::Named => "named",
            Self::Invisible => "invisible",
            Self::Assumed => "assumption",
            Self::Missed => "MISSED",
        }
    }
}

/// The chance that a test of two sides with a threshold in deviations sees what lies so many of them from zero.
fn power(deviations: f64, threshold: f64) -> f64 {
    let tail = |at: f64| 0.5 * libm::erfc(at / std::f64::consts::SQRT_2);
    tail(threshold - deviations) + tail(threshold + deviations)
}

/// How many deviations white noise exceeds as often as a level: no test of a family does better.
fn quantile(level: f64) -> f64 {
    let (mut low, mut high) = (0.0, 10.0);
    for _ in 0..60 {
        let middle: f64 = 0.5 * (low + high);
        let beyond = libm::erfc(middle / std::f64::consts::SQRT_2);
        *(if beyond > level { &mut low } else { &mut high }) = middle;
    }
    low
}

/// The records of a subject's experiment, which makes all traps.
///
/// # Errors
/// A run that can't be made.
pub fn prepared(subject: &Subject, experiment: &Experiment) -> Result<Vec<Record>, Failure> {
    Ok(simulate(subject.model(), experiment, &|_, _| ()).map_err(|error| error.to_string())?)
}

/// What the identification of records says in which a trap was set, beside what it says of `faultless` ones.
#[must_use]
pub fn outcome(
    subject: &Subject,
    trap: &Trap,
    records: Vec<Record>,
    faultless: &Identification,
) -> Outcome {
    let result = identified(subject, records);
    let start = Outcome {
        robot: subject.info().name.to_owned(),
        trap: trap.name.clone(),
        worst: None,
        worst_listed: None,
        oracle: None,
        honest: None,
        power: None,
        grade: None,
        found: Vec::new(),
        words: String::new(),
        assumed: trap.assumed.is_some(),
    };
    match result {
        Ok(result) => {
            let oracle = oracle(&result, faultless);
            let honest = trap.size.and_then(|size| honest(faultless, size));
            let at_report = honest.map(|(size, threshold)| power(size, threshold));
            Outcome {
                oracle,
                honest: honest.map(|(size, _)| size),
                power: at_report.or(oracle.map(|size| power(size, quantile(LEVEL)))),
                assumed: start.assumed || trap.size.is_some_and(|size| is_stated(&result, size)),
                ..told(&result, start)
            }
        }
        Err(error) => Outcome {
            words: error.to_string(),
            ..start
        },
    }
}

/// The checks of an identification of faultless records that found something.
///
/// # Errors
/// Records that can't be identified from.
pub fn clean(subject: &Subject, records: Vec<Record>) -> Result<(Grade, Vec<Check>), Failure> {
    let result = identified(subject, records)?;
    let grade = result.grade();
    Ok((
        grade,
        result
            .checks
            .into_iter()
            .filter(|check| !check.passed)
            .collect(),
    ))
}

/// What a fault adds to the squared residual of the base parameters, in deviations.
fn oracle(result: &Identification, faultless: &Identification) -> Option<f64> {
    let [with, without] = [result, faultless].map(|one| one.estimates.first());
    let (with, without) = (with?, without?);
    let lines = with.lines.iter().zip(&without.lines).zip(&without.weights);
    let added: f64 = lines
        .map(|((with, without), weight)| {
            let per = |line: &LineError| line.residual_norm.powi(2) / line.equations as f64;
            weight * weight * (per(with) - per(without)) * without.equations as f64
        })
        .sum();
    Some(added.max(0.0).sqrt() / without.residual_deviation)
}

/// The check of an identification that looks for faults of a kind and a name, and how well it tells them.
fn looked_for<'a>(
    result: &'a Identification,
    (kind, (name, unit)): (CheckKind, (&str, &str)),
) -> Option<(&'a Check, &'a Detectable)> {
    let own = result.checks.iter().filter(|check| check.kind == kind);
    let mut all = own.flat_map(|check| check.detectable.iter().map(move |one| (check, one)));
    all.find(|(_, one)| one.name == name && one.unit == unit)
}

/// The size of a fault by its deviation in faultless data, and the threshold of the check that looks for it.
fn honest(
    faultless: &Identification,
    (kind, name, size): (CheckKind, (&str, &str), f64),
) -> Option<(f64, f64)> {
    let (check, found) = looked_for(faultless, (kind, name))?;
    Some((size.abs() / found.deviation, check.threshold))
}

/// Whether the report says itself that a fault of this size may be hidden in the data and spoil parameters.
fn is_stated(result: &Identification, (kind, name, size): (CheckKind, (&str, &str), f64)) -> bool {
    let found = looked_for(result, (kind, name));
    found.is_some_and(|(check, one)| {
        check.passed && one.moves > LARGEST_ERROR && size.abs() <= one.size
    })
}

/// Identifies from records.
///
/// # Errors
/// Records that can't be identified from.
pub fn identified(subject: &Subject, records: Vec<Record>) -> Result<Identification, Failure> {
    let log = |record: Record| {
        let n = record.actuators.len();
        Log::new(
            record.name,
            record.sampling_hz,
            n,
            record.positions,
            record.torques,
            record.payload,
        )
    };
    let runs = records
        .into_iter()
        .map(log)
        .collect::<Result<Vec<Log>, _>>()?;
    let dataset = Dataset {
        runs: &runs,
        validation: &[],
        true_values: Some(&subject.truth),
        variants: &subject.variants.lent(),
        scales: Some(&subject.scales),
    };
    Ok(identify(
        subject.model(),
        &dataset,
        &subject.settings,
        &|_| {},
    )?)
}

fn told(result: &Identification, start: Outcome) -> Outcome {
    let verdict = result.verdicts.first();
    let listed = |name: &str| {
        verdict.is_none_or(|verdict| {
            verdict.grade == Grade::Use
                || verdict.grade == Grade::UseListed && verdict.listed.iter().any(|one| one == name)
        })
    };
    let recommended = result
        .estimates
        .iter()
        .find(|one| one.stage == Stage::Recommended);
    let errors = recommended.map(errors).unwrap_or_default();
    let worst = |of: &dyn Fn(&str) -> bool| {
        let own = errors.iter().filter(|(_, name)| of(name));
        own.max_by(|a, b| a.0.total_cmp(&b.0)).cloned()
    };
    let found = result.checks.iter().filter(|check| !check.passed);
    let mut kinds: Vec<String> = found.map(|check| check.kind.name().to_owned()).collect();
    kinds.dedup();
    Outcome {
        worst: worst(&|_| true),
        worst_listed: worst(&listed),
        grade: Some(result.grade()),
        found: kinds,
        words: match verdict {
            Some(verdict) if verdict.grade != Grade::Use => verdict.reasons.first().cloned(),
            _ => result
                .checks
                .iter()
                .find(|check| !check.passed)
                .map(Check::located),
        }
        .unwrap_or_default(),
        ..start
    }
}

/// Errors of the parameters by their deviations.
fn errors(estimate: &Estimate) -> Vec<(f64, String)> {
    let parameters = estimate.parameters.iter();
    let error = parameters.filter_map(|one| {
        let half = 0.5 * (one.interval_95[1] - one.interval_95[0]);
        Some((
            (one.value - one.true_value?).abs() * HALF_WIDTH / half,
            one.name.clone(),
        ))
    });
    error.collect()
}
