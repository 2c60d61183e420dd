//! Residuals unrelated to the motion, with the same size at each instant (wild bootstrap).
//!
//! The residual of each instant is multiplied by a random sign η, equal for all lines, and the
//! model is fitted again: ρ* = ηρ - W A^-1 Σ λ² w ηρ. This destroys repetition with the motion, but
//! keeps changes of the noise level and correlation between lines (Liu, *Annals of Statistics* 16,
//! 1988).

use std::ops::Range;

use nalgebra::DMatrix;
use rand::{RngExt, SeedableRng};
use rand_pcg::Pcg64;
use rayon::prelude::*;

use crate::{
    estimation::{
        correlation::{View, pieces, residual},
        intervals::scores::Context,
        nonzero::{at, nonzero},
    },
    regression::system::System,
};

/// Number of draws; at most the number of bits of an instant.
pub(super) const DRAWS: usize = 32;

/// Signs of all instants, and the fits.
pub(super) struct Signs {
    /// For each stretch and instant, a bit for each draw.
    bits: Vec<Vec<u64>>,
    /// A^-1 Σ λ² w ηρ, p × draws.
    fits: DMatrix<f64>,
}

/// Signs of the instants of a piece.
pub(super) struct Drawn<'a> {
    bits: &'a [u64],
    fits: &'a DMatrix<f64>,
}

impl Signs {
    /// Draws the signs of all stretches, reproducibly.
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
                let WeightedColumns { places, columns } = weighted(context, &rows, *weight);
                let signed = drawn.signed(&weighted_residual(context, &rows, *weight));
                let products = columns.transpose() * signed;
                for (place, own) in places.iter().zip(products.row_iter()) {
                    let mut row = sum.row_mut(*place);
                    row += own;
                }
            }
            sum
        });
        let sum = sums.reduce(|| none.clone(), |a, b| a + b);
        let fits = &context.inverse * sum;
        Self { bits, fits }
    }

    /// Signs of a piece of a stretch.
    pub(super) fn of(&self, stretch: usize, first: usize, count: usize) -> Drawn<'_> {
        let instants: Range<usize> = first..first + count;
        Drawn {
            bits: &self.bits[stretch][instants],
            fits: &self.fits,
        }
    }
}

impl Drawn<'_> {
    /// ηρ of all draws, one column each.
    fn signed(&self, residual: &[f64]) -> DMatrix<f64> {
        DMatrix::from_fn(residual.len(), DRAWS, |instant, draw| {
            if self.bits[instant] >> draw & 1 == 0 {
                residual[instant]
            } else {
                -residual[instant]
            }
        })
    }

    /// ρ* of all draws, for a line with these weighted columns and this residual.
    pub(super) fn residuals(&self, own: &WeightedColumns, residual: &[f64]) -> DMatrix<f64> {
        let mut drawn = self.signed(residual);
        let fits = self.fits.select_rows(&own.places);
        drawn.gemm(-1.0, &own.columns, &fits, 1.0);
        drawn
    }
}

/// λ w of the estimated columns that are not zero in a line.
pub(super) struct WeightedColumns {
    /// Their places among the estimated columns.
    pub(super) places: Vec<usize>,
    pub(super) columns: DMatrix<f64>,
}

/// λ w of a line.
pub(super) fn weighted(context: &Context<'_>, rows: &View<'_>, weight: f64) -> WeightedColumns {
    let places = nonzero(rows, context.selected);
    let columns = rows.select_columns(&at(context.selected, &places)) * weight;
    WeightedColumns { places, columns }
}

/// λ ρ.
pub(super) fn weighted_residual(context: &Context<'_>, rows: &View<'_>, weight: f64) -> Vec<f64> {
    let mut values = residual(rows, context.selected, &context.estimation.values);
    values.iter_mut().for_each(|value| *value *= weight);
    values
}
