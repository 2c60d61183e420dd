//! Replay of runs through the online filter.
//!
//! The equations are those of the identification: filtered, decimated, and weighted by the
//! standard deviation of each line. They enter [`overact::online::SliceFilter`] sample by sample.
//! So without forgetting the last estimate is the batch estimate.
//!
//! Standard deviations are those for white residuals, times the ratio of correlated to white ones
//! of the batch estimate.

mod replay;
mod timeline;

use serde::Serialize;

pub(crate) use replay::Replay;

/// Estimate of the base parameters after some of the samples.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct OnlineEstimate {
    /// Name of the run.
    pub run: String,
    /// Time, s from the start of the first run; runs follow each other without a gap.
    pub time: f64,
    /// Estimates in the order of the first model's base parameters; `None` if undetermined so far.
    pub values: Vec<Option<f64>>,
    /// Standard deviations for correlated residuals.
    pub standard_deviations: Vec<Option<f64>>,
    /// Change of a line's innovations that was detected at this time.
    pub change: Option<OnlineChange>,
}

/// A detected change.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct OnlineChange {
    /// Name of the line of Γ.
    pub line: String,
    /// Whether the measurements exceed their predictions.
    pub increase: bool,
}
