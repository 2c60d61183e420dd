//! Covariance of the estimates for residuals correlated over time and between lines.
//!
//! The standard deviations (46)-(47) hold for white residuals. Real residuals are correlated:
//! cogging and friction repeat with the trajectory and do not average out. Least squares χ = A^-1
//! Σ_j λ_j W_jᵀ Y_j with A = Σ_j λ_j W_jᵀ W_j and the weights λ_j of the lines has the covariance
//!
//! ```text
//! A^-1 M A^-1,   M = Σ_jk λ_j λ_k W_jᵀ Γ_jk W_k,
//! ```
//!
//! where Γ_jk(t - s) are the covariances of the residuals of lines j and k. They are estimated from
//! the residuals at all lags of a piece of the data. Without a window, a residual that repeats with
//! the trajectory keeps its full effect. With a zero-padded Fourier transform over time,
//!
//! ```text
//! M = Σ_f Re(u_f u_f*)/(P N),   u_f = Σ_j λ_j W_j(f)* ρ_j(f),
//! ```
//!
//! with P the padded length and N the samples of the piece. The fit removes part of the residual.
//! Each frequency is corrected by 1/(1 - h_f) with its leverage
//!
//! ```text
//! h_f = Σ_j λ_j W_j(f)* A^-1 W_j(f)/(N r).
//! ```
//!
//! If the leverage is large, as at frequency zero of a constant column, the residual there is too
//! small to correct. The neighbouring frequencies replace it if they are larger.

use nalgebra::{DMatrix, DMatrixView};
use rayon::prelude::*;

use super::{
    estimate::Estimation,
    fourier::{Fourier, Spectrum},
    nonzero::{at, nonzero},
};
use crate::{
    regression::system::{Stretch, System},
    series::LineResidual,
};

/// Largest number of equations of a line in one transform.
const LARGEST_PIECE: usize = 1 << 12;

/// Largest leverage that is corrected; beyond it a frequency says nothing about the residual.
const LARGEST_LEVERAGE: f64 = 0.9;

/// Number of neighbouring frequencies on either side.
const NEIGHBOURS: usize = 10;

/// Lags of the plotted autocorrelation.
const LAGS: usize = 200;

/// 95 % of normal values lie within this many standard deviations.
pub(crate) const NORMAL_95: f64 = 1.96;

/// The matrix M of a set of columns.
#[derive(Debug, Clone)]
pub(crate) struct Noise {
    columns: Vec<usize>,
    matrix: DMatrix<f64>,
}

impl Noise {
    /// M for the residual of the `estimation` of the columns `selected`.
    ///
    /// `None` without successive equations.
    pub(crate) fn new(
        system: &System,
        selected: &[usize],
        estimation: &Estimation,
    ) -> Option<Self> {
        let pieces: Vec<(&Stretch, usize, usize)> =
            system.stretches.iter().flat_map(pieces).collect();
        let kept: usize = pieces.iter().map(|(_, _, count)| count).sum();
        let equations = system.lines.iter().map(|line| line.equations()).max()?;
        if kept <= selected.len() {
            return None;
        }
        let inverse = &estimation.inverse * estimation.inverse.transpose();
        let context = Context {
            selected,
            values: &estimation.values,
            weights: estimation
                .weights
                .iter()
                .map(|weight| weight * weight)
                .collect(),
            inverse,
        };
        let matrix = pieces
            .par_iter()
            .map(|&(stretch, first, count)| context.piece(stretch, first, count))
            .reduce(
                || DMatrix::zeros(selected.len(), selected.len()),
                |a, b| a + b,
            );
        Some(Self {
            columns: selected.to_vec(),
            matrix: matrix * (equations as f64 / kept as f64),
        })
    }

    /// Standard deviations of an estimate of some of the columns.
    ///
    /// They are at least those for white residuals, since the spectrum of short data can be too
    /// small.
    pub(crate) fn deviations(&self, selected: &[usize], estimation: &Estimation) -> Vec<f64> {
        let places: Vec<usize> = selected
            .iter()
            .filter_map(|column| self.columns.iter().position(|own| own == column))
            .collect();
        let matrix = self.matrix.select_rows(&places).select_columns(&places);
        // Row i of A^-1 = R^-1 R^-T.
        let inverse = &estimation.inverse * estimation.inverse.transpose();
        let product = &inverse * matrix;
        let white = &estimation.standard_deviations;
        (0..places.len())
            .map(|i| {
                let variance = product.row(i).dot(&inverse.row(i));
                white[i].max(variance.max(0.0).sqrt())
            })
            .collect()
    }
}

/// Splits a stretch into pieces: first equation and number of equations.
pub(crate) fn pieces(stretch: &Stretch) -> impl Iterator<Item = (&Stretch, usize, usize)> {
    let rows = stretch.lines.first().map_or(0, DMatrix::nrows);
    let count = rows.div_ceil(LARGEST_PIECE).max(1);
    (0..count).map(move |piece| {
        let first = rows * piece / count;
        (stretch, first, rows * (piece + 1) / count - first)
    })
}

