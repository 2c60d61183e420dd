//! The clock of a run: whether its times are uniform, and how often it was sampled.

use crate::error::{Error, Problem};
use overact::Code;

/// A step of time may differ from the usual one by this fraction.
const STEP_TOLERANCE: f64 = 1e-3;

/// Steps from which the usual one is told.
const FIRST_STEPS: usize = 4096;

/// Steps of times that were rounded to 32 bits may be off by so many units in the last place, since the usual step is
/// off by one itself, ...
const UNITS: f64 = 2.0;

/// ... as long as that is no larger part of a step: beyond, a sample could be missing.
const MOST: f64 = 0.25;

/// Checks that times are uniform, one after the other, and tells the sampling frequency.
#[derive(Debug, Default)]
pub(super) struct Clock {
    samples: usize,
    first: f64,
    last: f64,
    /// The first times with the lines of the file on which they stand, until the usual step is told
    /// from them.
    beginning: Vec<(f64, Option<usize>)>,
    /// The usual step.
    expected: Option<f64>,
    /// The first step that is not the usual one.
    bad: Option<Problem>,
}

impl Clock {
    /// Takes the next time, s.
    pub(super) fn push(&mut self, time: f64, line: Option<usize>) {
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

    /// The sampling frequency (Hz), from the mean step.
    ///
    /// # Errors
    /// Fewer than two samples, or the first step that is not the usual one.
    pub(super) fn frequency(mut self, file: &str) -> Result<f64, Error> {
        if self.expected.is_none() {
            self.settle();
        }
        Self::check_count(self.samples, file)?;
        match self.bad {
            Some(problem) => Err(problem.file(file).into()),
            None => Ok((self.samples - 1) as f64 / (self.last - self.first)),
        }
    }

    /// Checks that a run has samples enough to have a frequency.
    pub(super) fn check_count(samples: usize, file: &str) -> Result<(), Error> {
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

    /// Tells the usual step from the beginning and checks the beginning by it.
    fn settle(&mut self) {
        let beginning = std::mem::take(&mut self.beginning);
        let pairs = || beginning.windows(2);
        let mut steps: Vec<f64> = pairs().map(|pair| pair[1].0 - pair[0].0).collect();
        steps.sort_by(f64::total_cmp);
        // The median stays right when samples are missing; the mean would not.
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
        let tolerance = match rounding <= MOST * expected {
            true => rounding.max(STEP_TOLERANCE * expected),
            false => STEP_TOLERANCE * expected,
        };
        // Written so that a step that is not a number counts as bad.
        let uniform = expected > 0.0 && (step - expected).abs() <= tolerance;
        if uniform || self.bad.is_some() {
            return;
        }
        let problem = Problem::new(Code::LOG_TIME, format!(
            "the time is not uniform: between samples {index} and {} it steps by {} s, expected {} s",
            index + 1,
            shown(step),
            shown(expected),
        ))
        .help(if is_rounded && step >= 0.0 {
            "the times are numbers of 32 bits, too coarse for this step so long after zero: log times of 64 bits, or from zero on"
        } else if step > 0.0 {
            "let `resample = \"1 kHz\"` in [data] interpolate at uniform times, or cut the run where samples are missing"
        } else {
            "the time stands or runs backwards: cut the run there, or take another column of the time"
        });
        self.bad = Some(match line {
            Some(line) => problem.line(line),
            None => problem,
        });
    }
}

/// The unit in the last place of times, if they are numbers of 32 bits; else 0.
fn rounding(times: [f64; 2]) -> f64 {
    let is_single = |time: f64| time == f64::from(time as f32);
    let largest = times
        .into_iter()
        .fold(0.0, |most: f64, time| most.max(time.abs()));
    match times.into_iter().all(is_single) {
        true => largest * f64::from(f32::EPSILON),
        false => 0.0,
    }
}

/// A step with nine decimals, or with all of them where these would be zero.
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

    /// The frequency told from times 1 ms apart from `start` on, of which each is changed.
    fn frequency(start: f64, change: impl Fn(f64) -> f64) -> Result<f64, Error> {
        let mut clock = Clock::default();
        let times = (0..6000).map(|sample| start + 1e-3 * f64::from(sample));
        times.for_each(|time| clock.push(change(time), None));
        clock.frequency("log.npz")
    }

    #[test]
    fn times_of_32_bits_are_uniform() {
        let single = |time: f64| f64::from(time as f32);
        let found = frequency(100.0, single).expect("uniform");
        assert!((found - 1000.0).abs() < 0.01, "{found}");
        // The same steps in numbers of 64 bits are not: something else shook them.
        assert!(frequency(100.0, |time| single(time) + 1e-9).is_err());
    }

    #[test]
    fn a_sample_that_is_missing_is_told_of_times_of_32_bits() {
        let lost = |time: f64| f64::from((if time > 103.0 { time + 1e-3 } else { time }) as f32);
        assert!(frequency(100.0, lost).is_err());
    }

    #[test]
    fn times_that_32_bits_do_not_tell_apart_are_told_as_such() {
        let told = frequency(9000.0, |time| f64::from(time as f32));
        let told = told.expect_err("too coarse").to_string();
        assert!(told.contains("numbers of 32 bits"), "{told}");
    }
}
