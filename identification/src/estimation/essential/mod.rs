//! Essential parameters by backward elimination, section 5.3 of the paper, with two further tests.
//!
//! The paper removes the parameter of largest relative standard deviation and repeats until max
//! σ_r/min σ_r < r_σ. With weak excitation, this rule also removes parameters that the data
//! determine, while the relative error stays small. Two tests therefore judge each step:
//!
//! - *Significance*: F = (χ/σ)² tests whether the parameter is zero, with σ for correlated
//!   residuals. A parameter with F above the squared threshold is significant.
//! - *Consequence*: a significant parameter may still be unimportant, such as friction of a light
//!   robot. It matters if its removal worsens the prediction of folds left out of the estimation.
//!   It also matters if another parameter drifts from its base estimate enough to change the
//!   torques.
//!
//! A significant parameter that matters is kept, and the elimination ends there. The path is
//! recorded as far as r_σ alone would go, to compare both ends.

mod cross_validation;

use serde::Serialize;

use super::{
    correlation::Noise,
    estimate::{Estimation, condition, fit},
};
use crate::{
    regression::{factor::Factor, system::System},
    settings::Settings,
    thresholds::Thresholds,
};
use overact_logs::Error;

pub(crate) use cross_validation::CrossValidationFolds;

/// Relative error in percent below which the fit is exact up to rounding.
///
/// Standard deviations are then rounding errors, too.
const EXACT_PERCENT: f64 = 1e-7;

/// One step of the elimination.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct Removal {
    /// Name of the removed parameter.
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
    /// F statistic of the removal, (χ/σ)² with σ for correlated residuals.
    pub f_statistic: f64,
    /// Whether the parameter was significant: F above the squared threshold.
    pub significant: bool,
    /// Cross-validated ||ρ||/||Y|| before the step, percent; `None` if the data cannot be divided.
    pub held_out_before_percent: Option<f64>,
    /// Cross-validated ||ρ||/||Y|| after the step, percent.
    pub held_out_after_percent: Option<f64>,
    /// The remaining parameter with the largest drift from its base estimate.
    pub drift: Option<Drift>,
    /// Whether the step was taken.
    ///
    /// After the first refused step follow those that r_σ alone would have taken.
    pub accepted: bool,
    /// Reason, in words.
    pub reason: String,
}

/// Drift of a remaining parameter from its base estimate.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct Drift {
    /// Name of the parameter.
    pub parameter: String,
    /// 100 |change|/|base estimate|.
    pub percent: f64,
    /// |change|/σ of the base estimate under correlated residuals.
    pub deviations: f64,
    /// 100 ||column|| |change|/||inputs||.
    pub inputs_percent: f64,
}

/// Essential parameters and the path of the elimination.
#[derive(Debug, Clone)]
#[non_exhaustive]
pub struct Essential {
    /// Remaining columns, in the order of the base parameters.
    pub selected: Vec<usize>,
    /// Their names.
    pub names: Vec<String>,
    /// Their estimates.
    pub estimation: Estimation,
    /// Removed parameters in order, and the refused step, if there is one.
    pub removals: Vec<Removal>,
    /// Reason for the end of the elimination, in words.
    pub stop: String,
    /// Correlation of the base estimate's residual.
    pub(crate) noise: Option<Noise>,
    /// Folds of the cross-validation.
    pub(crate) folds: Option<CrossValidationFolds>,
}

/// Eliminates parameters, starting from the estimation `start` of the columns `selected`.
///
/// `names` are those of the columns.
///
/// # Errors
/// An estimation fails.
pub fn essential(
    system: &System,
    selected: &[usize],
    names: &[String],
    start: &Estimation,
    settings: &Settings,
) -> Result<Essential, Error> {
    let elimination = Elimination::new(system, selected, names, start, settings);
    let mut here = EliminationState {
        held_out: elimination.held_out(selected),
        selected: selected.to_vec(),
        names: names.to_vec(),
        estimation: start.clone(),
    };
    let mut end = None;
    let mut removals: Vec<Removal> = Vec::new();
    while let Some(worst) = elimination.worst(&here) {
        let next = elimination.without(&here, worst)?;
        let mut removal = elimination.removal(&here, worst, &next);
        if end.is_some() {
            removal.accepted = false;
            removal.reason = String::from("only r_σ alone reaches this");
        } else if !removal.accepted {
            end = Some(here);
        }
        removals.push(removal);
        here = next;
    }
    let stop = stop(&removals, &here, settings);
    let end = end.unwrap_or(here);
    let condition_number = condition(system, &end.selected);
    Ok(Essential {
        selected: end.selected,
        names: end.names,
        estimation: Estimation {
            condition_number,
            ..end.estimation
        },
        removals,
        stop,
        noise: elimination.noise,
        folds: elimination.folds,
    })
}

