//! Converts motor positions, velocities and torques to those of the joints.

use nalgebra::{DMatrix, DVector};
use overact::Code;

use crate::{error::Problem, samples::Samples};

/// Transmission matrix T, with motor positions θ = T q.
#[derive(Debug, Clone, PartialEq)]
pub(crate) struct Transmission {
    /// Tᵀ, for torques.
    transposed: DMatrix<f64>,
    /// T^-1, for positions and velocities.
    inverse: DMatrix<f64>,
}

impl Transmission {
    /// Constructs it from the rows of T; `None` without rows.
    ///
    /// # Errors
    /// A matrix that is singular, or not square with the number of actuators.
    pub(crate) fn new(rows: &[Vec<f64>], actuators: usize) -> Result<Option<Self>, Problem> {
        if rows.is_empty() {
            return Ok(None);
        }
        let problem =
            |message: String| Problem::new(Code::DATA_TABLE, message).column("transmission");
        if rows.len() != actuators || rows.iter().any(|row| row.len() != actuators) {
            let message = format!("the transmission is not a matrix of {actuators} x {actuators}");
            return Err(problem(message));
        }
        let matrix = DMatrix::from_fn(actuators, actuators, |i, j| rows[i][j]);
        let transposed = matrix.transpose();
        match matrix.try_inverse() {
            Some(inverse) if inverse.iter().all(|value| value.is_finite()) => Ok(Some(Self {
                transposed,
                inverse,
            })),
            _ => Err(problem(String::from(
                "the transmission is singular: the motors do not determine the joints",
            ))),
        }
    }

    /// Converts the last sample from motor to joint coordinates.
    pub(crate) fn to_joints(&self, samples: &mut Samples) {
        let turn = |matrix: &DMatrix<f64>, values: &mut Vec<f64>| {
            let Some(start) = values.len().checked_sub(matrix.nrows()) else {
                return;
            };
            let joints = matrix * DVector::from_column_slice(&values[start..]);
            values[start..].copy_from_slice(joints.as_slice());
        };
        turn(&self.inverse, &mut samples.positions);
        turn(&self.inverse, &mut samples.velocities);
        turn(&self.transposed, &mut samples.torques);
    }
}

#[cfg(test)]
mod tests {
    use super::{Samples, Transmission};

    #[test]
    fn power_is_equal_in_motor_and_joint_coordinates() {
        // The second motor moves by the sum of both joints.
        let rows = [vec![45.0, 0.0], vec![-32.0, -32.0]];
        let both = Transmission::new(&rows, 2).expect("a regular matrix");
        let both = both.expect("a transmission");
        let (q, velocities, torques) = ([0.3, -0.1], [1.5, 2.0], [0.25, -0.5]);
        let motors = |v: [f64; 2]| vec![45.0 * v[0], -32.0 * (v[0] + v[1])];
        let mut samples = Samples {
            positions: motors(q),
            velocities: motors(velocities),
            torques: torques.to_vec(),
        };
        both.to_joints(&mut samples);
        for (found, wanted) in samples.positions.iter().zip(q) {
            assert!((found - wanted).abs() < 1e-15);
        }
        let power = |a: &[f64], b: &[f64]| a[0] * b[0] + a[1] * b[1];
        let at_motors = power(&torques, &motors(velocities));
        assert!((power(&samples.torques, &samples.velocities) - at_motors).abs() < 1e-12);
        assert_eq!(samples.torques, [45.0 * 0.25 + 32.0 * 0.5, 16.0]);
    }

    #[test]
    fn singular_transmissions_are_rejected() {
        let singular = [vec![1.0, 1.0], vec![2.0, 2.0]];
        assert!(Transmission::new(&singular, 2).is_err());
        assert!(Transmission::new(&[vec![1.0]], 2).is_err());
        assert_eq!(Transmission::new(&[], 2), Ok(None));
    }
}
