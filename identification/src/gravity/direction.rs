//! Direction of gravity, and the directions of its rotations.

use nalgebra::{DMatrix, DVector, Vector3};

/// Gravity: magnitude, direction, and orthogonal directions of rotation.
#[derive(Debug, Clone, PartialEq)]
pub(super) struct Frame {
    /// |g|, m/s².
    pub(super) size: f64,
    /// Direction.
    pub(super) direction: Vector3<f64>,
    /// Unit vectors orthogonal to it, one or two.
    pub(super) turns: Vec<Vector3<f64>>,
}

impl Frame {
    /// Frame of a vector; `None` for zero.
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
            turns: vec![first, second],
        })
    }

    /// The vector itself.
    pub(super) fn gravity(&self) -> Vector3<f64> {
        self.direction * self.size
    }

    /// The frame with only these rotations, combinations of its own.
    pub(super) fn confined(&self, turns: &[DVector<f64>]) -> Self {
        let combined = |one: &DVector<f64>| {
            let each = one.iter().zip(&self.turns);
            each.map(|(part, turn)| turn * *part).sum()
        };
        Self {
            turns: turns.iter().map(combined).collect(),
            ..self.clone()
        }
    }

    /// The frame rotated by angles (rad) in its directions, along a great circle.
    pub(super) fn turned(&self, angles: &DVector<f64>) -> Self {
        let angle = angles.norm();
        if angle == 0.0 {
            return self.clone();
        }
        let each = angles.iter().zip(&self.turns);
        let towards: Vector3<f64> = each.map(|(own, turn)| turn * (*own / angle)).sum();
        let (sine, cosine) = angle.sin_cos();
        let from = self.direction;
        let carried = |turn: &Vector3<f64>| {
            let along = turn.dot(&towards);
            turn + (towards * (cosine - 1.0) - from * sine) * along
        };
        Self {
            size: self.size,
            direction: from * cosine + towards * sine,
            turns: self.turns.iter().map(carried).collect(),
        }
    }

    /// Derivative of the vector with respect to the angles, 3 × rotations.
    pub(super) fn derivative(&self) -> DMatrix<f64> {
        DMatrix::from_fn(3, self.turns.len(), |axis, turn| {
            self.size * self.turns[turn][axis]
        })
    }
}

#[cfg(test)]
mod tests {
    use nalgebra::{DVector, Vector3};

    use super::Frame;

    #[test]
    fn gravity_along_z_turns_towards_x_and_y() {
        let frame = Frame::new(Vector3::new(0.0, 0.0, -9.81)).expect("a frame");
        assert_eq!(frame.turns, [Vector3::x(), Vector3::y()]);
        let turned = frame.turned(&DVector::from_vec(vec![0.03, 0.04]));
        let far = 9.81 * 0.05_f64.sin();
        let expected = Vector3::new(0.6 * far, 0.8 * far, -9.81 * 0.05_f64.cos());
        assert!((turned.gravity() - expected).norm() < 1e-14);
        for (i, a) in turned.turns.iter().enumerate() {
            assert!(a.dot(&turned.direction).abs() < 1e-15);
            for (j, b) in turned.turns.iter().enumerate() {
                assert!((a.dot(b) - f64::from(u8::from(i == j))).abs() < 1e-15);
            }
        }
        // Its derivative equals that of the path.
        let step = DVector::from_vec(vec![2e-7, -3e-7]);
        let moved = turned.turned(&step).gravity() - turned.gravity();
        assert!((turned.derivative() * step - moved).norm() < 1e-11);
        assert_eq!(Frame::new(Vector3::zeros()), None);
    }
}
