//! Actuator projection for any choice of kept actuators, eq. (36).
//!
//! Let J_a be the rows of J_p^inv of the r kept actuators and J_b the others. The torques obey
//! Γ¹ = J_aᵀ τ_a + J_bᵀ τ_b, hence Γ² = τ_a + J_a^-T J_bᵀ τ_b = J_a^-T Γ¹. So a solution with J_aᵀ
//! converts any platform projection to the actuator projection: a regressor, torques, or the inputs
//! of inverse dynamics. Generated code has functions for the partition in the description. This
//! module serves all others, from `inverse_jacobian` and the results of the platform projection.
//!
//! ```
//! use overact::partition::Partition;
//!
//! // Two drives along x and one along y move a point in the plane.
//! let inverse_jacobian = [[1.0, 0.0], [1.0, 0.0], [0.0, 2.0]];
//! let mut inputs = [[3.0], [4.0]];
//! let partition = Partition::new(&inverse_jacobian, &[1, 2])?;
//! partition.project(inputs.as_flattened_mut())?;
//! assert_eq!(inputs, [[3.0], [2.0]]);
//! // The two drives along x say nothing about y.
//! assert!(Partition::new(&inverse_jacobian, &[0, 1]).is_err());
//! # Ok::<(), overact::Error>(())
//! ```

use crate::Actuators;
use crate::{Error, SINGULAR, guard, math::sqrt};

/// Smallest length of a column of J_p^inv, relative to the longest, by which a coordinate is
/// scaled.
///
/// It is far below the effect of a change of units, and far above rounding.
const SMALLEST_SCALE: f64 = 1e-5;

/// r kept actuators in one configuration of a robot: the factors of their J_aᵀ.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Partition<const R: usize> {
    /// L below the diagonal, U on and above it, rows of J_aᵀ in the order of `order`.
    factors: [[f64; R]; R],
    /// The row of J_aᵀ in each row of the factors.
    order: [usize; R],
    /// Condition number of J_a.
    condition: f64,
}

impl<const R: usize> Partition<R> {
    /// The partition with the kept actuators `kept`, counted from 0 in the order of q and τ.
    ///
    /// `inverse_jacobian` is J_p^inv, one row of r numbers per actuator.
    ///
    /// # Errors
    /// [`Error::SingularPartition`] if the kept actuators do not determine the platform's motion:
    /// the condition number of J_a exceeds 1/[`SINGULAR`]. [`Error::NoActuator`] and
    /// [`Error::NotFinite`] for other invalid inputs.
    pub fn new(inverse_jacobian: &[[f64; R]], kept: &[usize; R]) -> Result<Self, Error> {
        let actuators = inverse_jacobian.len();
        if let Some(&index) = kept.iter().find(|&&at| at >= actuators) {
            return Err(Error::NoActuator { index, actuators });
        }
        guard::finite(&[("inverse_jacobian", inverse_jacobian.as_flattened())])?;
        let mut transposed = [[0.0; R]; R];
        for (column, &actuator) in kept.iter().enumerate() {
            for (row, entries) in transposed.iter_mut().enumerate() {
                entries[column] = inverse_jacobian[actuator][row];
            }
        }
        let (factors, order) = factorised(transposed);
        let mut partition = Self {
            factors,
            order,
            condition: f64::INFINITY,
        };
        partition.condition = partition.condition_of(&transposed, inverse_jacobian);
        // The comparison fails for NaN too.
        if partition.condition < 1.0 / SINGULAR {
            Ok(partition)
        } else {
            Err(Error::SingularPartition {
                kept: Actuators::new(kept),
                condition: partition.condition,
            })
        }
    }

    /// Condition number ‖J_aᵀ‖ ‖J_a^-T‖ (largest row sum) with scaled twist coordinates.
    ///
    /// Every coordinate is scaled by the length of its column in J_p^inv, but at least by 1e-5 of
    /// the longest. So it does not depend on whether lengths are in metres or millimetres. Errors
    /// of Γ¹ are amplified by up to this number.
    #[must_use]
    pub const fn condition(&self) -> f64 {
        self.condition
    }

