//! How well actuators determine the platform at a pose, and case 2 for any choice of them.
//!
//! With the rows J_a of J_p^inv that belong to the kept actuators, Γ² = J_a^-T Γ¹ (36). Their condition
//! number compares metres with radians by dividing the columns of J_p^inv by their norms at home. The
//! determinant changes its sign where a trajectory crosses a singularity of the partition, be it
//! between two samples.

use overact::{Function, Model};

use super::dense::{eliminated, invert, orthogonalised};

/// Inverse norms of the columns of J_p^inv at home, which make metres and radians comparable; ones
/// where the model has no value at home.
pub(crate) fn home_scales(model: &dyn Model) -> Vec<f64> {
    let info = model.info();
    let (n, r) = (info.sizes.actuators, info.sizes.dof);
    let mut jacobian = vec![0.0; n * r];
    let evaluated = model.evaluate(Function::InverseJacobian, &[info.home_pose], &mut jacobian);
    let norm = |column: usize| {
        let squares = (0..n).map(|row| jacobian[row * r + column].powi(2));
        squares.sum::<f64>().sqrt()
    };
    let scale = |norm: f64| {
        if evaluated.is_ok() && norm > 0.0 {
            1.0 / norm
        } else {
            1.0
        }
    };
    (0..r).map(norm).map(scale).collect()
}

/// What some actuators are like at one pose.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct Condition {
    /// Condition number (2-norm); infinite where they are singular.
    pub(crate) number: f64,
    /// Determinant divided by the product of the rows' norms; 0 unless there are r of them.
    pub(crate) determinant: f64,
}

impl Condition {
    /// The condition of an identity matrix.
    pub(crate) const PERFECT: Self = Self {
        number: 1.0,
        determinant: 1.0,
    };
}

/// A choice of actuators, with memory for its matrices.
#[derive(Debug, Clone)]
pub(crate) struct KeptActuators {
    kept: Vec<usize>,
    scales: Vec<f64>,
    /// Columns of the kept rows, scaled.
    columns: Vec<f64>,
    /// J_a, then its factors; J_a^-1 beside it.
    work: Vec<f64>,
}

impl KeptActuators {
    /// The actuators `kept`, with the `scales` of the platform's coordinates.
    pub(crate) fn new(kept: Vec<usize>, scales: &[f64]) -> Self {
        let (n, r) = (kept.len(), scales.len());
        Self {
            kept,
            scales: scales.to_vec(),
            columns: vec![0.0; n * r],
            work: vec![0.0; 2 * r * r],
        }
    }

    /// Whether the kept rows of J_p^inv are the identity, as without a loop.
    pub(crate) fn is_identity(&self, jacobian: &[f64]) -> bool {
        let r = self.scales.len();
        self.kept.len() == r
            && self.kept.iter().enumerate().all(|(i, actuator)| {
                let row = &jacobian[actuator * r..(actuator + 1) * r];
                row.iter()
                    .enumerate()
                    .all(|(j, v)| *v == f64::from(u8::from(i == j)))
            })
    }

    /// Condition and determinant of the kept rows of J_p^inv (n x r, row-major).
    pub(crate) fn condition(&mut self, jacobian: &[f64]) -> Condition {
        let (n, r) = (self.kept.len(), self.scales.len());
        for (i, actuator) in self.kept.iter().enumerate() {
            let row = &jacobian[actuator * r..(actuator + 1) * r];
            for (j, (value, scale)) in row.iter().zip(&self.scales).enumerate() {
                self.columns[j * n + i] = value * scale;
            }
        }
        let determinant = if n == r {
            self.scaled_determinant()
        } else {
            0.0
        };
        Condition {
            number: orthogonalised(&mut self.columns, n),
            determinant,
        }
    }

