//! Condition of the kept actuators at a pose, and the actuator projection.
//!
//! With the rows J_a of J_p^inv of the kept actuators, Γ² = J_a^-T Γ¹ (36). For the condition
//! number, the columns of J_p^inv are divided by their norms at home, which makes metres and
//! radians comparable. The determinant changes its sign where a trajectory crosses a singularity of
//! the partition, even between two samples.

use overact::{Function, Model};
use pulp::NullaryFnOnce;

use super::dense::{LANES, Lanes, eliminated, invert, lanes, orthogonalised};
use crate::with_avx::with_avx2;

/// Inverse norms of the columns of J_p^inv at home, to scale metres and radians.
///
/// Ones if the model has no value at home.
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

/// Condition of the kept actuators at one pose.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct Condition {
    /// Condition number (2-norm); infinite if singular.
    pub(crate) number: f64,
    /// Determinant divided by the product of the row norms; 0 unless there are r rows.
    pub(crate) determinant: f64,
}

impl Condition {
    /// Condition of an identity matrix.
    pub(crate) const PERFECT: Self = Self {
        number: 1.0,
        determinant: 1.0,
    };
}

/// A partition: the kept actuators.
#[derive(Debug, Clone)]
pub(crate) struct KeptActuators {
    kept: Vec<usize>,
    scales: Vec<f64>,
}

impl KeptActuators {
    /// The partition `kept`, with the `scales` of the platform's coordinates.
    pub(crate) fn new(kept: Vec<usize>, scales: &[f64]) -> Self {
        Self {
            kept,
            scales: scales.to_vec(),
        }
    }

    /// Whether the kept rows of J_p^inv are the identity, as in robots without loops.
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

    /// Conditions of successive samples; `jacobians` has n × r row-major values each.
    pub(crate) fn conditions(&self, jacobians: &[f64], size: usize) -> Vec<Condition> {
        let samples = jacobians.len() / size;
        let mut found = vec![Condition::PERFECT; samples];
        with_avx2(Conditions {
            choice: self,
            jacobians,
            size,
            found: &mut found,
        });
        found
    }

    /// J_a^-1 (r × r, row-major) of successive samples, and the first singular sample.
    pub(crate) fn inverses(&self, jacobians: &[f64], size: usize) -> (Vec<f64>, Option<usize>) {
        let r = self.scales.len();
        let mut inverses = vec![0.0; jacobians.len() / size * r * r];
        let singular = with_avx2(Inverses {
            choice: self,
            jacobians,
            size,
            inverses: &mut inverses,
        });
        (inverses, singular)
    }
}

/// Vectorised computation of conditions.
struct Conditions<'a> {
    choice: &'a KeptActuators,
    jacobians: &'a [f64],
    size: usize,
    found: &'a mut [Condition],
}

impl NullaryFnOnce for Conditions<'_> {
    type Output = ();

    #[inline(always)]
    fn call(self) {
        let KeptActuators { kept, scales } = self.choice;
        let (n, r) = (kept.len(), scales.len());
        let mut columns = vec![[0.0; LANES]; n * r];
        let mut matrix = vec![[0.0; LANES]; if n == r { r * r } else { 0 }];
        let groups = self.jacobians.chunks(LANES * self.size);
        for (rows, found) in groups.zip(self.found.chunks_mut(LANES)) {
            let mut own = rows.chunks_exact(self.size);
            if own.all(|jacobian| self.choice.is_identity(jacobian)) {
                continue;
            }
            for (j, scale) in scales.iter().enumerate() {
                for (i, actuator) in kept.iter().enumerate() {
                    let entry = |jacobian: &[f64]| jacobian[actuator * r + j] * scale;
                    columns[j * n + i] = lanes(rows, self.size, entry);
                }
            }
            let mut determinants = [0.0; LANES];
            if n == r {
                matrix.copy_from_slice(&columns);
                determinants = scaled_determinants(&mut matrix, r);
            }
            let numbers = orthogonalised(&mut columns, n);
            let jacobians = rows.chunks_exact(self.size);
            for ((lane, found), jacobian) in found.iter_mut().enumerate().zip(jacobians) {
                if !self.choice.is_identity(jacobian) {
                    *found = Condition {
                        number: numbers[lane],
                        determinant: determinants[lane],
                    };
                }
            }
        }
    }
}

