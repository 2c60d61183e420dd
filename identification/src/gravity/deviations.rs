//! How sure the angles are.
//!
//! The estimate is the zero of the sum of the scores z_t = Σ_i J_itᵀ ρ_it / s_i², J being what the angles do to the
//! torques beyond what parameters make up for, so that its covariance is (JᵀJ)^-1 Z (JᵀJ)^-1. Z is found from sums
//! of the scores over batches of successive samples, so that correlation of the lines among each other and of
//! neighbours in time is taken in; where there are too few of them, residuals are taken for white.

use nalgebra::{DMatrix, DVector};

use super::solve::Solution;
use crate::regression::{
    factor::Factor,
    system::{Stretch, System},
};

/// Batches that are wanted at least.
const FEWEST_BATCHES: usize = 30;

/// The covariance of the angles of a solution, rad²; none where the data do not tell them.
pub(super) fn covariance(system: &System, solution: &Solution) -> Option<DMatrix<f64>> {
    let inverse = solution.normal.clone().try_inverse()?;
    let white = &inverse * solution.deviation.powi(2);
    let samples = |stretch: &Stretch| stretch.lines.first().map_or(0, DMatrix::nrows);
    let kept: usize = system.stretches.iter().map(samples).sum();
    let all = system.lines.iter().map(Factor::equations).max()?;
    // About the third root of the samples, longer than noise is correlated over after decimation.
    let root = (kept as f64).cbrt().ceil() as usize;
    let batch = root.min(kept / FEWEST_BATCHES).max(1);
    let mut sums: Vec<DVector<f64>> = Vec::new();
    for stretch in &system.stretches {
        let scores = scores(stretch, solution);
        let mut first = 0;
        while first < scores.nrows() {
            let count = batch.min(scores.nrows() - first);
            sums.push(scores.rows(first, count).row_sum().transpose());
            first += count;
        }
    }
    if sums.len() < FEWEST_BATCHES {
        return Some(white);
    }
    let moved = &inverse * DMatrix::from_columns(&sums);
    let unknowns = solution.values.len() + solution.normal.nrows();
    let equations: usize = system.lines.iter().map(Factor::equations).sum();
    let freedom = equations as f64 / equations.saturating_sub(unknowns).max(1) as f64;
    let own = &moved * moved.transpose() * (freedom * all as f64 / kept.max(1) as f64);
    // Noise that hangs together makes them less sure, never surer.
    Some(if own.trace() > white.trace() {
        own
    } else {
        white
    })
}

/// The scores of successive samples, a row each.
fn scores(stretch: &Stretch, solution: &Solution) -> DMatrix<f64> {
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
