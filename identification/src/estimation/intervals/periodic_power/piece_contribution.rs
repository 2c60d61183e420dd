//! Contribution of a piece of a run to the power sums Q and Q'.
//!
//! The fit removes H_jk(f) = λ_j λ_k W_j(f) A^-1 W_k(f)* of white noise of constant size, so the
//! mean of c* P c is N c*c - c*H c. Removal of up to one half is corrected by division. Beyond
//! that, the removed part is replaced by the mean of the neighbours.

use nalgebra::DMatrix;

use super::{
    power::{FORMS, Forms, Neighbours, Powers},
    signs::{Drawn, WeightedColumns, weighted, weighted_residual},
};
use crate::estimation::{
    correlation::View,
    fourier::{Fourier, Spectrum},
    intervals::scores::{Context, cosines},
};

/// Smallest remaining part of the power that is corrected by division.
const LEAST_LEFT: f64 = 0.5;

/// Contribution of a piece for one parameter.
#[derive(Debug, Clone, Copy, Default)]
pub(super) struct PieceContribution {
    /// Q_i and Q'_i of the residual.
    pub(super) residual: PowerSums,
    /// Variance of Q_i.
    pub(super) variance: f64,
    /// Q_i and Q'_i of residuals with random signs, summed over all draws.
    pub(super) random_signs: PowerSums,
}

/// Sums of a residual's power, weighted by the influence of each frequency on a parameter.
#[derive(Debug, Clone, Copy, Default)]
pub(super) struct PowerSums {
    /// Q_i: power at the frequencies of the motion.
    pub(super) at_motion: f64,
    /// Q'_i: power at their neighbours.
    pub(super) at_neighbours: f64,
}

/// Spectra of the columns of a line of a piece.
///
/// Real and imaginary parts are parameters × frequencies, so each frequency is contiguous.
struct Line {
    /// Places of the columns that are not zero.
    places: Vec<usize>,
    /// These columns, weighted.
    columns: [DMatrix<f64>; 2],
    /// c of all parameters.
    influence: [DMatrix<f64>; 2],
}

impl Line {
    /// Transforms weighted columns.
    fn new(context: &Context<'_>, fourier: &Fourier, own: WeightedColumns) -> Self {
        let spectra: Vec<Spectrum> = fourier.columns(&own.columns);
        let inverse = context.inverse.select_columns(&own.places);
        let bins = fourier.frequencies();
        let part = |of: fn(&Spectrum) -> &[f64]| {
            let parts: Vec<&[f64]> = spectra.iter().map(of).collect();
            DMatrix::from_fn(parts.len(), bins, |column, bin| parts[column][bin])
        };
        let columns = [part(|own| &own.real), part(|own| &own.imaginary)];
        let influence = columns.each_ref().map(|part| &inverse * part);
        Self {
            places: own.places,
            columns,
            influence,
        }
    }

    /// c of all parameters at a frequency, real and imaginary parts.
    fn at(&self, bin: usize) -> [&[f64]; 2] {
        self.influence.each_ref().map(|part| {
            let count = part.nrows();
            &part.as_slice()[bin * count..(bin + 1) * count]
        })
    }

    /// H_jk/N of two lines at a frequency, real and imaginary parts.
    fn leverage(&self, other: &Self, bin: usize, count: usize) -> [f64; 2] {
        let [a, b] = self.columns.each_ref().map(|part| part.column(bin));
        let [c, d] = other.at(bin);
        let (mut real, mut imaginary) = (0.0, 0.0);
        for ((a, b), place) in a.iter().zip(b.iter()).zip(&self.places) {
            let (c, d) = (c[*place], d[*place]);
            real += a * c + b * d;
            imaginary += b * c - a * d;
        }
        [real, imaginary].map(|part| part / count as f64)
    }
}