/// Data that all pieces share.
struct Context<'a> {
    selected: &'a [usize],
    values: &'a [f64],
    /// λ of each line.
    weights: Vec<f64>,
    /// A^-1.
    inverse: DMatrix<f64>,
}

impl Context<'_> {
    /// Contribution of one piece to M.
    fn piece(&self, stretch: &Stretch, first: usize, count: usize) -> DMatrix<f64> {
        let p = self.selected.len();
        if count == 0 {
            return DMatrix::zeros(p, p);
        }
        let fourier = Fourier::for_correlation(count);
        let bins = fourier.frequencies();
        let lines: Vec<Line> = stretch
            .lines
            .iter()
            .zip(&self.weights)
            .map(|(rows, &weight)| self.line(&fourier, &rows.rows(first, count), weight))
            .collect();
        let leverage: Vec<f64> = (0..bins)
            .map(|bin| lines.iter().map(|line| line.leverage[bin]).sum::<f64>())
            .map(|sum| (sum / (count * lines.len()) as f64).min(LARGEST_LEVERAGE))
            .collect();
        // Inner frequencies also represent their negative ones.
        let scale = |bin: usize| {
            let twice = if bin == 0 || bin + 1 == bins {
                1.0
            } else {
                2.0
            };
            twice / (fourier.size() * count) as f64
        };
        let (mut real, mut imaginary) = (DMatrix::zeros(bins, p), DMatrix::zeros(bins, p));
        let mut share = DMatrix::zeros(p, p);
        for line in &lines {
            let missing = line.missing(&leverage);
            let mut own = (line.real.clone(), line.imaginary.clone());
            let scaled = |bin: usize| {
                let factor = line.weight * (scale(bin) / (1.0 - leverage[bin])).sqrt();
                [
                    factor * line.residual.real[bin],
                    factor * line.residual.imaginary[bin],
                    line.weight * (scale(bin) * missing[bin]).sqrt(),
                ]
            };
            let scaled: Vec<[f64; 3]> = (0..bins).map(scaled).collect();
            // Column by column, as stored in memory.
            for (column, place) in line.places.iter().enumerate() {
                let (mut to_real, mut to_imaginary) =
                    (real.column_mut(*place), imaginary.column_mut(*place));
                let to = to_real.iter_mut().zip(to_imaginary.iter_mut());
                let (mut own_real, mut own_imaginary) =
                    (own.0.column_mut(column), own.1.column_mut(column));
                let from = own_real.iter_mut().zip(own_imaginary.iter_mut());
                for (((x, y), (a, b)), [c, d, added]) in to.zip(from).zip(&scaled) {
                    *x += *a * c + *b * d;
                    *y += *a * d - *b * c;
                    *a *= added;
                    *b *= added;
                }
            }
            let squares = square(&own.0) + square(&own.1);
            for (to, from) in line.places.iter().zip(squares.column_iter()) {
                for (row, value) in line.places.iter().zip(from.iter()) {
                    share[(*row, *to)] += value;
                }
            }
        }
        share + square(&real) + square(&imaginary)
    }

    /// Spectra of a line.
    fn line(&self, fourier: &Fourier, rows: &View<'_>, weight: f64) -> Line {
        let places = nonzero(rows, self.selected);
        let (real, imaginary) = spectra(fourier, rows, &at(self.selected, &places));
        let inverse = self.inverse.select_rows(&places).select_columns(&places);
        let mut leverage = vec![0.0; fourier.frequencies()];
        for part in [&real, &imaginary] {
            let product = part * &inverse;
            for (own, part) in product.column_iter().zip(part.column_iter()) {
                for ((leverage, a), b) in leverage.iter_mut().zip(&own).zip(&part) {
                    *leverage += weight * a * b;
                }
            }
        }
        Line {
            residual: fourier.single(&residual(rows, self.selected, self.values)),
            places,
            weight,
            real,
            imaginary,
            leverage,
        }
    }
}

/// Real and imaginary parts of the spectra of the columns `selected`, frequencies × columns.
fn spectra(fourier: &Fourier, rows: &View<'_>, selected: &[usize]) -> (DMatrix<f64>, DMatrix<f64>) {
    let bins = fourier.frequencies();
    let size = bins * selected.len();
    let (mut real, mut imaginary) = (Vec::with_capacity(size), Vec::with_capacity(size));
    for pair in selected.chunks(2) {
        let column = |index: usize| -> Vec<f64> {
            let column = pair.get(index).map(|&column| rows.column(column));
            column.map_or_else(Vec::new, |column| column.iter().copied().collect())
        };
        let spectra = fourier.pair(&column(0), &column(1));
        for spectrum in spectra.into_iter().take(pair.len()) {
            real.extend(spectrum.real);
            imaginary.extend(spectrum.imaginary);
        }
    }
    let matrix = |values| DMatrix::from_vec(bins, selected.len(), values);
    (matrix(real), matrix(imaginary))
}

