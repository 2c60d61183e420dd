//! Sums of a periodic run by phase, and the mean of the other periods at each phase.

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
    pub(crate) width: usize,
    /// Sums over all periods at each phase, samples × n.
    pub(crate) sums: Vec<f64>,
    /// Number of values in each sum.
    pub(crate) counts: Vec<u32>,
}

impl Periods {
    /// Difference between periods by the motion's variance, for the actuator with the largest one.
    pub(crate) fn differ(
        &self,
        origin: &[f64],
        squares: &[f64],
        totals: &[f64],
        samples: usize,
    ) -> f64 {
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

/// Replaces positions by those of the other periods, block by block.
#[derive(Debug)]
pub(crate) struct MeanOfOtherPeriods<'a> {
    periods: &'a Periods,
    /// Number of the next sample.
    sample: usize,
}

impl<'a> MeanOfOtherPeriods<'a> {
    pub(crate) const fn new(periods: &'a Periods) -> Self {
        Self { periods, sample: 0 }
    }

    /// Replaces the positions of the next samples.
    pub(crate) fn replace(&mut self, positions: &mut [f64]) {
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
