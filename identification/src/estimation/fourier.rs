//! Discrete Fourier transform of real signals, zero-padded to a power of two.

use std::f64::consts::PI;

use nalgebra::DMatrix;
#[cfg(target_arch = "x86_64")]
use pulp::NullaryFnOnce;

/// Transform of one length, with its twiddle factors.
#[derive(Debug, Clone)]
pub(crate) struct Fourier {
    size: usize,
    /// cos and sin of π k/half for k < half, concatenated for half = 1, 2, 4 … below size.
    cosines: Vec<f64>,
    sines: Vec<f64>,
}

impl Fourier {
    /// A transform of at least twice `samples` values.
    ///
    /// The zero padding makes products of spectra linear correlations.
    pub(crate) fn for_correlation(samples: usize) -> Self {
        let size = (2 * samples.max(1)).next_power_of_two();
        let turn = |k: usize| {
            let angle = 2.0 * PI * k as f64 / size as f64;
            (angle.cos(), angle.sin())
        };
        let finest: Vec<(f64, f64)> = (0..size / 2).map(turn).collect();
        let halves = (0..size.trailing_zeros()).map(|bit| 1_usize << bit);
        let turns = halves.flat_map(|half| {
            let stride = size / (2 * half);
            finest.iter().step_by(stride).take(half).copied()
        });
        let (cosines, sines) = turns.unzip();
        Self {
            size,
            cosines,
            sines,
        }
    }

    /// A transform of periodic signals of `size` values, a power of two.
    pub(crate) fn circular(size: usize) -> Self {
        debug_assert!(size.is_power_of_two() && size > 1);
        Self::for_correlation(size / 2)
    }

    /// Real and imaginary parts of the spectra of whole periods, without padding.
    ///
    /// Input: values × signals; output: frequencies × signals.
    pub(crate) fn whole(&self, signals: &DMatrix<f64>) -> [DMatrix<f64>; 2] {
        let (last, count) = (self.size / 2, signals.ncols());
        let mut parts = [
            DMatrix::zeros(last + 1, count),
            DMatrix::zeros(last + 1, count),
        ];
        for first in (0..count).step_by(2) {
            // Two signals form one complex signal; their spectra are its even and odd parts.
            let column = |index: usize| {
                if index < count {
                    signals.column(index).iter().copied().collect()
                } else {
                    vec![0.0; self.size]
                }
            };
            let (mut real, mut imaginary) = (column(first), column(first + 1));
            self.transform(&mut real, &mut imaginary);
            for k in 0..=last {
                let mirrored = (self.size - k) % self.size;
                let (a, b) = (real[k], imaginary[k]);
                let (c, d) = (real[mirrored], imaginary[mirrored]);
                let own = [
                    [0.5 * (a + c), 0.5 * (b - d)],
                    [0.5 * (b + d), 0.5 * (c - a)],
                ];
                for (index, [re, im]) in own.into_iter().enumerate() {
                    if first + index < count {
                        parts[0][(k, first + index)] = re;
                        parts[1][(k, first + index)] = im;
                    }
                }
            }
        }
        parts
    }

    /// Length of the padded signals.
    pub(crate) const fn size(&self) -> usize {
        self.size
    }

    /// Number of frequencies from 0 to half the sampling frequency.
    pub(crate) const fn frequencies(&self) -> usize {
        self.size / 2 + 1
    }

