//! Noise of the drives' signals, estimated from the residuals.
//!
//! The residuals of lines i and l have the covariance C_il = Σ_j x_j m_jil. x_j = g_j² σ_j² is the
//! variance of the torque of drive j, and m_jil the mean of J_ji J_jl. These r (r + 1)/2 equations
//! determine the n variances of most robots. They are solved by nonnegative least squares, each
//! equation scaled by the lines' standard deviations.

use nalgebra::{DMatrix, DVector};

use super::{observation::Equations, selection::Selection};
use crate::regression::factor::Factor;

/// Sweeps of nonnegative least squares.
const SWEEPS: usize = 500;

/// Smallest standard deviation of a line, by its root mean square.
const LEAST: f64 = 1e-9;

/// Variances of the drives' torques.
#[derive(Debug, Clone)]
pub(super) struct Noise {
    /// x_j (N m or N, squared).
    torques: DVector<f64>,
    /// Row i contains m_jii for all drives j.
    moments: DMatrix<f64>,
}

impl Noise {
    /// Noise from the residuals of a solution [-χ; g].
    pub(super) fn new(equations: &Equations, selection: &Selection, values: &[f64]) -> Self {
        let covariance = covariance(equations, selection, values);
        let (r, n) = (covariance.nrows(), selection.drives);
        let pairs: Vec<(usize, usize)> = (0..r).flat_map(|i| (i..r).map(move |l| (i, l))).collect();
        // Every pair of different lines occurs twice in the covariance.
        let weight = |i: usize, l: usize| {
            let scale = (covariance[(i, i)] * covariance[(l, l)]).sqrt();
            let double = if i == l { 1.0 } else { f64::sqrt(2.0) };
            if scale > 0.0 { double / scale } else { 0.0 }
        };
        let matrix = DMatrix::from_fn(pairs.len(), n, |row, j| {
            let (i, l) = pairs[row];
            weight(i, l) * equations.moments[j][(i, l)]
        });
        let right = DVector::from_fn(pairs.len(), |row, _| {
            let (i, l) = pairs[row];
            weight(i, l) * covariance[(i, l)]
        });
        Self {
            torques: not_negative(&matrix, &right),
            moments: DMatrix::from_fn(r, n, |i, j| equations.moments[j][(i, i)]),
        }
    }

    /// Diagonals of Ω_i for gains g: σ_j² m_jii.
    pub(super) fn omegas(&self, gains: &[f64]) -> Vec<DVector<f64>> {
        let of = |i: usize| {
            let each = gains.iter().enumerate();
            let each = each.map(|(j, gain)| self.torques[j] * self.moments[(i, j)] / (gain * gain));
            DVector::from_iterator(gains.len(), each)
        };
        (0..self.moments.nrows()).map(of).collect()
    }

    /// Smallest variances of the lines, to be positive without noise.
    pub(super) fn least(lines: &[Factor]) -> Vec<f64> {
        let least = |line: &Factor| {
            let equations = line.equations().max(1) as f64;
            LEAST * LEAST * line.matrix().norm_squared() / equations
        };
        lines.iter().map(least).collect()
    }
}

/// Covariance of the lines' residuals: variances from all equations, correlations from stretches.
fn covariance(equations: &Equations, selection: &Selection, values: &[f64]) -> DMatrix<f64> {
    let lines = &equations.system.lines;
    let r = lines.len();
    let mut products: DMatrix<f64> = DMatrix::zeros(r, r);
    for stretch in &equations.system.stretches {
        let residuals: Vec<DVector<f64>> = stretch
            .lines
            .iter()
            .map(|rows| residual(rows, &selection.columns, values))
            .collect();
        for (i, l) in (0..r).flat_map(|i| (0..r).map(move |l| (i, l))) {
            products[(i, l)] += residuals[i].dot(&residuals[l]);
        }
    }
    let unknowns = selection.columns.len() as f64 / r as f64;
    let variance = |line: &Factor| {
        let square = line.residual_norm(&selection.columns, values).powi(2);
        square / (line.equations() as f64 - unknowns).max(1.0)
    };
    let variances: Vec<f64> = lines.iter().map(variance).collect();
    DMatrix::from_fn(r, r, |i, l| {
        let scale = (products[(i, i)] * products[(l, l)]).sqrt();
        let correlation = if scale > 0.0 {
            products[(i, l)] / scale
        } else {
            0.0
        };
        correlation * (variances[i] * variances[l]).sqrt()
    })
}

/// ρ = V g - W χ - w of equations in rows, for the `values` [-χ; g] of the `columns`.
pub(super) fn residual(rows: &DMatrix<f64>, columns: &[usize], values: &[f64]) -> DVector<f64> {
    let mut residual = -rows.column(rows.ncols() - 1).clone_owned();
    for (&column, value) in columns.iter().zip(values) {
        residual.axpy(*value, &rows.column(column), 1.0);
    }
    residual
}

/// Minimises ||A x - b|| for x >= 0 by coordinate descent.
fn not_negative(matrix: &DMatrix<f64>, right: &DVector<f64>) -> DVector<f64> {
    let normal = matrix.tr_mul(matrix);
    let target = matrix.tr_mul(right);
    let n = normal.nrows();
    let mut x = DVector::zeros(n);
    for _ in 0..SWEEPS {
        let before = x.clone();
        for j in 0..n {
            let rest = target[j] - normal.row(j).tr_dot(&x) + normal[(j, j)] * x[j];
            x[j] = if normal[(j, j)] > 0.0 {
                (rest / normal[(j, j)]).max(0.0)
            } else {
                0.0
            };
        }
        if (&x - before).amax() <= 1e-12 * x.amax() {
            break;
        }
    }
    x
}

#[cfg(test)]
mod tests {
    use super::not_negative;
    use nalgebra::{DMatrix, DVector};

    #[test]
    fn least_squares_values_are_not_negative() {
        let matrix = DMatrix::from_row_slice(3, 2, &[1.0, 1.0, 1.0, 2.0, 0.0, 1.0]);
        let free = not_negative(&matrix, &(&matrix * DVector::from_vec(vec![2.0, 3.0])));
        assert!((free - DVector::from_vec(vec![2.0, 3.0])).amax() < 1e-9);
        // Without the bound the second one would be negative; the first one alone is (4 + 2)/2.
        let bound = not_negative(&matrix, &DVector::from_vec(vec![4.0, 2.0, -3.0]));
        assert!((bound - DVector::from_vec(vec![3.0, 0.0])).amax() < 1e-9);
    }
}
