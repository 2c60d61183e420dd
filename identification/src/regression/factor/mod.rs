//! Least-squares system [W Y] of one line j of Γ, stored as its upper triangular factor R.
//!
//! Rows are added block by block: the QR factorisation of [R; block] is the factor of all rows so
//! far, so memory is independent of the number of equations. Residuals, norms, subsets of columns
//! and weights follow from R: ||Y - W χ|| = ||R_Y - R_W χ||.

mod update;

use nalgebra::{DMatrix, DVector};

use self::update::{update, update_by_triangle};
use super::{elimination::residual, transpose::transpose};

/// A column is dependent on the data if its part outside the others is below this fraction.
pub(crate) const DATA_RANK_TOLERANCE: f64 = 1e-10;

/// Largest number of values in one update, unless rows are as many as columns.
///
/// All reflections use them, so they should fit the first-level cache.
const TOGETHER: usize = 6144;

/// R factor of [W Y], with the sums of all columns for the mean residual.
#[derive(Debug, Clone, PartialEq)]
pub struct Factor {
    r: DMatrix<f64>,
    equations: usize,
    sums: DVector<f64>,
}

impl Factor {
    /// A factor without equations in `parameters` unknowns.
    #[must_use]
    pub fn new(parameters: usize) -> Self {
        let size = parameters + 1;
        Self {
            r: DMatrix::zeros(size, size),
            equations: 0,
            sums: DVector::zeros(size),
        }
    }

    /// The upper triangular factor `r` of `equations` equations with these column sums.
    pub(crate) fn of(r: DMatrix<f64>, equations: usize, sums: Vec<f64>) -> Self {
        Self {
            r,
            equations,
            sums: DVector::from_vec(sums),
        }
    }

    /// Adds equations: rows × (parameters + 1), with Y last.
    ///
    /// A matrix of another width is ignored.
    pub fn push(&mut self, rows: &DMatrix<f64>) {
        let size = self.r.ncols();
        if rows.ncols() != size {
            return;
        }
        self.equations += rows.nrows();
        self.sums += rows.row_sum().transpose();
        let step = self.worthwhile();
        for first in (0..rows.nrows()).step_by(step) {
            let count = step.min(rows.nrows() - first);
            self.absorb(rows.rows(first, count).clone_owned());
        }
    }

    /// Adds equations in row-major order.
    pub(crate) fn push_rows(&mut self, rows: &[f64]) {
        let size = self.r.ncols();
        for rows in rows.chunks(self.worthwhile() * size) {
            let block = transpose(rows, size);
            self.equations += block.nrows();
            self.sums += block.row_sum().transpose();
            self.absorb(block);
        }
    }

    /// Number of rows for an efficient update.
    pub(crate) fn worthwhile(&self) -> usize {
        let size = self.r.ncols();
        (TOGETHER / size).max(size)
    }

    /// Adds the equations of another factor.
    pub(crate) fn add(&mut self, other: &Self) {
        self.equations += other.equations;
        self.sums += &other.sums;
        update_by_triangle(&mut self.r, &mut other.r.clone());
    }

    /// Combines factors, each scaled by a weight.
    #[must_use]
    pub fn merged(factors: &[Self], weights: &[f64]) -> Self {
        let parameters = factors.first().map_or(0, Self::parameters);
        let mut merged = Self::new(parameters);
        for (factor, weight) in factors.iter().zip(weights) {
            merged.equations += factor.equations;
            merged.sums += &factor.sums * *weight;
            update_by_triangle(&mut merged.r, &mut (&factor.r * *weight));
        }
        merged
    }

    /// Factorises [R; block].
    fn absorb(&mut self, mut block: DMatrix<f64>) {
        update(&mut self.r, &mut block);
    }

    /// Factor of the same equations with columns W `coefficients`.
    pub(crate) fn combined(&self, coefficients: &DMatrix<f64>) -> Self {
        let own = self.parameters();
        let y = DVector::from_fn(own + 1, |row, _| f64::from(u8::from(row == own)));
        let rows = coefficients.clone().insert_row(own, 0.0);
        self.of_columns(&rows, &y)
    }

    /// The same with a combination of the columns instead of Y.
    pub(crate) fn combined_with(&self, coefficients: &DMatrix<f64>, y: &DVector<f64>) -> Self {
        let own = self.parameters();
        let rows = coefficients.clone().insert_row(own, 0.0);
        self.of_columns(&rows, &y.clone().insert_row(own, 0.0))
    }

