//! The thresholds of the elimination's second opinion and of the conditioning.

use serde::Serialize;

/// The thresholds that verdicts and warnings use.
#[derive(Debug, Clone, Copy, PartialEq, Serialize)]
pub struct Thresholds {
    /// A partition whose condition exceeds this spoils case 2.
    pub partition_condition: f64,
    /// |χ|/σ above which a parameter is significant.
    pub significance: f64,
    /// Growth of the held-out error, in percent of the measured inputs' norm, above which a
    /// significant parameter is not cancelled: the root of the difference of the squares before and
    /// after, the part of the inputs that the parameter alone explains, whatever the noise.
    pub held_out_growth_percent: f64,
    /// Move of another parameter, percent of its value, above which a significant parameter is not
    /// cancelled, provided that the move's part of the inputs exceeds
    /// [`held_out_growth_percent`](Self::held_out_growth_percent).
    pub drift_percent: f64,
}

impl Default for Thresholds {
    fn default() -> Self {
        Self {
            partition_condition: 30.0,
            significance: 5.0,
            held_out_growth_percent: 2.0,
            drift_percent: 10.0,
        }
    }
}
