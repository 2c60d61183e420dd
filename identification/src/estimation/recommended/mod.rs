//! The recommended model: the smallest one that the data do not refute.
//!
//! Parameters are cancelled as the paper does it, the one of the largest relative standard deviation
//! first (see the module `essential`). Where to stop is asked of the data at every step, twice:
//!
//! - Could all cancelled parameters C be zero together? With their base estimates χ_C and the
//!   covariance V_C of the module `intervals`, whose degrees of freedom are ν, and k of them,
//!   F = (ν - k + 1)/(ν k) χ_Cᵀ V_C^-1 χ_C follows Fisher's distribution of k and ν - k + 1 degrees of
//!   freedom if they are (Hotelling's test). A set that should exceed F with a probability below the
//!   level is refused: of right models at most that many are refused, whatever the residual is like.
//!   A covariance of ν degrees of freedom can't tell of more than ν/2 parameters, which is the end, too.
//! - Are data that were held out predicted worse than by the base model? The differences of the squared
//!   errors of the folds are compared with their spread by Student's test of the same level, one-sided.
//!
//! Unlike r_σ, none of this asks whether a parameter is large: friction of one percent of the torque
//! stays where the data know it.

#[cfg(test)]
mod tests;

use super::{
    essential::HeldOut,
    estimate::{Estimation, condition, fit},
    intervals::{
        Intervals,
        distributions::{fisher_tail, student_quantile},
    },
};
use crate::{error::Error, regression::system::System, settings::Settings};

/// How often right models are refused, at most.
const LEVEL: f64 = 0.05;

/// Folds whose spread is worth a test.
const FEWEST_FOLDS: usize = 3;

/// The recommended parameters.
#[derive(Debug, Clone)]
pub(crate) struct Recommended {
    /// Columns that are left, in the order of the base parameters.
    pub(crate) selected: Vec<usize>,
    /// Their names.
    pub(crate) names: Vec<String>,
    /// Their estimates.
    pub(crate) estimation: Estimation,
    /// Why no more was cancelled, in words.
    pub(crate) stop: String,
}

/// Cancels parameters of the base estimation `start` of the columns `selected` with their `names`, of
/// which `intervals` knows the covariance; `folds` are the parts of the data that are held out.
///
/// # Errors
/// An estimation that is not possible.
pub(crate) fn recommended(
    system: &System,
    (selected, names): (&[usize], &[String]),
    start: &Estimation,
    (intervals, folds): (&Intervals, Option<&HeldOut>),
    settings: &Settings,
) -> Result<Recommended, Error> {
    let base = folds.and_then(|folds| folds.squares(selected));
    let mut here = Recommended {
        selected: selected.to_vec(),
        names: names.to_vec(),
        estimation: start.clone(),
        stop: String::from("a single parameter is left"),
    };
    if settings.r_sigma.is_infinite() {
        here.stop = String::from("nothing is to be cancelled");
        return Ok(here);
    }
    while here.selected.len() > 1 {
        let worst = largest_deviation(&here.estimation);
        let name = here.names[worst].clone();
        let mut left = here.selected.clone();
        left.remove(worst);
        let is_cancelled = |column: &&usize| !left.contains(column);
        let cancelled: Vec<usize> = selected.iter().filter(is_cancelled).copied().collect();
        if let Some(reason) = refuted(intervals, &cancelled) {
            here.stop = format!("without `{name}`, {reason}");
            break;
        }
        let after = folds.and_then(|folds| folds.squares(&left));
        if let (Some(base), Some(after)) = (&base, &after)
            && grows(base, after)
        {
            here.stop = format!("without `{name}`, data that were held out are predicted worse");
            break;
        }
        here.estimation = fit(system, &left, settings)?;
        here.selected = left;
        here.names.remove(worst);
    }
    here.estimation.condition_number = condition(system, &here.selected);
    Ok(here)
}

/// The place of the largest relative standard deviation.
fn largest_deviation(estimation: &Estimation) -> usize {
    let deviations = estimation.relative_standard_deviations_percent.iter();
    let largest = deviations.enumerate().max_by(|a, b| a.1.total_cmp(b.1));
    largest.map_or(0, |(place, _)| place)
}

/// Why the data do not let all these base parameters be zero, in words.
fn refuted(intervals: &Intervals, cancelled: &[usize]) -> Option<String> {
    let count = cancelled.len() as f64;
    let Some((square, freedom)) = intervals.distance(cancelled) else {
        return Some(String::from("the data could not tell what is cancelled"));
    };
    let rest = freedom - count + 1.0;
    if count > 0.5 * freedom {
        return Some(format!(
            "{count} cancelled parameters would be more than these data can test together"
        ));
    }
    let f = rest / (freedom * count) * square;
    let probability = fisher_tail(f, count, rest);
    (probability < LEVEL).then(|| {
        format!(
            "what is cancelled could not all be zero: F = {f:.2} on {count} and {rest:.0} degrees of freedom, which chance exceeds with a probability of {probability:.1e}, below {LEVEL}"
        )
    })
}

/// Whether squared errors of folds have grown by more than chance explains.
fn grows(before: &[f64], after: &[f64]) -> bool {
    let count = before.len() as f64;
    let differences: Vec<f64> = after.iter().zip(before).map(|(a, b)| a - b).collect();
    let mean = differences.iter().sum::<f64>() / count;
    let squares: f64 = differences.iter().map(|d| (d - mean).powi(2)).sum();
    let deviation = (squares / (count - 1.0) / count).sqrt();
    before.len() >= FEWEST_FOLDS && mean > student_quantile(2.0 * LEVEL, count - 1.0) * deviation
}