    /// Factor of combinations of all columns, including Y.
    fn of_columns(&self, coefficients: &DMatrix<f64>, y: &DVector<f64>) -> Self {
        let count = coefficients.ncols();
        let all = coefficients.clone().insert_column(count, 0.0);
        let mut all = all;
        all.set_column(count, y);
        let mut combined = Self::new(count);
        combined.absorb(&self.r * &all);
        combined.equations = self.equations;
        combined.sums = all.tr_mul(&self.sums);
        combined
    }

    /// Number of unknowns.
    #[must_use]
    pub fn parameters(&self) -> usize {
        self.r.ncols() - 1
    }

    /// Number of equations.
    #[must_use]
    pub const fn equations(&self) -> usize {
        self.equations
    }

    /// Factor R of [W Y], square.
    #[must_use]
    pub const fn matrix(&self) -> &DMatrix<f64> {
        &self.r
    }

    /// Sums of all columns, Y last.
    pub(crate) fn sums(&self) -> &[f64] {
        self.sums.as_slice()
    }

    /// ||Y||.
    #[must_use]
    pub fn measured_norm(&self) -> f64 {
        self.r.column(self.parameters()).norm()
    }

    /// Norm of Y without its mean.
    #[must_use]
    pub fn measured_variation(&self) -> f64 {
        let sum = self.sums[self.parameters()];
        let of_mean = sum * sum / self.equations.max(1) as f64;
        (self.measured_norm().powi(2) - of_mean).max(0.0).sqrt()
    }

    /// ||Y - W χ|| for the parameters `values` of the columns `selected`.
    #[must_use]
    pub fn residual_norm(&self, selected: &[usize], values: &[f64]) -> f64 {
        let mut residual = self.r.column(self.parameters()).clone_owned();
        for (&column, value) in selected.iter().zip(values) {
            residual.axpy(-value, &self.r.column(column), 1.0);
        }
        residual.norm()
    }

    /// Smallest ||Y - W χ|| for the columns `selected`, which may be dependent.
    pub(crate) fn smallest_residual(&self, selected: &[usize]) -> f64 {
        residual(&self.r, selected, DATA_RANK_TOLERANCE).1
    }

    /// Σ(Y - W χ) over all equations.
    #[must_use]
    pub fn residual_sum(&self, selected: &[usize], values: &[f64]) -> f64 {
        let explained: f64 = selected
            .iter()
            .zip(values)
            .map(|(&column, value)| self.sums[column] * value)
            .sum();
        self.sums[self.parameters()] - explained
    }

    /// Factor of the columns `selected` and Y.
    ///
    /// R_1 (upper triangular), the right-hand side Q_1ᵀ Y and the smallest residual norm.
    pub(crate) fn reduced(&self, selected: &[usize]) -> ReducedFactor {
        Self::reduced_together(std::slice::from_ref(self), &[1.0], selected)
    }

    /// Reduced system of several factors, each scaled by a weight.
    pub(crate) fn reduced_together(
        factors: &[Self],
        weights: &[f64],
        selected: &[usize],
    ) -> ReducedFactor {
        let p = selected.len();
        let size = factors.first().map_or(0, |factor| factor.r.nrows());
        let mut stacked = DMatrix::zeros(size * factors.len(), p + 1);
        for (place, (factor, weight)) in factors.iter().zip(weights).enumerate() {
            let y = factor.parameters();
            for (to, from) in selected.iter().chain([&y]).enumerate() {
                let mut column = stacked.column_mut(to);
                let mut rows = column.rows_mut(place * size, size);
                rows.axpy(*weight, &factor.r.column(*from), 0.0);
            }
        }
        let r = stacked.qr().r();
        let rows = r.nrows();
        let residual_norm = if rows > p {
            r.view((p, p), (rows - p, 1)).norm()
        } else {
            0.0
        };
        let rhs = r.view((0, p), (p, 1)).column(0).clone_owned();
        ReducedFactor {
            triangle: r.view((0, 0), (p, p)).clone_owned(),
            rhs,
            residual_norm,
        }
    }
}

/// See [`Factor::reduced`].
#[derive(Debug, Clone)]
pub(crate) struct ReducedFactor {
    pub(crate) triangle: DMatrix<f64>,
    pub(crate) rhs: DVector<f64>,
    pub(crate) residual_norm: f64,
}
