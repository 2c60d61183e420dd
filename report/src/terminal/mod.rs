//! All tables of an identification as plain text.

pub(crate) mod calibration;
pub(crate) mod gains;
pub(crate) mod gears;
pub(crate) mod gravity;
pub(crate) mod motors;
pub(crate) mod stribeck;

use crate::{
    intervals::{half_width_percent, is_outside},
    layout::{definitions, paragraph, table},
    line_errors::{base_words, cells, is_mixed, relative, relative_words},
};
use overact_identification::{
    BaseParameter, Consistent, CrossValidation, Estimate, Estimator, Identification, LineError,
    ModelKind, ParameterEstimate, Regrouping, significant,
};

/// Largest denominator of a coefficient printed as a fraction.
const LARGEST_DENOMINATOR: u32 = 10_000;

/// Relative tolerance for printing a coefficient as a decimal or fraction.
const SNAP: f64 = 1e-11;

/// All tables: runs, base parameters, estimates, cross-validation.
#[must_use]
pub fn tables(identification: &Identification) -> String {
    let mut text = runs(identification);
    text.push_str(&base_parameters(&identification.base_parameters));
    if !identification.without_effect.is_empty() {
        paragraph(
            &mut text,
            "",
            &format!(
                "without effect: {}",
                identification.without_effect.join(", ")
            ),
        );
    }
    for one in &identification.estimates {
        text.push('\n');
        text.push_str(&estimate(one));
    }
    for one in &identification.consistent {
        text.push('\n');
        text.push_str(&consistent(identification, one));
    }
    if !identification.cross_validation.is_empty() {
        text.push('\n');
        text.push_str(&cross_validation(&identification.cross_validation));
    }
    text
}

/// Times of the stages and checks, if they were measured.
#[must_use]
pub fn timings(identification: &Identification) -> String {
    let all = &identification.timings;
    if all.is_empty() {
        return String::new();
    }
    let seconds = |value: f64| format!("{value:.3}");
    let row = |name: String, elapsed: f64, processors: Option<f64>| {
        let processors = processors.map_or_else(String::new, seconds);
        vec![name, seconds(elapsed), processors]
    };
    let mut rows: Vec<Vec<String>> = all
        .iter()
        .map(|one| {
            let check = if one.is_check { "check: " } else { "" };
            let name = format!("{check}{}", one.stage);
            row(name, one.seconds, one.processor_seconds)
        })
        .collect();
    let elapsed = all.iter().map(|one| one.seconds).sum();
    let processors = all.iter().map(|one| one.processor_seconds).sum();
    rows.push(row(String::from("all"), elapsed, processors));
    format!(
        "\nTimes of the stages\n{}",
        table(&["stage", "elapsed s", "processors s"], rows)
    )
}

/// Table of physically consistent standard parameters.
fn consistent(identification: &Identification, one: &Consistent) -> String {
    let rows = one.parameters.iter().map(|own| {
        vec![
            own.name.clone(),
            significant(own.value, 5),
            own.unit.clone(),
            significant(own.prior, 4),
            format!("{:.0}", 100.0 * own.determined),
        ]
    });
    let header = ["parameter", "value", "unit", "prior", "from data %"];
    format!(
        "Physically consistent parameters, {}: error {} (base parameters {})\n{}",
        one.model.label(),
        relative_words(&one.lines, one.relative_error_percent, 5),
        base_words(identification, one),
        table(&header, rows.collect())
    )
}

/// Table of the training runs.
fn runs(identification: &Identification) -> String {
    let rows = identification.runs.iter().map(|run| {
        vec![
            run.name.clone(),
            run.samples.to_string(),
            format!("{:.1}", run.sampling_frequency),
            run.carried().words().to_owned(),
        ]
    });
    format!(
        "\nRuns\n{}",
        table(&["run", "samples", "Hz", "payload"], rows.collect())
    )
}

/// The base parameters and their regroupings in words.
#[must_use]
pub fn base_parameters(parameters: &[BaseParameter]) -> String {
    let (alone, regrouped): (Vec<&BaseParameter>, Vec<&BaseParameter>) = parameters
        .iter()
        .partition(|base| base.regrouping.is_empty());
    let rows: Vec<(String, String)> = regrouped
        .iter()
        .map(|base| (base.name.clone(), sum(base)))
        .collect();
    let mut text = format!(
        "\nBase parameters ({})\n{}",
        parameters.len(),
        definitions(&rows, " = ")
    );
    if !alone.is_empty() {
        let names: Vec<&str> = alone.iter().map(|base| base.name.as_str()).collect();
        paragraph(&mut text, "", &format!("alone: {}", names.join(", ")));
    }
    text
}