    /// Determinant of the scaled rows, divided by the product of their norms.
    fn scaled_determinant(&mut self) -> f64 {
        let r = self.scales.len();
        let matrix = &mut self.work[..r * r];
        matrix.copy_from_slice(&self.columns);
        let norm = |row: usize| {
            let squares = (0..r).map(|j| self.columns[j * r + row].powi(2));
            squares.sum::<f64>().sqrt()
        };
        let product: f64 = (0..r).map(norm).product();
        let determinant = eliminated(matrix, r);
        if product > 0.0 {
            determinant / product
        } else {
            0.0
        }
    }

    /// J_a^-1 (r x r, row-major), or `None` where J_a is singular.
    pub(crate) fn inverse(&mut self, jacobian: &[f64]) -> Option<&[f64]> {
        let r = self.scales.len();
        let (matrix, inverse) = self.work.split_at_mut(r * r);
        for (i, actuator) in self.kept.iter().enumerate() {
            matrix[i * r..(i + 1) * r].copy_from_slice(&jacobian[actuator * r..(actuator + 1) * r]);
        }
        inverse.fill(0.0);
        inverse.iter_mut().step_by(r + 1).for_each(|one| *one = 1.0);
        invert(matrix, inverse, r).then_some(inverse)
    }
}

/// Whether the loops couple all actuators: J_p^inv at home is not the identity.
pub(crate) fn couples(model: &dyn Model) -> bool {
    let info = model.info();
    let (n, r) = (info.sizes.actuators, info.sizes.dof);
    let mut jacobian = vec![0.0; n * r];
    let evaluated = model.evaluate(Function::InverseJacobian, &[info.home_pose], &mut jacobian);
    let choice = KeptActuators::new((0..n).collect(), &home_scales(model));
    evaluated.is_ok() && !choice.is_identity(&jacobian)
}

#[cfg(test)]
mod tests {
    use super::KeptActuators;
    use nalgebra::DMatrix;

    #[test]
    fn conditions_determinants_and_inverses_are_those_of_dense_algebra() {
        let mut seed = 1_u64;
        let mut random = || {
            seed = seed.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1);
            (seed >> 11) as f64 / (1_u64 << 53) as f64 - 0.5
        };
        for r in 1..=6 {
            for n in r..r + 3 {
                let jacobian: Vec<f64> = (0..n * r).map(|_| random()).collect();
                let scales: Vec<f64> = (0..r).map(|_| 1.0 + random()).collect();
                let scaled = DMatrix::from_fn(n, r, |i, j| jacobian[i * r + j] * scales[j]);
                let whole = KeptActuators::new((0..n).collect(), &scales).condition(&jacobian);
                let values = scaled.singular_values();
                assert!((whole.number * values.min() / values.max() - 1.0).abs() < 1e-12);

                let kept: Vec<usize> = (n - r..n).rev().collect();
                let rows = scaled.select_rows(&kept);
                let mut choice = KeptActuators::new(kept.clone(), &scales);
                let found = choice.condition(&jacobian);
                let values = rows.singular_values();
                assert!((found.number * values.min() / values.max() - 1.0).abs() < 1e-10);
                let norms: f64 = rows.row_iter().map(|row| row.norm()).product();
                assert!((found.determinant - rows.determinant() / norms).abs() < 1e-12);

                let plain = DMatrix::from_fn(r, r, |i, j| jacobian[kept[i] * r + j]);
                let inverse = choice.inverse(&jacobian).expect("regular");
                let product = plain * DMatrix::from_row_slice(r, r, inverse);
                assert!((product - DMatrix::identity(r, r)).norm() < 1e-9);
            }
        }
        let mut singular = KeptActuators::new(vec![0, 1], &[1.0, 1.0]);
        let jacobian = [1.0, 2.0, 2.0, 4.0];
        assert!(singular.condition(&jacobian).number > 1e15);
        assert!(singular.condition(&jacobian).determinant.abs() < 1e-15);
        assert!(singular.inverse(&jacobian).is_none());
    }
}
