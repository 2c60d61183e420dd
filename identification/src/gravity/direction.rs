//! Direction of gravity, and the directions of its rotations.

use nalgebra::{DMatrix, DVector, Vector3};

/// Gravity: magnitude, direction, and orthogonal directions of rotation.
#[derive(Debug, Clone, PartialEq)]
pub(super) struct GravityFrame {
    /// |g|, m/s².
    pub(super) size: f64,
    /// Direction.
    pub(super) direction: Vector3<f64>,
    /// Directions that gravity can tilt towards: unit vectors orthogonal to it, one or two.
    pub(super) tilts: Vec<Vector3<f64>>,
}

impl GravityFrame {
    /// GravityFrame of a vector; `None` for zero.
    ///
    /// The first rotation is towards the axis most orthogonal to the vector: x for gravity along z.
    /// The second one is orthogonal to both, then y.
    pub(super) fn new(gravity: Vector3<f64>) -> Option<Self> {
        let size = gravity.norm();
        if !(size > 0.0 && size.is_finite()) {
            return None;
        }
        let direction = gravity / size;
        let axis = Vector3::ith(direction.iamin(), 1.0);
        let first = (axis - direction * direction.dot(&axis)).normalize();
        let second = first.cross(&direction);
        Some(Self {
            size,
            direction,
            tilts: vec![first, second],
        })
    }

    /// The vector itself.
    pub(super) fn gravity(&self) -> Vector3<f64> {
        self.direction * self.size
    }

    /// The frame with only these rotations, combinations of its own.
    pub(super) fn restricted_to(&self, tilts: &[DVector<f64>]) -> Self {
        let combined = |one: &DVector<f64>| {
            let each = one.iter().zip(&self.tilts);
            each.map(|(part, tilt)| tilt * *part).sum()
        };
        Self {
            tilts: tilts.iter().map(combined).collect(),
            ..self.clone()
        }
    }

    /// The frame rotated by angles (rad) in its directions, along a great circle.
    pub(super) fn rotated(&self, angles: &DVector<f64>) -> Self {
        let angle = angles.norm();
        if angle == 0.0 {
            return self.clone();
        }
        let each = angles.iter().zip(&self.tilts);
        let towards: Vector3<f64> = each.map(|(own, tilt)| tilt * (*own / angle)).sum();
        let (sine, cosine) = angle.sin_cos();
        let from = self.direction;
        let transported = |tilt: &Vector3<f64>| {
            let along = tilt.dot(&towards);
            tilt + (towards * (cosine - 1.0) - from * sine) * along
        };
        Self {
            size: self.size,
            direction: from * cosine + towards * sine,
            tilts: self.tilts.iter().map(transported).collect(),
        }
    }

    /// Derivative of the vector with respect to the angles, 3 × rotations.
    pub(super) fn derivative(&self) -> DMatrix<f64> {
        DMatrix::from_fn(3, self.tilts.len(), |axis, tilt| {
            self.size * self.tilts[tilt][axis]
        })
    }
}

#[cfg(test)]
mod tests {
    use nalgebra::{DVector, Vector3};

    use super::GravityFrame;

    #[test]
    fn gravity_along_z_is_tilted_towards_x_and_y() {
        let frame = GravityFrame::new(Vector3::new(0.0, 0.0, -9.81)).expect("a frame");
        assert_eq!(frame.tilts, [Vector3::x(), Vector3::y()]);
        let rotated = frame.rotated(&DVector::from_vec(vec![0.03, 0.04]));
        let far = 9.81 * 0.05_f64.sin();
        let expected = Vector3::new(0.6 * far, 0.8 * far, -9.81 * 0.05_f64.cos());
        assert!((rotated.gravity() - expected).norm() < 1e-14);
        for (i, a) in rotated.tilts.iter().enumerate() {
            assert!(a.dot(&rotated.direction).abs() < 1e-15);
            for (j, b) in rotated.tilts.iter().enumerate() {
                assert!((a.dot(b) - f64::from(u8::from(i == j))).abs() < 1e-15);
            }
        }
        // Its derivative equals that of the path.
        let step = DVector::from_vec(vec![2e-7, -3e-7]);
        let moved = rotated.rotated(&step).gravity() - rotated.gravity();
        assert!((rotated.derivative() * step - moved).norm() < 1e-11);
        assert_eq!(GravityFrame::new(Vector3::zeros()), None);
    }
}