/// Reason for the end of the elimination; `last` is where r_σ alone ends.
fn stop(removals: &[Removal], last: &EliminationState, settings: &Settings) -> String {
    let refused = removals.iter().find(|removal| !removal.accepted);
    match refused {
        Some(refused) => format!(
            "the additional criterion keeps `{}`: {}; r_σ = {} alone would have kept {} parameter{}",
            refused.name,
            refused.reason,
            settings.r_sigma,
            last.selected.len(),
            if last.selected.len() == 1 { "" } else { "s" }
        ),
        None if last.estimation.relative_error_percent <= EXACT_PERCENT => {
            String::from("the model fits exactly")
        }
        None if last.selected.len() == 1 => String::from("one parameter is left"),
        None => format!(
            "the largest relative standard deviation is {:.3} times the smallest, less than r_σ = {}",
            last.estimation.deviation_ratio(),
            settings.r_sigma
        ),
    }
}

/// State of the elimination.
struct EliminationState {
    selected: Vec<usize>,
    names: Vec<String>,
    estimation: Estimation,
    held_out: Option<f64>,
}

/// Data that all steps share.
struct Elimination<'a> {
    system: &'a System,
    settings: &'a Settings,
    thresholds: Thresholds,
    noise: Option<Noise>,
    folds: Option<CrossValidationFolds>,
    /// Significant base parameters.
    base: Vec<SignificantParameter>,
}

/// A significant base parameter.
struct SignificantParameter {
    column: usize,
    value: f64,
    deviation: f64,
    /// Norm of its column divided by that of the inputs.
    influence: f64,
}

impl<'a> Elimination<'a> {
    fn new(
        system: &'a System,
        selected: &[usize],
        names: &[String],
        start: &Estimation,
        settings: &'a Settings,
    ) -> Self {
        debug_assert_eq!(selected.len(), names.len());
        let thresholds = Thresholds::default();
        let noise = Noise::new(system, selected, start);
        let deviations = deviations(noise.as_ref(), selected, start);
        let all = selected.iter().zip(&start.values).zip(deviations);
        let base = all.map(|((&column, &value), deviation)| SignificantParameter {
            column,
            value,
            deviation,
            influence: influence(system, column),
        });
        Self {
            base: base
                .filter(|one| one.value.abs() > thresholds.significance * one.deviation)
                .collect(),
            folds: CrossValidationFolds::new(system, selected, &start.weights),
            system,
            settings,
            thresholds,
            noise,
        }
    }

    /// Cross-validated relative error with these columns, percent.
    fn held_out(&self, selected: &[usize]) -> Option<f64> {
        self.folds.as_ref()?.error_percent(selected)
    }

    /// The parameter that r_σ would remove next; `None` where r_σ stops.
    fn worst(&self, here: &EliminationState) -> Option<usize> {
        let estimation = &here.estimation;
        if here.selected.len() < 2
            || estimation.relative_error_percent <= EXACT_PERCENT
            || estimation.deviation_ratio() < self.settings.r_sigma
        {
            return None;
        }
        let deviations = estimation.relative_standard_deviations_percent.iter();
        let largest = deviations.enumerate().max_by(|a, b| a.1.total_cmp(b.1));
        largest.map(|(worst, _)| worst)
    }

    /// The state without one of the parameters.
    fn without(&self, here: &EliminationState, worst: usize) -> Result<EliminationState, Error> {
        let (mut selected, mut names) = (here.selected.clone(), here.names.clone());
        selected.remove(worst);
        names.remove(worst);
        Ok(EliminationState {
            estimation: fit(self.system, &selected, self.settings)?,
            held_out: self.held_out(&selected),
            selected,
            names,
        })
    }

