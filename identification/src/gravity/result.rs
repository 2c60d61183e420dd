//! Direction of gravity, for printing and serialisation.

use nalgebra::{DMatrix, Vector3};
use serde::Serialize;

use super::{direction::GravityFrame, uncertainty_propagation::Turned};
use crate::regression::uncertainty_propagation::PropagatedUncertainty;

/// 95 % quantiles of chi-squared with one and with two degrees of freedom.
const SIGNIFICANT: [f64; 2] = [3.841, 5.991];

/// Rounding factor of a direction, m/s²: far below any standard deviation.
const DECIMALS: f64 = 1e9;

/// Result of an identification of the direction of gravity.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct GravityDirection {
    /// Described acceleration of gravity, m/s², in the base frame.
    pub described: [f64; 3],
    /// Estimated acceleration, of equal magnitude.
    pub estimated: [f64; 3],
    /// Standard deviations of its components, m/s².
    pub deviations: [f64; 3],
    /// Angle between both, rad.
    pub tilt: f64,
    /// Standard deviation of this angle, rad.
    pub tilt_deviation: f64,
    /// Whether the angle is significant at the 5 % level.
    ///
    /// Otherwise everything else is identified with the described gravity.
    pub significant: bool,
    /// Axis of rotations of gravity that no torque shows, as a unit vector.
    ///
    /// The corresponding component of the direction is the described one.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub undetermined_about: Option<[f64; 3]>,
    /// Covariance of the angles, rad².
    #[serde(skip)]
    covariance: DMatrix<f64>,
    #[serde(skip)]
    rotated: Turned,
}

impl GravityDirection {
    pub(super) fn new(
        described: Vector3<f64>,
        frame: &GravityFrame,
        covariance: DMatrix<f64>,
        rotated: Turned,
    ) -> Self {
        let gravity = frame.gravity();
        let slopes = frame.derivative();
        let of_components = &slopes * &covariance * slopes.transpose();
        let deviation = |axis: usize| of_components[(axis, axis)].max(0.0).sqrt();
        let from = described / frame.size;
        let tilt = from
            .cross(&frame.direction)
            .norm()
            .atan2(from.dot(&frame.direction));
        // Direction back to the described gravity, in the frame's angles.
        let back = from - frame.direction * from.dot(&frame.direction);
        let each = frame.tilts.iter().map(|turn| turn.dot(&back));
        let back = nalgebra::DVector::from_iterator(frame.tilts.len(), each);
        let unit = match back.norm() {
            0.0 => nalgebra::DVector::from_element(back.len(), (back.len() as f64).sqrt().recip()),
            norm => &back / norm,
        };
        let tilt_deviation = (&covariance * &unit).dot(&unit).max(0.0).sqrt();
        let square = covariance
            .clone()
            .try_inverse()
            .map_or(f64::INFINITY, |inverse| {
                tilt * tilt * (inverse * &unit).dot(&unit)
            });
        let rounded = gravity.map(|one| (one * DECIMALS).round() / DECIMALS);
        let about = (frame.tilts.len() == 1).then(|| frame.tilts[0].into());
        Self {
            described: described.into(),
            estimated: rounded.into(),
            deviations: [0, 1, 2].map(deviation),
            tilt,
            tilt_deviation,
            significant: square > SIGNIFICANT[frame.tilts.len() - 1],
            undetermined_about: about,
            covariance,
            rotated,
        }
    }

    /// Gravity for the identification of everything else.
    #[must_use]
    pub const fn used(&self) -> [f64; 3] {
        if self.significant {
            self.estimated
        } else {
            self.described
        }
    }

    /// Effect of its uncertainty on base parameters that keep the standard parameters `names`.
    pub(crate) fn propagated_uncertainty(&self, names: &[&str]) -> PropagatedUncertainty {
        self.rotated.propagated_uncertainty(names, &self.covariance)
    }

    /// Warnings to the user.
    #[must_use]
    pub fn warnings(&self) -> Vec<String> {
        let [x, y, z] = self.estimated.map(|one| (one * 1e6).round() / 1e6);
        let mut warnings = Vec::new();
        if self.significant {
            warnings.push(format!(
                "gravity deviates by {:.2} deg from the description, with a standard deviation of {:.2} deg: all results use gravity = [{x}, {y}, {z}]; write it into the description",
                self.tilt.to_degrees(),
                self.tilt_deviation.to_degrees()
            ));
        }
        if let Some(axis) = self.undetermined_about {
            let [x, y, z] = axis.map(|one| (one * 1e4).round() / 1e4);
            warnings.push(format!(
                "the direction of gravity is only partly determined: parameters explain a rotation about [{x}, {y}, {z}] equally well",
            ));
        }
        warnings
    }
}