    /// Converts Γ¹ to Γ² in place: `inputs` is a matrix of r rows, row-major, with any number of
    /// columns.
    ///
    /// A regressor of the platform projection becomes that of the actuator projection.
    ///
    /// # Errors
    /// [`Error::Length`] if the length is no multiple of r, [`Error::NotFinite`] for an input that
    /// is not finite, and [`Error::Overflow`] for a result that is too large. Later columns are
    /// then unchanged.
    pub fn project(&self, inputs: &mut [f64]) -> Result<(), Error> {
        let columns = inputs.len().checked_div(R).unwrap_or(0);
        if inputs.len() != columns * R {
            return Err(Error::Length {
                expected: (columns + 1) * R,
                found: inputs.len(),
            });
        }
        guard::finite(&[("inputs", inputs)])?;
        for column in 0..columns {
            let mut vector = [0.0; R];
            for (row, entry) in vector.iter_mut().enumerate() {
                *entry = inputs[row * columns + column];
            }
            let solution = self.solve(&vector);
            if solution.iter().any(|entry| !entry.is_finite()) {
                return Err(Error::Overflow);
            }
            for (row, entry) in solution.into_iter().enumerate() {
                inputs[row * columns + column] = entry;
            }
        }
        Ok(())
    }

    /// J_a^-T times a vector.
    fn solve(&self, vector: &[f64; R]) -> [f64; R] {
        let mut solution = [0.0; R];
        for row in 0..R {
            let known = dot(&self.factors[row][..row], &solution[..row]);
            solution[row] = vector[self.order[row]] - known;
        }
        for row in (0..R).rev() {
            let known = dot(&self.factors[row][row + 1..], &solution[row + 1..]);
            solution[row] = (solution[row] - known) / self.factors[row][row];
        }
        solution
    }

    fn condition_of(&self, transposed: &[[f64; R]; R], inverse_jacobian: &[[f64; R]]) -> f64 {
        let mut scales = [0.0; R];
        for (coordinate, scale) in scales.iter_mut().enumerate() {
            let squares = inverse_jacobian
                .iter()
                .map(|row| row[coordinate] * row[coordinate]);
            *scale = sqrt(squares.sum());
        }
        // If no actuator moves a coordinate the robot itself is singular: a column of rounding
        // errors must not be scaled to the length of the others.
        let least = SMALLEST_SCALE * scales.iter().fold(0.0_f64, |m, s| m.max(*s));
        for scale in &mut scales {
            *scale = scale.max(least);
        }
        let size = |row: &[f64; R]| row.iter().map(|e| e.abs()).sum::<f64>();
        let mut largest = 0.0_f64;
        for (row, scale) in transposed.iter().zip(&scales) {
            largest = largest.max(size(row) / scale);
        }
        // Column by column of J_a^-T S, where S undoes the scaling of the coordinates.
        let mut sums = [0.0; R];
        for (coordinate, scale) in scales.iter().enumerate() {
            let mut unit = [0.0; R];
            unit[coordinate] = *scale;
            for (sum, entry) in sums.iter_mut().zip(self.solve(&unit)) {
                *sum += entry.abs();
            }
        }
        // `max` would ignore the NaN of a zero pivot.
        if sums.iter().any(|sum| !sum.is_finite()) || !largest.is_finite() {
            return f64::INFINITY;
        }
        largest * sums.iter().fold(0.0_f64, |m, s| m.max(*s))
    }
}