    /// The step between two states, with its tests.
    fn removal(&self, here: &EliminationState, worst: usize, next: &EliminationState) -> Removal {
        let (estimation, rest) = (&here.estimation, &next.estimation);
        let value = estimation.values[worst];
        let own = deviations(self.noise.as_ref(), &here.selected, estimation)[worst];
        let ratio = value.abs() / own;
        let significant = ratio > self.thresholds.significance;
        let drift = self.drift(next);
        // Without folds, use the error on the training data.
        let (before, after) = match (here.held_out, next.held_out) {
            (Some(before), Some(after)) => (before, after),
            _ => (
                estimation.relative_error_percent,
                rest.relative_error_percent,
            ),
        };
        let growth = (after * after - before * before).max(0.0).sqrt();
        let grows = growth > self.thresholds.held_out_growth_percent;
        let moved = drift.as_ref().filter(|drift| self.measure(drift) > 1.0);
        let matters = grows || moved.is_some() || self.settings.keep_significant;
        let reason = if !significant {
            format!("the data do not require it: |χ|/σ = {ratio:.1}")
        } else if let (false, Some(drift)) = (grows, moved) {
            format!(
                "the data require it, |χ|/σ = {ratio:.0}, and without it `{}` would shift by {:.0} %",
                drift.parameter, drift.percent
            )
        } else if matters {
            format!(
                "the data require it, |χ|/σ = {ratio:.0}, and without it the validation residual would grow by {growth:.2} %"
            )
        } else {
            format!(
                "the data require it, |χ|/σ = {ratio:.0}, but without it the validation residual grows by only {growth:.2} %"
            )
        };
        Removal {
            name: here.names[worst].clone(),
            column: here.selected[worst],
            value,
            relative_standard_deviation_percent: estimation.relative_standard_deviations_percent
                [worst],
            deviation_ratio: estimation.deviation_ratio(),
            relative_error_before_percent: estimation.relative_error_percent,
            relative_error_after_percent: rest.relative_error_percent,
            f_statistic: ratio * ratio,
            significant,
            held_out_before_percent: here.held_out,
            held_out_after_percent: next.held_out,
            drift,
            accepted: !(significant && matters),
            reason,
        }
    }

    /// The significant parameter with the largest drift, in units of the tolerance.
    fn drift(&self, next: &EliminationState) -> Option<Drift> {
        let places = next.selected.iter().enumerate();
        let drifts = places.filter_map(|(place, column)| {
            let base = self.base.iter().find(|base| base.column == *column)?;
            let change = (next.estimation.values[place] - base.value).abs();
            Some(Drift {
                parameter: next.names[place].clone(),
                percent: 100.0 * change / base.value.abs(),
                deviations: change / base.deviation,
                inputs_percent: 100.0 * change * base.influence,
            })
        });
        drifts.max_by(|a, b| self.measure(a).total_cmp(&self.measure(b)))
    }

    /// A drift in units of the tolerance.
    ///
    /// It counts only if it is large for the parameter, beyond the noise and large for the inputs.
    fn measure(&self, drift: &Drift) -> f64 {
        let tolerance = &self.thresholds;
        (drift.percent / tolerance.drift_percent)
            .min(drift.deviations / tolerance.significance)
            .min(drift.inputs_percent / tolerance.held_out_growth_percent)
    }
}

/// Norm of a column divided by that of the inputs.
fn influence(system: &System, column: usize) -> f64 {
    let norm = |of: &dyn Fn(&Factor) -> f64| {
        let squares = system.lines.iter().map(|line| of(line).powi(2));
        squares.sum::<f64>().sqrt()
    };
    let measured = norm(&Factor::measured_norm);
    if measured > 0.0 {
        norm(&|line| line.matrix().column(column).norm()) / measured
    } else {
        0.0
    }
}

/// Standard deviations for correlated residuals if known, else for white ones.
fn deviations(noise: Option<&Noise>, selected: &[usize], estimation: &Estimation) -> Vec<f64> {
    noise.map_or_else(
        || estimation.standard_deviations.clone(),
        |noise| noise.deviations(selected, estimation),
    )
}
