//! Ranges of the positions in short blocks of a run, from which long standstills follow.

use std::ops::Range;

/// Samples of a block of a short run.
const SAMPLES: usize = 16;

/// Largest number of blocks; those of a longer run have more samples.
const MOST_BLOCKS: usize = 8192;

/// Duration over which the range of a position is its motion, s.
const SECONDS: f64 = 0.1;

/// Shortest standstill that is long, s.
const LONG: f64 = 1.0;

/// A drive stands still if its range is below this fraction of its usual largest range.
const STILL: f64 = 0.01;

/// Quantile of the ranges that is the usual largest one: jumps of single samples do not count.
const USUAL: f64 = 0.98;

/// Range of a drive at rest in multiples of its smallest range, which is that of its noise.
const NOISE: f64 = 2.0;

/// Smallest and largest position of each actuator in successive blocks of equal length.
#[derive(Debug, Clone, PartialEq)]
pub(crate) struct BlockRanges {
    actuators: usize,
    /// Samples of a block.
    length: usize,
    /// Lowest and highest position of each actuator in each block, blocks × n.
    bounds: Vec<[f64; 2]>,
    samples: usize,
}

impl BlockRanges {
    pub(crate) const fn new(actuators: usize) -> Self {
        Self {
            actuators,
            length: SAMPLES,
            bounds: Vec::new(),
            samples: 0,
        }
    }

    /// Adds the positions of successive samples, samples × n.
    pub(crate) fn take(&mut self, positions: &[f64]) {
        for row in positions.chunks_exact(self.actuators) {
            if self.samples == self.length * self.blocks() {
                self.begin_block();
            }
            let first = self.bounds.len() - self.actuators;
            for ([low, high], position) in self.bounds[first..].iter_mut().zip(row) {
                *low = low.min(*position);
                *high = high.max(*position);
            }
            self.samples += 1;
        }
    }

    fn blocks(&self) -> usize {
        self.bounds.len() / self.actuators
    }

    fn begin_block(&mut self) {
        if self.blocks() == MOST_BLOCKS {
            self.bounds = self.merged(2);
            self.length *= 2;
        }
        let empty = [f64::INFINITY, f64::NEG_INFINITY];
        self.bounds
            .extend(std::iter::repeat_n(empty, self.actuators));
    }

    /// Bounds of blocks that are `count` times as long.
    fn merged(&self, count: usize) -> Vec<[f64; 2]> {
        let n = self.actuators;
        let merged = self.bounds.chunks(count * n).flat_map(|blocks| {
            (0..n).map(move |actuator| {
                let own = blocks.iter().skip(actuator).step_by(n);
                own.copied()
                    .reduce(|[low, high], [a, b]| [low.min(a), high.max(b)])
                    .unwrap_or_default()
            })
        });
        merged.collect()
    }

    /// Samples of long standstills of all actuators, in order, at a sampling frequency (Hz).
    ///
    /// An actuator stands still over 0.1 s if its positions range over less than 1 % of their usual
    /// largest range in such a time, which is 1 % of its usual largest speed, or over less than
    /// twice the smallest range other than zero, which is that of noise. All actuators stand still
    /// at the same time for at least 1 s.
    pub(crate) fn long_standstills(&self, frequency: f64) -> Vec<Range<usize>> {
        let n = self.actuators;
        let merged = (SECONDS * frequency / self.length as f64).ceil().max(1.0) as usize;
        let length = merged * self.length;
        let bounds = self.merged(merged);
        let ranges: Vec<f64> = bounds.iter().map(|[low, high]| high - low).collect();
        let limits: Vec<f64> = (0..n)
            .map(|actuator| limit(ranges.iter().skip(actuator).step_by(n).copied()))
            .collect();
        let rests = ranges.chunks_exact(n).map(|own| {
            let mut pairs = own.iter().zip(&limits);
            pairs.all(|(range, limit)| range <= limit)
        });
        let mut all: Vec<Range<usize>> = Vec::new();
        for (block, _) in rests.enumerate().filter(|(_, rests)| *rests) {
            let (first, end) = (block * length, ((block + 1) * length).min(self.samples));
            match all.last_mut() {
                Some(last) if last.end == first => last.end = end,
                _ => all.push(first..end),
            }
        }
        all.retain(|own| own.len() as f64 >= LONG * frequency);
        all
    }
}

/// Largest range of an actuator that stands still.
fn limit(ranges: impl Iterator<Item = f64>) -> f64 {
    let mut all: Vec<f64> = ranges.collect();
    all.sort_by(f64::total_cmp);
    let usual = all.get((USUAL * all.len() as f64) as usize);
    let usual = usual.or(all.last()).copied().unwrap_or(0.0);
    let smallest = all.iter().find(|range| **range > 0.0);
    let noise = NOISE * smallest.copied().unwrap_or(0.0);
    (STILL * usual).max(noise)
}

#[cfg(test)]
mod tests {
    use super::BlockRanges;

    /// Standstills of two drives at 100 Hz: `rests` says when both stand still.
    fn found(samples: usize, noise: f64, rests: impl Fn(f64) -> bool) -> Vec<(usize, usize)> {
        let mut ranges = BlockRanges::new(2);
        let (mut state, mut phase) = (1_u64, 0.0_f64);
        for sample in 0..samples {
            if !rests(sample as f64 / 100.0) {
                phase += 0.02;
            }
            let mut random = || {
                state = state
                    .wrapping_mul(6_364_136_223_846_793_005)
                    .wrapping_add(1_442_695_040_888_963_407);
                (state >> 33) as f64 / f64::from(1_u32 << 31) - 0.5
            };
            let own = [
                phase.sin() + noise * random(),
                0.3 * (1.7 * phase).cos() + noise * random(),
            ];
            ranges.take(&own);
        }
        let all = ranges.long_standstills(100.0).into_iter();
        all.map(|own| (own.start, own.end)).collect()
    }

    #[test]
    fn long_standstills_are_found_with_and_without_noise() {
        for noise in [0.0, 1e-4, 1e-2] {
            let rests = |time: f64| time < 3.0 || (20.0..22.0).contains(&time) || time >= 55.0;
            let found = found(6000, noise, rests);
            assert_eq!(found.len(), 3, "{noise}: {found:?}");
            for ((start, end), (first, last)) in
                found
                    .into_iter()
                    .zip([(0, 300), (2000, 2200), (5500, 6000)])
            {
                assert!(start >= first && start < first + 50, "{noise}: {start}");
                assert!(end <= last && end + 50 > last, "{noise}: {end}");
            }
        }
    }

    #[test]
    fn motion_and_short_rests_are_not_long_standstills() {
        assert!(found(6000, 0.0, |_| false).is_empty());
        assert!(found(6000, 1e-3, |_| false).is_empty());
        assert!(found(6000, 1e-4, |time| (20.0..20.8).contains(&time)).is_empty());
    }

    #[test]
    fn blocks_grow_with_the_length_of_the_run() {
        let mut ranges = BlockRanges::new(1);
        for sample in 0..1_000_000 {
            let own = f64::from(sample - 400_000).clamp(0.0, 200_000.0);
            ranges.take(&[(1e-4 * own).sin()]);
        }
        assert!(ranges.blocks() <= super::MOST_BLOCKS && ranges.samples == 1_000_000);
        let found = ranges.long_standstills(1000.0);
        assert_eq!(found.len(), 2);
        assert!(found[0].end.abs_diff(400_000) < 1000 && found[1].start.abs_diff(600_000) < 1000);
    }
}
