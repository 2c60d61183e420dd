//! The discrete Fourier transform of real signals, padded with zeros to a power of two.

use std::f64::consts::PI;

use nalgebra::DMatrix;
#[cfg(target_arch = "x86_64")]
use pulp::NullaryFnOnce;

/// A transform of one length, planned once.
#[derive(Debug, Clone)]
pub(crate) struct Fourier {
    size: usize,
    /// cos and sin of π k/half for k below half, for half = 1, 2, 4 … below size, one behind the other.
    cosines: Vec<f64>,
    sines: Vec<f64>,
}

impl Fourier {
    /// A transform that signals of `samples` values fit into twice, so that products of spectra are
    /// correlations without wrapping round.
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

    /// Length of the padded signals.
    pub(crate) const fn size(&self) -> usize {
        self.size
    }

    /// Number of frequencies from 0 to half the sampling frequency.
    pub(crate) const fn frequencies(&self) -> usize {
        self.size / 2 + 1
    }

    /// Real and imaginary parts of the spectra of two signals at all frequencies, Σ x_k exp(-i ω k).
    pub(crate) fn pair(&self, first: &[f64], second: &[f64]) -> [Spectrum; 2] {
        let mut real = vec![0.0; self.size];
        let mut imaginary = vec![0.0; self.size];
        real[..first.len()].copy_from_slice(first);
        imaginary[..second.len()].copy_from_slice(second);
        self.transform(&mut real, &mut imaginary);
        // The signals are the real and the imaginary part: even and odd parts of the spectrum.
        let empty = || Spectrum {
            real: Vec::with_capacity(self.frequencies()),
            imaginary: Vec::with_capacity(self.frequencies()),
        };
        let mut spectra = [empty(), empty()];
        for k in 0..self.frequencies() {
            let mirrored = (self.size - k) % self.size;
            let (a, b) = (real[k], imaginary[k]);
            let (c, d) = (real[mirrored], imaginary[mirrored]);
            spectra[0].real.push(0.5 * (a + c));
            spectra[0].imaginary.push(0.5 * (b - d));
            spectra[1].real.push(0.5 * (b + d));
            spectra[1].imaginary.push(0.5 * (c - a));
        }
        spectra
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

    /// Sums Σ_k x_k x_(k+l) of a signal with the given squared magnitudes, for lags l below `lags`.
    pub(crate) fn correlations(&self, squares: &[f64], lags: usize) -> Vec<f64> {
        let mut real = vec![0.0; self.size];
        let mut imaginary = vec![0.0; self.size];
        for (k, square) in squares.iter().enumerate().take(self.frequencies()) {
            real[k] = *square;
            real[(self.size - k) % self.size] = *square;
        }
        // Even in frequency: forwards and backwards are the same.
        self.transform(&mut real, &mut imaginary);
        real.truncate(lags);
        real.iter().map(|sum| sum / self.size as f64).collect()
    }

    /// The transform in place, radix two.
    fn transform(&self, real: &mut [f64], imaginary: &mut [f64]) {
        let bits = self.size.trailing_zeros();
        for k in 0..self.size {
            let mirrored = k.reverse_bits() >> (usize::BITS - bits);
            if k < mirrored {
                real.swap(k, mirrored);
                imaginary.swap(k, mirrored);
            }
        }
        let work = Butterflies {
            fourier: self,
            real,
            imaginary,
        };
        #[cfg(target_arch = "x86_64")]
        if let Some(simd) = pulp::x86::V3::try_new() {
            simd.vectorize(work);
            return;
        }
        work.run();
    }
}

/// The steps of a transform whose values have been put in order.
struct Butterflies<'a> {
    fourier: &'a Fourier,
    real: &'a mut [f64],
    imaginary: &'a mut [f64],
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
        let mut half = 1;
        while half < self.fourier.size {
            // The angles of the coarser steps stand before these, half - 1 in all.
            let cosines = &self.fourier.cosines[half - 1..2 * half - 1];
            let sines = &self.fourier.sines[half - 1..2 * half - 1];
            let (turns, parts) = ([cosines, sines], [&mut *self.real, &mut *self.imaginary]);
            // Short loops are unrolled where their length is known.
            match half {
                1 => step(turns, parts, 1),
                2 => step(turns, parts, 2),
                4 => step(turns, parts, 4),
                _ => step(turns, parts, half),
            }
            half *= 2;
        }
    }
}

/// Makes transforms of `2 half` values of pairs of those of `half`.
#[inline(always)]
fn step([cosines, sines]: [&[f64]; 2], [real, imaginary]: [&mut [f64]; 2], half: usize) {
    let (cosines, sines) = (&cosines[..half], &sines[..half]);
    let parts = real.chunks_exact_mut(2 * half);
    for (real, imaginary) in parts.zip(imaginary.chunks_exact_mut(2 * half)) {
        let (x, u) = real.split_at_mut(half);
        let (y, v) = imaginary.split_at_mut(half);
        // Loops: closures that iterators call would not be compiled for wide vectors.
        for k in 0..half {
            let a = cosines[k] * u[k] + sines[k] * v[k];
            let b = cosines[k] * v[k] - sines[k] * u[k];
            (u[k], v[k]) = (x[k] - a, y[k] - b);
            x[k] += a;
            y[k] += b;
        }
    }
}

/// The spectrum of a real signal from frequency 0 to half the sampling frequency.
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
    use std::f64::consts::PI;

    #[test]
    fn spectra_and_correlations_are_those_of_the_definitions() {
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
