//! Torques of redundant actuators for given inputs of the platform.

use pulp::NullaryFnOnce;

use super::dense::{LANES, invert, lanes};
use crate::with_avx::with_avx2;

/// J (Jᵀ J)^-1 of J_p^inv (n × r, row-major), which maps Γ¹ to the least-norm torques.
///
/// `None` if the actuators do not determine the platform.
pub(crate) fn least_norm(jacobian: &[f64], r: usize) -> Option<Vec<f64>> {
    // The actuators of most serial robots are their coordinates.
    if is_identity(jacobian, r) {
        return Some(jacobian.to_vec());
    }
    distribution(jacobian, jacobian, r)
}

/// Least-norm torques for several inputs at each of successive samples, samples × n.
///
/// `jacobians` has J_p^inv (n × r) of each sample, and inputs are samples × r. Zero if the
/// actuators do not determine the platform.
pub(crate) fn least_torques<const N: usize>(
    jacobians: &[f64],
    n: usize,
    r: usize,
    inputs: [&[f64]; N],
) -> [Vec<f64>; N] {
    if are_identities(jacobians, n, r) {
        return inputs.map(<[f64]>::to_vec);
    }
    let mut torques = inputs.map(|inputs| vec![0.0; inputs.len() / r * n]);
    with_avx2(LeastTorques {
        jacobians,
        n,
        r,
        inputs,
        torques: &mut torques,
    });
    torques
}

/// Vectorised computation of J (Jᵀ J)^-1 Γ¹.
struct LeastTorques<'a, const N: usize> {
    jacobians: &'a [f64],
    n: usize,
    r: usize,
    inputs: [&'a [f64]; N],
    torques: &'a mut [Vec<f64>; N],
}

impl<const N: usize> NullaryFnOnce for LeastTorques<'_, N> {
    type Output = ();

    #[inline(always)]
    fn call(self) {
        let (n, r) = (self.n, self.r);
        let (mut normal, mut inverse) = (vec![[0.0; LANES]; r * r], vec![[0.0; LANES]; r * r]);
        let mut solved = vec![0.0; r];
        for (group, rows) in self.jacobians.chunks(LANES * n * r).enumerate() {
            for i in 0..r {
                for j in 0..r {
                    normal[i * r + j] = [0.0; LANES];
                    inverse[i * r + j] = [f64::from(u8::from(i == j)); LANES];
                }
            }
            for entry in 0..n * r {
                let (actuator, i) = (entry / r, entry % r);
                let own = lanes(rows, n * r, |jacobian| jacobian[entry]);
                for j in 0..r {
                    let other = lanes(rows, n * r, |jacobian| jacobian[actuator * r + j]);
                    for lane in 0..LANES {
                        normal[i * r + j][lane] += own[lane] * other[lane];
                    }
                }
            }
            let is_regular = invert(&mut normal, &mut inverse, r);
            for (lane, jacobian) in rows.chunks_exact(n * r).enumerate() {
                if !is_regular[lane] {
                    continue;
                }
                let sample = group * LANES + lane;
                for (inputs, torques) in self.inputs.iter().zip(&mut *self.torques) {
                    let inputs = &inputs[sample * r..(sample + 1) * r];
                    for (i, solved) in solved.iter_mut().enumerate() {
                        *solved = 0.0;
                        for (j, input) in inputs.iter().enumerate() {
                            *solved += inverse[i * r + j][lane] * input;
                        }
                    }
                    product(
                        jacobian,
                        &solved,
                        &mut torques[sample * n..(sample + 1) * n],
                    );
                }
            }
        }
    }
}

/// Whether all n × r matrices are identities.
pub(crate) fn are_identities(matrices: &[f64], n: usize, r: usize) -> bool {
    let mut all = matrices.chunks_exact((n * r).max(1));
    all.all(|matrix| is_identity(matrix, r))
}

/// Whether a matrix of `r` columns is the identity.
fn is_identity(matrix: &[f64], r: usize) -> bool {
    let one = |(place, value): (usize, &f64)| *value == f64::from(u8::from(place % (r + 1) == 0));
    matrix.len() == r * r && matrix.iter().enumerate().all(one)
}

/// Bᵀ B J (Jᵀ Bᵀ B J)^-1 with B_p of the closure (n × n).
///
/// With A_p = -B_p J_p^inv, it maps Γ¹ to the torques -B_pᵀ λ of eq. (26) without overconstraint. λ
/// is the least-norm solution of A_pᵀ λ = Γ¹. The multipliers of the legs in (26) are unique.
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
    let [one, other] = [&mut normal, &mut inverse].map(|own| own.as_chunks_mut().0);
    if invert(one, other, r) != [true] {
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

/// Matrix times vector; rows have the vector's length.
pub(crate) fn product(matrix: &[f64], vector: &[f64], result: &mut [f64]) {
    for (row, result) in matrix.chunks_exact(vector.len()).zip(result) {
        *result = row.iter().zip(vector).map(|(a, b)| a * b).sum();
    }
}

/// Transposed matrix of `r` columns times vector: Γ¹ = J_p^invᵀ τ.
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

#[cfg(test)]
mod tests {
    use super::{least_multipliers, least_norm, least_torques, product, transposed_product};
    use nalgebra::DMatrix;

    /// With B = 1 both distributions agree. With any B they satisfy the model, and the multipliers
    /// are those of the pseudo-inverse.
    #[test]
    fn distributed_torques_satisfy_the_model() {
        let mut seed = 1_u64;
        let mut random = || {
            seed = seed.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1);
            (seed >> 11) as f64 / (1_u64 << 53) as f64 - 0.5
        };
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
        // After a singular sample, and twice as large.
        let both = [vec![0.0; n * r], jacobian.clone()].concat();
        let inputs = [gamma, gamma].concat();
        let twice: Vec<f64> = inputs.iter().map(|input| 2.0 * input).collect();
        let [one, two] = least_torques(&both, n, r, [&inputs, &twice]);
        assert_eq!(one[..n], [0.0; 4]);
        for ((a, b), c) in plain.iter().zip(&one[n..]).zip(&two[n..]) {
            assert!((a - b).abs() < 1e-12 && (2.0 * a - c).abs() < 1e-12);
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
    }
}