/// Contributions of the lines of a piece, each with its weight, for each parameter.
pub(super) fn contributions<'a>(
    context: &Context<'_>,
    views: impl Iterator<Item = (View<'a>, f64)>,
    signs: &Drawn<'_>,
) -> Vec<PieceContribution> {
    let (mut lines, mut spectra, mut drawn) = (Vec::new(), Vec::new(), Vec::new());
    let views: Vec<_> = views.collect();
    let count = views.first().map_or(0, |(rows, _)| rows.nrows());
    let fourier = Fourier::for_correlation(count);
    for (rows, weight) in views {
        let columns = weighted(context, &rows, weight);
        let residual = weighted_residual(context, &rows, weight);
        drawn.push(fourier.columns(&signs.residuals(&columns, &residual)));
        spectra.push(vec![fourier.single(&residual)]);
        lines.push(Line::new(context, &fourier, columns));
    }
    let bins = fourier.frequencies();
    let leverages = leverages(&lines, count, bins);
    let neighbours = Neighbours::new(count, bins, cosines(count));
    let means = |powers: &Powers| neighbours.means(powers, &leverages);
    let own = Powers::new(&spectra, bins);
    let drawn = Powers::new(&drawn, bins);
    let (around, drawn_around) = (means(&own), means(&drawn));
    summed(
        context.selected.len(),
        &lines,
        [&leverages, &own, &around, &drawn, &drawn_around],
        bins,
        neighbours.padding(),
    )
}

/// Contributions for all parameters.
///
/// `powers` are those that the fit removes, of the residual, its neighbours, the drawn residuals, and
/// their neighbours.
fn summed(
    parameters: usize,
    lines: &[Line],
    powers: [&Powers; FORMS],
    bins: usize,
    padding: f64,
) -> Vec<PieceContribution> {
    let mut contributions = vec![PieceContribution::default(); parameters];
    let mut sums = [const { Vec::new() }; FORMS];
    sums.iter_mut().for_each(|own| own.resize(parameters, 0.0));
    for bin in 0..bins {
        // Inner frequencies also represent their negative ones.
        let edge = bin == 0 || bin + 1 == bins;
        let twice = if edge { 1.0 } else { 2.0 };
        let c: Vec<[&[f64]; 2]> = lines.iter().map(|line| line.at(bin)).collect();
        let forms = Forms {
            matrices: powers,
            bin,
            vectors: &c,
            sums: &mut sums,
        };
        forms.evaluate();
        for (i, contribution) in contributions.iter_mut().enumerate() {
            let plain: f64 = c.iter().flatten().map(|part| part[i] * part[i]).sum();
            let [leverage, own, around, drawn, drawn_around] = sums.each_ref().map(|sum| sum[i]);
            let left = 1.0 - leverage / plain.max(f64::MIN_POSITIVE);
            let left = left.clamp(0.0, 1.0);
            let factor = 1.0 / left.max(LEAST_LEFT);
            let corrected = |power: f64, mean: f64| {
                let power = factor * power + (1.0 - factor * left) * mean;
                [power, mean].map(|part| twice * part)
            };
            let [square, mean] = corrected(own, around);
            contribution.residual.at_motion += square;
            contribution.residual.at_neighbours += mean;
            // With zero padding, `padding` frequencies carry one independent value. The fit removes
            // either of the two degrees of freedom of a frequency; a filled-in part does not vary.
            let varies = (factor * left).powi(2) * (1.0 / left.max(LEAST_LEFT));
            contribution.variance += padding * mean.powi(2) * varies;
            let [square, mean] = corrected(drawn, drawn_around);
            contribution.random_signs.at_motion += square;
            contribution.random_signs.at_neighbours += mean;
        }
    }
    contributions
}

/// H/N of all pairs of lines.
fn leverages(lines: &[Line], count: usize, bins: usize) -> Powers {
    Powers::from_fn(lines.len(), bins, |j, k, bin| {
        lines[j].leverage(&lines[k], bin, count)
    })
}
