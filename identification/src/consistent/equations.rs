//! Linear equations of a step.

use nalgebra::{Cholesky, DMatrix, DVector, Dyn};

use super::pseudo_inertia::Metric;

/// Number of refinements of a solution against rounding.
const REFINEMENTS: usize = 2;

/// Equations of a step u: y = r - M u and u = Mᵀ y - g.
pub(super) struct Equations {
    /// M: measured rows, then one row for each bound, in step coordinates.
    pub(super) matrix: DMatrix<f64>,
    /// Cholesky factor of 1 + M Mᵀ.
    gram: Cholesky<f64, Dyn>,
    /// For each block: first unknown, length, and matrix S from step coordinates to changes.
    scalings: Vec<(usize, usize, Metric)>,
}

impl Equations {
    /// `None` if numbers are not finite.
    pub(super) fn new(matrix: DMatrix<f64>, scalings: Vec<(usize, usize, Metric)>) -> Option<Self> {
        let gram = one_plus_square(&matrix)?;
        Some(Self {
            gram,
            matrix,
            scalings,
        })
    }

    /// The step for residuals `unexplained` of the measured rows and the gradient `slope`.
    pub(super) fn solved(&self, unexplained: &DVector<f64>, slope: &DVector<f64>) -> DVector<f64> {
        let mut rest = DVector::zeros(self.matrix.nrows());
        rest.rows_mut(0, unexplained.len()).copy_from(unexplained);
        let (mut y, mut step) = (DVector::zeros(rest.len()), DVector::zeros(slope.len()));
        for _ in 0..=REFINEMENTS {
            let first = &rest - &y - &self.matrix * &step;
            let second = slope - self.matrix.tr_mul(&y) + &step;
            let change = self.gram.solve(&(first + &self.matrix * &second));
            step += self.matrix.tr_mul(&change) - second;
            y += change;
        }
        step
    }

    /// Variances of the unknowns for rows of unit variance: diagonal of S (1 + Mᵀ M)^-1 Sᵀ.
    pub(super) fn variances(&self) -> DVector<f64> {
        let count = self.matrix.ncols();
        let determined = self.matrix.tr_mul(&self.gram.solve(&self.matrix));
        let covariance = DMatrix::identity(count, count) - determined;
        let mut variances = DVector::zeros(count);
        for (first, len, scaling) in &self.scalings {
            let scaling = scaling.view((0, 0), (*len, *len));
            let own =
                scaling * covariance.view((*first, *first), (*len, *len)) * scaling.transpose();
            variances.rows_mut(*first, *len).copy_from(&own.diagonal());
        }
        variances
    }
}

/// Triangular factor L of 1 + M Mᵀ.
///
/// If rows of M are nearly dependent, L follows from M itself: [Mᵀ; 1] = Q Lᵀ.
fn one_plus_square(matrix: &DMatrix<f64>) -> Option<Cholesky<f64, Dyn>> {
    let count = matrix.nrows();
    if !matrix.iter().all(|value| value.is_finite()) {
        return None;
    }
    let square = matrix * matrix.transpose() + DMatrix::identity(count, count);
    square.cholesky().or_else(|| {
        let (tall, identity) = (matrix.transpose(), DMatrix::identity(count, count));
        let mut both = DMatrix::zeros(tall.nrows() + count, count);
        both.rows_mut(0, tall.nrows()).copy_from(&tall);
        both.rows_mut(tall.nrows(), count).copy_from(&identity);
        Some(Cholesky::pack_dirty(both.qr().r().transpose()))
    })
}

#[cfg(test)]
mod tests {
    use super::{Equations, Metric};
    use nalgebra::{DMatrix, DVector};

    /// Two rows of twelve coordinates: a block of ten, and two of one.
    fn equations() -> Equations {
        let rows = DMatrix::from_fn(2, 12, |i, k| (1.0 + i as f64 + 2.0 * k as f64).sin() * 1e3);
        let metric = |factor: f64| Metric::from_diagonal_element(factor);
        let scalings = vec![
            (0, 10, metric(2.0)),
            (10, 1, metric(0.5)),
            (11, 1, metric(3.0)),
        ];
        Equations::new(rows, scalings).expect("finite numbers")
    }

    #[test]
    fn newton_steps_solve_the_normal_equations() {
        let equations = equations();
        let (rest, slope) = (
            DVector::from_vec(vec![3.0, -1.0]),
            DVector::from_fn(12, |k, _| k as f64),
        );
        let step = equations.solved(&rest, &slope);
        let matrix = &equations.matrix;
        let left = matrix.tr_mul(&(matrix * &step - &rest)) + &step + &slope;
        assert!(left.norm() < 1e-8 * matrix.norm(), "{left}");
    }

    #[test]
    fn nearly_dependent_rows_are_resolved() {
        let mut rows = DMatrix::from_fn(2, 12, |_, k| (1.0 + k as f64) * 1e6);
        rows[(1, 0)] += 1e-4;
        let scalings = vec![(0, 10, Metric::identity()), (10, 1, Metric::identity())];
        let equations = Equations::new(rows, scalings).expect("finite numbers");
        // The difference of both rows measures 1e-4 d_0 with variance 2. Therefore d_0 = 1, minus
        // its part along the rows, which may not change.
        let (rest, slope) = (DVector::from_vec(vec![0.0, 2e4]), DVector::zeros(12));
        let step = equations.solved(&rest, &slope);
        assert!((step[0] - (1.0 - 1.0 / 650.0)).abs() < 1e-3, "{step}");
    }

    #[test]
    fn variances_are_the_diagonal_of_the_inverse() {
        let equations = equations();
        let normal = DMatrix::identity(12, 12) + equations.matrix.tr_mul(&equations.matrix);
        let inverse = normal.try_inverse().expect("regular");
        let variances = equations.variances();
        for (k, scaling) in [2.0; 10].into_iter().chain([0.5, 3.0]).enumerate() {
            let expected = scaling * scaling * inverse[(k, k)];
            assert!((variances[k] - expected).abs() < 1e-8, "{k}");
        }
    }
}
