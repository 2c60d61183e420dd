//! How much more of the residual returns with the motion than beside it.
//!
//! A column that varies with a period has its power at the multiples of one frequency. What a model
//! lacks, or a sensor's error that depends on the position, returns with the same period: it stands at
//! the very frequencies of the columns and does not average out, however often it is repeated. Scores
//! do not show it, since the fit makes their sum zero; the covariance of the module `scores`
//! looks at the frequencies around those of the columns and is too small by the ratio
//!
//! ```text
//! Q_i/Q'_i,   Q_i = Σ_f |Σ_j c_ij(f)* ρ_j(f)|²,   Q'_i = Σ_f Σ_jk c_ij(f)* S_jk(f) c_ik(f),
//! ```
//!
//! with c_i = λ W A^-1 e_i, everything transformed over time, and S the mean of ρ_j ρ_k* over the
//! neighbours of f, without f itself, as far as the cosines of the scores reach. For a residual that
//! has nothing to do with the motion the ratio is 1 in the mean.
//!
//! Here, too, the fit has taken a part of the residual away: for white noise the mean of |Σ_j c_j* ρ_j|²
//! is N c*c - c*H c with H_jk(f) = λ_j λ_k W_j(f) A^-1 W_k(f)*. Up to one half, the part that is taken
//! is divided out; what is taken beyond is supposed to be like the neighbours.

use nalgebra::DMatrix;
use rayon::prelude::*;

use super::scores::{Context, cosines};
use crate::{
    estimation::{
        correlation::{View, pieces, residual},
        fourier::Fourier,
    },
    regression::system::System,
};

/// What is divided out at most is the inverse of this.
const LEAST_LEFT: f64 = 0.5;

/// Q_i/Q'_i of each parameter, and the degrees of freedom of Q_i.
pub(crate) fn ratios(system: &System, context: &Context<'_>) -> Vec<(f64, f64)> {
    let p = context.selected.len();
    let pieces: Vec<_> = system.stretches.iter().flat_map(pieces).collect();
    let shares: Vec<Vec<Share>> = pieces
        .par_iter()
        .map(|&(stretch, first, count)| {
            let views = stretch.lines.iter().map(|line| line.rows(first, count));
            let weights = &context.estimation.weights;
            let lines: Vec<Line> = views
                .zip(weights)
                .map(|(rows, weight)| Line::new(context, &rows, *weight))
                .collect();
            shares(&lines, count, p)
        })
        .collect();
    (0..p)
        .map(|i| {
            let sum = |of: fn(&Share) -> f64| -> f64 { shares.iter().map(|all| of(&all[i])).sum() };
            let around = sum(|share| share.around);
            let squares = sum(|share| share.squares);
            (
                sum(|share| share.own) / around,
                2.0 * around * around / squares,
            )
        })
        .collect()
}

/// What a piece adds for one parameter.
#[derive(Debug, Clone, Copy, Default)]
struct Share {
    /// Its part of Q_i.
    own: f64,
    /// Its part of Q'_i.
    around: f64,
    /// Its part of the variance of Q_i.
    squares: f64,
}

/// A line of a piece over frequency; real and imaginary parts.
struct Line {
    /// Columns, weighted, parameters x frequencies: what belongs to a frequency lies together.
    columns: [DMatrix<f64>; 2],
    /// c of all parameters, parameters x frequencies.
    influence: [DMatrix<f64>; 2],
    /// Residual, weighted.
    residual: [Vec<f64>; 2],
    /// H_jj/N of the line itself.
    leverage: Vec<f64>,
}

