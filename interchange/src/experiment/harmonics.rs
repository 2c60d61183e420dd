//! Sums of sines about home, normalised to a known amplitude.

use super::Term;
use std::f64::consts::TAU;

/// Number of periods of the first harmonic in a run.
pub(super) const PERIODS: f64 = 5.0;
/// Relative amplitudes of the harmonics; higher ones are smaller to limit velocities.
const SIZES: [f64; 5] = [1.0, 0.7, 0.5, 0.35, 0.3];
/// Samples of a period for finding the largest value.
const INSTANTS: u32 = 360;

/// Sum of sines with largest magnitude 1.
#[derive(Debug, Clone)]
pub(super) struct Shape {
    /// Amplitude and phase (whole degrees) of each harmonic.
    harmonics: Vec<(f64, f64)>,
}

impl Shape {
    /// Shape of a coordinate in a run; phases are multiples of the golden ratio.
    ///
    /// Such phases are spread evenly for any number of harmonics.
    pub(super) fn new(coordinate: usize, run: usize) -> Self {
        let golden = 0.618_033_988_749_894_9;
        let raw = SIZES.iter().enumerate().map(|(at, size)| {
            let number = SIZES.len() * (super::RUNS * coordinate + run) + at + 1;
            #[allow(clippy::cast_precision_loss, reason = "a small whole number")]
            let turns = (golden * number as f64).fract();
            (*size, (360.0 * turns).round() - 180.0)
        });
        let mut own = Self {
            harmonics: raw.collect(),
        };
        let values = (0..INSTANTS).map(|at| own.at(f64::from(at) / f64::from(INSTANTS)).0.abs());
        let whole = values.fold(0.0, f64::max);
        own.harmonics
            .iter_mut()
            .for_each(|(amplitude, _)| *amplitude /= whole);
        own
    }

    /// Value, first and second derivative at a fraction of the period.
    pub(super) fn at(&self, part: f64) -> (f64, f64, f64) {
        let mut sum = (0.0, 0.0, 0.0);
        let mut rate = 0.0;
        for (amplitude, phase) in &self.harmonics {
            rate += TAU;
            let (sine, cosine) = (rate * part + phase.to_radians()).sin_cos();
            sum.0 += amplitude * sine;
            sum.1 += amplitude * rate * cosine;
            sum.2 -= amplitude * rate * rate * sine;
        }
        sum
    }

    /// Terms of the description for an amplitude in rad or m.
    pub(super) fn terms(&self, name: &str, is_angle: bool, size: f64) -> Vec<Term> {
        let unit = if is_angle { size.to_degrees() } else { size };
        let term = |(at, (amplitude, phase)): (usize, &(f64, f64))| Term {
            coordinate: name.to_owned(),
            is_angle,
            harmonic: at + 1,
            amplitude: ready(amplitude * unit, 3),
            phase: *phase,
        };
        self.harmonics.iter().enumerate().map(term).collect()
    }
}

/// Rounds a number to `digits` significant digits.
pub(super) fn ready(value: f64, digits: usize) -> f64 {
    let text = format!("{value:.*e}", digits - 1);
    text.parse().unwrap_or(value)
}
