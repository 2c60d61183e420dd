//! Series over time for plots: at most a thousand points per run.

use serde::Serialize;

/// Largest number of points of a series over time.
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

/// Motion of a run.
#[derive(Debug, Clone, PartialEq, Default, Serialize)]
pub struct RunFigures {
    /// Name of the run.
    pub run: String,
    /// Whether it is a training run; otherwise it is a validation run.
    pub identified: bool,
    /// Whether the platform carried the payload.
    pub payload: bool,
    /// Times of the points, s from the start of the log.
    pub time: Vec<f64>,
    /// Names of the pose coordinates.
    pub coordinates: Vec<String>,
    /// For each pose coordinate, its values (m, rad; a quaternion w, x, y, z for free rotation).
    pub pose: Vec<Vec<f64>>,
    /// Velocity of each actuator's joint at the points.
    pub velocities: Vec<VelocitySeries>,
    /// Condition numbers along the path, for each projection that has one.
    pub conditions: Vec<ConditionSeries>,
}

/// Velocity of an actuator's joint along a run.
#[derive(Debug, Clone, PartialEq, Default, Serialize)]
pub struct VelocitySeries {
    /// Name of the actuator.
    pub actuator: String,
    /// Velocities at [`RunFigures::time`] (m/s, rad/s).
    pub velocity: Vec<f64>,
    /// Largest speed of all samples (m/s, rad/s).
    pub largest_velocity: f64,
    /// Largest acceleration of all samples, from differences of the velocity (m/s², rad/s²).
    pub largest_acceleration: f64,
}

/// Conditioning of the kept actuators along a run.
#[derive(Debug, Clone, PartialEq, Default, Serialize)]
pub struct ConditionSeries {
    /// Names of the kept actuators; all actuators for the platform projection.
    pub kept_actuators: Vec<String>,
    /// Condition number of the kept rows of J_p^inv with scaled columns, at [`RunFigures::time`].
    ///
    /// The largest one of the samples that each point represents.
    pub condition: Vec<f64>,
    /// Determinant of the kept rows, divided by the product of their norms.
    ///
    /// A sign change is a crossing of the partition's singularity. Empty for the platform
    /// projection.
    pub determinant: Vec<f64>,
}

/// Residual of one line of Γ after decimation.
#[derive(Debug, Clone, PartialEq, Default, Serialize)]
pub struct LineResidual {
    /// Name of the coordinate or actuator.
    pub name: String,
    /// Residual of each run over time.
    pub runs: Vec<ResidualSeries>,
    /// Time between two lags, s.
    pub lag_s: f64,
    /// Autocorrelation, starting with lag 0 (which is 1).
    pub autocorrelation: Vec<f64>,
    /// Bound of 95 % of the autocorrelations of a white residual.
    pub white_bound: f64,
    /// Fraction of the autocorrelations from lag 1 on within the bound.
    pub within_bound: f64,
    /// Frequencies of the spectrum, Hz.
    pub frequency_hz: Vec<f64>,
    /// One-sided power spectral density at the frequencies ((N, N m)²/Hz).
    ///
    /// Bartlett's estimate: the transform of the tapered autocovariance.
    pub power: Vec<f64>,
}

/// A residual over time.
#[derive(Debug, Clone, PartialEq, Default, Serialize)]
pub struct ResidualSeries {
    /// Name of the run.
    pub run: String,
    /// Times, s from the start of the log.
    pub time: Vec<f64>,
    /// Measured minus predicted (N, N m).
    pub residual: Vec<f64>,
}