    /// Spectra of two signals at all frequencies, Σ x_k exp(-i ω k).
    pub(crate) fn pair(&self, first: &[f64], second: &[f64]) -> [Spectrum; 2] {
        let (mut real, mut imaginary) = (self.started(first), self.started(second));
        self.finish(&mut real, &mut imaginary, 2);
        // The signals form one complex signal; their spectra are its even and odd parts.
        let parts = |values: &[f64], of: fn(f64, f64) -> f64| {
            let half = self.size / 2;
            let mut parts = Vec::with_capacity(half + 1);
            parts.push(of(values[0], values[0]));
            let mirrored = values[half..].iter().rev();
            let pairs = values[1..=half].iter().zip(mirrored);
            parts.extend(pairs.map(|(own, mirrored)| of(*own, *mirrored)));
            parts
        };
        let even: fn(f64, f64) -> f64 = |own, mirrored| 0.5 * (own + mirrored);
        [
            Spectrum {
                real: parts(&real, even),
                imaginary: parts(&imaginary, |own, mirrored| 0.5 * (own - mirrored)),
            },
            Spectrum {
                real: parts(&imaginary, even),
                imaginary: parts(&real, |own, mirrored| 0.5 * (mirrored - own)),
            },
        ]
    }

    /// Copies a padded signal in bit-reversed order and performs the first step.
    ///
    /// The other value of each pair is a zero of the padding.
    fn started(&self, signal: &[f64]) -> Vec<f64> {
        debug_assert!(2 * signal.len() <= self.size);
        let mut values = Vec::with_capacity(self.size);
        let shift = usize::BITS - self.size.trailing_zeros();
        for place in (0..self.size).step_by(2) {
            let value = signal.get(place.reverse_bits() >> shift);
            values.extend([value.copied().unwrap_or(0.0); 2]);
        }
        values
    }

    /// The spectrum of one signal.
    pub(crate) fn single(&self, signal: &[f64]) -> Spectrum {
        let [spectrum, _] = self.pair(signal, &[]);
        spectrum
    }

    /// The spectra of the columns of a matrix.
    pub(crate) fn columns(&self, signals: &DMatrix<f64>) -> Vec<Spectrum> {
        let count = signals.nrows().max(1);
        let pairs = signals.as_slice().chunks(2 * count);
        let spectra = pairs.flat_map(|pair| {
            let (first, second) = pair.split_at(count.min(pair.len()));
            self.pair(first, second)
        });
        spectra.take(signals.ncols()).collect()
    }

    /// Autocorrelations Σ_k x_k x_(k+l) for lags l < `lags`, from the power spectrum.
    pub(crate) fn correlations(&self, squares: &[f64], lags: usize) -> Vec<f64> {
        let mut real = vec![0.0; self.size];
        let mut imaginary = vec![0.0; self.size];
        for (k, square) in squares.iter().enumerate().take(self.frequencies()) {
            real[k] = *square;
            real[(self.size - k) % self.size] = *square;
        }
        // The spectrum is even, so the inverse transform equals the forward one.
        self.transform(&mut real, &mut imaginary);
        real.truncate(lags);
        real.iter().map(|sum| sum / self.size as f64).collect()
    }

    /// cos and sin of π k/half for k < half.
    #[inline(always)]
    fn turns(&self, half: usize) -> Turns<'_> {
        // The half - 1 angles of the smaller steps come first.
        let range = half - 1..2 * half - 1;
        Turns {
            cosines: &self.cosines[range.clone()],
            sines: &self.sines[range],
        }
    }

    /// In-place radix-2 transform.
    fn transform(&self, real: &mut [f64], imaginary: &mut [f64]) {
        let bits = self.size.trailing_zeros();
        for k in 0..self.size {
            let mirrored = k.reverse_bits() >> (usize::BITS - bits);
            if k < mirrored {
                real.swap(k, mirrored);
                imaginary.swap(k, mirrored);
            }
        }
        self.finish(real, imaginary, 1);
    }

    /// The steps from transforms of `half` values upwards.
    fn finish(&self, real: &mut [f64], imaginary: &mut [f64], half: usize) {
        let work = Butterflies {
            fourier: self,
            real,
            imaginary,
            half,
        };
        #[cfg(target_arch = "x86_64")]
        if let Some(simd) = pulp::x86::V3::try_new() {
            simd.vectorize(work);
            return;
        }
        work.run();
    }
}

/// cos and sin of the angles of a step.
#[derive(Clone, Copy)]
struct Turns<'a> {
    cosines: &'a [f64],
    sines: &'a [f64],
}

