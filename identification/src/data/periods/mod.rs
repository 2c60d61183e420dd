//! A run of periodic motion as repetitions of one period.
//!
//! The mean of the other periods at the same phase follows the measured motion but not its errors,
//! if errors of different periods are independent. They are not if the error is a function of the
//! position, such as steps or eccentricity of an encoder.
//!
//! Periodic errors cannot be distinguished from the motion at its own frequencies, but above them.
//! There the fourth differences of a smooth motion are much smaller than those of noise. With the
//! fourth differences d_k of N periods, the correlation of the errors of two periods is
//!
//! ```text
//! ρ = (|Σ_k d_k|²/Σ_k |d_k|² - 1)/(N - 1).
//! ```
//!
//! Phases are compared at samples, so a period needs a whole number of them. Otherwise several
//! periods together may have one.

mod find;
mod returns;

pub(crate) use returns::{PeriodicMotion, returns};

use super::Log;
use crate::error::{Error, Problem};
use overact::Code;

/// Largest number of periods combined for a whole number of samples.
const MOST_TOGETHER: usize = 10;

/// Largest phase error of the last period, in samples.
const LARGEST_DRIFT: f64 = 0.05;

/// Largest number of values of a period (16 MB), which bounds memory.
const LARGEST_PERIOD: usize = 1 << 21;

/// Largest difference between periods, by the motion's variance.
const LARGEST_DIFFERENCE: f64 = 1e-3;

/// Fourth differences of numbers of size one that are rounding errors.
const ROUNDING: f64 = 1e-14;

/// Periods of a run.
#[derive(Debug, Clone, PartialEq)]
#[non_exhaustive]
pub struct Periods {
    /// Samples of a period.
    pub samples: usize,
    /// Number of whole periods.
    pub count: usize,
    /// ρ: correlation of the errors of two periods; `None` if the positions have no noise.
    pub correlation: Option<f64>,
    /// Difference between the periods, by the motion's variance.
    pub difference: f64,
    /// Number of actuators.
    width: usize,
    /// Sums over all periods at each phase, samples × n.
    sums: Vec<f64>,
    /// Number of values in each sum.
    counts: Vec<u32>,
}

/// Periods of a run with a given `period` (s), or one to be found.
///
/// # Errors
/// A run of fewer than two periods, or a motion that is not periodic.
pub(crate) fn periods(log: &Log, period: Option<f64>) -> Result<Periods, Error> {
    let samples = match period {
        Some(period) => together(log, period)?,
        None => find::period(log)?.ok_or_else(|| {
            Problem::new(Code::PERIODS, "no period of the motion was found")
                .file(log.name())
                .help("record at least two periods, or give `period` if the motion is periodic")
        })?,
    };
    let periods = gathered(log, samples)?;
    if periods.difference > LARGEST_DIFFERENCE {
        return Err(Problem::new(Code::PERIODS, format!(
            "the motion does not repeat after {:.6} s: the periods differ by {:.1} % of the motion",
            samples as f64 / log.sampling_frequency(),
            100.0 * periods.difference.sqrt()
        ))
        .file(log.name())
        .help("correct `period`, or start the run when the motion has settled")
        .into());
    }
    Ok(periods)
}

/// Samples of the shortest multiple of `period` (s) with a whole number of samples.
fn together(log: &Log, period: f64) -> Result<usize, Error> {
    let problem = |text: String, help: &str| {
        let problem = Problem::new(Code::PERIODS, text)
            .file(log.name())
            .help(help);
        Err(Error::from(problem))
    };
    let one = period * log.sampling_frequency();
    let half = log.samples() / 2;
    if !(one.is_finite() && one >= 1.0) {
        return problem(
            format!("a period of {period} s is not possible"),
            "give it in seconds, a sampling interval at least",
        );
    }
    if one.round() > half as f64 {
        return problem(
            format!("the run has fewer than two periods of {period} s"),
            "record at least two periods",
        );
    }
    let whole = (1..=MOST_TOGETHER).find_map(|count| {
        let samples = count as f64 * one;
        let drift = (samples - samples.round()).abs() * log.samples() as f64 / samples;
        let fits = drift <= LARGEST_DRIFT && samples.round() <= half as f64;
        fits.then_some(samples.round() as usize)
    });
    if let Some(samples) = whole.filter(|samples| samples * log.actuators() > LARGEST_PERIOD) {
        return problem(
            format!("a period of {period} s has {samples} samples: too many for the memory"),
            "log it at a lower frequency, or choose another source of `instruments`",
        );
    }
    whole.map_or_else(
        || {
            problem(
                format!("a period of {period} s is {one:.4} samples: no number of periods up to {MOST_TOGETHER} is a whole number of samples and occurs in the run twice"),
                "choose a period that is a multiple of the sampling interval, or record longer",
            )
        },
        Ok,
    )
}

