//! Torques that do not change while their actuator moves: a frozen signal.
//!
//! A quantised torque repeats values, too. A rest is therefore compared with the lengths of all
//! others of the same signal.

use super::statistics::Histogram;

/// Fewest equal values in a row for a rest.
const REST_SAMPLES: usize = 20;

/// Fraction of rests that are usual.
const USUAL: f64 = 0.99;

/// Smallest ratio of an unusual rest's length to usual ones.
const UNUSUAL: f64 = 10.0;

/// Equal torques in a row.
#[derive(Debug, Clone, Copy, Default, PartialEq)]
pub(super) struct TorqueRest {
    pub(super) first: usize,
    pub(super) samples: usize,
    pub(super) torque: f64,
    /// Range of the actuator's position during the rest (m, rad).
    pub(super) moved: f64,
}

/// Rests of an actuator's torque.
#[derive(Debug, Clone, Default)]
pub(super) struct TorqueRests {
    current: TorqueRest,
    low: f64,
    high: f64,
    /// Number of rests, also of a single sample, and their lengths.
    count: usize,
    lengths: Histogram,
    /// The rest with the largest motion.
    longest: Option<TorqueRest>,
}

impl TorqueRests {
    /// Adds the torque and position at sample `sample`.
    pub(super) fn take(&mut self, sample: usize, torque: f64, position: f64) {
        if sample > 0 && torque == self.current.torque {
            (self.low, self.high) = (self.low.min(position), self.high.max(position));
            return;
        }
        self.end(sample);
        self.current = TorqueRest {
            first: sample,
            torque,
            ..TorqueRest::default()
        };
        (self.low, self.high) = (position, position);
    }

    /// Ends the current rest before sample `end`.
    pub(super) fn end(&mut self, end: usize) {
        let samples = end - self.current.first;
        if samples == 0 {
            return;
        }
        self.count += 1;
        self.lengths.take(samples as f64);
        let moved = self.high - self.low;
        let is_more = self.longest.is_none_or(|known| moved > known.moved);
        if samples >= REST_SAMPLES && is_more {
            self.longest = Some(TorqueRest {
                samples,
                moved,
                ..self.current
            });
        }
    }

    /// The rest with the largest motion, if it is unusually long for this signal.
    ///
    /// A single rest is a constant signal.
    pub(super) fn unusual(&self) -> Option<TorqueRest> {
        let usual = match self.count {
            1 => 1.0,
            _ => self.lengths.quantile(USUAL),
        };
        self.longest
            .filter(|one| one.samples as f64 >= UNUSUAL * usual)
    }
}
