//! Singular values, and the rank, condition number, pseudo-inverse and null space from them.
//!
//! All such decisions about a mechanism are made here.
//!
//! One-sided Jacobi (Hestenes): plane rotations from the right make the columns of A V orthogonal;
//! their lengths are the singular values. For matrices of a leg's size this is cheap and computes
//! small singular values to full relative accuracy. Nearly equal values, and more columns than
//! rows, need no special treatment. The result is checked by the residual |A V - U Σ|, which is
//! rounding by construction, and by the orthogonality of the columns, which depends on convergence.

use nalgebra::DMatrix;

/// A = U Σ Vᵀ, in descending order of the singular values.
#[derive(Debug, Clone)]
pub(super) struct SingularValues {
    /// One for each column of the matrix; those beyond the number of rows are zero.
    values: Vec<f64>,
    /// V: one column for each singular value, including zero ones.
    right: DMatrix<f64>,
    /// A V = U Σ.
    scaled_left: DMatrix<f64>,
}

/// Cosine of the angle between two columns below which they count as orthogonal.
const ORTHOGONAL: f64 = 16.0 * f64::EPSILON;
/// Cosine of that angle above which the iteration has not converged.
const RESIDUAL: f64 = 1e-12;
/// Largest number of sweeps over all pairs of columns. Convergence is quadratic: six to ten are
/// usual.
const SWEEPS: usize = 60;
/// Length of a column, relative to the largest, below which its direction is rounding.
const NEGLIGIBLE: f64 = 1e-15;

impl SingularValues {
    /// The singular values of a matrix; `None` if an entry is not finite or the iteration does not
    /// converge.
    #[must_use]
    pub(super) fn new(matrix: &DMatrix<f64>) -> Option<Self> {
        if matrix.iter().any(|entry| !entry.is_finite()) {
            return None;
        }
        // Scaled to entries of order one, so that no square overflows.
        let size = matrix.amax();
        let scale = if size > 0.0 { size } else { 1.0 };
        let mut columns = matrix / scale;
        let mut right = DMatrix::identity(matrix.ncols(), matrix.ncols());
        let converged = (0..SWEEPS).any(|_| sweep(&mut columns, &mut right) <= ORTHOGONAL);
        if !converged && worst_angle(&columns) > RESIDUAL {
            return None;
        }
        let lengths: Vec<f64> = columns.column_iter().map(|c| c.norm() * scale).collect();
        let mut order: Vec<usize> = (0..lengths.len()).collect();
        order.sort_by(|a, b| lengths[*b].total_cmp(&lengths[*a]));
        let found = Self {
            values: order.iter().map(|&at| lengths[at]).collect(),
            right: right.select_columns(&order),
            scaled_left: columns.select_columns(&order) * scale,
        };
        (found.residual(matrix) <= RESIDUAL * size).then_some(found)
    }

    /// Largest entry of A - (U Σ) Vᵀ.
    fn residual(&self, matrix: &DMatrix<f64>) -> f64 {
        (matrix - &self.scaled_left * self.right.transpose()).amax()
    }

    /// The largest singular value; zero for an empty matrix.
    #[must_use]
    pub(super) fn largest(&self) -> f64 {
        self.values.first().copied().unwrap_or(0.0)
    }

    /// Number of singular values above `least`.
    #[must_use]
    pub(super) fn rank(&self, least: f64) -> usize {
        self.values.iter().filter(|value| **value > least).count()
    }

    /// Ratio of the largest to the smallest of the min(rows, columns) singular values; infinite for
    /// a zero matrix.
    #[must_use]
    pub(super) fn condition(&self) -> f64 {
        let count = self.scaled_left.nrows().min(self.values.len());
        match self.values[..count].last() {
            Some(smallest) if *smallest > 0.0 => self.largest() / smallest,
            _ => f64::INFINITY,
        }
    }

    /// Orthonormal directions that the matrix maps to less than `least` times their length, as
    /// columns.
    #[must_use]
    pub(super) fn null_space(&self, least: f64) -> DMatrix<f64> {
        let rank = self.rank(least);
        self.right.columns_range(rank..).into_owned()
    }

    /// The pseudo-inverse; singular values up to `least` count as zero.
    #[must_use]
    pub(super) fn pseudo_inverse(&self, least: f64) -> DMatrix<f64> {
        let rank = self.rank(least);
        let mut left = self.scaled_left.columns_range(..rank).into_owned();
        for (mut column, value) in left.column_iter_mut().zip(&self.values) {
            // U Σ divided by Σ².
            column /= value * value;
        }
        self.right.columns_range(..rank) * left.transpose()
    }
}

/// Number of singular values above `least`; zero for a matrix that is not finite.
#[must_use]
pub(super) fn rank(matrix: &DMatrix<f64>, least: f64) -> usize {
    SingularValues::new(matrix).map_or(0, |found| found.rank(least))
}

/// Makes every pair of columns orthogonal by a rotation; returns the largest cosine before.
fn sweep(columns: &mut DMatrix<f64>, right: &mut DMatrix<f64>) -> f64 {
    let mut worst: f64 = 0.0;
    let negligible = NEGLIGIBLE * longest(columns);
    for a in 0..columns.ncols() {
        for b in a + 1..columns.ncols() {
            let Some(cosine) = cosine(columns, a, b, negligible) else {
                continue;
            };
            worst = worst.max(cosine.abs());
            if cosine.abs() <= ORTHOGONAL {
                continue;
            }
            let (first, second) = (columns.column(a), columns.column(b));
            let product = first.dot(&second);
            let ratio = (second.norm_squared() - first.norm_squared()) / (2.0 * product);
            let tangent = ratio.signum() / (ratio.abs() + ratio.hypot(1.0));
            let cosine = 1.0 / tangent.hypot(1.0);
            rotate(columns, a, b, cosine, cosine * tangent);
            rotate(right, a, b, cosine, cosine * tangent);
        }
    }
    worst
}

