//! Thresholds of the elimination's tests and of the conditioning.

use serde::Serialize;

/// Thresholds of verdicts and warnings.
#[derive(Debug, Clone, Copy, PartialEq, Serialize)]
pub struct Thresholds {
    /// Condition number of a partition above which the actuator projection is unreliable.
    pub partition_condition: f64,
    /// |χ|/σ above which a parameter is significant.
    pub significance: f64,
    /// Growth of the cross-validation error, in percent of the norm of the inputs.
    ///
    /// Above it, a significant parameter is not removed. The growth is √(after² - before²), the
    /// part of the inputs that the parameter alone explains, independent of the noise.
    pub held_out_growth_percent: f64,
    /// Drift of another parameter, in percent of its value.
    ///
    /// Above it, a significant parameter is not removed, if the drift's effect on the inputs also
    /// exceeds [`held_out_growth_percent`](Self::held_out_growth_percent).
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
