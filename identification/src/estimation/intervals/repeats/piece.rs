//! What a piece of a run adds to Q and Q'.
//!
//! Of white noise as large everywhere the fit takes a part, H_jk(f) = λ_j λ_k W_j(f) A^-1 W_k(f)*, so that
//! the mean of c* P c is N c*c - c*H c. Up to one half, the part that is taken is divided out; what is taken
//! beyond is supposed to be like the neighbours.

use nalgebra::DMatrix;

use super::{
    power::{FORMS, Forms, Neighbours, Powers},
    signs::{Drawn, weighted, weighted_residual},
};
use crate::estimation::{
    correlation::View,
    fourier::{Fourier, Spectrum},
    intervals::scores::{Context, cosines},
};

/// What is divided out at most is the inverse of this.
const LEAST_LEFT: f64 = 0.5;

/// What a piece adds for one parameter.
#[derive(Debug, Clone, Copy, Default)]
pub(super) struct Share {
    /// Its part of Q_i.
    pub(super) own: f64,
    /// Its part of Q'_i.
    pub(super) around: f64,
    /// Its part of the variance of Q_i.
    pub(super) squares: f64,
    /// The parts with random signs, of all draws.
    pub(super) drawn: Parts,
}

/// Parts of Q_i and Q'_i.
#[derive(Debug, Clone, Copy, Default)]
pub(super) struct Parts {
    pub(super) own: f64,
    pub(super) around: f64,
}

/// The columns of a line of a piece over frequency; real and imaginary parts, parameters x frequencies:
/// what belongs to a frequency lies together.
struct Line {
    /// Weighted columns.
    columns: [DMatrix<f64>; 2],
    /// c of all parameters.
    influence: [DMatrix<f64>; 2],
}

impl Line {
    /// That of weighted columns over time.
    fn new(context: &Context<'_>, fourier: &Fourier, columns: &DMatrix<f64>) -> Self {
        let spectra: Vec<Spectrum> = fourier.columns(columns);
        let bins = fourier.frequencies();
        let part = |of: fn(&Spectrum) -> &[f64]| {
            let parts: Vec<&[f64]> = spectra.iter().map(of).collect();
            DMatrix::from_fn(parts.len(), bins, |column, bin| parts[column][bin])
        };
        let columns = [part(|own| &own.real), part(|own| &own.imaginary)];
        let influence = columns.each_ref().map(|part| &context.inverse * part);
        Self { columns, influence }
    }

    /// c of all parameters at a frequency, real and imaginary parts.
    fn at(&self, bin: usize) -> [&[f64]; 2] {
        self.influence.each_ref().map(|part| {
            let count = part.nrows();
            &part.as_slice()[bin * count..(bin + 1) * count]
        })
    }

    /// H_jk/N of two lines at a frequency, real and imaginary part.
    fn leverage(&self, other: &Self, bin: usize, count: usize) -> [f64; 2] {
        let [a, b] = self.columns.each_ref().map(|part| part.column(bin));
        let [c, d] = other.influence.each_ref().map(|part| part.column(bin));
        let real = a.dot(&c) + b.dot(&d);
        let imaginary = b.dot(&c) - a.dot(&d);
        [real, imaginary].map(|part| part / count as f64)
    }
}

/// What the lines of a piece, each with its weight, add for each parameter.
pub(super) fn shares<'a>(
    context: &Context<'_>,
    views: impl Iterator<Item = (View<'a>, f64)>,
    signs: &Drawn<'_>,
) -> Vec<Share> {
    let (mut lines, mut spectra, mut drawn) = (Vec::new(), Vec::new(), Vec::new());
    let views: Vec<_> = views.collect();
    let count = views.first().map_or(0, |(rows, _)| rows.nrows());
    let fourier = Fourier::for_correlation(count);
    for (rows, weight) in views {
        let columns = weighted(context, &rows, weight);
        let residual = weighted_residual(context, &rows, weight);
        drawn.push(fourier.columns(&signs.residuals(&columns, &residual)));
        spectra.push(vec![fourier.single(&residual)]);
        lines.push(Line::new(context, &fourier, &columns));
    }
    let bins = fourier.frequencies();
    let taken = taken(&lines, count, bins);
    let neighbours = Neighbours::new(count, bins, cosines(count));
    let means = |powers: &Powers| neighbours.means(powers, &taken);
    let own = Powers::new(&spectra, bins);
    let drawn = Powers::new(&drawn, bins);
    let (around, drawn_around) = (means(&own), means(&drawn));
    let powers = [&taken, &own, &around, &drawn, &drawn_around];
    summed(
        context.selected.len(),
        &lines,
        (powers, bins),
        neighbours.padding(),
    )
}

/// The shares of all parameters, of what is taken and the powers of the residual and of those drawn, their own
/// and their neighbours'.
fn summed(
    parameters: usize,
    lines: &[Line],
    (powers, bins): ([&Powers; FORMS], usize),
    padding: f64,
) -> Vec<Share> {
    let mut shares = vec![Share::default(); parameters];
    let mut sums = [const { Vec::new() }; FORMS];
    sums.iter_mut().for_each(|own| own.resize(parameters, 0.0));
    for bin in 0..bins {
        // Frequencies inside stand for their negative ones, too.
        let edge = bin == 0 || bin + 1 == bins;
        let twice = if edge { 1.0 } else { 2.0 };
        let c: Vec<[&[f64]; 2]> = lines.iter().map(|line| line.at(bin)).collect();
        let forms = Forms {
            matrices: powers,
            bin,
            vectors: &c,
            sums: &mut sums,
        };
        forms.tell();
        for (i, share) in shares.iter_mut().enumerate() {
            let plain: f64 = c.iter().flatten().map(|part| part[i] * part[i]).sum();
            let [taken, own, around, drawn, drawn_around] = sums.each_ref().map(|sum| sum[i]);
            let left = 1.0 - taken / plain.max(f64::MIN_POSITIVE);
            let left = left.clamp(0.0, 1.0);
            let factor = 1.0 / left.max(LEAST_LEFT);
            let filled = |own: f64, mean: f64| {
                let own = factor * own + (1.0 - factor * left) * mean;
                [own, mean].map(|part| twice * part)
            };
            let [square, mean] = filled(own, around);
            share.own += square;
            share.around += mean;
            // The transform is padded: so many frequencies tell one thing. The fit takes either of the
            // two degrees of freedom of a frequency; what is filled in does not vary.
            let varies = (factor * left).powi(2) * (1.0 / left.max(LEAST_LEFT));
            share.squares += padding * mean.powi(2) * varies;
            let [square, mean] = filled(drawn, drawn_around);
            share.drawn.own += square;
            share.drawn.around += mean;
        }
    }
    shares
}

/// H/N of all pairs of lines.
fn taken(lines: &[Line], count: usize, bins: usize) -> Powers {
    Powers::from_fn(lines.len(), bins, |j, k, bin| {
        lines[j].leverage(&lines[k], bin, count)
    })
}
