//! Recommended parameters: the smallest model that the data do not refute.
//!
//! Parameters are removed in the paper's order, largest relative standard deviation first (see the
//! module `essential`). Two tests decide where to stop:
//!
//! - Can all k removed parameters C be zero? They have the base estimates χ_C and the covariance
//!   V_C of the module `intervals` with ν degrees of freedom. Then F = (ν - k + 1)/(ν k) χ_Cᵀ
//!   V_C^-1 χ_C has Fisher's distribution with k and ν - k + 1 degrees of freedom (Hotelling's
//!   test). The step is refused if its p-value is below the level, so at most that fraction of
//!   right models is refused. The elimination also ends at ν/2 removed parameters, since V cannot
//!   test more.
//! - Does the prediction of folds worsen compared with the base model? Student's one-sided test
//!   compares the differences of their squared errors with the spread, at the same level.
//!
//! Unlike r_σ, neither test depends on the size of a parameter. Friction of one percent of the
//! torque is kept if the data determine it.

#[cfg(test)]
mod tests;

use super::{
    essential::CrossValidationFolds,
    estimate::{Estimation, condition, fit},
    intervals::{
        Intervals,
        distributions::{fisher_tail, student_quantile},
    },
};
use crate::{regression::system::System, settings::Settings};
use overact_logs::Error;

/// Level of both tests: the largest fraction of right models that is refused.
const LEVEL: f64 = 0.05;

/// Fewest folds for the test of their errors.
const FEWEST_FOLDS: usize = 3;

/// Recommended parameters.
#[derive(Debug, Clone)]
pub(crate) struct Recommended {
    /// Remaining columns, in the order of the base parameters.
    pub(crate) selected: Vec<usize>,
    /// Their names.
    pub(crate) names: Vec<String>,
    /// Their estimates.
    pub(crate) estimation: Estimation,
    /// Reason for the end of the elimination, in words.
    pub(crate) stop: String,
}

/// Estimate of all base parameters that the data separate.
pub(crate) struct BaseEstimate<'a> {
    /// Columns of the base parameters.
    pub(crate) selected: &'a [usize],
    /// Their names.
    pub(crate) names: &'a [String],
    pub(crate) estimation: &'a Estimation,
    /// Intervals with the covariance of the estimates.
    pub(crate) intervals: &'a Intervals,
}

/// Eliminates parameters from the estimate `start`; `folds` serve for cross-validation.
///
/// # Errors
/// An estimation fails.
pub(crate) fn recommended(
    system: &System,
    start: &BaseEstimate<'_>,
    folds: Option<&CrossValidationFolds>,
    settings: &Settings,
) -> Result<Recommended, Error> {
    let selected = start.selected;
    let base = folds.and_then(|folds| folds.squares(selected));
    let mut here = Recommended {
        selected: selected.to_vec(),
        names: start.names.to_vec(),
        estimation: start.estimation.clone(),
        stop: String::from("one parameter is left"),
    };
    if settings.r_sigma.is_infinite() {
        here.stop = String::from("the settings cancel nothing");
        return Ok(here);
    }
    while here.selected.len() > 1 {
        let worst = largest_deviation(&here.estimation);
        let name = here.names[worst].clone();
        let mut left = here.selected.clone();
        left.remove(worst);
        let is_cancelled = |column: &&usize| !left.contains(column);
        let cancelled: Vec<usize> = selected.iter().filter(is_cancelled).copied().collect();
        if let Some(reason) = refuted(start.intervals, &cancelled) {
            here.stop = format!("without `{name}`, {reason}");
            break;
        }
        let after = folds.and_then(|folds| folds.squares(&left));
        if let (Some(base), Some(after)) = (&base, &after)
            && grows(base, after)
        {
            here.stop = format!("without `{name}`, validation data are predicted worse");
            break;
        }
        here.estimation = fit(system, &left, settings)?;
        here.selected = left;
        here.names.remove(worst);
    }
    here.estimation.condition_number = condition(system, &here.selected);
    Ok(here)
}

/// Index of the largest relative standard deviation.
fn largest_deviation(estimation: &Estimation) -> usize {
    let deviations = estimation.relative_standard_deviations_percent.iter();
    let largest = deviations.enumerate().max_by(|a, b| a.1.total_cmp(b.1));
    largest.map_or(0, |(place, _)| place)
}

/// Why these base parameters cannot all be zero, in words; `None` if they can.
fn refuted(intervals: &Intervals, cancelled: &[usize]) -> Option<String> {
    let count = cancelled.len() as f64;
    let Some((square, freedom)) = intervals.distance(cancelled) else {
        return Some(String::from(
            "the data do not determine the cancelled parameters",
        ));
    };
    let rest = freedom - count + 1.0;
    if count > 0.5 * freedom {
        return Some(format!(
            "these data cannot test {count} cancelled parameters together"
        ));
    }
    let f = rest / (freedom * count) * square;
    let probability = fisher_tail(f, count, rest);
    (probability < LEVEL).then(|| {
        format!(
            "the cancelled parameters are not all zero: F = {f:.2} with {count} and {rest:.0} degrees of freedom, probability {probability:.1e}, below {LEVEL}"
        )
    })
}

/// Whether the squared errors of folds have grown significantly.
fn grows(before: &[f64], after: &[f64]) -> bool {
    let count = before.len() as f64;
    let differences: Vec<f64> = after.iter().zip(before).map(|(a, b)| a - b).collect();
    let mean = differences.iter().sum::<f64>() / count;
    let squares: f64 = differences.iter().map(|d| (d - mean).powi(2)).sum();
    let deviation = (squares / (count - 1.0) / count).sqrt();
    before.len() >= FEWEST_FOLDS && mean > student_quantile(2.0 * LEVEL, count - 1.0) * deviation
}
