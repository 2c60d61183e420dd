//! What the plots of a report show, in reduced resolution.
//!
//! Where to find what:
//!
//! - the platform's way (Fig. 7 of the paper): [`RunFigures::pose`];
//! - the conditioning along it: [`RunFigures::conditions`];
//! - measured and predicted Γ (Figs. 5 and 6) and τ (Figs. 8 and 9): [`PredictionFigures`], for every
//!   run, identified from or held out, and every estimate;
//! - the residual over time, its autocorrelation and its spectrum, line by line:
//!   [`ResidualFigures`], for every estimate.

use serde::Serialize;

use crate::{
    regression::projection::ModelKind,
    result::Stage,
    series::{LineResidual, RunFigures, Series},
};

/// All plots.
#[derive(Debug, Clone, PartialEq, Default, Serialize)]
pub struct Figures {
    /// Motion and conditioning of each run: those identified from, then the held-out ones.
    pub runs: Vec<RunFigures>,
    /// Measured and predicted inputs of each estimate on each run.
    pub predictions: Vec<PredictionFigures>,
    /// Residuals of each estimate on the runs identified from.
    pub residuals: Vec<ResidualFigures>,
}

/// Measured and predicted inputs.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct PredictionFigures {
    /// Name of the run.
    pub run: String,
    /// Whether parameters are identified from it; else it is held out.
    pub identified: bool,
    /// Model of the estimate.
    pub model: ModelKind,
    /// Stage of the estimate.
    pub stage: Stage,
    /// The lines of Γ.
    pub lines: Vec<Series>,
    /// The torques of all actuators against the least-norm prediction.
    pub torques: Vec<Series>,
}

/// The residuals of one estimate.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct ResidualFigures {
    /// Model of the estimate.
    pub model: ModelKind,
    /// Stage of the estimate.
    pub stage: Stage,
    /// Each line of Γ.
    pub lines: Vec<LineResidual>,
}