fn longest(columns: &DMatrix<f64>) -> f64 {
    let lengths = columns.column_iter().map(|column| column.norm());
    lengths.fold(0.0, f64::max)
}

/// Cosine of the angle between two columns; `None` if one of them is rounding.
fn cosine(columns: &DMatrix<f64>, a: usize, b: usize, negligible: f64) -> Option<f64> {
    let (first, second) = (columns.column(a), columns.column(b));
    let lengths = [first.norm(), second.norm()];
    let has_direction = lengths.iter().all(|length| *length > negligible);
    has_direction.then(|| first.dot(&second) / (lengths[0] * lengths[1]))
}

/// The largest cosine of an angle between two columns.
fn worst_angle(columns: &DMatrix<f64>) -> f64 {
    let negligible = NEGLIGIBLE * longest(columns);
    let pairs = (0..columns.ncols()).flat_map(|b| (0..b).map(move |a| (a, b)));
    let cosines = pairs.filter_map(|(a, b)| cosine(columns, a, b, negligible));
    cosines.fold(0.0, |worst, cosine| worst.max(cosine.abs()))
}

fn rotate(matrix: &mut DMatrix<f64>, a: usize, b: usize, cosine: f64, sine: f64) {
    for row in 0..matrix.nrows() {
        let (first, second) = (matrix[(row, a)], matrix[(row, b)]);
        matrix[(row, a)] = cosine * first - sine * second;
        matrix[(row, b)] = sine * first + cosine * second;
    }
}

#[cfg(test)]
mod tests {
    use super::SingularValues;
    use crate::cas::Stream;
    use nalgebra::DMatrix;

    fn random(rows: usize, columns: usize, stream: &mut Stream) -> DMatrix<f64> {
        DMatrix::from_fn(rows, columns, |_, _| stream.number())
    }

    #[test]
    fn factors_reconstruct_pseudo_inverse_and_null_space() {
        let mut stream = Stream::new(5);
        for (rows, columns) in [(1, 1), (3, 3), (6, 6), (6, 3), (3, 6), (2, 5), (8, 6)] {
            for _ in 0..200 {
                let matrix = random(rows, columns, &mut stream);
                let found = SingularValues::new(&matrix).unwrap();
                let count = rows.min(columns);
                let inverse = found.pseudo_inverse(1e-9);
                let again = &matrix * inverse * &matrix;
                assert!((again - &matrix).amax() < 1e-9, "{matrix}");
                assert!(found.values.windows(2).all(|pair| pair[0] >= pair[1]));
                assert_eq!(found.rank(1e-9), count);
                let free = found.null_space(1e-9);
                assert_eq!(free.ncols(), columns - count);
                assert!((matrix * &free).iter().all(|e| e.abs() < 1e-14));
                let identity = DMatrix::identity(free.ncols(), free.ncols());
                assert!(
                    (free.tr_mul(&free) - identity)
                        .iter()
                        .all(|e| e.abs() < 1e-14)
                );
            }
        }
    }

    #[test]
    fn nearly_equal_singular_values_are_decomposed_accurately() {
        let mut stream = Stream::new(6);
        for _ in 0..2000 {
            // A rotation with a small disturbance, like the Jacobian of a leg with crossing axes.
            let rotation = random(3, 3, &mut stream).qr().q();
            let disturbance = 10.0_f64.powf(-6.0 + 10.0 * stream.number());
            let matrix = rotation + random(3, 3, &mut stream) * disturbance.min(1e-2);
            let inverse = SingularValues::new(&matrix).unwrap().pseudo_inverse(1e-9);
            let identity = DMatrix::identity(3, 3);
            assert!((matrix * inverse - identity).amax() < 1e-13);
        }
    }

    #[test]
    fn rank_and_condition_of_rank_deficient_matrices_are_right() {
        let matrix = DMatrix::from_row_slice(3, 3, &[1., 2., 3., 2., 4., 6., 1., 0., 1.]);
        let found = SingularValues::new(&matrix).unwrap();
        assert_eq!(found.rank(1e-12), 2);
        assert!(found.condition() > 1e15);
        let zero = SingularValues::new(&DMatrix::zeros(2, 3)).unwrap();
        assert_eq!((zero.rank(0.0), zero.null_space(0.0).ncols()), (0, 3));
        assert!(zero.condition().is_infinite());
        let scaled = DMatrix::from_diagonal(&nalgebra::dvector![1e200, 1e-180]);
        let found = SingularValues::new(&scaled).unwrap();
        assert!(found.condition().is_infinite() || found.condition() > 1e300);
        let wide = DMatrix::from_row_slice(1, 2, &[3.0, 4.0]);
        assert_eq!(SingularValues::new(&wide).unwrap().condition(), 1.0);
        let infinite = DMatrix::from_element(1, 1, f64::NAN);
        assert!(SingularValues::new(&infinite).is_none());
    }
}
