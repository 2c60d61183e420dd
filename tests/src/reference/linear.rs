//! Dense linear algebra of the reference, by singular value decomposition or by definition.
//!
//! The decomposition is the one-sided Jacobi method: plane rotations V make the columns of A V
//! orthogonal; their lengths are the singular values. It is slow and accurate to the last digits.
//! Bidiagonalisation with a deflation threshold reconstructed a well-conditioned 12 x 21 matrix to
//! 4e-10 only, which is not sufficient for a reference.

use nalgebra::{DMatrix, DVector};

/// Singular values below this fraction of the largest one count as zero.
pub const RANK_TOLERANCE: f64 = 1e-11;
/// Cosine of the angle between two columns below which they count as orthogonal.
const ORTHOGONAL_COSINE: f64 = 1e-15;
/// Sweeps over all pairs of columns; about eight are needed.
const MAX_SWEEPS: usize = 60;

/// Singular value decomposition A V = U diag(s), largest value first.
#[derive(Clone, Debug, PartialEq)]
pub struct Decomposition {
    /// U diag(s): orthogonal columns of length s.
    pub scaled_left: DMatrix<f64>,
    /// Singular values, as many as A has columns.
    pub values: DVector<f64>,
    /// V, square and orthogonal.
    pub right: DMatrix<f64>,
}

/// Singular value decomposition by one-sided Jacobi rotations.
#[must_use]
pub fn decompose(matrix: &DMatrix<f64>) -> Decomposition {
    let (rows, columns) = matrix.shape();
    let mut left: Vec<Vec<f64>> = matrix
        .column_iter()
        .map(|column| column.iter().copied().collect())
        .collect();
    let identity = |at: usize| {
        (0..columns)
            .map(|row| f64::from(u8::from(row == at)))
            .collect()
    };
    let mut right: Vec<Vec<f64>> = (0..columns).map(identity).collect();
    // Columns this short are rounding errors without a meaningful direction.
    let negligible = (1e-16 * matrix.norm()).powi(2);
    for _ in 0..MAX_SWEEPS {
        let mut turned = false;
        for p in 0..columns {
            for q in p + 1..columns {
                if let Some((c, s)) = rotation(&left[p], &left[q], negligible) {
                    turn(&mut left, p, q, c, s);
                    turn(&mut right, p, q, c, s);
                    turned = true;
                }
            }
        }
        if !turned {
            break;
        }
    }
    let lengths: Vec<f64> = left
        .iter()
        .map(|column| dot(column, column).sqrt())
        .collect();
    let mut order: Vec<usize> = (0..columns).collect();
    order.sort_by(|&a, &b| lengths[b].total_cmp(&lengths[a]));
    Decomposition {
        scaled_left: DMatrix::from_fn(rows, columns, |row, at| left[order[at]][row]),
        values: DVector::from_fn(columns, |at, _| lengths[order[at]]),
        right: DMatrix::from_fn(columns, columns, |row, at| right[order[at]][row]),
    }
}

/// Cosine and sine of the rotation that makes two columns orthogonal; none if they are.
fn rotation(a: &[f64], b: &[f64], negligible: f64) -> Option<(f64, f64)> {
    let (aa, bb, ab) = (dot(a, a), dot(b, b), dot(a, b));
    if aa <= negligible || bb <= negligible || ab.abs() <= ORTHOGONAL_COSINE * (aa * bb).sqrt() {
        return None;
    }
    let zeta = (bb - aa) / (2.0 * ab);
    let tangent = 1.0_f64.copysign(zeta) / (zeta.abs() + zeta.hypot(1.0));
    let cosine = 1.0 / tangent.hypot(1.0);
    Some((cosine, cosine * tangent))
}

fn turn(columns: &mut [Vec<f64>], p: usize, q: usize, c: f64, s: f64) {
    let (before, after) = columns.split_at_mut(q);
    for (a, b) in before[p].iter_mut().zip(&mut after[0]) {
        (*a, *b) = (c * *a - s * *b, s * *a + c * *b);
    }
}

