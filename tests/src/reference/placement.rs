//! Rigid placements: a rotation and a position, both seen from an outer frame.
//!
//! The columns of the rotation are the frame's axes in the outer frame.

use nalgebra::{Matrix3, Rotation3, Vector3};
use std::ops::Mul;

/// Placement of a frame in another one.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Frame {
    /// Axes of the frame as columns.
    pub rotation: Matrix3<f64>,
    /// Origin of the frame.
    pub position: Vector3<f64>,
}

impl Frame {
    /// The frame that coincides with the outer one.
    #[must_use]
    pub fn identity() -> Self {
        Self {
            rotation: Matrix3::identity(),
            position: Vector3::zeros(),
        }
    }

    /// Unrotated frame at (x, y, z).
    #[must_use]
    pub fn at(x: f64, y: f64, z: f64) -> Self {
        Self {
            rotation: Matrix3::identity(),
            position: Vector3::new(x, y, z),
        }
    }

    /// Frame of given rotation and position.
    #[must_use]
    pub fn new(rotation: Matrix3<f64>, position: Vector3<f64>) -> Self {
        Self { rotation, position }
    }

    /// Translation along z.
    #[must_use]
    pub fn along_z(distance: f64) -> Self {
        Self::at(0.0, 0.0, distance)
    }

    /// Translation along x.
    #[must_use]
    pub fn along_x(distance: f64) -> Self {
        Self::at(distance, 0.0, 0.0)
    }

    /// Rotation about x.
    #[must_use]
    pub fn about_x(angle: f64) -> Self {
        Self::new(about(Vector3::x(), angle), Vector3::zeros())
    }

    /// Rotation about z.
    #[must_use]
    pub fn about_z(angle: f64) -> Self {
        Self::new(about(Vector3::z(), angle), Vector3::zeros())
    }

    /// The z axis in the outer frame.
    #[must_use]
    pub fn z(&self) -> Vector3<f64> {
        self.rotation.column(2).into_owned()
    }
}

impl Mul for Frame {
    type Output = Self;

    fn mul(self, inner: Self) -> Self {
        Self {
            rotation: self.rotation * inner.rotation,
            position: self.position + self.rotation * inner.position,
        }
    }
}

/// Rotation matrix that turns by the length of `vector` about its direction.
#[must_use]
pub fn exponential(vector: Vector3<f64>) -> Matrix3<f64> {
    Rotation3::new(vector).into_inner()
}

/// Rotation vector, of length at most π, of a rotation matrix.
///
/// The angle comes from atan2 of its sine and cosine, which keeps full precision near zero. Near a
/// half turn the axis is inaccurate; Newton's method never needs that.
#[must_use]
pub fn logarithm(rotation: &Matrix3<f64>) -> Vector3<f64> {
    let skew = 0.5
        * Vector3::new(
            rotation[(2, 1)] - rotation[(1, 2)],
            rotation[(0, 2)] - rotation[(2, 0)],
            rotation[(1, 0)] - rotation[(0, 1)],
        );
    let sine = skew.norm();
    let cosine = 0.5 * (rotation.trace() - 1.0);
    let angle = sine.atan2(cosine);
    if sine < 1e-9 {
        skew
    } else {
        skew * (angle / sine)
    }
}

fn about(axis: Vector3<f64>, angle: f64) -> Matrix3<f64> {
    exponential(axis * angle)
}
