//! The clock of a run: whether its times are uniform, and how often it was sampled.

use crate::error::{Error, Problem};
use overact::Code;

/// A step of time may differ from the usual one by this fraction.
const STEP_TOLERANCE: f64 = 1e-3;

/// Steps from which the usual one is told.
const FIRST_STEPS: usize = 4096;

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
            self.check(self.samples - 1, time - self.last, line);
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
        let found: Vec<f64> = beginning
            .windows(2)
            .map(|pair| pair[1].0 - pair[0].0)
            .collect();
        let mut steps = found.clone();
        steps.sort_by(f64::total_cmp);
        // The median stays right when samples are missing; the mean would not.
        let Some(expected) = steps.get(steps.len() / 2) else {
            return;
        };
        self.expected = Some(*expected);
        for (index, step) in found.into_iter().enumerate() {
            self.check(index, step, beginning[index + 1].1);
        }
    }

    /// Checks the step after sample `index`.
    fn check(&mut self, index: usize, step: f64, line: Option<usize>) {
        let expected = self.expected.unwrap_or(step);
        // Written so that a step that is not a number counts as bad.
        let uniform = expected > 0.0 && (step - expected).abs() <= STEP_TOLERANCE * expected;
        if uniform || self.bad.is_some() {
            return;
        }
        let problem = Problem::new(Code::LOG_TIME, format!(
            "the time is not uniform: between samples {index} and {} it steps by {} s, expected {} s",
            index + 1,
            shown(step),
            shown(expected),
        ))
        .help(if step > 0.0 {
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

/// A step with nine decimals, or with all of them where these would be zero.
fn shown(step: f64) -> String {
    if step.abs() < 1e-6 {
        format!("{step}")
    } else {
        format!("{step:.9}")
    }
}
