//! Reported result on errors in the regressor of one model: test, estimates and strength.

use serde::Serialize;

use super::{
    Instrumental,
    hausman::{Hausman, LEVEL},
    strength::{WEAK, strengths},
};
use crate::{
    estimation::{estimate::Estimation, instruments::total_least_squares::total_least_squares},
    regression::{projection::ModelKind, system::System},
    settings::Instruments,
};
use overact_logs::Periods;

/// Largest correlation between the errors of two periods.
///
/// Above it, instruments of other periods keep more than a fifth of the bias.
const LARGEST_CORRELATION: f64 = 0.2;

/// Comparison of least squares and instrumental variables for one model.
#[derive(Debug, Clone, PartialEq, Serialize)]
#[non_exhaustive]
pub struct ErrorsInRegressor {
    /// The model.
    pub model: ModelKind,
    /// Source of the instruments.
    pub instruments: Instruments,
    /// Periods of each run, for instruments from other periods.
    #[serde(skip_serializing_if = "Vec::is_empty")]
    pub runs: Vec<RepeatedRun>,
    /// Reproduction of each run, for instruments from the simulated robot.
    #[serde(skip_serializing_if = "Vec::is_empty")]
    pub simulated: Vec<SimulatedRun>,
    /// Reason for missing or unusable instruments.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub missing: Option<String>,
    /// Test whether both estimates agree.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub agreement: Option<Agreement>,
    /// Comparison of each base parameter.
    #[serde(skip_serializing_if = "Vec::is_empty")]
    pub parameters: Vec<RegressorError>,
}

/// Periods of a run.
#[derive(Debug, Clone, PartialEq, Serialize)]
#[non_exhaustive]
pub struct RepeatedRun {
    /// Name of the run.
    pub run: String,
    /// Period in s, or the shortest multiple of it with a whole number of samples.
    pub period_s: f64,
    /// Whether the period was detected, not given.
    pub found: bool,
    /// Number of whole periods in the run.
    pub periods: usize,
    /// Correlation of the errors of two periods; `None` if the positions have no noise.
    pub error_correlation: Option<f64>,
}

/// How well the simulated robot reproduces a run.
#[derive(Debug, Clone, PartialEq, Serialize)]
#[non_exhaustive]
pub struct SimulatedRun {
    /// Name of the run.
    pub run: String,
    /// 100 ||τ simulated - τ measured||/||τ measured||, over all actuators and samples.
    pub torque_error_percent: f64,
}

/// Durbin-Wu-Hausman test.
#[derive(Debug, Clone, PartialEq, Serialize)]
#[non_exhaustive]
pub struct Agreement {
    /// F.
    pub statistic: f64,
    /// Its degrees of freedom.
    pub degrees_of_freedom: [f64; 2],
    /// p-value.
    pub probability: f64,
    /// Whether all parameters are tested together.
    ///
    /// With too few degrees of freedom, F is that of the parameter with the largest difference. The
    /// p-value is then that of any parameter to differ so much (Bonferroni).
    pub together: bool,
    /// Level below which the estimates differ.
    pub level: f64,
    /// Whether the estimates differ.
    pub differs: bool,
    /// Smallest F of the instruments' strength over all parameters.
    pub weakest: f64,
    /// F below which an instrument is weak.
    pub weak_below: f64,
}

/// One parameter by least squares, instrumental variables and total least squares.
#[derive(Debug, Clone, PartialEq, Serialize)]
#[non_exhaustive]
pub struct RegressorError {
    /// Name.
    pub name: String,
    /// SI unit.
    pub unit: String,
    /// Least-squares estimate.
    pub least_squares: f64,
    /// Instrumental-variable estimate.
    pub instruments: f64,
    /// Total-least-squares estimate, for comparison; `None` if it is undetermined.
    pub total_least_squares: Option<f64>,
    /// Standard deviation of the difference between the first two.
    pub difference_deviation: f64,
    /// p-value of the difference.
    pub probability: f64,
    /// Whether the difference is significant, at the level divided by the number of parameters, or
    /// at 5 % if all parameters together differ.
    pub differs: bool,
    /// Whether it also exceeds the standard deviation of least squares; then it is unusable.
    pub spoiled: bool,
    /// Partial R²: part of the column outside the others that the instruments reproduce.
    pub partial_r2: f64,
    /// F statistic of the partial R².
    pub strength: f64,
}

