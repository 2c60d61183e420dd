//! Series over time as plots show them, in reduced resolution: at most a thousand points per
//! run, whatever the length of the log.

use serde::Serialize;

/// Most points of a series over time.
pub(crate) const LARGEST_SERIES: usize = 1000;

/// Measured and predicted values of one line or torque, decimated.
#[derive(Debug, Clone, PartialEq, Default, Serialize)]
pub struct Series {
    /// Name of the coordinate or actuator.
    pub name: String,
    /// Times, s from the start of the log.
    pub time: Vec<f64>,
    /// Measured values (N, N m).
    pub measured: Vec<f64>,
    /// Predicted values (N, N m).
    pub predicted: Vec<f64>,
}

/// The motion of a run.
#[derive(Debug, Clone, PartialEq, Default, Serialize)]
pub struct RunFigures {
    /// Its name.
    pub run: String,
    /// Whether parameters are identified from it; else it is held out.
    pub identified: bool,
    /// Whether the platform carried the payload.
    pub payload: bool,
    /// Times of the points, s from the start of the log.
    pub time: Vec<f64>,
    /// Names of the pose coordinates.
    pub coordinates: Vec<String>,
    /// For each pose coordinate, its values (m, rad; a quaternion w, x, y, z for free rotation).
    pub pose: Vec<Vec<f64>>,
    /// Condition numbers along the way, for each projection that has one.
    pub conditions: Vec<ConditionSeries>,
}

/// The conditioning of the kept actuators along a run.
#[derive(Debug, Clone, PartialEq, Default, Serialize)]
pub struct ConditionSeries {
    /// Names of the kept actuators; all actuators for the platform projection.
    pub kept_actuators: Vec<String>,
    /// Condition number of the kept rows of J_p^inv, columns scaled to be comparable, at
    /// [`RunFigures::time`]: the largest one of the samples that each point stands for.
    pub condition: Vec<f64>,
    /// Determinant of the kept rows, divided by the product of their norms; empty for the platform
    /// projection. A change of sign is a partition singularity that was crossed.
    pub determinant: Vec<f64>,
}

/// The residual of one line of Γ after decimation.
#[derive(Debug, Clone, PartialEq, Default, Serialize)]
pub struct LineResidual {
    /// Name of the coordinate or actuator.
    pub name: String,
    /// The residual of each run over time.
    pub runs: Vec<ResidualSeries>,
    /// Time between two lags, s.
    pub lag_s: f64,
    /// Autocorrelation from lag 0 (which is 1) on.
    pub autocorrelation: Vec<f64>,
    /// A white residual keeps 95 % of its autocorrelations within plus and minus this.
    pub white_bound: f64,
    /// Part of the autocorrelations from lag 1 on that lie within the bound.
    pub within_bound: f64,
    /// Frequencies of the spectrum, Hz.
    pub frequency_hz: Vec<f64>,
    /// One-sided power spectral density at the frequencies ((N, N m)²/Hz), Bartlett's estimate: the
    /// transform of the tapered autocovariance.
    pub power: Vec<f64>,
}

/// A residual over time.
#[derive(Debug, Clone, PartialEq, Default, Serialize)]
pub struct ResidualSeries {
    /// Name of the run.
    pub run: String,
    /// Times, s from the start of the log.
    pub time: Vec<f64>,
    /// Measured less predicted (N, N m).
    pub residual: Vec<f64>,
}
