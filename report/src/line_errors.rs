//! Errors of single lines and drives: root mean square, relative error and fit.
//!
//! A norm over lines in N and N m has no unit. Texts therefore give the largest relative error of a
//! line if the units differ.

use crate::choice::{answers, of};
use overact_identification::{
    Consistent, CrossValidation, Estimate, Identification, LineError, Stage, significant,
};

/// Whether lines have different units.
pub(crate) fn is_mixed(lines: &[LineError]) -> bool {
    lines.windows(2).any(|pair| pair[0].unit != pair[1].unit)
}

/// Relative error of all lines in percent; with different units the largest one of a line.
pub(crate) fn relative(lines: &[LineError], overall: f64) -> f64 {
    match LineError::worst(lines) {
        Some(worst) if is_mixed(lines) => worst.relative_error_percent,
        _ => overall,
    }
}

/// [`relative`] in words: `1.2 %`, or `at most 1.5 % of each torque`.
pub(crate) fn relative_words(lines: &[LineError], overall: f64, digits: usize) -> String {
    let percent = significant(relative(lines, overall), digits);
    if is_mixed(lines) {
        format!("at most {percent} % of each torque")
    } else {
        format!("{percent} %")
    }
}

/// Relative error of the base parameters that belong to consistent ones, in words.
pub(crate) fn base_words(identification: &Identification, one: &Consistent) -> String {
    let overall = one.base_relative_error_percent;
    let base = of(identification, one.model, Stage::Base);
    let lines = base.map_or(&[][..], |base| base.lines.as_slice());
    relative_words(lines, overall, 4)
}

/// Relative error of an estimate on its worst validation run, in words; `None` without such runs.
///
/// It is the same figure as [`relative_words`] of the training runs.
pub(crate) fn validation_words(
    identification: &Identification,
    estimate: &Estimate,
) -> Option<String> {
    let error = |run: &CrossValidation| relative(&run.lines, run.relative_error_percent);
    let runs = validations(identification, estimate);
    let worst = runs.max_by(|a, b| error(a).total_cmp(&error(b)))?;
    let words = relative_words(&worst.lines, worst.relative_error_percent, 3);
    Some(match validations(identification, estimate).count() {
        1 => format!("{words} (validation)"),
        _ => format!("{words} (worst validation run)"),
    })
}

/// Validation runs of an estimate.
fn validations<'a>(
    identification: &'a Identification,
    estimate: &Estimate,
) -> impl Iterator<Item = &'a CrossValidation> {
    let (model, stage) = (estimate.model, estimate.stage);
    let all = identification.cross_validation.iter();
    all.filter(move |run| run.model == model && run.stage == stage)
}

/// Errors of one line or drive on the training runs and on the worst validation run.
#[derive(Debug, Clone, PartialEq)]
pub(crate) struct ErrorRow<'a> {
    /// Model, if there are several.
    pub(crate) model: Option<&'static str>,
    /// Name of the coordinate or drive.
    pub(crate) name: &'a str,
    /// Unit of the root mean square.
    pub(crate) unit: &'static str,
    /// Errors on all training runs; `None` for torques that are only predicted.
    pub(crate) training: Option<&'a LineError>,
    /// Errors on the validation run with the largest relative error; `None` without one.
    pub(crate) validation: Option<&'a LineError>,
}

