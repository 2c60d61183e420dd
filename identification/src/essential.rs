//! Essential parameters: backward elimination of the base parameters that the data do not
//! determine, section 5.3 of the paper.
//!
//! The parameter of the largest relative standard deviation is cancelled and the rest estimated
//! anew, until max σ_r/min σ_r < r_σ. The rule can walk past the right model: with weak excitation
//! it goes on cancelling parameters that the data do determine, while the relative error stays
//! harmless. So every step is recorded with a second opinion: t = |χ|/σ of the cancelled parameter,
//! whose square is the F statistic of the cancellation; above 5 the data speak clearly for it.

use serde::Serialize;

use crate::{
    error::Error,
    estimate::{Estimation, estimate},
    regression::System,
    settings::Settings,
};

/// A cancelled parameter of |χ|/σ above this was significant.
const SIGNIFICANT: f64 = 5.0;

/// Relative error in percent below which the fit is exact but for rounding, and deviations are
/// rounding, too.
const EXACT_PERCENT: f64 = 1e-7;

/// One step of the elimination.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct Removal {
    /// Name of the cancelled parameter.
    pub name: String,
    /// Its column.
    #[serde(skip)]
    pub column: usize,
    /// Its last estimate (SI units).
    pub value: f64,
    /// Its relative standard deviation, percent.
    pub relative_standard_deviation_percent: f64,
    /// max σ_r/min σ_r before the step.
    pub deviation_ratio: f64,
    /// ||ρ||/||Y|| before the step, percent.
    pub relative_error_before_percent: f64,
    /// ||ρ||/||Y|| after the step, percent.
    pub relative_error_after_percent: f64,
    /// F statistic of the cancellation, (χ/σ)² with the σ of correlated residuals.
    pub f_statistic: f64,
    /// Whether the parameter was significant all the same: F above the square of the threshold.
    pub significant: bool,
    /// ||ρ||/||Y|| on parts of the data that were not estimated from, before the step, percent; none
    /// where the data can't be divided.
    pub held_out_before_percent: Option<f64>,
    /// The same after the step.
    pub held_out_after_percent: Option<f64>,
    /// The remaining parameter that the step moves most, seen from the base estimate and counted in
    /// units of the tolerance.
    pub drift: Option<Drift>,
    /// Whether the step was taken; only the last one can be refused.
    pub accepted: bool,
    /// Why it was taken or refused, in words.
    pub reason: String,
}

/// How far a step of the elimination leads a remaining parameter from its base estimate.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct Drift {
    /// Name of the parameter.
    pub parameter: String,
    /// 100 |change|/|base estimate|.
    pub percent: f64,
    /// |change|/σ of the base estimate under correlated residuals.
    pub deviations: f64,
}

/// The essential parameters and the way to them.
#[derive(Debug, Clone, PartialEq)]
pub struct Essential {
    /// Columns that are left, in the order of the base parameters.
    pub selected: Vec<usize>,
    /// Their names.
    pub names: Vec<String>,
    /// Their estimates.
    pub estimation: Estimation,
    /// What was cancelled, in order, and the step that was refused, if one was.
    pub removals: Vec<Removal>,
    /// Why the elimination ended, in words.
    pub stop: String,
}

/// Eliminates parameters, starting from the estimation `start` of the columns `selected` with
/// their `names`.
///
/// # Errors
/// An estimation that is not possible.
pub fn essential(
    system: &System,
    selected: &[usize],
    names: &[String],
    start: &Estimation,
    settings: &Settings,
) -> Result<Essential, Error> {
    let mut selected = selected.to_vec();
    let mut names = names.to_vec();
    let mut estimation = start.clone();
    let mut removals = Vec::new();
    while selected.len() > 1 && estimation.relative_error_percent > EXACT_PERCENT {
        let ratio = estimation.deviation_ratio();
        if ratio < settings.r_sigma {
            break;
        }
        let deviations = &estimation.relative_standard_deviations_percent;
        let Some((worst, &deviation)) = deviations
            .iter()
            .enumerate()
            .max_by(|a, b| a.1.total_cmp(b.1))
        else {
            break;
        };
        let significant = deviation < 100.0 / SIGNIFICANT;
        if significant && settings.keep_significant {
            break;
        }
        let (column, name) = (selected.remove(worst), names.remove(worst));
        let next = estimate(system, &selected, settings)?;
        removals.push(Removal {
            name,
            column,
            value: estimation.values[worst],
            relative_standard_deviation_percent: deviation,
            deviation_ratio: ratio,
            relative_error_before_percent: estimation.relative_error_percent,
            relative_error_after_percent: next.relative_error_percent,
            f_statistic: (100.0 / deviation).powi(2),
            significant,
            held_out_before_percent: None,
            held_out_after_percent: None,
            drift: None,
            accepted: true,
            reason: String::new(),
        });
        estimation = next;
    }
    Ok(Essential {
        selected,
        names,
        estimation,
        removals,
        stop: String::new(),
    })
}