/// Scalar product in eight sums for vectorisation.
fn dot(a: &[f64], b: &[f64]) -> f64 {
    let (a, a_rest) = a.as_chunks::<8>();
    let (b, b_rest) = b.as_chunks::<8>();
    let mut sums = [0.0; 8];
    for (a, b) in a.iter().zip(b) {
        for (sum, (x, y)) in sums.iter_mut().zip(a.iter().zip(b)) {
            *sum += x * y;
        }
    }
    let rest: f64 = a_rest.iter().zip(b_rest).map(|(x, y)| x * y).sum();
    sums.iter().sum::<f64>() + rest
}

/// Moore-Penrose pseudo-inverse by singular value decomposition.
#[must_use]
pub fn pseudo_inverse(matrix: &DMatrix<f64>) -> DMatrix<f64> {
    if matrix.nrows() < matrix.ncols() {
        // A tall matrix has no columns that the rotations must reduce to zero.
        return pseudo_inverse(&matrix.transpose()).transpose();
    }
    let Decomposition {
        scaled_left,
        values,
        right,
    } = decompose(matrix);
    let cut = RANK_TOLERANCE * largest(&values);
    // From U diag(s), U diag(1/s) needs the square of s.
    let inverse = values.map(|s| if s > cut { 1.0 / (s * s) } else { 0.0 });
    right * DMatrix::from_diagonal(&inverse) * scaled_left.transpose()
}

/// Singular values, largest first, as many as the smaller dimension.
#[must_use]
pub fn singular_values(matrix: &DMatrix<f64>) -> DVector<f64> {
    let tall = if matrix.nrows() < matrix.ncols() {
        matrix.transpose()
    } else {
        matrix.clone()
    };
    // The triangular factor has the same singular values and fewer rows. With column pivoting, its
    // rows are more nearly orthogonal than its columns.
    let small = if tall.is_empty() {
        tall
    } else {
        tall.col_piv_qr().r().transpose()
    };
    decompose(&small).values
}

/// Ratio of the largest to the smallest singular value.
#[must_use]
pub fn condition(matrix: &DMatrix<f64>) -> f64 {
    let values = singular_values(matrix);
    if values.is_empty() {
        1.0
    } else {
        values[0] / values[values.len() - 1]
    }
}

/// Orthonormal basis, as columns, of the vectors x with `matrix` x = 0.
#[must_use]
pub fn null_space(matrix: &DMatrix<f64>) -> DMatrix<f64> {
    let Decomposition { values, right, .. } = decompose(matrix);
    let cut = RANK_TOLERANCE * largest(&values);
    let zero: Vec<usize> = (0..values.len()).filter(|&at| values[at] <= cut).collect();
    right.select_columns(&zero)
}

fn largest(values: &DVector<f64>) -> f64 {
    values.iter().copied().fold(0.0, f64::max)
}

/// Adjugate: the transposed matrix of cofactors, so that adj(M) M = det(M) I.
#[must_use]
pub fn adjugate(matrix: &DMatrix<f64>) -> DMatrix<f64> {
    DMatrix::from_fn(matrix.nrows(), matrix.ncols(), |row, column| {
        // Entry (row, column) of the adjugate leaves out row `column` and column `row`.
        let minor = matrix.clone().remove_row(column).remove_column(row);
        let sign = if (row + column).is_multiple_of(2) {
            1.0
        } else {
            -1.0
        };
        sign * determinant(&minor)
    })
}

/// Determinant, 1 for the empty matrix.
#[must_use]
pub fn determinant(matrix: &DMatrix<f64>) -> f64 {
    if matrix.is_empty() {
        1.0
    } else {
        matrix.determinant()
    }
}