impl Line {
    fn new(context: &Context<'_>, rows: &View<'_>, weight: f64) -> Self {
        let count = rows.nrows();
        let fourier = Fourier::for_correlation(count);
        let bins = fourier.frequencies();
        let p = context.selected.len();
        let mut columns = [DMatrix::zeros(bins, p), DMatrix::zeros(bins, p)];
        for (place, pair) in context.selected.chunks(2).enumerate() {
            let signal = |index: usize| -> Vec<f64> {
                let column = pair.get(index).map(|&column| rows.column(column) * weight);
                column.map_or_else(Vec::new, |column| column.iter().copied().collect())
            };
            let spectra = fourier.pair(&signal(0), &signal(1));
            for (own, spectrum) in spectra.iter().take(pair.len()).enumerate() {
                let column = 2 * place + own;
                columns[0]
                    .column_mut(column)
                    .copy_from_slice(&spectrum.real);
                columns[1]
                    .column_mut(column)
                    .copy_from_slice(&spectrum.imaginary);
            }
        }
        let columns = columns.map(|part| part.transpose());
        let influence = columns.each_ref().map(|part| &context.inverse * part);
        let leverage = (0..bins)
            .map(|bin| {
                let parts = columns.iter().zip(&influence);
                let sum: f64 = parts.map(|(a, b)| a.column(bin).dot(&b.column(bin))).sum();
                (sum / count as f64).min(1.0)
            })
            .collect();
        let mut values = residual(rows, context.selected, &context.estimation.values);
        values.iter_mut().for_each(|value| *value *= weight);
        let spectrum = fourier.single(&values);
        Self {
            columns,
            influence,
            residual: [spectrum.real, spectrum.imaginary],
            leverage,
        }
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

/// What the lines of a piece of `count` equations add for each of `p` parameters.
fn shares(lines: &[Line], count: usize, p: usize) -> Vec<Share> {
    let bins = lines.first().map_or(0, |line| line.leverage.len());
    let padding = 2.0 * (bins - 1) as f64 / count as f64;
    let reach = 0.5 * cosines(count) as f64 * padding;
    let neighbours = Neighbours {
        nearest: (0.5 * padding).ceil() as usize,
        farthest: (reach.ceil() as usize).max(1),
    };
    let around: Vec<Vec<[Vec<f64>; 2]>> = lines
        .iter()
        .enumerate()
        .map(|(j, a)| lines[..=j].iter().map(|b| neighbours.means(a, b)).collect())
        .collect();
    let mut shares = vec![Share::default(); p];
    for bin in 0..bins {
        // Frequencies inside stand for their negative ones, too.
        let twice = if bin == 0 || bin + 1 == bins {
            1.0
        } else {
            2.0
        };
        let pairs = lines.iter().enumerate();
        let taken: Vec<Vec<[f64; 2]>> = pairs
            .map(|(j, a)| {
                let others = lines[..=j].iter();
                others.map(|b| a.leverage(b, bin, count)).collect()
            })
            .collect();
        for (i, share) in shares.iter_mut().enumerate() {
            let c: Vec<[f64; 2]> = lines
                .iter()
                .map(|line| line.influence.each_ref().map(|part| part[(i, bin)]))
                .collect();
            let mut sum = [0.0; 2];
            for ([a, b], line) in c.iter().zip(lines) {
                let [x, y] = line.residual.each_ref().map(|part| part[bin]);
                sum[0] += a * x + b * y;
                sum[1] += a * y - b * x;
            }
            let plain: f64 = c.iter().flatten().map(|part| part * part).sum();
            let taken = quadratic(&c, |j, k| taken[j][k]);
            let left = (1.0 - taken / plain.max(f64::MIN_POSITIVE)).clamp(0.0, 1.0);
            let factor = 1.0 / left.max(LEAST_LEFT);
            let mean = quadratic(&c, |j, k| around[j][k].each_ref().map(|part| part[bin]));
            let square = sum[0] * sum[0] + sum[1] * sum[1];
            share.own += twice * (factor * square + (1.0 - factor * left) * mean);
            share.around += twice * mean;
            // The transform is padded: so many frequencies tell one thing. The fit takes either of the
            // two degrees of freedom of a frequency; what is filled in does not vary.
            let varies = (factor * left).powi(2) * (1.0 / left.max(LEAST_LEFT));
            share.squares += padding * (twice * mean).powi(2) * varies;
        }
    }
    shares
}

/// Σ_jk Re(c_j* M_jk c_k) of a Hermitian matrix, given below its diagonal.
fn quadratic(c: &[[f64; 2]], matrix: impl Fn(usize, usize) -> [f64; 2]) -> f64 {
    let mut sum = 0.0;
    for (j, [a, b]) in c.iter().enumerate() {
        for (k, [d, e]) in c[..=j].iter().enumerate() {
            let [real, imaginary] = matrix(j, k);
            let both = if k == j { 1.0 } else { 2.0 };
            sum += both * ((a * d + b * e) * real - (a * e - b * d) * imaginary);
        }
    }
    sum
}

/// The frequencies on either side of one that are its neighbours, as distances.
struct Neighbours {
    nearest: usize,
    farthest: usize,
}

impl Neighbours {
    /// Means of ρ_a ρ_b* around each frequency, freed of what the fit has taken away.
    fn means(&self, a: &Line, b: &Line) -> [Vec<f64>; 2] {
        let bins = a.leverage.len();
        // Beyond either end stand the conjugates of the frequencies inside.
        let inside = |place: isize| -> (usize, f64) {
            let last = bins as isize - 1;
            if place < 0 {
                (place.unsigned_abs().min(bins - 1), -1.0)
            } else if place > last {
                ((2 * last - place).max(0).unsigned_abs(), -1.0)
            } else {
                (place.unsigned_abs(), 1.0)
            }
        };
        let first = -(self.farthest as isize);
        let mut sums = vec![[0.0; 3]];
        for place in first..bins as isize + self.farthest as isize {
            let (bin, sign) = inside(place);
            let [x, y] = a.residual.each_ref().map(|part| part[bin]);
            let [u, v] = b.residual.each_ref().map(|part| part[bin]);
            let left = (1.0 - a.leverage[bin]) * (1.0 - b.leverage[bin]);
            let last = sums[sums.len() - 1];
            let own = [x * u + y * v, sign * (y * u - x * v), left.sqrt()];
            sums.push([0, 1, 2].map(|part| last[part] + own[part]));
        }
        let between = |from: isize, to: isize| -> [f64; 3] {
            let place = |bin: isize| (bin - first) as usize;
            [0, 1, 2].map(|part| sums[place(to) + 1][part] - sums[place(from)][part])
        };
        let (near, far) = (self.nearest as isize, self.farthest as isize);
        let mean = |bin: usize| {
            let bin = bin as isize;
            let (before, after) = (
                between(bin - far, bin - near),
                between(bin + near, bin + far),
            );
            let [x, y, weight] = [0, 1, 2].map(|part| before[part] + after[part]);
            [x / weight, y / weight]
        };
        let means: Vec<[f64; 2]> = (0..bins).map(mean).collect();
        [0, 1].map(|part| means.iter().map(|mean| mean[part]).collect())
    }
}

#[cfg(test)]
mod tests {
    use super::{Line, Neighbours};
    use nalgebra::{Complex, DMatrix};

    const BINS: usize = 9;

    /// A line of which only residual and leverage matter.
    fn line(residual: impl Fn(f64) -> [f64; 2], leverage: impl Fn(f64) -> f64) -> Line {
        let parts: Vec<[f64; 2]> = (0..BINS).map(|bin| residual(bin as f64)).collect();
        let nothing = || [DMatrix::zeros(0, BINS), DMatrix::zeros(0, BINS)];
        Line {
            columns: nothing(),
            influence: nothing(),
            residual: [0, 1].map(|part| parts.iter().map(|both| both[part]).collect()),
            leverage: (0..BINS).map(|bin| leverage(bin as f64)).collect(),
        }
    }

    /// The mean of ρ_a ρ_b* around a frequency by its definition, on the whole circle of frequencies.
    fn mean(neighbours: &Neighbours, a: &Line, b: &Line, bin: usize) -> Complex<f64> {
        let size = 2 * (BINS as isize - 1);
        let (mut sum, mut weight) = (Complex::ZERO, 0.0);
        for distance in neighbours.nearest as isize..=neighbours.farthest as isize {
            for place in [bin as isize - distance, bin as isize + distance] {
                let place = place.rem_euclid(size);
                let inside = place.min(size - place) as usize;
                let of = |line: &Line| {
                    let [x, y] = line.residual.each_ref().map(|part| part[inside]);
                    Complex::new(x, if inside as isize == place { y } else { -y })
                };
                sum += of(a) * of(b).conj();
                weight += ((1.0 - a.leverage[inside]) * (1.0 - b.leverage[inside])).sqrt();
            }
        }
        sum / weight
    }

    #[test]
    fn neighbours_are_averaged_on_the_circle_of_frequencies() {
        // At the ends, which are their own conjugates, the transform of real numbers is real.
        let imaginary = |bin: f64| bin * (bin - (BINS - 1) as f64);
        let a = line(|k| [1.0 + k * k, 0.3 * imaginary(k)], |k| 0.02 * k);
        let b = line(|k| [5.0 - 2.0 * k, 0.7 * imaginary(k)], |k| 0.5 - 0.03 * k);
        for (nearest, farthest) in [(1, 1), (1, 3), (2, 8)] {
            let neighbours = Neighbours { nearest, farthest };
            for (a, b) in [(&a, &a), (&a, &b), (&b, &a)] {
                let [real, imaginary] = neighbours.means(a, b);
                for bin in 0..BINS {
                    let expected = mean(&neighbours, a, b, bin);
                    let found = Complex::new(real[bin], imaginary[bin]);
                    let miss = (found - expected).norm() / expected.norm().max(1.0);
                    assert!(miss < 1e-12, "{bin}: {found} is not {expected}");
                }
            }
        }
    }
}
