//! Data for the plots of a report, in reduced resolution.
//!
//! - platform path (Fig. 7 of the paper): [`RunFigures::pose`];
//! - conditioning along it: [`RunFigures::conditions`];
//! - measured and predicted Γ (Figs. 5 and 6) and τ (Figs. 8 and 9): [`PredictionFigures`], for
//!   every training or validation run and every estimate;
//! - residual over time, autocorrelation and spectrum of each line: [`ResidualFigures`], for every
//!   estimate;
//! - velocity of each actuator, for friction: [`RunFigures::velocities`];
//! - correlation of the parameters: [`CorrelationFigures`];
//! - motion of each actuator: [`ActuatorRange`].

use serde::Serialize;

use crate::{
    regression::projection::ModelKind,
    result::Stage,
    series::{LineResidual, RunFigures, Series},
};

/// All plots.
#[derive(Debug, Clone, PartialEq, Default, Serialize)]
pub struct Figures {
    /// Motion and conditioning of each run: training runs, then validation runs.
    pub runs: Vec<RunFigures>,
    /// Measured and predicted inputs of each estimate on each run.
    pub predictions: Vec<PredictionFigures>,
    /// Residuals of each estimate on the training runs.
    pub residuals: Vec<ResidualFigures>,
    /// Correlation of the parameters of each estimate.
    pub correlations: Vec<CorrelationFigures>,
    /// Motion of each actuator in the training runs.
    pub ranges: Vec<ActuatorRange>,
}

/// Correlation of the estimated parameters.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct CorrelationFigures {
    /// Model of the estimate.
    pub model: ModelKind,
    /// Stage of the estimate.
    pub stage: Stage,
    /// Names of the parameters.
    pub names: Vec<String>,
    /// Correlation coefficients for white residuals, symmetric, one row for each parameter.
    pub correlation: Vec<Vec<f64>>,
}

/// Motion of an actuator's joint in the training runs, with its limits.
#[derive(Debug, Clone, PartialEq, Default, Serialize)]
pub struct ActuatorRange {
    /// Name of the actuator.
    pub actuator: String,
    /// Unit of the position, `rad` or `m`.
    pub unit: &'static str,
    /// Smallest and largest position (rad, m).
    pub position: [f64; 2],
    /// Largest speed (rad/s, m/s).
    pub velocity: f64,
    /// Largest acceleration (rad/s², m/s²).
    pub acceleration: f64,
    /// Described limits of the position; `None` if not described.
    pub position_limits: Option<[f64; 2]>,
    /// Described limit of the speed; `None` if not described.
    pub velocity_limit: Option<f64>,
    /// Described limit of the acceleration; `None` if not described.
    pub acceleration_limit: Option<f64>,
}

/// Measured and predicted inputs.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct PredictionFigures {
    /// Name of the run.
    pub run: String,
    /// Whether it is a training run; otherwise it is a validation run.
    pub identified: bool,
    /// Model of the estimate.
    pub model: ModelKind,
    /// Stage of the estimate.
    pub stage: Stage,
    /// Lines of Γ.
    pub lines: Vec<Series>,
    /// Torques of all actuators and their least-norm prediction.
    pub torques: Vec<Series>,
}

/// Residuals of one estimate.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct ResidualFigures {
    /// Model of the estimate.
    pub model: ModelKind,
    /// Stage of the estimate.
    pub stage: Stage,
    /// Each line of Γ.
    pub lines: Vec<LineResidual>,
}