/// Steps of a transform after bit reversal.
struct Butterflies<'a> {
    fourier: &'a Fourier,
    real: &'a mut [f64],
    imaginary: &'a mut [f64],
    /// Length of the finished transforms.
    half: usize,
}

#[cfg(target_arch = "x86_64")]
impl NullaryFnOnce for Butterflies<'_> {
    type Output = ();

    #[inline(always)]
    fn call(self) {
        self.run();
    }
}

impl Butterflies<'_> {
    #[inline(always)]
    fn run(self) {
        let Self {
            fourier,
            real,
            imaginary,
            mut half,
        } = self;
        let steps = (fourier.size / half).trailing_zeros();
        if steps % 2 == 1 {
            match half {
                1 => step(fourier.turns(1), real, imaginary, 1),
                2 => step(fourier.turns(2), real, imaginary, 2),
                _ => step(fourier.turns(half), real, imaginary, half),
            }
            half *= 2;
        }
        // Two steps in one pass over the memory.
        while half < fourier.size {
            let (inner, outer) = (fourier.turns(half), fourier.turns(2 * half));
            // Constant lengths let the compiler unroll short loops.
            match half {
                1 => two_steps(inner, outer, real, imaginary, 1),
                2 => two_steps(inner, outer, real, imaginary, 2),
                4 => two_steps(inner, outer, real, imaginary, 4),
                _ => two_steps(inner, outer, real, imaginary, half),
            }
            half *= 4;
        }
    }
}

/// Combines pairs of transforms of `half` values.
#[inline(always)]
fn step(turns: Turns<'_>, real: &mut [f64], imaginary: &mut [f64], half: usize) {
    let (cosines, sines) = (&turns.cosines[..half], &turns.sines[..half]);
    let parts = real.chunks_exact_mut(2 * half);
    for (real, imaginary) in parts.zip(imaginary.chunks_exact_mut(2 * half)) {
        let (x, u) = real.split_at_mut(half);
        let (y, v) = imaginary.split_at_mut(half);
        // Loops, since closures in iterators would not be vectorised.
        for k in 0..half {
            let a = cosines[k] * u[k] + sines[k] * v[k];
            let b = cosines[k] * v[k] - sines[k] * u[k];
            (u[k], v[k]) = (x[k] - a, y[k] - b);
            x[k] += a;
            y[k] += b;
        }
    }
}

/// Combines four transforms of `half` values, equivalent to two steps.
#[inline(always)]
fn two_steps(
    inner: Turns<'_>,
    outer: Turns<'_>,
    real: &mut [f64],
    imaginary: &mut [f64],
    half: usize,
) {
    let (inner_cosines, inner_sines) = (&inner.cosines[..half], &inner.sines[..half]);
    let (cosines, more_cosines) = outer.cosines[..2 * half].split_at(half);
    let (sines, more_sines) = outer.sines[..2 * half].split_at(half);
    let parts = real.chunks_exact_mut(4 * half);
    for (real, imaginary) in parts.zip(imaginary.chunks_exact_mut(4 * half)) {
        let [x, u, p, q] = quarters(real, half);
        let [y, v, r, s] = quarters(imaginary, half);
        for k in 0..half {
            let (c, d) = (inner_cosines[k], inner_sines[k]);
            let turned = |c: f64, d: f64, re: f64, im: f64| (c * re + d * im, c * im - d * re);
            let (a, b) = turned(c, d, u[k], v[k]);
            let (first, second) = ((x[k] + a, y[k] + b), (x[k] - a, y[k] - b));
            let (a, b) = turned(c, d, q[k], s[k]);
            let (third, fourth) = ((p[k] + a, r[k] + b), (p[k] - a, r[k] - b));
            let (a, b) = turned(cosines[k], sines[k], third.0, third.1);
            (x[k], y[k]) = (first.0 + a, first.1 + b);
            (p[k], r[k]) = (first.0 - a, first.1 - b);
            let (a, b) = turned(more_cosines[k], more_sines[k], fourth.0, fourth.1);
            (u[k], v[k]) = (second.0 + a, second.1 + b);
            (q[k], s[k]) = (second.0 - a, second.1 - b);
        }
    }
}

