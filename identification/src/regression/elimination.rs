//! Linear dependence of matrix columns on earlier ones, by Householder QR without pivoting, eq.
//! (42).
//!
//! Columns are processed in a given order. A column is dependent if its part outside the span of
//! the kept ones is below a tolerance times its norm: |R_kk| < α. It then causes no reflection, and
//! its coefficients on the kept columns are R_1^-1 times its part inside the span.

use nalgebra::DMatrix;

/// Coefficients below this, for columns of unit norm, are rounding errors.
const COEFFICIENT_TOLERANCE: f64 = 1e-9;

/// Columns below this fraction of the largest column norm are zero.
const ZERO_TOLERANCE: f64 = 1e-13;

/// Result of the factorisation; all numbers are column indices of the matrix.
#[derive(Debug, Clone, PartialEq, Default)]
pub(crate) struct Elimination {
    /// Independent columns, in the given order.
    pub(crate) kept: Vec<usize>,
    /// Dependent columns, with their coefficients on kept ones.
    pub(crate) dependent: Vec<(usize, Vec<(usize, f64)>)>,
    /// Zero columns.
    pub(crate) zero: Vec<usize>,
}

/// Splits the columns `order` of `matrix` into independent, dependent and zero ones.
pub(crate) fn eliminate(matrix: &DMatrix<f64>, order: &[usize], tolerance: f64) -> Elimination {
    let norms: Vec<f64> = order
        .iter()
        .map(|&column| matrix.column(column).norm())
        .collect();
    let largest = norms
        .iter()
        .fold(0.0_f64, |largest, norm| largest.max(*norm));
    let mut work = DMatrix::zeros(matrix.nrows(), order.len());
    for (k, (&column, &norm)) in order.iter().zip(&norms).enumerate() {
        if norm > 0.0 {
            work.set_column(k, &(matrix.column(column) / norm));
        }
    }
    let mut result = Elimination::default();
    // Positions of the kept columns in `order`.
    let mut places: Vec<usize> = Vec::new();
    for k in 0..order.len() {
        let rank = places.len();
        let rest = work.nrows() - rank;
        if norms[k] <= ZERO_TOLERANCE * largest {
            result.zero.push(order[k]);
        } else if rest == 0 || work.view((rank, k), (rest, 1)).norm() < tolerance {
            let coefficients = back_substitute(&work, &places, k)
                .into_iter()
                .zip(&places)
                .filter(|(coefficient, _)| coefficient.abs() >= COEFFICIENT_TOLERANCE)
                .map(|(coefficient, &place)| (order[place], coefficient * norms[k] / norms[place]))
                .collect();
            result.dependent.push((order[k], coefficients));
        } else {
            reflect(&mut work, rank, k);
            places.push(k);
            result.kept.push(order[k]);
        }
    }
    result
}

/// Rank of the columns `order` of `matrix`, and distance of its last column from their span.
pub(crate) fn residual(matrix: &DMatrix<f64>, order: &[usize], tolerance: f64) -> (usize, f64) {
    let count = order.len();
    let mut work = DMatrix::zeros(matrix.nrows(), count + 1);
    let norms: Vec<f64> = order
        .iter()
        .map(|&column| matrix.column(column).norm())
        .collect();
    let largest = norms.iter().copied().fold(0.0, f64::max);
    for (k, (&column, &norm)) in order.iter().zip(&norms).enumerate() {
        if norm > ZERO_TOLERANCE * largest {
            work.set_column(k, &(matrix.column(column) / norm));
        }
    }
    work.set_column(count, &matrix.column(matrix.ncols() - 1));
    let mut rank = 0;
    for k in 0..count {
        let rest = work.nrows() - rank;
        if rest > 0 && work.view((rank, k), (rest, 1)).norm() >= tolerance {
            reflect(&mut work, rank, k);
            rank += 1;
        }
    }
    let rest = work.nrows() - rank;
    (rank, work.view((rank, count), (rest, 1)).norm())
}

/// Zeroes column `k` below row `row` by a Householder reflection of it and all later columns.
fn reflect(work: &mut DMatrix<f64>, row: usize, k: usize) {
    let (rows, columns) = work.shape();
    let mut normal = work.view((row, k), (rows - row, 1)).clone_owned();
    let norm = normal.norm();
    // The sign that avoids cancellation.
    normal[0] += norm.copysign(normal[0]);
    let square = normal.norm_squared();
    let mut rest = work.view_mut((row, k), (rows - row, columns - k));
    let projection = normal.transpose() * &rest * (2.0 / square);
    rest -= normal * projection;
}

/// Solves R_1 c = (column k above row `places.len()`), with the triangle R_1 of the kept columns.
fn back_substitute(work: &DMatrix<f64>, places: &[usize], k: usize) -> Vec<f64> {
    let rank = places.len();
    let mut c: Vec<f64> = (0..rank).map(|row| work[(row, k)]).collect();
    for i in (0..rank).rev() {
        for j in i + 1..rank {
            c[i] -= work[(i, places[j])] * c[j];
        }
        c[i] /= work[(i, places[i])];
    }
    c
}

#[cfg(test)]
mod tests {
    use nalgebra::DMatrix;

    use super::{eliminate, residual};

    #[test]
    fn column_relations_are_recovered() {
        // Column 2 = 3 × column 0 - 0.5 × column 1, column 3 is zero, column 4 is independent.
        let matrix = DMatrix::from_fn(6, 5, |row, column| {
            let x = [(row as f64).sin(), (row * row) as f64 * 0.1];
            match column {
                0 | 1 => x[column],
                2 => 3.0 * x[0] - 0.5 * x[1],
                3 => 0.0,
                _ => (row as f64).exp(),
            }
        });
        let result = eliminate(&matrix, &[0, 1, 2, 3, 4], 1e-9);
        assert_eq!(result.kept, [0, 1, 4]);
        assert_eq!(result.zero, [3]);
        let (column, coefficients) = &result.dependent[0];
        assert_eq!(*column, 2);
        assert!((coefficients[0].1 - 3.0).abs() < 1e-13 && (coefficients[1].1 + 0.5).abs() < 1e-13);
        // Column 4 is outside the span of the first three by its remainder.
        let (rank, norm) = residual(&matrix, &[0, 1, 2, 3], 1e-9);
        let plane = matrix.columns(0, 2).clone_owned();
        let y = matrix.column(4).clone_owned();
        let nearest = plane
            .clone()
            .svd(true, true)
            .solve(&y, 1e-14)
            .expect("a solution");
        assert_eq!(rank, 2);
        assert!((norm - (y - plane * nearest).norm()).abs() < 1e-10);
        // In another order, another column is dependent.
        assert_eq!(eliminate(&matrix, &[2, 1, 0], 1e-9).kept, [2, 1]);
    }
}