/// Least-squares and instrumental-variable estimates of the same columns.
pub(crate) struct EstimatePair<'a> {
    pub(crate) system: &'a System,
    /// Estimated columns.
    pub(crate) selected: &'a [usize],
    pub(crate) least_squares: &'a Estimation,
    /// Standard deviations of least squares for autocorrelated residuals.
    pub(crate) deviations: &'a [f64],
    pub(crate) instrumental: &'a Instrumental,
}

impl RepeatedRun {
    /// Periods of a run with this sampling frequency.
    pub(crate) fn new(run: &str, frequency: f64, found: bool, periods: &Periods) -> Self {
        Self {
            run: run.to_owned(),
            period_s: periods.samples as f64 / frequency,
            found,
            periods: periods.count,
            error_correlation: periods.correlation,
        }
    }

    /// Whether the errors repeat with the motion, so that other periods contain them, too.
    #[must_use]
    pub fn errors_return(&self) -> bool {
        self.error_correlation
            .is_some_and(|own| own > LARGEST_CORRELATION)
    }
}

impl ErrorsInRegressor {
    /// A model without instruments, with the reason.
    pub(crate) fn without(model: ModelKind, instruments: Instruments, why: Option<String>) -> Self {
        Self {
            model,
            instruments,
            runs: Vec::new(),
            simulated: Vec::new(),
            missing: why,
            agreement: None,
            parameters: Vec::new(),
        }
    }

    /// Compares two estimates of parameters with these names and units.
    pub(crate) fn compared(
        self,
        estimates: &EstimatePair<'_>,
        names: &[String],
        units: &[&str],
    ) -> Self {
        let &EstimatePair {
            system,
            selected,
            least_squares,
            deviations,
            instrumental,
        } = estimates;
        let Some(test) = Hausman::new(system, selected, least_squares, instrumental) else {
            return Self {
                missing: Some(String::from("too few equations follow one another")),
                ..self
            };
        };
        let total = total_least_squares(system, selected, instrumental);
        let strengths = strengths(instrumental);
        let parameters = names
            .iter()
            .zip(units)
            .enumerate()
            .map(|(i, (name, unit))| {
                let own = &test.parameters[i];
                let differs = test.differs(own);
                RegressorError {
                    name: name.clone(),
                    unit: (*unit).to_owned(),
                    least_squares: least_squares.values[i],
                    instruments: instrumental.estimation.values[i],
                    total_least_squares: total.as_ref().map(|values| values[i]),
                    difference_deviation: own.deviation,
                    probability: own.probability,
                    differs,
                    spoiled: differs && own.difference.abs() > deviations[i],
                    partial_r2: strengths[i].partial_r2,
                    strength: strengths[i].f,
                }
            });
        let weakest = strengths.iter().map(|own| own.f);
        Self {
            parameters: parameters.collect(),
            agreement: Some(Agreement {
                statistic: test.statistic,
                degrees_of_freedom: test.freedoms,
                probability: test.probability,
                together: test.together,
                level: LEVEL,
                differs: test.rejects(),
                weakest: weakest.fold(f64::INFINITY, f64::min),
                weak_below: WEAK,
            }),
            ..self
        }
    }

    /// Whether the estimates differ significantly.
    #[must_use]
    pub fn differs(&self) -> bool {
        self.agreement.as_ref().is_some_and(|own| own.differs)
    }

    /// Whether the instruments are too weak for a comparison.
    #[must_use]
    pub fn is_weak(&self) -> bool {
        let weak = |own: &Agreement| own.weakest < own.weak_below;
        self.agreement.as_ref().is_some_and(weak)
    }
}
