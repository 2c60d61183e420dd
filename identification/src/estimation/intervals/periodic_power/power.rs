//! Cross spectra of the lines of a piece.

#[cfg(target_arch = "x86_64")]
use pulp::NullaryFnOnce;

use crate::estimation::fourier::Spectrum;

/// A Hermitian matrix over pairs of lines, for each frequency from 0 to Nyquist.
pub(super) struct Powers {
    lines: usize,
    /// Lower triangle, row by row.
    pairs: Vec<Spectrum>,
}

impl Powers {
    /// Σ ρ_j ρ_k* over the residuals of each line; each line has the same number of residuals.
    pub(super) fn new(residuals: &[Vec<Spectrum>], bins: usize) -> Self {
        let lines = residuals.len();
        let below = (0..lines).flat_map(|j| (0..=j).map(move |k| (j, k)));
        let pairs = below.map(|(j, k)| {
            let (mut real, mut imaginary) = (vec![0.0; bins], vec![0.0; bins]);
            // Residual by residual, as stored in memory.
            for (a, b) in residuals[j].iter().zip(&residuals[k]) {
                let sums = real.iter_mut().zip(&mut imaginary);
                let (first, second) = (
                    a.real.iter().zip(&a.imaginary),
                    b.real.iter().zip(&b.imaginary),
                );
                for (((to, turned), (x, y)), (u, v)) in sums.zip(first).zip(second) {
                    *to = *to + x * u + y * v;
                    *turned = *turned + y * u - x * v;
                }
            }
            Spectrum { real, imaginary }
        });
        Self {
            lines,
            pairs: pairs.collect(),
        }
    }

    /// Matrices with entries `of` row, column and frequency.
    pub(super) fn from_fn(
        lines: usize,
        bins: usize,
        of: impl Fn(usize, usize, usize) -> [f64; 2],
    ) -> Self {
        let below = (0..lines).flat_map(|j| (0..=j).map(move |k| (j, k)));
        let pairs = below.map(|(j, k)| {
            let (real, imaginary) = (0..bins).map(|bin| of(j, k, bin).into()).unzip();
            Spectrum { real, imaginary }
        });
        Self {
            lines,
            pairs: pairs.collect(),
        }
    }

    fn pair(&self, j: usize, k: usize) -> &Spectrum {
        &self.pairs[j * (j + 1) / 2 + k]
    }
}

/// Number of matrices whose forms are computed together.
pub(super) const FORMS: usize = 5;

/// Hermitian forms Σ_jk Re(c_j* M_jk c_k) of several matrices at a frequency, for many c.
pub(super) struct Forms<'a> {
    pub(super) matrices: [&'a Powers; FORMS],
    pub(super) bin: usize,
    /// For each line, the real and imaginary parts of c_j of all vectors.
    pub(super) vectors: &'a [[&'a [f64]; 2]],
    /// For each matrix, the forms of all vectors.
    pub(super) sums: &'a mut [Vec<f64>; FORMS],
}

impl Forms<'_> {
    /// Writes the forms to `sums`.
    pub(super) fn evaluate(self) {
        #[cfg(target_arch = "x86_64")]
        if let Some(simd) = pulp::x86::V3::try_new() {
            simd.vectorize(self);
            return;
        }
        self.run();
    }

    #[inline(always)]
    fn run(self) {
        let count = self.sums[0].len();
        let [first, second, third, fourth, fifth] = self.sums.each_mut().map(|sums| {
            sums.fill(0.0);
            &mut sums[..count]
        });
        let mut pair = 0;
        for (j, [a, b]) in self.vectors.iter().enumerate() {
            for (k, [d, e]) in self.vectors[..=j].iter().enumerate() {
                let both = if k == j { 1.0 } else { 2.0 };
                let [m, n, o, p, q] = self.matrices.map(|matrix| {
                    let power = &matrix.pairs[pair];
                    [power.real[self.bin], power.imaginary[self.bin]]
                });
                pair += 1;
                let (a, b, d, e) = (&a[..count], &b[..count], &d[..count], &e[..count]);
                // A loop, since closures in iterators would not be vectorised.
                for i in 0..count {
                    let (x, y) = (a[i] * d[i] + b[i] * e[i], a[i] * e[i] - b[i] * d[i]);
                    first[i] += both * (x * m[0] - y * m[1]);
                    second[i] += both * (x * n[0] - y * n[1]);
                    third[i] += both * (x * o[0] - y * o[1]);
                    fourth[i] += both * (x * p[0] - y * p[1]);
                    fifth[i] += both * (x * q[0] - y * q[1]);
                }
            }
        }
    }
}

