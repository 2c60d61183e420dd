//! How much more of the residual returns with the motion than beside it.
//!
//! A column that varies with a period has its power at the multiples of one frequency. What a model
//! lacks, or a sensor's error that depends on the position, returns with the same period: it stands at
//! the very frequencies of the columns and does not average out, however often it is repeated. Scores
//! do not show it, since the fit makes their sum zero; the covariance of the module `scores`
//! looks at the frequencies around those of the columns and is too small by the ratio
//!
//! ```text
//! Q_i/Q'_i,   Q_i = Σ_f Σ_jk c_ij* P_jk c_ik,   Q'_i = Σ_f Σ_jk c_ij* S_jk c_ik,   P_jk = ρ_j ρ_k*,
//! ```
//!
//! with c_i = λ W A^-1 e_i, everything transformed over time, and S the mean of P over the neighbours of a
//! frequency, without itself, as far as the cosines of the scores reach.
//!
//! - `power`: P of the lines of a piece, and S.
//! - `piece`: what a piece adds to Q and Q'.
//! - `signs`: what the ratio would be of a residual that has nothing to do with the motion. It is 1 in the
//!   mean where that is as large everywhere, else less or more, since the fit takes another part of it. The
//!   ratio is divided by what random signs of each instant's residual give.

mod piece;
mod power;
mod signs;

use rayon::prelude::*;

use super::scores::Context;
use crate::{estimation::correlation::pieces, regression::system::System};
use piece::{Share, shares};
use signs::{DRAWS, Signs};

/// Q_i/Q'_i of each parameter, and the degrees of freedom of Q_i.
pub(crate) fn ratios(system: &System, context: &Context<'_>) -> Vec<(f64, f64)> {
    let p = context.selected.len();
    let signs = Signs::new(system, context);
    let stretches = system.stretches.iter().enumerate();
    let pieces: Vec<_> = stretches
        .flat_map(|(number, stretch)| pieces(stretch).map(move |piece| (number, piece)))
        .collect();
    let shares: Vec<Vec<Share>> = pieces
        .par_iter()
        .map(|&(number, (stretch, first, count))| {
            let signs = signs.of(number, first, count);
            let lines = stretch.lines.iter().zip(&context.estimation.weights);
            let views = lines.map(|(line, weight)| (line.rows(first, count), *weight));
            shares(context, views, &signs)
        })
        .collect();
    (0..p)
        .map(|i| {
            let sum = |of: fn(&Share) -> f64| -> f64 { shares.iter().map(|all| of(&all[i])).sum() };
            let around = sum(|share| share.around);
            let ratio = sum(|share| share.own) / around;
            let by_chance = sum(|share| share.drawn.own) / sum(|share| share.drawn.around);
            let freedom = 2.0 * around * around / sum(|share| share.squares);
            // What signs give scatters, too, as much as so many residuals in the mean.
            (ratio / by_chance, freedom / (1.0 + 1.0 / DRAWS as f64))
        })
        .collect()
}
