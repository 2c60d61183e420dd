//! Small dense matrices in slices, row by row, without allocation.

/// Sweeps after which the singular values of a small matrix have converged to rounding.
const SWEEPS: usize = 30;

/// Cosine of the angle between two columns that count as orthogonal.
const ORTHOGONAL: f64 = 1e-15;

/// Ratio of the largest to the smallest singular value of a matrix of columns of `n` values, by
/// one-sided Jacobi rotations, which make the columns orthogonal.
pub(super) fn orthogonalised(columns: &mut [f64], n: usize) -> f64 {
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
pub(super) fn eliminated(matrix: &mut [f64], r: usize) -> f64 {
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
pub(super) fn invert(matrix: &mut [f64], inverse: &mut [f64], r: usize) -> bool {
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
    use super::{eliminated, invert};
    use nalgebra::DMatrix;

    /// Row by row; without pivots, the digits of each are lost, or its first step divides by zero.
    const NEEDS_PIVOTS: [[f64; 9]; 5] = [
        [0.0, 2.0, 1.0, 1.0, 0.0, 3.0, 4.0, 1.0, 0.0],
        [1e-17, 1.0, 2.0, 1.0, 1.0, 1.0, 2.0, -1.0, 1.0],
        [1e-17, 1.0, 2.0, 1.0, 0.0, 0.0, 2.0, -1.0, 1.0],
        [1.0, 2.0, 3.0, 1.0, 2.0, -1.0, 0.5, 3.0, 1.0],
        [3.0, 1.0, -2.0, 3.0, 1.0 + 1e-17, 4.0, 1.0, 5.0, 9.0],
    ];

    #[test]
    fn rows_are_exchanged_where_a_diagonal_is_small() {
        for rows in NEEDS_PIVOTS {
            let matrix = DMatrix::from_row_slice(3, 3, &rows);
            let determinant = eliminated(&mut rows.clone(), 3);
            let expected = matrix.determinant();
            assert!(
                (determinant / expected - 1.0).abs() < 1e-14,
                "{determinant}"
            );
            let mut inverse = [1.0, 0.0, 0.0, 0.0, 1.0, 0.0, 0.0, 0.0, 1.0];
            assert!(invert(&mut rows.clone(), &mut inverse, 3));
            let product = matrix * DMatrix::from_row_slice(3, 3, &inverse);
            let miss = (product - DMatrix::identity(3, 3)).abs().max();
            assert!(miss < 1e-14, "{rows:?}: {miss:e}");
        }
    }

    #[test]
    fn a_singular_matrix_has_no_inverse() {
        let rows = [1.0, 2.0, 2.0, 4.0];
        assert_eq!(eliminated(&mut rows.clone(), 2), 0.0);
        assert!(!invert(&mut rows.clone(), &mut [1.0, 0.0, 0.0, 1.0], 2));
    }
}
