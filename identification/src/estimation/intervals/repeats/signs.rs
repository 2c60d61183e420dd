//! Residuals that have nothing to do with the motion, and are as large as the residual at each instant.
//!
//! The residual of every instant gets a random sign, all lines the same, and the model is fitted anew:
//! ρ* = ηρ - W A^-1 Σ λ² w ηρ. What returns with the motion does so no longer; how noise grows and shrinks
//! with it, and what lines share, remains (the wild bootstrap, Liu, *Annals of Statistics* 16, 1988).

use std::ops::Range;

use nalgebra::DMatrix;
use rand::{RngExt, SeedableRng};
use rand_pcg::Pcg64;
use rayon::prelude::*;

use crate::{
    estimation::{
        correlation::{View, pieces, residual},
        intervals::scores::Context,
    },
    regression::system::System,
};

/// How many residuals are drawn; no more than an instant has bits.
pub(super) const DRAWS: usize = 32;

/// The signs of all instants, and what the fit takes away.
pub(super) struct Signs {
    /// For each stretch and instant a bit for each draw.
    bits: Vec<Vec<u64>>,
    /// A^-1 Σ λ² w ηρ, p x draws.
    fits: DMatrix<f64>,
}

/// The signs of the instants of a piece.
pub(super) struct Drawn<'a> {
    bits: &'a [u64],
    fits: &'a DMatrix<f64>,
}

impl Signs {
    /// Those for all stretches; the same ones for the same system.
    pub(super) fn new(system: &System, context: &Context<'_>) -> Self {
        let p = context.selected.len();
        let bits: Vec<Vec<u64>> = (0_u64..)
            .zip(&system.stretches)
            .map(|(number, stretch)| {
                let mut generator = Pcg64::seed_from_u64(number);
                let instants = stretch.lines.first().map_or(0, DMatrix::nrows);
                (0..instants).map(|_| generator.random()).collect()
            })
            .collect();
        let none = DMatrix::zeros(p, DRAWS);
        let pieces: Vec<_> = bits
            .iter()
            .zip(&system.stretches)
            .flat_map(|(bits, stretch)| pieces(stretch).map(move |piece| (bits, piece)))
            .collect();
        let sums = pieces.par_iter().map(|&(bits, (stretch, first, count))| {
            let drawn = Drawn {
                bits: &bits[first..first + count],
                fits: &none,
            };
            let mut sum = none.clone();
            for (line, weight) in stretch.lines.iter().zip(&context.estimation.weights) {
                let rows = line.rows(first, count);
                let columns = weighted(context, &rows, *weight);
                let signed = drawn.signed(&weighted_residual(context, &rows, *weight));
                sum.gemm(1.0, &columns.transpose(), &signed, 1.0);
            }
            sum
        });
        let sum = sums.reduce(|| none.clone(), |a, b| a + b);
        let fits = &context.inverse * sum;
        Self { bits, fits }
    }

    /// Those of the instants of a piece of a stretch.
    pub(super) fn of(&self, stretch: usize, first: usize, count: usize) -> Drawn<'_> {
        let instants: Range<usize> = first..first + count;
        Drawn {
            bits: &self.bits[stretch][instants],
            fits: &self.fits,
        }
    }
}

impl Drawn<'_> {
    /// ηρ of all draws, a column for each.
    fn signed(&self, residual: &[f64]) -> DMatrix<f64> {
        DMatrix::from_fn(residual.len(), DRAWS, |instant, draw| {
            if self.bits[instant] >> draw & 1 == 0 {
                residual[instant]
            } else {
                -residual[instant]
            }
        })
    }

    /// ρ* of all draws, of a line with these weighted columns and this residual.
    pub(super) fn residuals(&self, columns: &DMatrix<f64>, residual: &[f64]) -> DMatrix<f64> {
        let mut drawn = self.signed(residual);
        drawn.gemm(-1.0, columns, self.fits, 1.0);
        drawn
    }
}

/// λ w of the columns that were estimated.
pub(super) fn weighted(context: &Context<'_>, rows: &View<'_>, weight: f64) -> DMatrix<f64> {
    rows.select_columns(context.selected) * weight
}

/// λ ρ.
pub(super) fn weighted_residual(context: &Context<'_>, rows: &View<'_>, weight: f64) -> Vec<f64> {
    let mut values = residual(rows, context.selected, &context.estimation.values);
    values.iter_mut().for_each(|value| *value *= weight);
    values
}