/// Sum of standard parameters that a base parameter is: `zz_1 + ia_1 + 0.16 m_2`.
pub(crate) fn sum(base: &BaseParameter) -> String {
    let terms: String = base.regrouping.iter().map(signed_term).collect();
    format!("{}{terms}", base.parameter)
}

/// ` + 0.0784 m_2_leg1`; a coefficient of 1 is omitted.
fn signed_term(term: &Regrouping) -> String {
    let sign = if term.coefficient < 0.0 { '-' } else { '+' };
    match coefficient(term.coefficient.abs()).as_str() {
        "1" => format!(" {sign} {}", term.parameter),
        number => format!(" {sign} {number} {}", term.parameter),
    }
}

/// Positive coefficient as an equal short decimal or fraction, else with six digits.
#[must_use]
pub fn coefficient(value: f64) -> String {
    let near = |candidate: f64| (candidate - value).abs() <= SNAP * value.abs();
    for digits in 1..=7 {
        let text = significant(value, digits);
        if text.parse().is_ok_and(near) {
            return text;
        }
    }
    match fraction(value) {
        Some((numerator, denominator)) => format!("({numerator}/{denominator})"),
        None => significant(value, 6),
    }
}

/// Fraction of smallest denominator that equals a positive value, by continued fractions.
fn fraction(value: f64) -> Option<(u64, u64)> {
    let (mut before, mut now) = ((0.0, 1.0), (1.0, 0.0));
    let mut rest = value;
    loop {
        let whole = rest.floor();
        (before, now) = (now, (whole * now.0 + before.0, whole * now.1 + before.1));
        let (numerator, denominator): (f64, f64) = now;
        if !(denominator <= f64::from(LARGEST_DENOMINATOR) && numerator < 1e9) {
            return None;
        }
        if (numerator / denominator - value).abs() <= SNAP * value {
            return Some((numerator as u64, denominator as u64));
        }
        rest = 1.0 / (rest - whole);
    }
}

/// Table of one estimate, followed by its quality.
#[must_use]
pub fn estimate(estimate: &Estimate) -> String {
    let what = match estimate.model {
        ModelKind::Platform => String::from("Platform projection"),
        ModelKind::Actuators => format!(
            "Actuator projection on {}",
            estimate.kept_actuators.join(", ")
        ),
        ModelKind::Joints => String::from("Joint model"),
    };
    let how = match estimate.estimator {
        Estimator::LeastSquares => "",
        Estimator::OrdinaryLeastSquares => ", by ordinary least squares",
        Estimator::InstrumentalVariables => ", by instruments",
    };
    let mut text = String::new();
    paragraph(
        &mut text,
        "",
        &format!("{what}: {} parameters{how}", estimate.stage.name()),
    );
    let truth = estimate
        .parameters
        .iter()
        .any(|parameter| parameter.true_value.is_some());
    let mut header = vec!["parameter"];
    if truth {
        header.push("true value");
    }
    header.extend(["estimate", "95 % interval", "+-%"]);
    if truth {
        header.push("error %");
    }
    header.push("unit");
    let optional = |value: Option<f64>, digits: usize| {
        value.map_or_else(|| String::from("-"), |value| significant(value, digits))
    };
    let rows = estimate.parameters.iter().map(|parameter| {
        let mut row = vec![parameter.name.clone()];
        if truth {
            row.push(optional(parameter.true_value, 6));
        }
        row.push(significant(parameter.value, 7));
        row.push(interval(parameter));
        row.push(optional(half_width_percent(parameter), 3));
        if truth {
            row.push(optional(parameter.error_percent, 3));
        }
        row.push(parameter.unit.clone());
        row
    });
    text.push_str(&table(&header, rows.collect()));
    if estimate.parameters.iter().any(is_outside) {
        paragraph(
            &mut text,
            "",
            "* outside its own interval: eliminating other parameters moved this estimate to a value that the data contradict",
        );
    }
    text.push_str(&quality(estimate));
    text
}

