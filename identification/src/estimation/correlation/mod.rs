//! How residuals hang together over time and between the lines, and what that means for the
//! estimates.
//!
//! The deviations (46)-(47) hold for white residuals. Those of a real robot, or of a model that lacks
//! something, are correlated: cogging and friction return with every period of the trajectory, and
//! what returns does not average out. Least squares χ = A^-1 Σ_j λ_j W_jᵀ Y_j with
//! A = Σ_j λ_j W_jᵀ W_j and the weights λ_j of the lines has the covariance
//!
//! ```text
//! A^-1 M A^-1,   M = Σ_jk λ_j λ_k W_jᵀ Γ_jk W_k,
//! ```
//!
//! where Γ_jk(t - s) are the covariances of the residuals of lines j and k. They are taken from the
//! residuals themselves at all lags of a piece of the data (no window: a residual that repeats itself
//! with the trajectory stays as bad however often it is repeated). By the transform over time, padded
//! so that nothing wraps round, M is a sum over frequencies,
//!
//! ```text
//! M = Σ_f Re(u_f u_f*)/(P N),   u_f = Σ_j λ_j W_j(f)* ρ_j(f),
//! ```
//!
//! with P the padded length and N the samples of the piece. The fit has taken away a part of the
//! residual where the columns are strong; each frequency is freed of that by its leverage
//! h_f = Σ_j λ_j W_j(f)* A^-1 W_j(f)/(N r), dividing by 1 - h_f. Where the fit has a frequency nearly to
//! itself, as a constant column has frequency zero, there is little to divide: there the neighbouring
//! frequencies speak, as far as they tell more.

use nalgebra::{DMatrix, DMatrixView};
use rayon::prelude::*;

use super::{
    estimate::Estimation,
    fourier::{Fourier, Spectrum},
};
use crate::{
    regression::system::{Stretch, System},
    series::LineResidual,
};

/// Equations of a line that are transformed at once.
const LARGEST_PIECE: usize = 1 << 12;

/// A frequency that the fit has nearly to itself says nothing about the residual; its share is freed
/// of the leverage only up to here.
const LARGEST_LEVERAGE: f64 = 0.9;

/// Frequencies on either side that are neighbours.
const NEIGHBOURS: usize = 10;

/// Lags of the plotted autocorrelation.
const LAGS: usize = 200;

/// 95 % of normal values are within so many deviations.
const NORMAL_95: f64 = 1.96;

/// The matrix M of a set of columns.
#[derive(Debug, Clone)]
pub(crate) struct Noise {
    columns: Vec<usize>,
    matrix: DMatrix<f64>,
}

impl Noise {
    /// The matrix of the residual which the `estimation` of the columns `selected` leaves; none without
    /// successive equations.
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

    /// Standard deviations of an estimate of some of the columns, from its R^-1: those under white
    /// residuals where these are larger, since the spectrum of few data can miss what is there.
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

/// Pieces of a stretch that are short enough: first equation and number of equations.
pub(crate) fn pieces(stretch: &Stretch) -> impl Iterator<Item = (&Stretch, usize, usize)> {
    let rows = stretch.lines.first().map_or(0, DMatrix::nrows);
    let count = rows.div_ceil(LARGEST_PIECE).max(1);
    (0..count).map(move |piece| {
        let first = rows * piece / count;
        (stretch, first, rows * (piece + 1) / count - first)
    })
}

/// What all pieces share.
struct Context<'a> {
    selected: &'a [usize],
    values: &'a [f64],
    /// λ of each line.
    weights: Vec<f64>,
    /// A^-1.
    inverse: DMatrix<f64>,
}

impl Context<'_> {
    /// The share of one piece in M.
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
        // Frequencies inside stand for their negative ones, too.
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
            // Column by column, as they lie in memory.
            for column in 0..p {
                let (mut to_real, mut to_imaginary) =
                    (real.column_mut(column), imaginary.column_mut(column));
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
            share += square(&own.0) + square(&own.1);
        }
        share + square(&real) + square(&imaginary)
    }

    /// The spectra of a line.
    fn line(&self, fourier: &Fourier, rows: &View<'_>, weight: f64) -> Line {
        let (real, imaginary) = self.spectra(fourier, rows);
        let mut leverage = vec![0.0; fourier.frequencies()];
        for part in [&real, &imaginary] {
            let product = part * &self.inverse;
            for (own, part) in product.column_iter().zip(part.column_iter()) {
                for ((leverage, a), b) in leverage.iter_mut().zip(&own).zip(&part) {
                    *leverage += weight * a * b;
                }
            }
        }
        Line {
            residual: fourier.single(&residual(rows, self.selected, self.values)),
            weight,
            real,
            imaginary,
            leverage,
        }
    }

    /// Real and imaginary parts of the spectra of the selected columns, frequencies x columns.
    fn spectra(&self, fourier: &Fourier, rows: &View<'_>) -> (DMatrix<f64>, DMatrix<f64>) {
        let bins = fourier.frequencies();
        let (mut real, mut imaginary) = (Vec::new(), Vec::new());
        for pair in self.selected.chunks(2) {
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
        let matrix = |values| DMatrix::from_vec(bins, self.selected.len(), values);
        (matrix(real), matrix(imaginary))
    }
}

/// Mᵀ M, as a product of matrices, which is quicker than one of columns.
pub(crate) fn square(matrix: &DMatrix<f64>) -> DMatrix<f64> {
    matrix.transpose() * matrix
}

/// The spectra of the residual and the columns of a line.
struct Line {
    weight: f64,
    residual: Spectrum,
    real: DMatrix<f64>,
    imaginary: DMatrix<f64>,
    /// The line's share in N r times the leverage.
    leverage: Vec<f64>,
}

impl Line {
    /// What the neighbours have more of the residual's square than a frequency itself, in so far as the
    /// fit has taken it away.
    fn missing(&self, leverage: &[f64]) -> Vec<f64> {
        let squares: Vec<f64> = self.residual.squares().collect();
        let around = |bin: usize| {
            let range = bin.saturating_sub(NEIGHBOURS)..(bin + NEIGHBOURS + 1).min(squares.len());
            // A square over 1 - h, weighted by 1 - h.
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

/// Autocorrelation and spectrum of the residual of line number `line`, decimated to one equation in
/// `interval` seconds; its values over time are left empty.
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

/// Bartlett's estimate of the one-sided power spectral density at as many frequencies as there are
/// lags: the transform of the autocovariance, tapered linearly.
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