#[cfg(target_arch = "x86_64")]
impl NullaryFnOnce for Forms<'_> {
    type Output = ();

    #[inline(always)]
    fn call(self) {
        self.run();
    }
}

/// Neighbouring frequencies on either side, as distances.
pub(super) struct Neighbours {
    padding: f64,
    nearest: usize,
    farthest: usize,
}

impl Neighbours {
    /// For a piece of `count` equations, padded to `bins` frequencies, within the band of
    /// `cosines`.
    pub(super) fn new(count: usize, bins: usize, cosines: usize) -> Self {
        let padding = 2.0 * bins.saturating_sub(1) as f64 / count.max(1) as f64;
        let reach = 0.5 * cosines as f64 * padding;
        Self {
            padding,
            nearest: (0.5 * padding).ceil() as usize,
            farthest: (reach.ceil() as usize).max(1),
        }
    }

    /// Number of frequencies per independent value.
    pub(super) const fn padding(&self) -> f64 {
        self.padding
    }

    /// Means of the neighbours around each frequency, corrected for the fit's removal.
    pub(super) fn means(&self, powers: &Powers, taken: &Powers) -> Powers {
        let lines = powers.lines;
        let left: Vec<Vec<f64>> = (0..lines)
            .map(|j| {
                let own = &taken.pair(j, j).real;
                own.iter().map(|part| 1.0 - part.min(1.0)).collect()
            })
            .collect();
        let below = (0..lines).flat_map(|j| (0..=j).map(move |k| (j, k)));
        let pairs = below.map(|(j, k)| {
            let weights = left[j].iter().zip(&left[k]).map(|(a, b)| (a * b).sqrt());
            self.mean(powers.pair(j, k), &weights.collect::<Vec<_>>())
        });
        Powers {
            lines,
            pairs: pairs.collect(),
        }
    }

    /// Sum of the neighbours' values divided by the sum of their weights.
    fn mean(&self, power: &Spectrum, weights: &[f64]) -> Spectrum {
        let bins = weights.len();
        // Frequencies beyond either end are the conjugates of those inside.
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
            let own = [power.real[bin], sign * power.imaginary[bin], weights[bin]];
            let last = sums[sums.len() - 1];
            sums.push([0, 1, 2].map(|part| last[part] + own[part]));
        }
        let between = |from: isize, to: isize| -> [f64; 3] {
            let place = |bin: isize| (bin - first) as usize;
            [0, 1, 2].map(|part| sums[place(to) + 1][part] - sums[place(from)][part])
        };
        let (near, far) = (self.nearest as isize, self.farthest as isize);
        let mean = |bin: usize| {
            let bin = bin as isize;
            let before = between(bin - far, bin - near);
            let after = between(bin + near, bin + far);
            let [x, y, weight] = [0, 1, 2].map(|part| before[part] + after[part]);
            (x / weight, y / weight)
        };
        let (real, imaginary) = (0..bins).map(mean).unzip();
        Spectrum { real, imaginary }
    }
}

#[cfg(test)]
mod tests {
    use super::{FORMS, Forms, Neighbours, Powers};
    use crate::estimation::fourier::Spectrum;
    use nalgebra::Complex;

    const BINS: usize = 9;

    /// The residual of a line.
    fn line(residual: impl Fn(f64) -> [f64; 2]) -> Vec<Spectrum> {
        let parts = || (0..BINS).map(|bin| residual(bin as f64));
        vec![Spectrum {
            real: parts().map(|[real, _]| real).collect(),
            imaginary: parts().map(|[_, imaginary]| imaginary).collect(),
        }]
    }

