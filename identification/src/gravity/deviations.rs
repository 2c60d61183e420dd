//! Covariance of the angles.
//!
//! The estimate is the zero of the sum of the scores z_t = Σ_i J_itᵀ ρ_it/s_i². J is the effect of
//! the angles on the torques that parameters cannot explain. The covariance of the angles is
//! (JᵀJ)^-1 Z (JᵀJ)^-1. Z is estimated from score sums over batches of successive samples. It thus
//! allows for correlation between lines and over time. With too few batches, residuals are assumed
//! white.

use nalgebra::DMatrix;

use super::solve::GravitySolution;
use crate::regression::{
    factor::Factor,
    score_batches::{FEWEST_BATCHES, batch_sums, samples},
    system::{Stretch, System},
};

/// Covariance of the angles of a solution, rad²; `None` if the data do not determine it.
pub(super) fn covariance(system: &System, solution: &GravitySolution) -> Option<DMatrix<f64>> {
    let inverse = solution.normal.clone().try_inverse()?;
    let white = &inverse * solution.deviation.powi(2);
    let kept = samples(&system.stretches);
    let all = system.lines.iter().map(Factor::equations).max()?;
    let sums = batch_sums(&system.stretches, |stretch| scores(stretch, solution));
    if sums.len() < FEWEST_BATCHES {
        return Some(white);
    }
    let moved = &inverse * DMatrix::from_columns(&sums);
    let unknowns = solution.values.len() + solution.normal.nrows();
    let equations: usize = system.lines.iter().map(Factor::equations).sum();
    let freedom = equations as f64 / equations.saturating_sub(unknowns).max(1) as f64;
    let own = &moved * moved.transpose() * (freedom * all as f64 / kept.max(1) as f64);
    // Autocorrelated noise can only increase the covariance.
    Some(if own.trace() > white.trace() {
        own
    } else {
        white
    })
}

/// Scores of successive samples, one row each.
fn scores(stretch: &Stretch, solution: &GravitySolution) -> DMatrix<f64> {
    let samples = stretch.lines.first().map_or(0, DMatrix::nrows);
    let explained = &solution.columns * &solution.values;
    let mut scores = DMatrix::zeros(samples, solution.free.ncols());
    for (rows, weight) in stretch.lines.iter().zip(&solution.weights) {
        let count = explained.len();
        let columns = rows.columns(0, count);
        let residual = (rows.column(count) - columns * &explained) * weight.powi(2);
        let mut own = columns * &solution.free;
        for mut column in own.column_iter_mut() {
            column.component_mul_assign(&residual);
        }
        scores += own;
    }
    scores
}
