//! Ratio of the residual's power at the frequencies of the motion to that at their neighbours.
//!
//! A periodic column has its power at multiples of one frequency. Missing terms of the model, or
//! position-dependent sensor errors, have the same period. Their residual is at exactly these
//! frequencies, and more periods do not reduce it. The scores do not show it, since the fit makes
//! their sum zero. The covariance of the module `scores` uses the frequencies around those of the
//! columns and is too small by the ratio
//!
//! ```text
//! Q_i/Q'_i,   Q_i = Σ_f Σ_jk c_ij* P_jk c_ik,   Q'_i = Σ_f Σ_jk c_ij* S_jk c_ik,   P_jk = ρ_j ρ_k*.
//! ```
//!
//! Here c_i = λ W A^-1 e_i, transformed over time. S is the mean of P over the neighbours of a
//! frequency, without itself, within the band of the cosines of the scores.
//!
//! - `power`: P of the lines of a piece, and S.
//! - `piece_contribution`: contribution of a piece to Q and Q'.
//! - `signs`: the ratio for residuals that are unrelated to the motion.
//!
//! The latter ratio is 1 on average for a residual of constant size. Otherwise it differs, since
//! the fit removes another part of the residual. The result is divided by the ratio for residuals
//! with random signs.

mod piece_contribution;
mod power;
mod signs;

use rayon::prelude::*;

use super::scores::Context;
use crate::{
    estimation::{correlation::pieces, periodic_variance::VarianceRatio},
    regression::system::System,
};
use piece_contribution::{PieceContribution, contributions};
use signs::{DRAWS, Signs};

/// Q_i/Q'_i of each parameter, and the degrees of freedom of Q_i.
pub(crate) fn ratios(system: &System, context: &Context<'_>) -> Vec<VarianceRatio> {
    let p = context.selected.len();
    let signs = Signs::new(system, context);
    let stretches = system.stretches.iter().enumerate();
    let pieces: Vec<_> = stretches
        .flat_map(|(number, stretch)| pieces(stretch).map(move |piece| (number, piece)))
        .collect();
    let contributions: Vec<Vec<PieceContribution>> = pieces
        .par_iter()
        .map(|&(number, (stretch, first, count))| {
            let signs = signs.of(number, first, count);
            let lines = stretch.lines.iter().zip(&context.estimation.weights);
            let views = lines.map(|(line, weight)| (line.rows(first, count), *weight));
            contributions(context, views, &signs)
        })
        .collect();
    (0..p)
        .map(|i| {
            let sum = |of: fn(&PieceContribution) -> f64| -> f64 {
                contributions.iter().map(|all| of(&all[i])).sum()
            };
            let around = sum(|contribution| contribution.residual.at_neighbours);
            let ratio = sum(|contribution| contribution.residual.at_motion) / around;
            let by_chance = sum(|contribution| contribution.random_signs.at_motion)
                / sum(|contribution| contribution.random_signs.at_neighbours);
            let freedom = 2.0 * around * around / sum(|contribution| contribution.variance);
            VarianceRatio {
                ratio: ratio / by_chance,
                // The ratio for random signs also scatters, like the mean of `DRAWS` residuals.
                freedom: freedom / (1.0 + 1.0 / DRAWS as f64),
            }
        })
        .collect()
}
