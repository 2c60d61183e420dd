//! What is known of errors in the regressor of one model: the test, the estimates beside each other, and
//! what the instruments are worth.

use serde::Serialize;

use super::{
    Instrumental,
    hausman::{Hausman, LEVEL},
    strength::{WEAK, strengths},
};
use crate::{
    data::Periods,
    estimation::{estimate::Estimation, total_least_squares::total_least_squares},
    regression::{projection::ModelKind, system::System},
    settings::Instruments,
};

/// Errors of two periods that are correlated by more than this are not told apart by instruments of other
/// periods: a fifth of the bias would stay.
const LARGEST_CORRELATION: f64 = 0.2;

/// Errors in the regressor of one model.
#[derive(Debug, Clone, PartialEq, Serialize)]
#[non_exhaustive]
pub struct ErrorsInRegressor {
    /// Which inputs are explained.
    pub model: ModelKind,
    /// Where the instruments come from.
    pub instruments: Instruments,
    /// For instruments from other periods, the repetitions of each run.
    #[serde(skip_serializing_if = "Vec::is_empty")]
    pub runs: Vec<RepeatedRun>,
    /// For instruments from the simulated robot, how well it reproduces each run.
    #[serde(skip_serializing_if = "Vec::is_empty")]
    pub simulated: Vec<SimulatedRun>,
    /// Why there are no instruments, or why they could not be used.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub missing: Option<String>,
    /// Whether least squares and instruments agree.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub agreement: Option<Agreement>,
    /// Each base parameter.
    #[serde(skip_serializing_if = "Vec::is_empty")]
    pub parameters: Vec<RegressorError>,
}

/// The repetitions of a run.
#[derive(Debug, Clone, PartialEq, Serialize)]
#[non_exhaustive]
pub struct RepeatedRun {
    /// Name of the run.
    pub run: String,
    /// The period, or that of the fewest periods with a whole number of samples, s.
    pub period_s: f64,
    /// Whether the period was found from the run, not given.
    pub found: bool,
    /// How many whole ones the run has.
    pub periods: usize,
    /// Correlation of the errors of two periods; none where the positions have no noise.
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

/// The test of Durbin, Wu and Hausman.
#[derive(Debug, Clone, PartialEq, Serialize)]
#[non_exhaustive]
pub struct Agreement {
    /// F.
    pub statistic: f64,
    /// Its degrees of freedom.
    pub degrees_of_freedom: [f64; 2],
    /// With which chance exceeds it where the regressor has no errors.
    pub probability: f64,
    /// Whether all parameters are tested together. Where these data have too few degrees of freedom for
    /// that, F is that of the parameter that differs most, and its probability that of any parameter to
    /// differ so much (Bonferroni).
    pub together: bool,
    /// Below this probability the estimates differ.
    pub level: f64,
    /// Whether they do.
    pub differs: bool,
    /// The smallest F of the instruments' strength over the parameters.
    pub weakest: f64,
    /// The F below which an instrument is weak.
    pub weak_below: f64,
}

/// One parameter by least squares, by instruments and by total least squares.
#[derive(Debug, Clone, PartialEq, Serialize)]
#[non_exhaustive]
pub struct RegressorError {
    /// Its name.
    pub name: String,
    /// SI unit.
    pub unit: String,
    /// By least squares.
    pub least_squares: f64,
    /// By instruments.
    pub instruments: f64,
    /// By total least squares, for comparison; none where it is not determined.
    pub total_least_squares: Option<f64>,
    /// Standard deviation of the difference between the first two.
    pub difference_deviation: f64,
    /// With which chance exceeds the difference.
    pub probability: f64,
    /// Whether it is too large for chance, at the level of the test divided by the number of parameters.
    pub differs: bool,
    /// Whether it exceeds the standard deviation of least squares, too, so that the parameter is spoiled.
    pub spoiled: bool,
    /// Part of what the column has beside the others that the instruments reproduce.
    pub partial_r2: f64,
    /// F of that.
    pub strength: f64,
}

impl RepeatedRun {
    /// What is told of a run of that sampling frequency.
    pub(crate) fn new(run: &str, frequency: f64, found: bool, periods: &Periods) -> Self {
        Self {
            run: run.to_owned(),
            period_s: periods.samples as f64 / frequency,
            found,
            periods: periods.count,
            error_correlation: periods.correlation,
        }
    }

    /// Whether the errors return with the motion, so that other periods have them, too.
    #[must_use]
    pub fn errors_return(&self) -> bool {
        self.error_correlation
            .is_some_and(|own| own > LARGEST_CORRELATION)
    }
}

impl ErrorsInRegressor {
    /// A model without instruments, and why.
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

    /// Compares the estimates of the columns `selected`, each with its name and unit; `deviations` are
    /// the honest ones of least squares.
    pub(crate) fn compared(
        self,
        (system, selected): (&System, &[usize]),
        (least_squares, deviations): (&Estimation, &[f64]),
        found: &Instrumental,
        names: &[(String, String)],
    ) -> Self {
        let Some(test) = Hausman::new(system, selected, least_squares, found) else {
            return Self {
                missing: Some(String::from("too few equations follow one another")),
                ..self
            };
        };
        let total = total_least_squares(system, selected, found);
        let strengths = strengths(found);
        let parameters = names.iter().enumerate().map(|(i, (name, unit))| {
            let own = &test.parameters[i];
            let differs = test.differs(own);
            RegressorError {
                name: name.clone(),
                unit: unit.clone(),
                least_squares: least_squares.values[i],
                instruments: found.estimation.values[i],
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

    /// Whether the estimates differ by more than chance explains.
    #[must_use]
    pub fn differs(&self) -> bool {
        self.agreement.as_ref().is_some_and(|own| own.differs)
    }

    /// Whether the instruments are too weak to say anything.
    #[must_use]
    pub fn is_weak(&self) -> bool {
        let weak = |own: &Agreement| own.weakest < own.weak_below;
        self.agreement.as_ref().is_some_and(weak)
    }
}