/// Interval; an asterisk marks estimates outside.
fn interval(parameter: &ParameterEstimate) -> String {
    let [low, high] = parameter.interval_95;
    let mark = if is_outside(parameter) { " *" } else { "" };
    format!("{} .. {}{mark}", significant(low, 5), significant(high, 5))
}

/// Errors, condition number and elimination path of an estimate.
fn quality(estimate: &Estimate) -> String {
    let mut text = String::new();
    // A norm over N and N m has no unit.
    let residual_norm = if is_mixed(&estimate.lines) {
        String::new()
    } else {
        format!(" residual norm {},", significant(estimate.residual_norm, 7))
    };
    paragraph(
        &mut text,
        "",
        &format!(
            "relative error {},{} condition number {}, {} equations{}",
            relative_words(&estimate.lines, estimate.relative_error_percent, 5),
            residual_norm,
            significant(estimate.condition_number, 6),
            estimate.equations,
            if estimate.weighted { ", weighted" } else { "" },
        ),
    );
    let header = ["residual of", "unit", "rms", "error %", "fit %"];
    let rows = estimate.lines.iter().map(|line| {
        let mut row = vec![line.name.clone(), line.unit.to_owned()];
        row.extend(cells(Some(line)));
        row
    });
    text.push_str(&table(&header, rows.collect()));
    if let Some(partition) = &estimate.partition
        && estimate.model == ModelKind::Actuators
    {
        paragraph(
            &mut text,
            "",
            &format!(
                "condition number of the kept actuators: at most {} ({}, t = {:.3} s)",
                significant(partition.largest, 4),
                partition.run,
                partition.time
            ),
        );
    }
    if !estimate.removals.is_empty() {
        let rows = estimate.removals.iter().map(|removal| {
            vec![
                removal.name.clone(),
                significant(removal.relative_standard_deviation_percent, 4),
                significant(removal.deviation_ratio, 4),
                format!("{:.4}", removal.relative_error_before_percent),
                format!("{:.4}", removal.relative_error_after_percent),
                removal
                    .held_out_after_percent
                    .map_or_else(|| String::from("-"), |percent| format!("{percent:.4}")),
                significant(removal.f_statistic.sqrt(), 3),
                String::from(if removal.accepted { "" } else { "kept" }),
            ]
        });
        let header = [
            "eliminated",
            "% sigma",
            "max/min",
            "error % before",
            "after",
            "validation",
            "|value|/sigma",
            "",
        ];
        text.push_str(&table(&header, rows.collect()));
    }
    if let Some(stop) = &estimate.stop {
        paragraph(&mut text, "", &format!("the elimination stopped: {stop}"));
    }
    text
}

/// Cross-validation of all estimates.
#[must_use]
pub fn cross_validation(all: &[CrossValidation]) -> String {
    let list = |errors: &[LineError]| -> String {
        let errors: Vec<String> = errors
            .iter()
            .map(|error| format!("{:.2}", error.relative_error_percent))
            .collect();
        errors.join(" ")
    };
    let redundant = all.iter().any(|one| !one.projected_torques.is_empty());
    let mut header = vec![
        "run",
        "model",
        "stage",
        "residual norm",
        "error %",
        "torques %",
    ];
    if redundant {
        header.push("without preload %");
    }
    let rows = all.iter().map(|one| {
        let mut row = vec![
            one.run.clone(),
            one.model.name().to_owned(),
            one.stage.name().to_owned(),
            if is_mixed(&one.lines) {
                String::from("-")
            } else {
                significant(one.residual_norm, 7)
            },
            format!("{:.4}", relative(&one.lines, one.relative_error_percent)),
            list(&one.torques),
        ];
        if redundant {
            row.push(list(&one.projected_torques));
        }
        row
    });
    format!("Cross-validation\n{}", table(&header, rows.collect()))
}

#[cfg(test)]
mod tests {
    use super::coefficient;

    #[test]
    fn coefficients_are_printed_as_simple_fractions() {
        assert_eq!(coefficient(0.28 * 0.28), "0.0784");
        assert_eq!(coefficient(1.0 / 0.28), "(25/7)");
        assert_eq!(coefficient(0.11 * 0.11 / 0.28), "(121/2800)");
        assert_eq!(coefficient(std::f64::consts::PI), "3.14159");
        assert_eq!(coefficient(1.0), "1");
    }
}
