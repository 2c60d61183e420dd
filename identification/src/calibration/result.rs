//! The result of a calibration, as it is printed and as it is serialised.

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

/// What the closure of the loops tells of encoder offsets and lengths.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct Calibration {
    /// Which parameters it was free to change.
    pub scope: CalibrationScope,
    /// n, measured positions of a sample.
    pub sensors: usize,
    /// r, coordinates of the platform: each sample tells n - r numbers.
    pub coordinates: usize,
    /// Samples that it was made from.
    pub samples: usize,
    /// The noise of each sensor, as successive samples tell it.
    pub noise: Vec<SensorNoise>,
    /// Root mean square of what the described geometry leaves unexplained, in units of the sensors'
    /// noise: 1 where the description is right.
    pub misfit_before: f64,
    /// The same with the estimated changes.
    pub misfit_after: f64,
    /// The parameters that are changed.
    pub estimated: Vec<CalibratedParameter>,
    /// The parameters that stay as described.
    pub held: Vec<HeldParameter>,
    /// Whether the estimation has converged; what has not is not to be used.
    pub converged: bool,
    /// What is right to know: what the data can't determine at all, and why.
    pub remarks: Vec<String>,
    /// What speaks against the result.
    pub warnings: Vec<String>,
}

/// The noise of a sensor.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct SensorNoise {
    /// Name of the actuator.
    pub actuator: String,
    /// Unit of its position, `rad` or `m`.
    pub unit: &'static str,
    /// Standard deviation.
    pub standard_deviation: f64,
}

/// A parameter that is changed.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct CalibratedParameter {
    /// Its name: `offset_leg1`, `d_2_leg1`, `base_x_leg1`, `end_x_leg1`.
    pub name: String,
    /// `rad` or `m`.
    pub unit: &'static str,
    /// What it is.
    pub kind: ParameterKind,
    /// What the description says; an offset is zero there, whatever the log's `position_offset` is.
    pub described: f64,
    /// What is added to it.
    pub change: f64,
    /// Standard deviation of the change.
    pub standard_deviation: f64,
    /// The 95 % interval of the change.
    pub interval_95: [f64; 2],
    /// Parameters that would explain the data as well in its place.
    pub alternatives: Vec<String>,
    /// Its place among the sensors (offsets) or among the geometry's parameters.
    #[serde(skip)]
    pub index: usize,
}

/// A parameter that stays as described.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct HeldParameter {
    /// Its name.
    pub name: String,
    /// `rad` or `m`.
    pub unit: &'static str,
    /// What it is.
    pub kind: ParameterKind,
    /// What the description says.
    pub described: f64,
    /// Standard deviation that a change of it would have beside the estimated ones; none where the data
    /// do not determine it.
    pub deviation_of_a_change: Option<f64>,
    /// Why the data do not determine it.
    pub reason: Option<String>,
}

impl Calibration {
    /// Whether it changes anything: an estimation that has not converged does not.
    #[must_use]
    pub fn is_change(&self) -> bool {
        self.converged && !self.estimated.is_empty()
    }

    /// What is to be subtracted from the position of each sensor; zero where no offset is estimated.
    #[must_use]
    pub fn offsets(&self) -> Vec<f64> {
        let mut offsets = vec![0.0; self.sensors];
        let of_encoders = |one: &&CalibratedParameter| one.kind == ParameterKind::EncoderOffset;
        for one in self.estimated.iter().filter(of_encoders) {
            offsets[one.index] = one.change;
        }
        offsets
    }

    /// The lengths that are changed.
    pub fn lengths(&self) -> impl Iterator<Item = &CalibratedParameter> {
        let is_length = |one: &&CalibratedParameter| one.kind != ParameterKind::EncoderOffset;
        self.estimated.iter().filter(is_length)
    }
}
