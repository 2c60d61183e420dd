//! Result of a calibration, for printing and serialisation.

use serde::{Deserialize, Serialize};

use super::geometry::ParameterKind;

/// Which parameters a calibration may change.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default, Serialize, Deserialize)]
#[serde(rename_all = "kebab-case")]
pub enum CalibrationScope {
    /// The fewest encoder offsets and lengths that explain the data.
    #[default]
    Smallest,
    /// All encoder offsets that the data determine; the lengths are as described.
    Offsets,
    /// All encoder offsets and lengths that the data determine.
    All,
}

/// Encoder offsets and lengths estimated from the loop closure.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct Calibration {
    /// Parameters that were allowed to change.
    pub scope: CalibrationScope,
    /// Number of measured positions of a sample, n.
    pub sensors: usize,
    /// Number of platform coordinates, r; each sample has n - r equations.
    pub coordinates: usize,
    /// Number of samples.
    pub samples: usize,
    /// Noise of each sensor, from successive samples.
    pub noise: Vec<SensorNoise>,
    /// RMS residual of the described geometry, in units of the noise: 1 if it is right.
    pub misfit_before: f64,
    /// The same with the estimated changes.
    pub misfit_after: f64,
    /// Changed parameters.
    pub estimated: Vec<CalibratedParameter>,
    /// Parameters that stay as described.
    pub held: Vec<HeldParameter>,
    /// Whether the estimation converged; otherwise it must not be used.
    pub converged: bool,
    /// Remarks, such as what the data cannot determine and why.
    pub remarks: Vec<String>,
    /// Warnings against using the result.
    pub warnings: Vec<String>,
}

/// Noise of a sensor.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct SensorNoise {
    /// Name of the actuator.
    pub actuator: String,
    /// Unit of its position, `rad` or `m`.
    pub unit: &'static str,
    /// Standard deviation.
    pub standard_deviation: f64,
}

/// A changed parameter.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct CalibratedParameter {
    /// Name: `offset_leg1`, `d_2_leg1`, `base_x_leg1`, `end_x_leg1`.
    pub name: String,
    /// `rad` or `m`.
    pub unit: &'static str,
    /// Kind.
    pub kind: ParameterKind,
    /// Value in the description; zero for an offset, whatever the log's `position_offset` is.
    pub described: f64,
    /// Change to add.
    pub change: f64,
    /// Standard deviation of the change.
    pub standard_deviation: f64,
    /// 95 % interval of the change.
    pub interval_95: [f64; 2],
    /// Parameters that would explain the data as well instead.
    pub alternatives: Vec<String>,
    /// Index among the sensors (offsets) or the geometry's parameters.
    #[serde(skip)]
    pub index: usize,
}

/// A parameter that stays as described.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct HeldParameter {
    /// Name.
    pub name: String,
    /// `rad` or `m`.
    pub unit: &'static str,
    /// Kind.
    pub kind: ParameterKind,
    /// Value in the description.
    pub described: f64,
    /// Standard deviation of a change, if it were estimated with the others.
    ///
    /// `None` if the data do not determine it.
    pub deviation_of_a_change: Option<f64>,
    /// Why the data do not determine it.
    pub reason: Option<String>,
}

impl Calibration {
    /// Whether it changes anything; a result that has not converged does not.
    #[must_use]
    pub fn is_change(&self) -> bool {
        self.converged && !self.estimated.is_empty()
    }

    /// Offset to subtract from each sensor's position; zero if none is estimated.
    #[must_use]
    pub fn offsets(&self) -> Vec<f64> {
        let mut offsets = vec![0.0; self.sensors];
        let of_encoders = |one: &&CalibratedParameter| one.kind == ParameterKind::EncoderOffset;
        for one in self.estimated.iter().filter(of_encoders) {
            offsets[one.index] = one.change;
        }
        offsets
    }

    /// Changed lengths.
    pub fn lengths(&self) -> impl Iterator<Item = &CalibratedParameter> {
        let is_length = |one: &&CalibratedParameter| one.kind != ParameterKind::EncoderOffset;
        self.estimated.iter().filter(is_length)
    }
}
