//! Scaled Cholesky factor of a positive definite matrix, independent of units.

use nalgebra::{Cholesky, DMatrix, DVector, Dyn};

/// A column is dependent if the square of its part outside the others is below this fraction.
const LEAST_OUTSIDE: f64 = 1e-8;

/// D A D = L Lᵀ with the diagonal matrix D that makes the diagonal 1.
#[derive(Debug, Clone)]
pub(super) struct Scaled {
    scales: DVector<f64>,
    factor: Cholesky<f64, Dyn>,
}

impl Scaled {
    /// Factorises A; `None` if A is not positive definite.
    pub(super) fn new(matrix: &DMatrix<f64>) -> Option<Self> {
        let scales = matrix.diagonal().map(|square: f64| 1.0 / square.sqrt());
        let scaled = DMatrix::from_fn(matrix.nrows(), matrix.ncols(), |i, j| {
            matrix[(i, j)] * scales[i] * scales[j]
        });
        let sound = scales.iter().all(|scale| scale.is_finite());
        let factor = Cholesky::new(scaled).filter(|_| sound)?;
        Some(Self { scales, factor })
    }

    /// A^-1 b.
    pub(super) fn solve(&self, rhs: &DMatrix<f64>) -> DMatrix<f64> {
        self.scaled(self.factor.solve(&self.scaled(rhs.clone())))
    }

    /// M b with Mᵀ M = A^-1.
    pub(super) fn white(&self, rhs: &DMatrix<f64>) -> DMatrix<f64> {
        let mut white = self.scaled(rhs.clone());
        self.factor.l_dirty().solve_lower_triangular_mut(&mut white);
        white
    }

    fn scaled(&self, mut matrix: DMatrix<f64>) -> DMatrix<f64> {
        for (mut row, scale) in matrix.row_iter_mut().zip(self.scales.iter()) {
            row *= *scale;
        }
        matrix
    }
}

/// Indices of the columns that are independent of the model's and of earlier ones.
pub(super) fn independent_columns(outside: &DMatrix<f64>, square: &DMatrix<f64>) -> Vec<usize> {
    let mut rest = outside.clone();
    let mut independent = Vec::new();
    for i in 0..rest.nrows() {
        let left = rest[(i, i)];
        if left > LEAST_OUTSIDE * square[(i, i)] {
            independent.push(i);
            let column = rest.column(i).clone_owned();
            rest.ger(-1.0 / left, &column, &column, 1.0);
        }
    }
    independent
}
