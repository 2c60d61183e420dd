//! Clock of a run: uniformity of its times, and sampling frequency.

use crate::{
    error::{Error, Problem},
    resampling::backward_help,
    significant,
};
use overact::Code;

/// Largest relative deviation of a time step from the usual one.
const STEP_TOLERANCE: f64 = 1e-3;

/// Number of steps from which the usual one is determined.
const FIRST_STEPS: usize = 4096;

/// Largest error of a step between times rounded to 32 bits, in units in the last place.
///
/// The usual step has an error of one unit itself.
const UNITS: f64 = 2.0;

/// Largest such error as a fraction of the step; beyond it a sample could be missing.
const MOST: f64 = 0.25;

/// Checks that successive times are uniform, and computes the sampling frequency.
#[derive(Debug, Default)]
pub(crate) struct Clock {
    samples: usize,
    first: f64,
    last: f64,
    /// First times with their lines in the file, until the usual step is known.
    beginning: Vec<(f64, Option<usize>)>,
    /// Usual step.
    expected: Option<f64>,
    /// First step that differs from the usual one.
    bad: Option<Problem>,
}

impl Clock {
    /// Adds the next time, s.
    pub(crate) fn push(&mut self, time: f64, line: Option<usize>) {
        if self.samples == 0 {
            self.first = time;
        } else if self.expected.is_some() {
            self.check(self.samples - 1, [self.last, time], line);
        }
        self.samples += 1;
        self.last = time;
        if self.expected.is_none() {
            self.beginning.push((time, line));
            if self.samples > FIRST_STEPS {
                self.settle();
            }
        }
    }

    /// Sampling frequency (Hz), from the mean step; NaN for fewer than two samples.
    ///
    /// # Errors
    /// A step that differs from the usual one.
    pub(crate) fn frequency(mut self, file: &str) -> Result<f64, Error> {
        if self.expected.is_none() {
            self.settle();
        }
        match self.bad {
            Some(problem) => Err(problem.file(file).into()),
            None => Ok(self.samples.saturating_sub(1) as f64 / (self.last - self.first)),
        }
    }

    /// Checks that a run has enough samples for a frequency.
    pub(crate) fn check_count(samples: usize, file: &str) -> Result<(), Error> {
        let message = match samples {
            0 => "the run is empty",
            1 => "the run has a single sample",
            _ => return Ok(()),
        };
        let problem = Problem::new(Code::LOG_TOO_SHORT, message).file(file);
        Err(problem
            .help("give a log with the samples of a whole motion")
            .into())
    }

    /// Determines the usual step from the first times, and checks these.
    fn settle(&mut self) {
        let beginning = std::mem::take(&mut self.beginning);
        let pairs = || beginning.windows(2);
        let mut steps: Vec<f64> = pairs().map(|pair| pair[1].0 - pair[0].0).collect();
        steps.sort_by(f64::total_cmp);
        // The median is robust against missing samples, unlike the mean.
        let Some(expected) = steps.get(steps.len() / 2) else {
            return;
        };
        self.expected = Some(*expected);
        for (index, pair) in pairs().enumerate() {
            self.check(index, [pair[0].0, pair[1].0], pair[1].1);
        }
    }

    /// Checks the step after sample `index`, between two times.
    fn check(&mut self, index: usize, times: [f64; 2], line: Option<usize>) {
        let step = times[1] - times[0];
        let expected = self.expected.unwrap_or(step);
        let rounding = UNITS * rounding(times);
        let is_rounded = rounding > STEP_TOLERANCE * expected;
        let tolerance = if rounding <= MOST * expected {
            rounding.max(STEP_TOLERANCE * expected)
        } else {
            STEP_TOLERANCE * expected
        };
        // Also false for NaN.
        let uniform = expected > 0.0 && (step - expected).abs() <= tolerance;
        if uniform || self.bad.is_some() {
            return;
        }
        let message = if step < 0.0 {
            format!(
                "the time runs backwards after sample {index}, from {} s to {} s",
                times[0], times[1]
            )
        } else if expected <= 0.0 {
            format!(
                "most samples have the time of the sample before them, as samples {index} and {} at {} s",
                index + 1,
                times[1]
            )
        } else {
            format!(
                "the time is not uniform: between samples {index} and {} it steps by {} s, expected {} s",
                index + 1,
                shown(step),
                shown(expected),
            )
        };
        let problem = Problem::new(Code::LOG_TIME, message).help(if step < 0.0 {
            backward_help(-step, expected).to_owned()
        } else if expected <= 0.0 {
            String::from(
                "the resolution of the times is coarser than their steps: log the times with more decimals, or replace `time` in [data] by `sampling`, the sampling frequency",
            )
        } else if is_rounded {
            String::from(
                "the times are 32-bit numbers, too coarse for this step so long after zero: log 64-bit times, or start at zero",
            )
        } else if step > 0.0 {
            format!(
                "set `resample = \"{}\"` in [data] to interpolate at uniform times, or cut the run where samples are missing",
                rate(expected)
            )
        } else {
            String::from("the time does not increase: use another column of the time")
        });
        self.bad = Some(match line {
            Some(line) => problem.line(line),
            None => problem,
        });
    }
}