/// Reads a run once to sum its periods.
fn gathered(log: &Log, samples: usize) -> Result<Periods, Error> {
    let n = log.actuators();
    let count = log.samples() / samples;
    let mut sums = vec![0.0; samples * n];
    let mut counts = vec![0; samples];
    let mut origin: Vec<f64> = Vec::new();
    let (mut squares, mut totals) = (vec![0.0; n], vec![0.0; n]);
    let mut tail = Differences::new(n);
    // Fourth differences of whole periods: their squares, and their sums at each phase.
    let (mut own, mut together) = (vec![0.0; n], vec![0.0; samples * n]);
    let mut reader = log.reader()?;
    let mut sample = 0;
    while let Some(block) = reader.next()? {
        for row in block.positions.chunks_exact(n) {
            if origin.is_empty() {
                origin = row.to_vec();
            }
            let phase = sample % samples;
            counts[phase] += 1;
            let differences = tail.next(row);
            for i in 0..n {
                let value = row[i] - origin[i];
                sums[phase * n + i] += row[i];
                squares[i] += value * value;
                totals[i] += value;
                if let (Some(d), true) = (&differences, sample < count * samples) {
                    own[i] += d[i] * d[i];
                    together[phase * n + i] += d[i];
                }
            }
            sample += 1;
        }
    }
    let mut periods = Periods {
        samples,
        count,
        correlation: None,
        difference: 0.0,
        width: n,
        sums,
        counts,
    };
    periods.difference = periods.differ(&origin, &squares, &totals, sample);
    let size = origin.iter().fold(1.0_f64, |size, q| size.max(q.abs()));
    let floor = (ROUNDING * size).powi(2) * (count * samples) as f64;
    periods.correlation = correlation(&own, &together, count, floor);
    Ok(periods)
}

/// ρ over all actuators, each scaled by its own noise.
fn correlation(own: &[f64], together: &[f64], count: usize, floor: f64) -> Option<f64> {
    let n = own.len();
    let noisy: Vec<usize> = (0..n).filter(|&i| own[i] > floor).collect();
    let ratio = |i: &usize| {
        let sum: f64 = together[*i..].iter().step_by(n).map(|d| d * d).sum();
        (sum / own[*i] - 1.0) / (count as f64 - 1.0)
    };
    let total: f64 = noisy.iter().map(ratio).sum();
    (!noisy.is_empty() && count > 1).then(|| total / noisy.len() as f64)
}

impl Periods {
    /// Difference between periods by the motion's variance, for the actuator with the largest one.
    fn differ(&self, origin: &[f64], squares: &[f64], totals: &[f64], samples: usize) -> f64 {
        let n = self.width;
        let of = |i: usize| {
            let rows = self.sums[i..].iter().step_by(n).zip(&self.counts);
            let between: f64 = rows
                .map(|(sum, count)| {
                    let count = f64::from(*count);
                    (sum - count * origin[i]).powi(2) / count
                })
                .sum();
            let variance = squares[i] - totals[i] * totals[i] / samples as f64;
            if variance > 0.0 {
                (squares[i] - between).max(0.0) / variance
            } else {
                0.0
            }
        };
        (0..n).map(of).fold(0.0, f64::max)
    }
}

/// Fourth differences of successive rows.
struct Differences {
    /// Differences of orders 0 to 3 that end with the last row.
    last: [Vec<f64>; 4],
    taken: usize,
}

impl Differences {
    fn new(width: usize) -> Self {
        Self {
            last: std::array::from_fn(|_| vec![0.0; width]),
            taken: 0,
        }
    }

    /// The fourth differences that end with a row; `None` for the first four rows.
    fn next(&mut self, row: &[f64]) -> Option<Vec<f64>> {
        let mut difference = row.to_vec();
        for last in &mut self.last {
            for (now, last) in difference.iter_mut().zip(last) {
                let before = *last;
                *last = *now;
                *now -= before;
            }
        }
        self.taken += 1;
        (self.taken > self.last.len()).then_some(difference)
    }
}

/// Replaces positions by those of the other periods, block by block.
#[derive(Debug)]
pub(super) struct Others<'a> {
    periods: &'a Periods,
    /// Number of the next sample.
    sample: usize,
}

impl<'a> Others<'a> {
    pub(super) const fn new(periods: &'a Periods) -> Self {
        Self { periods, sample: 0 }
    }

    /// Replaces the positions of the next samples.
    pub(super) fn replace(&mut self, positions: &mut [f64]) {
        let n = self.periods.width;
        for row in positions.chunks_exact_mut(n) {
            let phase = self.sample % self.periods.samples;
            let others = f64::from(self.periods.counts[phase]) - 1.0;
            for (i, value) in row.iter_mut().enumerate() {
                *value = (self.periods.sums[phase * n + i] - *value) / others;
            }
            self.sample += 1;
        }
    }
}

#[cfg(test)]
mod tests;
