//! Differentiation of uniformly sampled signals.

use std::ops::Range;

/// Successive samples of some signals of a run.
#[derive(Debug, Clone, Copy)]
pub(crate) struct SampledSignals<'a> {
    /// Values, samples × signals.
    pub(crate) values: &'a [f64],
    /// Number of signals.
    pub(crate) width: usize,
    /// Number of the first sample in the run.
    pub(crate) start: usize,
    /// Number of the run's last sample.
    pub(crate) last: usize,
}

impl SampledSignals<'_> {
    /// Central differences per sample, for the samples `range`.
    ///
    /// With `reach` 1 or 2 samples on either side, the error is of order 2 or 4 in the step:
    ///
    /// ```text
    /// reach 1: q' = (q_1 - q_-1)/2,
    /// reach 2: q' = 2/3 (q_1 - q_-1) - 1/12 (q_2 - q_-2).
    /// ```
    ///
    /// Near the ends of the run the reach is smaller, and at the ends the differences are
    /// one-sided. Central differences have zero phase, so velocities and accelerations stay aligned
    /// with torques.
    pub(crate) fn central_differences(self, range: Range<usize>, reach: usize) -> Vec<f64> {
        let Self {
            values,
            width: n,
            start,
            last,
        } = self;
        let mut found = Vec::with_capacity(range.len() * n);
        let row = |sample: usize| &values[(sample - start) * n..(sample - start + 1) * n];
        let next_to_the_ends = |samples: Range<usize>, found: &mut Vec<f64>| {
            for sample in samples {
                let (before, after) = (sample.saturating_sub(1), (sample + 1).min(last));
                let step = (after - before).max(1) as f64;
                let rows = row(after).iter().zip(row(before));
                found.extend(rows.map(|(after, before)| (after - before) / step));
            }
        };
        // With full reach, all rows are processed as one.
        let first = range.start.max(reach).min(range.end);
        let end = (last + 1).saturating_sub(reach).clamp(first, range.end);
        next_to_the_ends(range.start..first, &mut found);
        if first < end {
            let rows = |shift: usize| {
                let from = (first + shift - reach - start) * n;
                values[from..from + (end - first) * n].iter()
            };
            let near = rows(reach + 1).zip(rows(reach - 1));
            let near = near.map(|(after, before)| (after - before) / 2.0);
            if reach > 1 {
                let far = rows(2 * reach).zip(rows(0));
                let far = far.map(|(after, before)| (after - before) / 4.0);
                found.extend(near.zip(far).map(|(near, far)| (4.0 * near - far) / 3.0));
            } else {
                found.extend(near);
            }
        }
        next_to_the_ends(end..range.end, &mut found);
        found
    }
}

#[cfg(test)]
mod tests {
    use super::SampledSignals;

    /// Signals from sample `start` on that end with the run.
    fn signals(values: &[f64], width: usize, start: usize) -> SampledSignals<'_> {
        SampledSignals {
            values,
            width,
            start,
            last: start + values.len() / width - 1,
        }
    }

    #[test]
    fn central_differences_are_exact_for_a_parabola() {
        let signal: Vec<f64> = (0..6).map(|k| f64::from(k * k)).collect();
        for reach in [1, 2] {
            let whole = signals(&signal, 1, 0).central_differences(0..6, reach);
            assert_eq!(whole, [1.0, 2.0, 4.0, 6.0, 8.0, 9.0]);
        }
        let part = signals(&signal[2..], 1, 2).central_differences(3..5, 1);
        assert_eq!(part, [6.0, 8.0]);
        assert_eq!(signals(&[3.0], 1, 0).central_differences(0..1, 2), [0.0]);
    }

    /// A sine's derivative is too small by (ωT)²/6 and (ωT)⁴/30.
    #[test]
    fn central_differences_are_of_second_and_fourth_order() {
        let step = 0.1_f64;
        let signal: Vec<f64> = (0..9)
            .flat_map(|k| [(step * f64::from(k)).sin(), 1.0])
            .collect();
        for (reach, error) in [(1, step.powi(2) / 6.0), (2, step.powi(4) / 30.0)] {
            let found = signals(&signal, 2, 0).central_differences(4..5, reach);
            let relative = 1.0 - found[0] / (step * (4.0 * step).cos());
            assert!(
                (relative / error - 1.0).abs() < 0.01,
                "{reach}: {relative:e}"
            );
            assert_eq!(found[1], 0.0);
        }
    }
}