/// Splits into four parts of equal length.
#[inline(always)]
fn quarters(values: &mut [f64], quarter: usize) -> [&mut [f64]; 4] {
    let (front, back) = values.split_at_mut(2 * quarter);
    let (first, second) = front.split_at_mut(quarter);
    let (third, fourth) = back.split_at_mut(quarter);
    [first, second, third, &mut fourth[..quarter]]
}

/// Spectrum of a real signal from frequency 0 to half the sampling frequency.
#[derive(Debug, Clone, PartialEq, Default)]
pub(crate) struct Spectrum {
    pub(crate) real: Vec<f64>,
    pub(crate) imaginary: Vec<f64>,
}

impl Spectrum {
    /// Squared magnitudes.
    pub(crate) fn squares(&self) -> impl Iterator<Item = f64> {
        let parts = self.real.iter().zip(&self.imaginary);
        parts.map(|(a, b)| a * a + b * b)
    }
}

#[cfg(test)]
mod tests {
    use super::{Fourier, Spectrum};
    use nalgebra::DMatrix;
    use std::f64::consts::PI;

    #[test]
    fn whole_period_spectra_match_the_definition() {
        let value = |row: usize, column: usize| ((row * row + 3 * column) as f64 * 0.7).sin();
        let signals = DMatrix::from_fn(16, 3, value);
        let [real, imaginary] = Fourier::circular(16).whole(&signals);
        assert_eq!(real.shape(), (9, 3));
        for (k, column) in (0..9).flat_map(|k| (0..3).map(move |column| (k, column))) {
            let sum = |part: fn(f64) -> f64| -> f64 {
                let angle = |i: usize| 2.0 * PI * (i * k) as f64 / 16.0;
                (0..16).map(|i| signals[(i, column)] * part(angle(i))).sum()
            };
            assert!((real[(k, column)] - sum(f64::cos)).abs() < 1e-13);
            assert!((imaginary[(k, column)] + sum(f64::sin)).abs() < 1e-13);
        }
    }

    #[test]
    fn spectra_and_correlations_match_the_definitions() {
        let x: Vec<f64> = (0..13).map(|k| (f64::from(k * k) * 0.7).sin()).collect();
        let y: Vec<f64> = (0..11).map(|k| (f64::from(k) * 1.3).cos()).collect();
        let fourier = Fourier::for_correlation(x.len());
        assert_eq!((fourier.size(), fourier.frequencies()), (32, 17));
        let direct = |signal: &[f64]| {
            let sum = |k: usize, part: fn(f64) -> f64| -> f64 {
                let angle = |i: usize| 2.0 * PI * (i * k) as f64 / 32.0;
                signal
                    .iter()
                    .enumerate()
                    .map(|(i, x)| x * part(angle(i)))
                    .sum()
            };
            Spectrum {
                real: (0..17).map(|k| sum(k, f64::cos)).collect(),
                imaginary: (0..17).map(|k| -sum(k, f64::sin)).collect(),
            }
        };
        let close = |a: &[f64], b: &[f64]| {
            assert_eq!(a.len(), b.len());
            assert!(
                a.iter().zip(b).all(|(a, b)| (a - b).abs() < 1e-13),
                "{a:?} {b:?}"
            );
        };
        for (found, expected) in fourier.pair(&x, &y).iter().zip([direct(&x), direct(&y)]) {
            close(&found.real, &expected.real);
            close(&found.imaginary, &expected.imaginary);
        }
        let squares: Vec<f64> = fourier.single(&x).squares().collect();
        let sums: Vec<f64> = (0..5)
            .map(|lag| x.iter().zip(&x[lag..]).map(|(a, b)| a * b).sum())
            .collect();
        close(&fourier.correlations(&squares, 5), &sums);
    }
}
