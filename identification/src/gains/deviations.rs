//! Standard deviations of gains and parameters, to first order.
//!
//! The estimate is the zero of Σ_t z_t. The scores of sample t are z_t = Σ_i ([W V]_itᵀ ρ_it -
//! [0; Ω_i g] ρ_it²/s_i²)/s_i². They have zero mean at the true values. With the derivative H =
//! RᵀR - Λ of the sum and its covariance Z, the covariance of the estimate is H^-1 Z H^-1. Z is
//! estimated from sums over batches of successive samples. It thus allows for correlation between
//! lines and over time, and for varying noise.

use nalgebra::{DMatrix, DVector};

use super::{noise::residual, observation::Equations, selection::Selection, solve::Solution};
use crate::regression::{
    factor::Factor,
    score_batches::{batch_sums, samples},
    system::Stretch,
};

/// Uncertainty of a solution.
pub(super) struct Deviations {
    /// Standard deviations of all values, in their order.
    pub(super) all: Vec<f64>,
    /// Covariance of the gains.
    pub(super) gains: DMatrix<f64>,
}

/// Uncertainty of a solution; `None` if the data do not determine it.
pub(super) fn deviations(
    equations: &Equations,
    selection: &Selection,
    solution: &Solution,
) -> Option<Deviations> {
    let system = &equations.system;
    let kept = samples(&system.stretches);
    let all = system.lines.iter().map(Factor::equations).max()?;
    let scores = |stretch: &Stretch| scores(stretch, selection, solution);
    let sums = batch_sums(&system.stretches, scores);
    let size = selection.columns.len();
    let own = size - selection.drives;
    let sums = DMatrix::from_columns(&sums);
    // In the coordinates R [-χ; g], H is the identity minus the transformed Λ.
    let whitened = solution.triangle.tr_solve_upper_triangular(&sums)?;
    let mut lambda = DMatrix::zeros(size, size);
    for (j, value) in solution.lambda.iter().enumerate() {
        lambda[(own + j, own + j)] = *value;
    }
    let half = solution.triangle.tr_solve_upper_triangular(&lambda)?;
    let whole = solution
        .triangle
        .tr_solve_upper_triangular(&half.transpose())?;
    let derivative = DMatrix::identity(size, size) - 0.5 * (&whole + whole.transpose());
    let moved = derivative.cholesky()?.solve(&whitened);
    let errors = solution.triangle.solve_upper_triangular(&moved)?;
    let equations = (all * system.lines.len()) as f64;
    let freedom = equations / (equations - size as f64).max(1.0);
    let scale = (freedom * all as f64 / kept.max(1) as f64).sqrt();
    let all: Vec<f64> = errors.row_iter().map(|row| scale * row.norm()).collect();
    let gains = errors.rows(own, selection.drives) * scale;
    let gains = &gains * gains.transpose();
    let sound = all.iter().all(|deviation| deviation.is_finite());
    sound.then_some(Deviations { all, gains })
}

/// Scores of successive samples, one row each.
fn scores(stretch: &Stretch, selection: &Selection, solution: &Solution) -> DMatrix<f64> {
    let size = selection.columns.len();
    let own = size - selection.drives;
    let samples = stretch.lines.first().map_or(0, DMatrix::nrows);
    let mut scores = DMatrix::zeros(samples, size);
    let gains = DVector::from_column_slice(solution.gains());
    let lines = stretch.lines.iter().zip(&solution.variances);
    for ((rows, variance), omega) in lines.zip(&solution.omegas) {
        let residual = residual(rows, &selection.columns, &solution.values);
        let weighted = &residual / *variance;
        for (place, &column) in selection.columns.iter().enumerate() {
            let products = rows.column(column).component_mul(&weighted);
            let mut target = scores.column_mut(place);
            target += products;
        }
        let squares = weighted.component_mul(&weighted);
        for (j, noise) in omega.component_mul(&gains).iter().enumerate() {
            scores.column_mut(own + j).axpy(-noise, &squares, 1.0);
        }
    }
    scores
}