/// Indices of the first rows, in order, that are independent of the rows before them.
#[must_use]
pub fn independent_rows(matrix: &DMatrix<f64>, tolerance: f64) -> Vec<usize> {
    let mut kept = Vec::new();
    let mut basis: Vec<DVector<f64>> = Vec::new();
    for at in 0..matrix.nrows() {
        let mut rest = matrix.row(at).transpose();
        // A second pass removes what rounding leaves of the first one.
        for direction in basis.iter().chain(&basis) {
            let share = direction.dot(&rest);
            rest -= direction * share;
        }
        if rest.norm() > tolerance {
            kept.push(at);
            basis.push(rest.normalize());
        }
    }
    kept
}

/// Singular values after every column that isn't zero is scaled to unit length, largest first.
#[must_use]
pub fn normalized_singular_values(matrix: &DMatrix<f64>) -> DVector<f64> {
    let mut scaled = matrix.clone();
    let largest = scaled.amax();
    for mut column in scaled.column_iter_mut() {
        let norm = column.norm();
        if norm > 1e-12 * largest {
            column /= norm;
        } else {
            column.fill(0.0);
        }
    }
    singular_values(&scaled)
}

/// Rank by normalised singular values above `tolerance` times the largest one.
#[must_use]
pub fn rank(matrix: &DMatrix<f64>, tolerance: f64) -> usize {
    let values = normalized_singular_values(matrix);
    let cut = tolerance * largest(&values);
    values.iter().filter(|&&value| value > cut).count()
}

/// Largest absolute entry of `a - b` relative to the largest absolute entry of `b`.
#[must_use]
pub fn relative_difference(a: &DMatrix<f64>, b: &DMatrix<f64>) -> f64 {
    (a - b).amax() / b.amax().max(f64::MIN_POSITIVE)
}

#[cfg(test)]
mod tests {
    use super::{adjugate, decompose, determinant, null_space, pseudo_inverse};
    use nalgebra::DMatrix;

    fn sample(rows: usize, columns: usize) -> DMatrix<f64> {
        // Entries without pattern, then two proportional columns for a deficient rank.
        let mut matrix = DMatrix::from_fn(rows, columns, |i, j| {
            ((7 * i * i * (j + 1) + 13 * j * j + 3) as f64).sin()
        });
        let first = matrix.column(0) * 2.0;
        matrix.set_column(columns - 1, &first);
        matrix
    }

    #[test]
    fn singular_value_decomposition_reconstructs_the_matrix() {
        for (rows, columns) in [(8, 5), (5, 5), (5, 9)] {
            let matrix = sample(rows, columns);
            let found = decompose(&matrix);
            let gap = &found.scaled_left * found.right.transpose() - &matrix;
            assert!(gap.amax() < 1e-14, "{gap}");
            let gram = found.right.transpose() * &found.right;
            assert!((gram - DMatrix::identity(columns, columns)).amax() < 1e-14);
        }
    }

    #[test]
    fn pseudo_inverse_satisfies_the_penrose_conditions() {
        for (rows, columns) in [(8, 5), (5, 5), (5, 9)] {
            let a = sample(rows, columns);
            let x = pseudo_inverse(&a);
            let (ax, xa) = (&a * &x, &x * &a);
            let scale = x.amax().max(1.0);
            assert!((&ax * &a - &a).amax() < 1e-13 * scale);
            assert!((&xa * &x - &x).amax() < 1e-13 * scale * scale);
            assert!((ax.transpose() - ax).amax() < 1e-13 * scale);
            assert!((xa.transpose() - xa).amax() < 1e-13 * scale);
        }
    }

    #[test]
    fn null_space_and_adjugate_satisfy_their_definitions() {
        let matrix = sample(6, 4);
        let basis = null_space(&matrix);
        assert_eq!(basis.ncols(), 1);
        assert!((&matrix * &basis).amax() < 1e-14);
        let square = DMatrix::from_fn(4, 4, |i, j| {
            ((5 * i * (j + 2) + 3 * j * j + 1) as f64).cos()
        });
        assert!(determinant(&square).abs() > 1e-3);
        let product = adjugate(&square) * &square;
        let expected = DMatrix::identity(4, 4) * determinant(&square);
        assert!((product - expected).amax() < 1e-13);
    }
}
