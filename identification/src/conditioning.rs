//! How well actuators determine the platform at a pose, and case 2 for any choice of them.
//!
//! With the rows J_a of J_p^inv that belong to the kept actuators, Γ² = J_a^-T Γ¹ (36). Their condition
//! number compares metres with radians by dividing the columns of J_p^inv by their norms at home. The
//! determinant changes its sign where a trajectory crosses a singularity of the partition, be it
//! between two samples.

use overact::{Function, Model};

/// Sweeps after which the singular values of a small matrix have converged to rounding.
const SWEEPS: usize = 30;

/// Cosine of the angle between two columns that count as orthogonal.
const ORTHOGONAL: f64 = 1e-15;

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
    /// That of the identity.
    pub(crate) const PERFECT: Self = Self {
        number: 1.0,
        determinant: 1.0,
    };
}

/// A choice of actuators, with memory for its matrices.
#[derive(Debug, Clone)]
pub(crate) struct Choice {
    kept: Vec<usize>,
    scales: Vec<f64>,
    /// Columns of the kept rows, scaled.
    columns: Vec<f64>,
    /// J_a, then its factors; J_a^-1 beside it.
    work: Vec<f64>,
}

impl Choice {
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

/// J (Jᵀ J)^-1 of J_p^inv (n x r, row-major), which turns Γ¹ into the torques of least norm; `None` where
/// the actuators do not determine the platform.
pub(crate) fn least_norm(jacobian: &[f64], r: usize) -> Option<Vec<f64>> {
    distribution(jacobian, jacobian, r)
}

/// Bᵀ B J (Jᵀ Bᵀ B J)^-1 with B_p of the closure (n x n): with A_p = -B_p J_p^inv, this is what turns Γ¹
/// into the torques -B_pᵀ λ of eq. (26) without overconstraint, λ being of least norm in A_pᵀ λ = Γ¹. (The
/// multipliers of the legs in (26) are determined without a choice.)
pub(crate) fn least_multipliers(jacobian: &[f64], closure: &[f64], r: usize) -> Option<Vec<f64>> {
    let n = jacobian.len() / r.max(1);
    let platform: Vec<f64> = closure
        .chunks_exact(n)
        .flat_map(|row| transposed_product(jacobian, row, r))
        .collect();
    // Row i of Bᵀ (B J) is the product of column i of B with B J.
    let weighted: Vec<f64> = (0..n)
        .flat_map(|i| {
            let column: Vec<f64> = closure.iter().skip(i).step_by(n).copied().collect();
            transposed_product(&platform, &column, r)
        })
        .collect();
    distribution(jacobian, &weighted, r)
}

/// M (Jᵀ M)^-1 of two n x r matrices.
fn distribution(jacobian: &[f64], weighted: &[f64], r: usize) -> Option<Vec<f64>> {
    let mut normal = vec![0.0; r * r];
    for (row, weighted) in jacobian.chunks_exact(r).zip(weighted.chunks_exact(r)) {
        for (i, a) in row.iter().enumerate() {
            for (j, b) in weighted.iter().enumerate() {
                normal[i * r + j] += a * b;
            }
        }
    }
    let mut inverse = vec![0.0; r * r];
    inverse.iter_mut().step_by(r + 1).for_each(|one| *one = 1.0);
    if !invert(&mut normal, &mut inverse, r) {
        return None;
    }
    let mut product = vec![0.0; jacobian.len()];
    for (row, target) in weighted.chunks_exact(r).zip(product.chunks_exact_mut(r)) {
        for (a, inverse) in row.iter().zip(inverse.chunks_exact(r)) {
            target
                .iter_mut()
                .zip(inverse)
                .for_each(|(t, i)| *t += a * i);
        }
    }
    Some(product)
}

/// Product of a matrix (rows of the vector's length) with a vector.
pub(crate) fn product(matrix: &[f64], vector: &[f64], result: &mut [f64]) {
    for (row, result) in matrix.chunks_exact(vector.len()).zip(result) {
        *result = row.iter().zip(vector).map(|(a, b)| a * b).sum();
    }
}

/// Product of the transpose of a matrix of `r` columns with a vector: Γ¹ = J_p^invᵀ τ.
pub(crate) fn transposed_product(matrix: &[f64], vector: &[f64], r: usize) -> Vec<f64> {
    let mut result = vec![0.0; r];
    for (row, factor) in matrix.chunks_exact(r).zip(vector) {
        result
            .iter_mut()
            .zip(row)
            .for_each(|(result, a)| *result += a * factor);
    }
    result
}

/// Ratio of the largest to the smallest singular value of a matrix of columns of `n` values, by
/// one-sided Jacobi rotations, which make the columns orthogonal.
fn orthogonalised(columns: &mut [f64], n: usize) -> f64 {
    let r = columns.len() / n.max(1);
    let product = |columns: &[f64], p: usize, q: usize| -> f64 {
        let pair = columns[p * n..(p + 1) * n]
            .iter()
            .zip(&columns[q * n..(q + 1) * n]);
        pair.map(|(a, b)| a * b).sum()
    };
    for _ in 0..SWEEPS {
        let mut turned = false;
        for p in 0..r {
            for q in p + 1..r {
                let (a, b) = (product(columns, p, p), product(columns, q, q));
                let c = product(columns, p, q);
                if c.abs() <= ORTHOGONAL * (a * b).sqrt() || c == 0.0 {
                    continue;
                }
                turned = true;
                let zeta = (b - a) / (2.0 * c);
                // Where the square overflows the rotation is none, as it should be.
                let t = zeta.signum() / (zeta.abs() + (zeta * zeta + 1.0).sqrt());
                let cosine = 1.0 / (t * t + 1.0).sqrt();
                let sine = cosine * t;
                let (left, right) = columns.split_at_mut(q * n);
                for (x, y) in left[p * n..(p + 1) * n].iter_mut().zip(&mut right[..n]) {
                    (*x, *y) = (cosine * *x - sine * *y, sine * *x + cosine * *y);
                }
            }
        }
        if !turned {
            break;
        }
    }
    let squares = (0..r).map(|p| product(columns, p, p));
    let (least, largest) = squares.fold((f64::INFINITY, 0.0_f64), |(low, high), s| {
        (f64::min(low, s), f64::max(high, s))
    });
    // A matrix that is not finite has no condition number either.
    if least > 0.0 && largest.is_finite() {
        (largest / least).sqrt()
    } else {
        f64::INFINITY
    }
}

/// Determinant by elimination with pivots, in place.
fn eliminated(matrix: &mut [f64], r: usize) -> f64 {
    let mut determinant = 1.0;
    for k in 0..r {
        let pivot = pivot(matrix, r, k);
        if pivot != k {
            swap_rows(matrix, r, k, pivot);
            determinant = -determinant;
        }
        let diagonal = matrix[k * r + k];
        determinant *= diagonal;
        if diagonal == 0.0 {
            return 0.0;
        }
        for i in k + 1..r {
            let factor = matrix[i * r + k] / diagonal;
            for j in k + 1..r {
                matrix[i * r + j] -= factor * matrix[k * r + j];
            }
        }
    }
    determinant
}

/// Turns the identity in `inverse` into the inverse of `matrix`, which is overwritten; `false` where
/// it is singular.
fn invert(matrix: &mut [f64], inverse: &mut [f64], r: usize) -> bool {
    for k in 0..r {
        let pivot = pivot(matrix, r, k);
        swap_rows(matrix, r, k, pivot);
        swap_rows(inverse, r, k, pivot);
        let diagonal = matrix[k * r + k];
        if diagonal == 0.0 || !diagonal.is_finite() {
            return false;
        }
        for j in 0..r {
            matrix[k * r + j] /= diagonal;
            inverse[k * r + j] /= diagonal;
        }
        for i in (0..r).filter(|i| *i != k) {
            let factor = matrix[i * r + k];
            for j in 0..r {
                matrix[i * r + j] -= factor * matrix[k * r + j];
                inverse[i * r + j] -= factor * inverse[k * r + j];
            }
        }
    }
    true
}

/// The row from `k` on that has the largest value in column `k`.
fn pivot(matrix: &[f64], r: usize, k: usize) -> usize {
    (k..r)
        .max_by(|a, b| matrix[a * r + k].abs().total_cmp(&matrix[b * r + k].abs()))
        .unwrap_or(k)
}

/// Exchanges two rows.
fn swap_rows(matrix: &mut [f64], r: usize, a: usize, b: usize) {
    if a != b {
        for j in 0..r {
            matrix.swap(a * r + j, b * r + j);
        }
    }
}

#[cfg(test)]
mod tests {
    use super::{Choice, least_multipliers, least_norm, product, transposed_product};
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
                let whole = Choice::new((0..n).collect(), &scales).condition(&jacobian);
                let values = scaled.singular_values();
                assert!((whole.number * values.min() / values.max() - 1.0).abs() < 1e-12);

