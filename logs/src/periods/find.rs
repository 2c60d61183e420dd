//! Finds the period of a motion.
//!
//! D(L) is the mean squared difference of positions to those L samples before, by their variance.
//! It is small at every multiple of the period. Minima are first searched on about two thousand
//! means, then refined sample by sample. If the period has no whole number of samples, the first
//! multiple that fits as well as the best is taken.

use super::Log;
use crate::error::Error;

/// Values at the start of a run in which the period is searched (4 MB).
const LARGEST_BEGINNING: usize = 1 << 19;

/// Number of means in the coarse search.
const MEANS: usize = 2048;

/// Shortest period, in means.
const SHORTEST: usize = 8;

/// Largest D of a minimum of the coarse search.
const LARGEST_COARSE: f64 = 0.1;

/// Largest D of a periodic motion.
const LARGEST_FINE: f64 = 1e-3;

/// Number of sample pairs for D.
const PAIRS: usize = 2000;

/// A lag is as good as the best if its D is at most this multiple.
const AS_GOOD: f64 = 2.0;

/// Samples of the period, or of its shortest multiple with a whole number of samples.
pub(super) fn period(log: &Log) -> Result<Option<usize>, Error> {
    let n = log.actuators();
    let motion = Motion::new(beginning(log, LARGEST_BEGINNING / n)?, n);
    let factor = motion.samples().div_ceil(MEANS).max(1);
    let coarse = Motion::new(motion.means(factor), n);
    let last = coarse.samples() / 2;
    let lags: Vec<f64> = (0..=last + 1)
        .map(|lag| coarse.difference(lag, usize::MAX))
        .collect();
    let minimum = |lag: &usize| {
        let here = lags[*lag];
        here < LARGEST_COARSE && here <= lags[lag - 1] && here <= lags[lag + 1]
    };
    let found: Vec<(usize, f64)> = (SHORTEST..=last)
        .filter(minimum)
        .filter_map(|lag| motion.finest((lag - 1) * factor..=(lag + 1) * factor))
        .collect();
    let best = found.iter().map(|(_, d)| *d).fold(f64::INFINITY, f64::min);
    let fits = |(_, d): &&(usize, f64)| *d < LARGEST_FINE && *d <= AS_GOOD * best;
    Ok(found.iter().find(fits).map(|(lag, _)| *lag))
}

/// Whether two runs start with the same motion.
///
/// # Errors
/// A log that cannot be read.
pub(super) fn same(first: &Log, second: &Log) -> Result<bool, Error> {
    let n = first.actuators();
    let samples = (LARGEST_BEGINNING / n).min(first.samples());
    let samples = samples.min(second.samples());
    let (a, b) = (beginning(first, samples)?, beginning(second, samples)?);
    let count = a.len().min(b.len()) / n;
    let stride = (count / PAIRS).max(1);
    // Mean squared difference of each actuator by its variance.
    let part = |i: usize| {
        let rows = || (0..count).step_by(stride).map(|row| row * n + i);
        let taken = rows().count().max(1) as f64;
        let mean = rows().map(|place| a[place]).sum::<f64>() / taken;
        let spread: f64 = rows().map(|place| (a[place] - mean).powi(2)).sum();
        let apart: f64 = rows().map(|place| (a[place] - b[place]).powi(2)).sum();
        (spread > 0.0).then_some(0.5 * apart / spread)
    };
    let parts: Vec<f64> = (0..n).filter_map(part).collect();
    let moving = parts.len().max(1) as f64;
    Ok(!parts.is_empty() && parts.iter().sum::<f64>() / moving < LARGEST_FINE)
}

/// Positions of the first `samples` of a run.
fn beginning(log: &Log, samples: usize) -> Result<Vec<f64>, Error> {
    let wanted = samples.min(log.samples()) * log.actuators();
    let mut positions = Vec::with_capacity(wanted);
    let mut reader = log.reader()?;
    while positions.len() < wanted
        && let Some(block) = reader.next()?
    {
        let rest = wanted - positions.len();
        positions.extend(block.positions.into_iter().take(rest));
    }
    Ok(positions)
}

/// Standardised positions of all actuators: zero mean, unit variance.
struct Motion {
    values: Vec<f64>,
    width: usize,
}

impl Motion {
    fn new(mut values: Vec<f64>, width: usize) -> Self {
        let samples = (values.len() / width).max(1) as f64;
        let mut moving = 0_u32;
        for i in 0..width {
            let own = || values[i..].iter().step_by(width);
            let mean = own().sum::<f64>() / samples;
            let variance = own().map(|q| (q - mean).powi(2)).sum::<f64>() / samples;
            // An actuator at rest is ignored.
            let scale = if variance > 0.0 {
                moving += 1;
                variance.sqrt().recip()
            } else {
                0.0
            };
            let column = values[i..].iter_mut().step_by(width);
            column.for_each(|q| *q = (*q - mean) * scale);
        }
        let whole = f64::from(moving.max(1)).sqrt().recip();
        values.iter_mut().for_each(|q| *q *= whole);
        Self { values, width }
    }

    fn samples(&self) -> usize {
        self.values.len() / self.width
    }

    /// Means of `count` samples each.
    fn means(&self, count: usize) -> Vec<f64> {
        let mut means = Vec::new();
        for rows in self.values.chunks_exact(count * self.width) {
            for i in 0..self.width {
                let sum: f64 = rows[i..].iter().step_by(self.width).sum();
                means.push(sum / count as f64);
            }
        }
        means
    }

    /// D of a lag, from about `pairs` sample pairs.
    fn difference(&self, lag: usize, pairs: usize) -> f64 {
        let count = self.samples().saturating_sub(lag);
        if count == 0 {
            return f64::INFINITY;
        }
        let stride = (count / pairs).max(1);
        if stride == 1 {
            let values = &self.values[..count * self.width];
            let later = &self.values[lag * self.width..][..values.len()];
            return 0.5 * squared_distance(values, later) / count as f64;
        }
        let row = |sample: usize| &self.values[sample * self.width..(sample + 1) * self.width];
        let (mut sum, mut taken) = (0.0, 0);
        for sample in (0..count).step_by(stride) {
            let both = row(sample).iter().zip(row(sample + lag));
            sum += both.map(|(a, b)| (a - b).powi(2)).sum::<f64>();
            taken += 1;
        }
        0.5 * sum / f64::from(taken)
    }

    /// The lag with the smallest D, and D; the run must have two periods.
    fn finest(&self, lags: std::ops::RangeInclusive<usize>) -> Option<(usize, f64)> {
        lags.filter(|lag| *lag > 0 && 2 * lag <= self.samples())
            .map(|lag| (lag, self.difference(lag, PAIRS)))
            .min_by(|a, b| a.1.total_cmp(&b.1))
    }
}

/// Number of partial sums.
const SIDE_BY_SIDE: usize = 16;

/// Σ (a - b)² of two slices.
fn squared_distance(first: &[f64], second: &[f64]) -> f64 {
    let (own, rest) = first.as_chunks::<SIDE_BY_SIDE>();
    let (other, end) = second.as_chunks::<SIDE_BY_SIDE>();
    let mut sums = [0.0; SIDE_BY_SIDE];
    for (own, other) in own.iter().zip(other) {
        for (sum, (a, b)) in sums.iter_mut().zip(own.iter().zip(other)) {
            *sum += (a - b) * (a - b);
        }
    }
    let rest = rest.iter().zip(end).map(|(a, b)| (a - b).powi(2));
    sums.iter().sum::<f64>() + rest.sum::<f64>()
}