    /// Mean of ρ_a ρ_b* around a frequency by definition, on the circle of frequencies.
    fn mean(
        neighbours: &Neighbours,
        a: &Spectrum,
        b: &Spectrum,
        taken: [fn(f64) -> f64; 2],
        bin: usize,
    ) -> Complex<f64> {
        let size = 2 * (BINS as isize - 1);
        let (mut sum, mut weight) = (Complex::ZERO, 0.0);
        for distance in neighbours.nearest as isize..=neighbours.farthest as isize {
            for place in [bin as isize - distance, bin as isize + distance] {
                let place = place.rem_euclid(size);
                let inside = place.min(size - place) as usize;
                let of = |line: &Spectrum| {
                    let (x, y) = (line.real[inside], line.imaginary[inside]);
                    Complex::new(x, if inside as isize == place { y } else { -y })
                };
                sum += of(a) * of(b).conj();
                let left = taken.map(|taken| 1.0 - taken(inside as f64));
                weight += (left[0] * left[1]).sqrt();
            }
        }
        sum / weight
    }

    #[test]
    fn neighbouring_frequencies_are_averaged_cyclically() {
        // The ends are their own conjugates, so the transform of real numbers is real there.
        let imaginary = |bin: f64| bin * (bin - (BINS - 1) as f64);
        let residuals = [
            line(|k| [1.0 + k * k, 0.3 * imaginary(k)]),
            line(|k| [5.0 - 2.0 * k, 0.7 * imaginary(k)]),
        ];
        let parts: [fn(f64) -> f64; 2] = [|k| 0.02 * k, |k| 0.5 - 0.03 * k];
        let taken = Powers::from_fn(2, BINS, |j, k, bin| {
            let own = if j == k { parts[j](bin as f64) } else { 0.0 };
            [own, 0.0]
        });
        let powers = Powers::new(&residuals, BINS);
        for (nearest, farthest) in [(1, 1), (1, 3), (2, 8)] {
            let neighbours = Neighbours {
                padding: 2.0,
                nearest,
                farthest,
            };
            let means = neighbours.means(&powers, &taken);
            for (j, k) in [(0, 0), (1, 0), (1, 1)] {
                let power = means.pair(j, k);
                let taken = [j, k].map(|j| parts[j]);
                for bin in 0..BINS {
                    let expected =
                        mean(&neighbours, &residuals[j][0], &residuals[k][0], taken, bin);
                    let found = Complex::new(power.real[bin], power.imaginary[bin]);
                    let miss = (found - expected).norm() / expected.norm().max(1.0);
                    assert!(miss < 1e-12, "{bin}: {found} is not {expected}");
                }
            }
        }
    }

    #[test]
    fn the_power_of_a_sum_of_lines_is_the_square_of_the_sum() {
        let residuals = [
            line(|k| [1.0 + k * k, 0.3 * k]),
            line(|k| [5.0 - 2.0 * k, k - 3.0]),
        ];
        let powers = Powers::new(&residuals, BINS);
        let c = [[0.3, -1.2], [2.0, 0.7]];
        for bin in 0..BINS {
            let sum: Complex<f64> = c
                .iter()
                .zip(&residuals)
                .map(|([a, b], line)| {
                    let rho = Complex::new(line[0].real[bin], line[0].imaginary[bin]);
                    Complex::new(*a, *b).conj() * rho
                })
                .sum();
            let parts = c.map(|both| both.map(|part| [part]));
            let vectors = parts
                .each_ref()
                .map(|both| both.each_ref().map(|part| &part[..]));
            let mut sums = [const { Vec::new() }; FORMS];
            sums.iter_mut().for_each(|own| own.push(f64::NAN));
            let forms = Forms {
                matrices: [&powers; FORMS],
                bin,
                vectors: &vectors,
                sums: &mut sums,
            };
            forms.evaluate();
            let found = sums[0][0];
            assert!(sums.iter().all(|own| own[..] == [found]), "{sums:?}");
            assert!((found - sum.norm_sqr()).abs() < 1e-12 * sum.norm_sqr());
        }
    }
}