/// Unit in the last place of times that are 32-bit numbers; else 0.
fn rounding(times: [f64; 2]) -> f64 {
    let is_single = |time: f64| time == f64::from(time as f32);
    let largest = times
        .into_iter()
        .fold(0.0, |most: f64, time| most.max(time.abs()));
    if times.into_iter().all(is_single) {
        largest * f64::from(f32::EPSILON)
    } else {
        0.0
    }
}

/// Sampling frequency of steps of this size (s), with two digits and its unit.
fn rate(step: f64) -> String {
    let frequency = 1.0 / step;
    if frequency < 1e3 {
        format!("{} Hz", significant(frequency, 2))
    } else {
        format!("{} kHz", significant(1e-3 * frequency, 2))
    }
}

/// A step with nine decimals, or with all of them if these were zero.
fn shown(step: f64) -> String {
    if step.abs() < 1e-6 {
        format!("{step}")
    } else {
        format!("{step:.9}")
    }
}

#[cfg(test)]
mod tests {
    use super::Clock;
    use crate::error::Error;

    /// Frequency from changed times that start at `start` and are 1 ms apart.
    fn frequency(start: f64, change: impl Fn(f64) -> f64) -> Result<f64, Error> {
        let mut clock = Clock::default();
        let times = (0..6000).map(|sample| start + 1e-3 * f64::from(sample));
        times.for_each(|time| clock.push(change(time), None));
        clock.frequency("log.npz")
    }

    #[test]
    fn rounded_32_bit_times_are_accepted_as_uniform() {
        let single = |time: f64| f64::from(time as f32);
        let found = frequency(100.0, single).expect("uniform");
        assert!((found - 1000.0).abs() < 0.01, "{found}");
        // The same steps in 64-bit numbers are not rounding errors.
        assert!(frequency(100.0, |time| single(time) + 1e-9).is_err());
    }

    #[test]
    fn a_missing_sample_is_detected_in_32_bit_times() {
        let lost = |time: f64| f64::from((if time > 103.0 { time + 1e-3 } else { time }) as f32);
        assert!(frequency(100.0, lost).is_err());
    }

    #[test]
    fn times_too_coarse_in_32_bits_are_rejected() {
        let message = frequency(9000.0, |time| f64::from(time as f32));
        let message = message.expect_err("too coarse").to_string();
        assert!(message.contains("32-bit numbers"), "{message}");
    }

    #[test]
    fn times_in_whole_seconds_are_rejected() {
        let message = frequency(100.0, f64::floor).expect_err("too coarse");
        let message = message.to_string();
        assert!(
            message.contains("the time of the sample before"),
            "{message}"
        );
        assert!(message.contains("`sampling`"), "{message}");
    }

    #[test]
    fn the_help_suggests_the_sampling_rate_of_the_log() {
        let late = |time: f64| if time > 2.0 { time + 3e-4 } else { time };
        for (scale, rate) in [(1.0, "1 kHz"), (4.0, "250 Hz"), (0.1, "10 kHz")] {
            let message = frequency(0.0, |time| scale * late(time)).expect_err("not uniform");
            let message = message.to_string();
            assert!(
                message.contains(&format!("resample = \"{rate}\"")),
                "{message}"
            );
        }
    }
}