/// Determinants of r × r matrices, divided by the product of their row norms.
#[inline(always)]
fn scaled_determinants(matrix: &mut [Lanes], r: usize) -> Lanes {
    let mut norms = [1.0; LANES];
    for row in 0..r {
        let mut squares = [0.0; LANES];
        for j in 0..r {
            for lane in 0..LANES {
                squares[lane] += matrix[j * r + row][lane] * matrix[j * r + row][lane];
            }
        }
        for lane in 0..LANES {
            norms[lane] *= squares[lane].sqrt();
        }
    }
    let mut determinants = eliminated(matrix, r);
    for lane in 0..LANES {
        determinants[lane] = if norms[lane] > 0.0 {
            determinants[lane] / norms[lane]
        } else {
            0.0
        };
    }
    determinants
}

/// Vectorised computation of inverses.
struct Inverses<'a> {
    choice: &'a KeptActuators,
    jacobians: &'a [f64],
    size: usize,
    inverses: &'a mut [f64],
}

impl NullaryFnOnce for Inverses<'_> {
    type Output = Option<usize>;

    #[inline(always)]
    fn call(self) -> Option<usize> {
        let KeptActuators { kept, scales } = self.choice;
        let r = scales.len();
        let mut matrix = vec![[0.0; LANES]; r * r];
        let mut inverse = matrix.clone();
        let groups = self.jacobians.chunks(LANES * self.size).enumerate();
        for ((group, rows), inverses) in groups.zip(self.inverses.chunks_mut(LANES * r * r)) {
            for (i, actuator) in kept.iter().enumerate() {
                for j in 0..r {
                    let entry = |jacobian: &[f64]| jacobian[actuator * r + j];
                    matrix[i * r + j] = lanes(rows, self.size, entry);
                    inverse[i * r + j] = [f64::from(u8::from(i == j)); LANES];
                }
            }
            let is_regular = invert(&mut matrix, &mut inverse, r);
            for (lane, own) in inverses.chunks_exact_mut(r * r).enumerate() {
                if !is_regular[lane] {
                    return Some(group * LANES + lane);
                }
                for (to, from) in own.iter_mut().zip(&inverse) {
                    *to = from[lane];
                }
            }
        }
        None
    }
}

/// Whether loops couple the actuators: J_p^inv at home is not the identity.
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
    fn conditions_determinants_and_inverses_agree_with_dense_algebra() {
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
                let whole = KeptActuators::new((0..n).collect(), &scales);
                let whole = whole.conditions(&jacobian, n * r)[0];
                let values = scaled.singular_values();
                assert!((whole.number * values.min() / values.max() - 1.0).abs() < 1e-12);

                let kept: Vec<usize> = (n - r..n).rev().collect();
                let rows = scaled.select_rows(&kept);
                let choice = KeptActuators::new(kept.clone(), &scales);
                let found = choice.conditions(&jacobian, n * r)[0];
                let values = rows.singular_values();
                assert!((found.number * values.min() / values.max() - 1.0).abs() < 1e-10);
                let norms: f64 = rows.row_iter().map(|row| row.norm()).product();
                assert!((found.determinant - rows.determinant() / norms).abs() < 1e-12);

                let plain = DMatrix::from_fn(r, r, |i, j| jacobian[kept[i] * r + j]);
                let (inverse, singular) = choice.inverses(&jacobian, n * r);
                assert_eq!(singular, None);
                let product = plain * DMatrix::from_row_slice(r, r, &inverse);
                assert!((product - DMatrix::identity(r, r)).norm() < 1e-9);
            }
        }
        let singular = KeptActuators::new(vec![0, 1], &[1.0, 1.0]);
        // After a regular one: neighbours do not matter.
        let jacobians = [[1.0, 0.5, 2.0, 4.0], [1.0, 2.0, 2.0, 4.0]].concat();
        let conditions = singular.conditions(&jacobians, 4);
        assert!(conditions[0].number < 10.0);
        assert!(conditions[1].number > 1e15);
        assert!(conditions[1].determinant.abs() < 1e-15);
        assert_eq!(singular.inverses(&jacobians, 4).1, Some(1));
    }

    #[test]
    fn condition_numbers_do_not_depend_on_other_samples() {
        let jacobians: Vec<f64> = (0..21 * 12)
            .map(|k| (0.37 * f64::from(k * k)).sin())
            .collect();
        let choice = KeptActuators::new(vec![3, 0, 2], &[1.0, 0.7, 2.0]);
        let together = choice.conditions(&jacobians, 12);
        for (jacobian, found) in jacobians.chunks_exact(12).zip(&together) {
            assert_eq!(choice.conditions(jacobian, 12)[0], *found);
        }
    }
}