/// Mᵀ M as a matrix product, which is faster than a product of columns.
pub(crate) fn square(matrix: &DMatrix<f64>) -> DMatrix<f64> {
    matrix.transpose() * matrix
}

/// Spectra of the residual and the columns of a line.
struct Line {
    /// Places of the columns that are not zero.
    places: Vec<usize>,
    weight: f64,
    residual: Spectrum,
    real: DMatrix<f64>,
    imaginary: DMatrix<f64>,
    /// Contribution of the line to N r h_f.
    leverage: Vec<f64>,
}

impl Line {
    /// Excess of the neighbours' squared residual over that of each frequency, times its leverage.
    fn missing(&self, leverage: &[f64]) -> Vec<f64> {
        let squares: Vec<f64> = self.residual.squares().collect();
        let around = |bin: usize| {
            let range = bin.saturating_sub(NEIGHBOURS)..(bin + NEIGHBOURS + 1).min(squares.len());
            // A square by 1 - h, weighted with 1 - h.
            let sum: f64 = squares[range.clone()].iter().sum();
            let weight: f64 = leverage[range].iter().map(|leverage| 1.0 - leverage).sum();
            sum / weight
        };
        let own = |bin: usize| squares[bin] / (1.0 - leverage[bin]);
        (0..squares.len())
            .map(|bin| leverage[bin] * (around(bin) - own(bin)).max(0.0))
            .collect()
    }
}

/// Some equations of a line.
pub(crate) type View<'a> = DMatrixView<'a, f64, nalgebra::Const<1>, nalgebra::Dyn>;

/// Y - W χ.
pub(crate) fn residual(rows: &View<'_>, selected: &[usize], values: &[f64]) -> Vec<f64> {
    let mut residual = rows.column(rows.ncols() - 1).clone_owned();
    for (&column, value) in selected.iter().zip(values) {
        residual.axpy(-value, &rows.column(column), 1.0);
    }
    residual.iter().copied().collect()
}

/// Autocorrelation and spectrum of the residual of line number `line`.
///
/// Equations are `interval` seconds apart. The values over time stay empty.
pub(crate) fn line_residual(
    system: &System,
    line: usize,
    selected: &[usize],
    values: &[f64],
    interval: f64,
) -> LineResidual {
    let mut sums = vec![0.0; LAGS + 1];
    let mut kept = 0;
    for (stretch, first, count) in system.stretches.iter().flat_map(pieces) {
        let Some(rows) = stretch.lines.get(line) else {
            continue;
        };
        let residual = residual(&rows.rows(first, count), selected, values);
        let fourier = Fourier::for_correlation(count);
        let squares: Vec<f64> = fourier.single(&residual).squares().collect();
        let own = fourier.correlations(&squares, sums.len().min(count));
        sums.iter_mut().zip(own).for_each(|(sum, own)| *sum += own);
        kept += count;
    }
    let lags = sums.len().min(kept / 4 + 1);
    sums.truncate(lags);
    let power = sums.first().copied().unwrap_or(0.0);
    let autocorrelation: Vec<f64> = sums
        .iter()
        .map(|sum| if power > 0.0 { sum / power } else { 0.0 })
        .collect();
    let white_bound = NORMAL_95 / (kept.max(1) as f64).sqrt();
    let rest = autocorrelation.iter().skip(1);
    let within = rest
        .clone()
        .filter(|value| value.abs() <= white_bound)
        .count();
    let (frequency_hz, power) = spectrum(&sums, kept, interval);
    LineResidual {
        name: system.line_names.get(line).cloned().unwrap_or_default(),
        runs: Vec::new(),
        lag_s: interval,
        within_bound: within as f64 / rest.len().max(1) as f64,
        autocorrelation,
        white_bound,
        frequency_hz,
        power,
    }
}

/// Bartlett's estimate of the one-sided power spectral density, at as many frequencies as lags.
///
/// It is the transform of the linearly tapered autocovariance.
fn spectrum(sums: &[f64], count: usize, interval: f64) -> (Vec<f64>, Vec<f64>) {
    let size = sums.len();
    let last = size.saturating_sub(1).max(1);
    let turn = |step: usize| (std::f64::consts::PI * step as f64 / last as f64).cos();
    let cosines: Vec<f64> = (0..2 * last).map(turn).collect();
    let density = |k: usize| -> f64 {
        let terms = sums.iter().enumerate().map(|(lag, sum)| {
            let taper = 1.0 - lag as f64 / size as f64;
            let twice = if lag == 0 { 1.0 } else { 2.0 };
            twice * taper * sum * cosines[k * lag % cosines.len()]
        });
        2.0 * interval * terms.sum::<f64>() / count.max(1) as f64
    };
    let frequency = |k: usize| 0.5 * k as f64 / (last as f64 * interval);
    (
        (0..size).map(frequency).collect(),
        (0..size).map(density).collect(),
    )
}

#[cfg(test)]
pub(crate) mod tests;
