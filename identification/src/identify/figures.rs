//! Data for the plots of a report, in reduced resolution.
//!
//! - platform path (Fig. 7 of the paper): [`RunFigures::pose`];
//! - conditioning along it: [`RunFigures::conditions`];
//! - measured and predicted Γ (Figs. 5 and 6) and τ (Figs. 8 and 9): [`PredictionFigures`], for
//!   every training or validation run and every estimate;
//! - residual over time, autocorrelation and spectrum of each line: [`ResidualFigures`], for every
//!   estimate.

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