                let kept: Vec<usize> = (n - r..n).rev().collect();
                let rows = scaled.select_rows(&kept);
                let mut choice = Choice::new(kept.clone(), &scales);
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
        // Torques for given inputs: with B = 1 both distributions agree; with any B they satisfy the
        // model, and the multipliers are those of the pseudo-inverse.
        let (n, r) = (4, 3);
        let jacobian: Vec<f64> = (0..n * r).map(|_| random()).collect();
        let closure: Vec<f64> = (0..n * n).map(|_| random()).collect();
        let gamma = [0.3, -1.0, 2.0];
        let torques = |distribution: &[f64]| {
            let mut torques = vec![0.0; n];
            product(distribution, &gamma, &mut torques);
            torques
        };
        let identity = DMatrix::<f64>::identity(n, n);
        let plain = torques(&least_norm(&jacobian, r).expect("regular"));
        let same = least_multipliers(&jacobian, identity.as_slice(), r).expect("regular");
        let found = torques(&least_multipliers(&jacobian, &closure, r).expect("regular"));
        for (a, b) in plain.iter().zip(torques(&same)) {
            assert!((a - b).abs() < 1e-12);
        }
        for (a, b) in transposed_product(&jacobian, &found, r).iter().zip(gamma) {
            assert!((a - b).abs() < 1e-11);
        }
        let (b, j) = (
            DMatrix::from_row_slice(n, n, &closure),
            DMatrix::from_row_slice(n, r, &jacobian),
        );
        let a = -&b * j;
        let inverse = a.transpose().pseudo_inverse(1e-14).expect("an inverse");
        let expected = -b.transpose() * inverse * DMatrix::from_column_slice(r, 1, &gamma);
        for (a, b) in found.iter().zip(expected.iter()) {
            assert!((a - b).abs() < 1e-11, "{a} {b}");
        }

        let mut singular = Choice::new(vec![0, 1], &[1.0, 1.0]);
        let jacobian = [1.0, 2.0, 2.0, 4.0];
        assert!(singular.condition(&jacobian).number > 1e15);
        assert!(singular.condition(&jacobian).determinant.abs() < 1e-15);
        assert!(singular.inverse(&jacobian).is_none());
    }
}
