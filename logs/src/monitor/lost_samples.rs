//! Lost samples, and rows that repeat the one before.
//!
//! A bus without a new packet repeats all numbers of the last one, so the next step is twice as
//! long, like that over a lost sample.

use super::{
    position::Position,
    suspicion::{DataFault, Suspicion},
};
use crate::significant;

/// Smallest change of a step at lost samples, by the usual largest step.
const LOST_STEP: f64 = 0.5;

/// Smallest ratio of it to the encoder's resolution and to usual changes of steps.
const LOST_RATIO: f64 = 4.0;

/// Fraction of steps that are usual, even if samples are lost.
const USUAL: f64 = 0.9;

/// Largest number of successive repeated rows; more are a standstill.
const LONGEST_REPETITION: usize = 3;

/// Counts rows that repeat all numbers of the row before.
#[derive(Debug, Clone, Default)]
pub(super) struct RepeatedRows {
    last: Vec<f64>,
    /// Length of the current repetition.
    current: usize,
    count: usize,
}

impl RepeatedRows {
    /// Adds the next row.
    pub(super) fn take(&mut self, positions: &[f64], torques: &[f64]) {
        if self.last.iter().eq(positions.iter().chain(torques)) {
            self.current += 1;
            return;
        }
        if self.current <= LONGEST_REPETITION {
            self.count += self.current;
        }
        self.current = 0;
        self.last.clear();
        self.last.extend(positions.iter().chain(torques));
    }
}

/// The positions of a run, to find steps that are too large.
pub(super) struct Steps<'m> {
    pub(super) positions: &'m [Position],
    pub(super) repeated: &'m RepeatedRows,
    pub(super) frequency: f64,
    /// Whether the run was resampled from irregular times, which may be late.
    pub(super) is_resampled: bool,
}

impl Steps<'_> {
    /// Steps that are too large, in any actuator.
    pub(super) fn suspicion(&self, names: &[&str]) -> Option<Suspicion> {
        let mut samples: Vec<usize> = Vec::new();
        let mut largest = 0.0_f64;
        let mut actuators: Vec<&str> = Vec::new();
        for (one, name) in self.positions.iter().zip(names) {
            let Some(resolution) = one.smallest else {
                continue;
            };
            let usual = one.sizes.quantile(USUAL);
            let least = (LOST_STEP * usual)
                .max(LOST_RATIO * resolution)
                .max(LOST_RATIO * one.changes.quantile(USUAL));
            let jumps = one.jumps.iter().filter(|(size, _)| *size > least);
            largest = jumps
                .clone()
                .fold(largest, |most, (size, _)| most.max(size / least));
            let before = samples.len();
            samples.extend(jumps.map(|(_, sample)| *sample));
            if samples.len() > before {
                actuators.push(name);
            }
        }
        let first = *samples.iter().min()?;
        Some(Suspicion {
            fault: if self.is_resampled {
                DataFault::Late
            } else {
                DataFault::Dropped
            },
            statistic: largest,
            unit: "times the largest usual change of a step",
            threshold: 1.0,
            actuator: match actuators[..] {
                [one] if names.len() > 1 => Some(one.to_owned()),
                _ => None,
            },
            message: self.message(first),
        })
    }

    fn message(&self, first: usize) -> String {
        let seconds = first as f64 / self.frequency;
        let jump = format!("positions jump between samples, first at t = {seconds:.4} s");
        if self.is_resampled {
            return format!(
                "{jump}: some times are late or early by a large part of a step, which acts as noise of the positions; log the times of the measurement, not those of the program that reads it"
            );
        }
        match self.repeated.count {
            0 => format!(
                "{jump} (sample {first}): samples are lost or repeated; record the run again, or cut it there"
            ),
            count => {
                let repeat = if count == 1 {
                    "sample repeats"
                } else {
                    "samples repeat"
                };
                format!(
                    "{jump} (sample {first}), and {count} {repeat} all numbers of the one before, like a bus without a new packet; `resample = \"{} Hz\"` in [data] leaves them out and interpolates",
                    significant(self.frequency, 6)
                )
            }
        }
    }
}