/// LU factorisation of a matrix with row pivoting; also returns the order of the rows.
fn factorised<const R: usize>(mut matrix: [[f64; R]; R]) -> ([[f64; R]; R], [usize; R]) {
    let mut order: [usize; R] = core::array::from_fn(|row| row);
    for k in 0..R {
        let mut pivot = k;
        for row in k + 1..R {
            if matrix[row][k].abs() > matrix[pivot][k].abs() {
                pivot = row;
            }
        }
        matrix.swap(k, pivot);
        order.swap(k, pivot);
        let (done, rest) = matrix.split_at_mut(k + 1);
        for row in rest {
            let factor = row[k] / done[k][k];
            row[k] = factor;
            for (entry, above) in row[k + 1..].iter_mut().zip(&done[k][k + 1..]) {
                *entry -= factor * above;
            }
        }
    }
    (matrix, order)
}

fn dot(a: &[f64], b: &[f64]) -> f64 {
    a.iter().zip(b).map(|(x, y)| x * y).sum()
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Three actuators, two coordinates; actuators 0 and 2 have proportional rates.
    const JACOBIAN: [[f64; 2]; 3] = [[0.0, 3.0], [2.0, 1.0], [0.0, -6.0]];

    #[test]
    fn a_matrix_is_projected_in_place() {
        let partition = Partition::new(&JACOBIAN, &[0, 1]).unwrap();
        // J_aᵀ = [0 2; 3 1], so that Γ² = [(Γ_2 - Γ_1/2)/3, Γ_1/2].
        let mut inputs = [[4.0, 2.0, 0.0], [5.0, 1.0, 9.0]];
        partition.project(inputs.as_flattened_mut()).unwrap();
        assert_eq!(inputs, [[1.0, 0.0, 3.0], [2.0, 1.0, 0.0]]);
    }

    #[test]
    fn a_singular_partition_reports_its_actuators() {
        let error = Partition::new(&JACOBIAN, &[0, 2]).unwrap_err();
        let Error::SingularPartition { kept, condition } = error else {
            panic!("{error:?}");
        };
        assert!(kept.iter().eq([0, 2]));
        assert_eq!(condition, f64::INFINITY);
        let twice = Partition::new(&JACOBIAN, &[1, 1]);
        assert!(matches!(twice, Err(Error::SingularPartition { .. })));
    }

    #[test]
    fn the_condition_number_is_independent_of_units() {
        let metres = Partition::new(&JACOBIAN, &[0, 1]).unwrap();
        let millimetres = JACOBIAN.map(|[x, y]| [1e-3 * x, y]);
        let same = Partition::new(&millimetres, &[0, 1]).unwrap();
        assert!((metres.condition() / same.condition() - 1.0).abs() < 1e-12);
        // Rows that differ by a millionth.
        let near = [[1.0, 1.0], [1.0, 1.0 + 1e-6]];
        let condition = Partition::new(&near, &[0, 1]).unwrap().condition();
        assert!((3e6..5e6).contains(&condition), "{condition:e}");
    }

    /// The robot's own singularity: a coordinate's column is only rounding.
    #[test]
    fn an_undriven_coordinate_is_singular() {
        for small in [0.0, 1e-17, 1e-16] {
            let jacobian = [[1.0, small], [-1.0, 2.0 * small], [0.5, small]];
            let found = Partition::new(&jacobian, &[0, 1]);
            assert!(
                matches!(found, Err(Error::SingularPartition { condition, .. }) if condition > 1e10),
                "{small:e}"
            );
        }
    }

    #[test]
    fn invalid_inputs_are_rejected() {
        let outside = Partition::new(&JACOBIAN, &[0, 3]);
        let expected = Error::NoActuator {
            index: 3,
            actuators: 3,
        };
        assert_eq!(outside, Err(expected));
        let broken = Partition::new(&[[1.0, f64::NAN], [0.0, 1.0]], &[0, 1]);
        let input = "inverse_jacobian";
        assert_eq!(broken, Err(Error::NotFinite { input }));
        let partition = Partition::new(&JACOBIAN, &[0, 1]).unwrap();
        let short = partition.project(&mut [1.0; 3]);
        assert_eq!(
            short,
            Err(Error::Length {
                expected: 4,
                found: 3
            })
        );
    }
}
