//! Anti-aliasing low-pass filter before a rate is lowered.
//!
//! It is a sinc with Kaiser window: finite length, zero phase. In units of the new rate, it passes
//! frequencies below 0.4 and attenuates those above 0.6 by 80 dB. Nothing aliases to below 0.4.

/// Half length of the kernel, in steps of the new rate.
pub(super) const HALF_LENGTH: f64 = 13.0;

/// Kaiser's β for 80 dB: 0.1102 (80 - 8.7).
const BETA: f64 = 7.857;

/// Tabulated values of the kernel per step of the new rate, linearly interpolated.
const RESOLUTION: usize = 1024;

/// One half of the symmetric kernel, starting at the centre.
#[derive(Debug)]
pub(super) struct Kernel(Vec<f64>);

impl Kernel {
    pub(super) fn new() -> Self {
        let count = HALF_LENGTH as usize * RESOLUTION;
        let value = |k: usize| {
            let x = k as f64 / RESOLUTION as f64;
            let part = x / HALF_LENGTH;
            let window = bessel(BETA * (1.0 - part * part).max(0.0).sqrt()) / bessel(BETA);
            let angle = std::f64::consts::PI * x;
            if k == 0 {
                window
            } else {
                window * angle.sin() / angle
            }
        };
        // It is zero beyond the end.
        Self((0..=count).map(value).chain([0.0, 0.0]).collect())
    }

    /// Value of the kernel at a distance from its centre, in steps of the new rate.
    pub(super) fn at(&self, x: f64) -> f64 {
        let place = x.abs() * RESOLUTION as f64;
        let index = (place as usize).min(self.0.len() - 2);
        let part = (place - index as f64).min(1.0);
        self.0[index] + part * (self.0[index + 1] - self.0[index])
    }
}

/// Modified Bessel function of the first kind and order zero, by its series.
fn bessel(x: f64) -> f64 {
    let quarter = 0.25 * x * x;
    let (mut sum, mut term) = (1.0, 1.0);
    for k in 1..60 {
        term *= quarter / f64::from(k * k);
        sum += term;
    }
    sum
}

#[cfg(test)]
mod tests {
    use std::f64::consts::TAU;

    use super::{HALF_LENGTH, Kernel};

    #[test]
    fn the_kernel_passes_low_and_stops_high_frequencies() {
        let kernel = Kernel::new();
        // Ten samples in a step of the new rate.
        let taps: Vec<f64> = (-130..=130).map(|k| f64::from(k) / 10.0).collect();
        assert_eq!(taps[0], -HALF_LENGTH);
        let sum: f64 = taps.iter().map(|x| kernel.at(*x)).sum();
        let gain = |frequency: f64| {
            let parts = taps
                .iter()
                .map(|x| kernel.at(*x) * (TAU * frequency * x).cos());
            parts.sum::<f64>() / sum
        };
        for k in 0..=40 {
            let frequency = f64::from(k) / 100.0;
            assert!(
                (gain(frequency) - 1.0).abs() < 2e-4,
                "{frequency}: {}",
                gain(frequency)
            );
        }
        for k in 60..=500 {
            let frequency = f64::from(k) / 100.0;
            assert!(
                gain(frequency).abs() < 2e-4,
                "{frequency}: {}",
                gain(frequency)
            );
        }
        assert!((gain(0.5) - 0.5).abs() < 0.01);
    }
}