/// Rows of all results.
///
/// With more drives than lines, the torques of all drives follow, which are predicted on validation
/// runs only. The prediction has least norm. If that differs from the measured torques by a preload,
/// as in cable robots, the measured torques without preload are compared.
pub(crate) fn rows<'a>(identification: &'a Identification) -> Vec<ErrorRow<'a>> {
    let answers = answers(identification);
    let has_several = answers.len() > 1;
    let mut rows = Vec::new();
    for estimate in &answers {
        for line in &estimate.lines {
            let of_line = validations(identification, estimate).flat_map(|run| &run.lines);
            rows.push(ErrorRow {
                model: has_several.then_some(estimate.model.name()),
                name: &line.name,
                unit: line.unit,
                training: Some(line),
                validation: worst(of_line, &line.name),
            });
        }
    }
    if let (Some(first), true) = (answers.first(), has_several) {
        let runs = || validations(identification, first);
        let has_preload = runs().any(has_preload);
        let torques = |run: &'a CrossValidation| -> &'a [LineError] {
            if has_preload {
                &run.projected_torques
            } else {
                &run.torques
            }
        };
        for drive in runs().next().into_iter().flat_map(torques) {
            rows.push(ErrorRow {
                model: Some(if has_preload {
                    "without preload"
                } else {
                    "torque"
                }),
                name: &drive.name,
                unit: drive.unit,
                training: None,
                validation: worst(runs().flat_map(torques), &drive.name),
            });
        }
    }
    rows
}

/// Part of the squared errors that is left without a preload, if there is one.
const PRELOAD: f64 = 0.25;

/// Whether most of the errors of torques of least norm is a preload.
fn has_preload(run: &CrossValidation) -> bool {
    let sum = |lines: &[LineError]| lines.iter().map(|one| one.rms * one.rms).sum::<f64>();
    let rest = sum(&run.projected_torques);
    !run.projected_torques.is_empty() && rest < PRELOAD * sum(&run.torques)
}

/// Error with the largest relative residual among those of a name.
fn worst<'a>(all: impl Iterator<Item = &'a LineError>, name: &str) -> Option<&'a LineError> {
    let own = all.filter(|one| one.name == name);
    own.max_by(|a, b| {
        a.relative_error_percent
            .total_cmp(&b.relative_error_percent)
    })
}

/// Root mean square, relative error in percent and fit in percent, as text.
pub(crate) fn cells(error: Option<&LineError>) -> [String; 3] {
    let nothing = || String::from("-");
    let number = |value: Option<f64>, digits: usize| {
        let known = value.filter(|value| value.is_finite());
        known.map_or_else(nothing, |value| significant(value, digits))
    };
    // A fit near 100 % keeps two decimals.
    let fit = error.and_then(|one| one.nrmse_fit_percent);
    let fit = fit.filter(|value| value.is_finite());
    [
        number(error.map(|one| one.rms), 3),
        number(error.map(|one| one.relative_error_percent), 3),
        fit.map_or_else(nothing, |value| format!("{value:.2}")),
    ]
}

#[cfg(test)]
mod tests {
    use super::{cells, is_mixed, relative, relative_words};
    use overact_identification::{LineError, LineNorms};

    fn line(name: &str, unit: &'static str, residual: f64) -> LineError {
        let norms = LineNorms {
            residual,
            measured: 100.0,
            variation: 50.0,
        };
        LineError::new(name, unit, &norms, 400)
    }

    #[test]
    fn error_figures_match_their_definitions() {
        let [rms, error, fit] = cells(Some(&line("leg1", "N m", 2.0)));
        assert_eq!(
            (rms.as_str(), error.as_str(), fit.as_str()),
            ("0.1", "2", "96.00")
        );
        let constant = LineNorms {
            residual: 1.0,
            measured: 10.0,
            variation: 0.0,
        };
        let constant = LineError::new("leg1", "N", &constant, 4);
        assert_eq!(cells(Some(&constant))[2], "-");
        assert_eq!(cells(None), ["-", "-", "-"]);
    }

    #[test]
    fn norms_never_mix_units() {
        let (force, moment) = (line("x", "N", 1.0), line("phi", "N m", 3.0));
        let mixed = [force.clone(), moment];
        assert!(is_mixed(&mixed));
        assert!((relative(&mixed, 1.5) - 3.0).abs() < 1e-12);
        assert_eq!(relative_words(&mixed, 1.5, 3), "at most 3 % of each torque");
        let one_unit = [force.clone(), force];
        assert_eq!(relative_words(&one_unit, 1.0, 3), "1 %");
    }
}
