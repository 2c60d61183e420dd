//! Hashes of selected samples, to find samples that occur in two runs.
//!
//! The selection depends on the numbers of a sample alone. Two runs that share samples therefore
//! select the same ones, wherever they start.

use std::collections::HashMap;

/// Largest number of marks of a run.
const MOST: usize = 1 << 14;

/// Fewest common marks at one time shift for runs that share samples.
const FEWEST: usize = 10;

/// An odd number with well-mixed bits: 2⁶⁴ divided by the golden ratio.
const MIX: u64 = 0x9e37_79b9_7f4a_7c15;

/// Marks of a run: one in 2^level of its samples, whose hashes end with that many zeros.
#[derive(Debug, Clone, Default)]
pub(crate) struct Marks {
    level: u32,
    samples: usize,
    last: u64,
    /// Hashes, with the first sample of each.
    kept: HashMap<u64, usize>,
}

/// Samples that two runs have in common.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct CommonSamples {
    /// Approximate number of samples.
    pub samples: usize,
    /// Fraction of the shorter run.
    pub part: f64,
}

impl Marks {
    /// Adds the next sample, unless it equals the previous one.
    pub(super) fn take(&mut self, positions: &[f64], torques: &[f64]) {
        let all = positions.iter().chain(torques);
        let hash = all.fold(MIX, |hash, value| {
            let mixed = (hash ^ value.to_bits()).wrapping_mul(MIX);
            mixed ^ (mixed >> 32)
        });
        if hash != self.last && hash.trailing_zeros() >= self.level {
            self.kept.entry(hash).or_insert(self.samples);
            while self.kept.len() > MOST {
                self.level += 1;
                let level = self.level;
                self.kept.retain(|hash, _| hash.trailing_zeros() >= level);
            }
        }
        self.last = hash;
        self.samples += 1;
    }

    /// Samples in common with another run; `None` without any.
    pub(crate) fn shared(&self, other: &Self) -> Option<CommonSamples> {
        let level = self.level.max(other.level);
        let mut distances: HashMap<i128, usize> = HashMap::new();
        for (hash, own) in &self.kept {
            if let Some(place) = other
                .kept
                .get(hash)
                .filter(|_| hash.trailing_zeros() >= level)
            {
                *distances.entry(*own as i128 - *place as i128).or_default() += 1;
            }
        }
        let most = distances
            .into_values()
            .max()
            .filter(|count| *count >= FEWEST)?;
        let shorter = self.samples.min(other.samples);
        let samples = (most << level).min(shorter);
        Some(CommonSamples {
            samples,
            part: samples as f64 / shorter.max(1) as f64,
        })
    }
}

#[cfg(test)]
mod tests {
    use super::{MOST, Marks};

    /// Different samples of two actuators.
    fn marks(samples: std::ops::Range<usize>) -> Marks {
        let mut marks = Marks::default();
        for sample in samples {
            let x = (sample as f64).sin();
            marks.take(&[x, x * x], &[1.0 - x, x.powi(3)]);
        }
        marks
    }

    #[test]
    fn overlapping_parts_of_one_log_are_recognised() {
        let shared = marks(0..3000).shared(&marks(2000..4000)).expect("shared");
        assert_eq!(shared.samples, 1000);
        assert!((shared.part - 0.5).abs() < 1e-12);
        let all = 4 * MOST;
        let shared = marks(0..all)
            .shared(&marks(all / 2..2 * all))
            .expect("shared");
        let expected = all as f64 / 2.0;
        assert!(
            (shared.samples as f64 / expected - 1.0).abs() < 0.1,
            "{shared:?}"
        );
    }

    #[test]
    fn runs_that_share_only_a_standstill_do_not_overlap() {
        assert_eq!(marks(0..3000).shared(&marks(3000..6000)), None);
        let resting = |first: usize| {
            let mut marks = marks(first..first + 1000);
            (0..1000).for_each(|_| marks.take(&[0.0, 0.0], &[1.0, 2.0]));
            marks
        };
        assert_eq!(resting(0).shared(&resting(5000)), None);
    }
}
