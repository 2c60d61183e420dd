//! Resampling: files with separate clocks at the times of one of them, or a run at uniform times.
//!
//! Values between samples are interpolated by polynomials. For a lower rate, a low-pass filter
//! comes first, on a grid with at least twice the rate of the samples.

mod clocks;
mod low_pass;
mod polynomial;

use overact::Code;
use std::collections::VecDeque;

pub(crate) use self::clocks::{apart, differ, times, usual_step};
use self::{
    clocks::LONGEST_STEP,
    low_pass::{HALF_LENGTH, Kernel},
    polynomial::{NODES, Node, Polynomial},
};
use crate::{
    error::{Error, Problem},
    mapping::expression::Expression,
};

/// Longest gap for interpolation, s, if it has at most [`MOST_STEPS`].
///
/// Polynomials cross it with errors below 0.05 % of a motion at 5 Hz.
const LONGEST_GAP: f64 = 0.02;
const MOST_STEPS: f64 = 25.0;

/// Shortest distance of two samples, in usual steps; nearer samples are skipped as noise.
const SHORTEST_STEP: f64 = 0.5;

/// The new rate is lower if it is below this fraction of that of the samples.
const LOWER: f64 = 0.95;

/// Largest factors by which the new rate may be lower or higher.
pub(crate) const MOST_LOWER: f64 = 1000.0;
pub(crate) const MOST_HIGHER: f64 = 10.0;

/// Reads the next row of numbers; `false` at the end.
pub(crate) type Source<'a> = dyn FnMut(&mut [f64]) -> Result<bool, Error> + 'a;

/// Position of a time relative to the samples.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) enum Place {
    Before,
    Inside,
    Behind,
}

/// Rows of numbers that are read at other times.
#[derive(Debug)]
pub(crate) struct Resampled {
    /// File name for messages.
    file: String,
    /// Time of a row.
    clock: Expression,
    /// Usual step between two rows, s.
    step: f64,
    /// Last samples.
    nodes: VecDeque<Node>,
    /// Time of the last row, which may be too near to a sample to be one itself.
    last: Option<f64>,
    /// First time, and time of the last sample.
    range: Option<(f64, f64)>,
    has_ended: bool,
    /// Columns of a row.
    width: usize,
    low_pass: Option<LowPass>,
    /// Last row, if it repeats the numbers of the last sample at a later time, and the number of
    /// such rows.
    repeated: Option<(Node, usize)>,
    /// Whether rows have been equal for longer than a gap.
    stands_still: bool,
    irregularities: Irregularities,
}

/// Irregularities of the samples of a run that resampling has removed.
#[derive(Debug, Clone, Copy, Default, PartialEq)]
pub(crate) struct Irregularities {
    /// Rows that repeat all numbers of the row before, as a bus does that has no new packet.
    pub(crate) repeated: usize,
    /// Number of gaps longer than [`LONGEST_STEP`] usual steps, and the longest one, s.
    pub(crate) gaps: usize,
    pub(crate) longest_gap: f64,
}

impl Irregularities {
    /// Sentence about them, if there are some.
    pub(crate) fn note(self) -> Option<String> {
        let s = |count: usize| if count == 1 { "" } else { "s" };
        let mut parts = Vec::new();
        if self.repeated > 0 {
            let count = self.repeated;
            parts.push(format!(
                "{count} row{} that repeat the one before left out",
                s(count)
            ));
        }
        if self.gaps > 0 {
            parts.push(format!(
                "{} gap{} of up to {:.1} ms interpolated",
                self.gaps,
                s(self.gaps),
                1e3 * self.longest_gap
            ));
        }
        (!parts.is_empty()).then(|| parts.join(", "))
    }

    /// Those of two files.
    pub(crate) fn and(self, other: Self) -> Self {
        Self {
            repeated: self.repeated + other.repeated,
            gaps: self.gaps + other.gaps,
            longest_gap: self.longest_gap.max(other.longest_gap),
        }
    }
}

/// State of the low-pass filter.
#[derive(Debug)]
struct LowPass {
    kernel: Kernel,
    /// New rate, Hz.
    rate: f64,
    /// Step of the grid, s, and its origin, which is the first requested time.
    step: f64,
    origin: Option<f64>,
    /// Values on the grid, and the grid index of the first one.
    values: VecDeque<Vec<f64>>,
    first: i64,
}

impl Resampled {
    /// Rows of `width` numbers with a usual `step`, s, for a new `rate`, Hz.
    pub(crate) fn new(file: String, clock: Expression, width: usize, step: f64, rate: f64) -> Self {
        let ratio = 1.0 / (step * rate);
        // A NaN step gets no low-pass filter; its times are rejected later.
        let low_pass = is_lower(step, rate).then(|| LowPass {
            kernel: Kernel::new(),
            rate,
            step: 1.0 / (rate * (2.0 * ratio.min(2.0 * MOST_LOWER)).ceil()),
            origin: None,
            values: VecDeque::new(),
            first: 0,
        });
        Self {
            file,
            clock,
            step,
            nodes: VecDeque::new(),
            last: None,
            range: None,
            has_ended: false,
            width,
            low_pass,
            repeated: None,
            stands_still: false,
            irregularities: Irregularities::default(),
        }
    }

    /// Irregularities so far.
    pub(crate) const fn irregularities(&self) -> Irregularities {
        self.irregularities
    }

    /// First time, and time of the last sample read.
    pub(crate) const fn range(&self) -> Option<(f64, f64)> {
        self.range
    }

    /// First time with values; `None` without any rows.
    ///
    /// # Errors
    /// As [`at`](Self::at).
    pub(crate) fn begin(&mut self, source: &mut Source<'_>) -> Result<Option<f64>, Error> {
        while !self.has_ended && self.range.is_none() {
            self.advance(source)?;
        }
        Ok(self.range.map(|(first, _)| first + self.margin()))
    }

    /// Time around a new sample that must be known, s.
    fn margin(&self) -> f64 {
        self.low_pass
            .as_ref()
            .map_or(0.0, |own| HALF_LENGTH / own.rate)
    }

    /// Writes the values at a time to `values`, if it lies inside. Times must increase.
    ///
    /// # Errors
    /// Cells that are no numbers; a clock that stops or has a gap.
    pub(crate) fn at(
        &mut self,
        source: &mut Source<'_>,
        time: f64,
        values: &mut [f64],
    ) -> Result<Place, Error> {
        let Some(mut low_pass) = self.low_pass.take() else {
            return self.between(source, time, values);
        };
        let place = self.passed(&mut low_pass, source, time, values);
        self.low_pass = Some(low_pass);
        place
    }

    /// Filtered values at a time.
    fn passed(
        &mut self,
        low_pass: &mut LowPass,
        source: &mut Source<'_>,
        time: f64,
        values: &mut [f64],
    ) -> Result<Place, Error> {
        let origin = *low_pass.origin.get_or_insert(time);
        let half = HALF_LENGTH / low_pass.rate;
        let place = |time: f64| (time - origin) / low_pass.step;
        let (first, last) = (
            place(time - half).ceil() as i64,
            place(time + half).floor() as i64,
        );
        while low_pass.first < first && low_pass.values.pop_front().is_some() {
            low_pass.first += 1;
        }
        if low_pass.values.is_empty() {
            low_pass.first = first;
        }
        let mut next = low_pass.first + low_pass.values.len() as i64;
        while next <= last {
            let mut row = vec![0.0; self.width];
            match self.between(source, origin + next as f64 * low_pass.step, &mut row)? {
                Place::Inside => low_pass.values.push_back(row),
                // Times before the first sample are not requested again.
                Place::Before => {
                    low_pass.values.clear();
                    return Ok(Place::Before);
                }
                Place::Behind => return Ok(Place::Behind),
            }
            next += 1;
        }
        values.fill(0.0);
        let mut sum = 0.0;
        for (row, k) in low_pass.values.iter().zip(low_pass.first..=last) {
            let weight = low_pass
                .kernel
                .at((origin + k as f64 * low_pass.step - time) * low_pass.rate);
            sum += weight;
            values
                .iter_mut()
                .zip(row)
                .for_each(|(value, own)| *value += weight * own);
        }
        values.iter_mut().for_each(|value| *value /= sum);
        Ok(Place::Inside)
    }

    /// Interpolated values at a time.
    fn between(
        &mut self,
        source: &mut Source<'_>,
        time: f64,
        values: &mut [f64],
    ) -> Result<Place, Error> {
        let is_enough = |nodes: &VecDeque<Node>| {
            let after = nodes.len().checked_sub(NODES / 2);
            nodes.len() >= NODES && after.is_some_and(|after| nodes[after].0 >= time)
        };
        while !self.has_ended && !is_enough(&self.nodes) {
            self.advance(source)?;
            // Six samples before a time suffice, even at the end.
            while self.nodes.get(NODES).is_some_and(|(own, _)| *own < time) {
                self.nodes.pop_front();
            }
        }
        match self.range {
            Some((first, _)) if time < first => return Ok(Place::Before),
            Some((_, last)) if time <= last => {}
            _ => return Ok(Place::Behind),
        }
        let polynomial = Polynomial::new(&self.nodes, time, self.step);
        polynomial.values(&self.nodes, values);
        // Later times need no earlier samples.
        self.nodes.drain(..polynomial.start);
        Ok(Place::Inside)
    }

    /// Reads one row.
    fn advance(&mut self, source: &mut Source<'_>) -> Result<(), Error> {
        let mut row = vec![f64::NAN; self.width];
        let read = source(&mut row);
        self.has_ended |= read.is_err();
        if !read? {
            self.has_ended = true;
            return Ok(());
        }
        let time = self.clock.evaluate(&row);
        let before = self.last.replace(time);
        let (Some((first, last)), Some(before)) = (self.range, before) else {
            self.range = Some((time, time));
            self.nodes.push_back((time, row));
            return Ok(());
        };
        let is_repeated = self.is_repeated(&row);
        let mut last = last;
        if is_repeated && !self.stands_still && time - last <= longest_gap(self.step) {
            let count = self.repeated.as_ref().map_or(0, |(_, count)| *count);
            self.repeated = Some(((time, row), count + 1));
            return self.check_step(before, before, time);
        }
        if let Some((node, count)) = self.repeated.take() {
            if is_repeated {
                // The robot stands still: its rows are samples.
                last = node.0;
                self.nodes.push_back(node);
            } else {
                self.irregularities.repeated += count;
            }
        }
        self.stands_still = is_repeated;
        self.check_step(before, last, time)?;
        if time - last > LONGEST_STEP * self.step {
            self.irregularities.gaps += 1;
            self.irregularities.longest_gap = self.irregularities.longest_gap.max(time - last);
        }
        if time - last >= SHORTEST_STEP * self.step {
            self.range = Some((first, time));
            self.nodes.push_back((time, row));
        }
        Ok(())
    }

    /// Whether a row has all numbers of the last sample, except the time.
    fn is_repeated(&self, row: &[f64]) -> bool {
        let Some((_, last)) = self.nodes.back() else {
            return false;
        };
        let clock = |place: usize| self.clock == Expression::Column(place);
        let others = || (0..self.width).filter(|place| !clock(*place));
        others().count() > 1 && others().all(|place| row[place] == last[place])
    }

    /// Checks the time after a row at `before`; the last sample is at `last`.
    fn check_step(&mut self, before: f64, last: f64, time: f64) -> Result<(), Error> {
        // Also false for NaN.
        if time > before && time - last <= longest_gap(self.step) {
            return Ok(());
        }
        self.has_ended = true;
        let message = format!("the time steps from {before} s to {time} s");
        let problem = Problem::new(Code::LOG_TIME, message).file(self.file.as_str());
        let help = if time > before {
            "samples are missing for too long to be interpolated: cut the run there into two"
        } else {
            backward_help(before - time, self.step)
        };
        Err(problem.help(help).into())
    }
}

/// Longest gap for interpolation, s, between samples with this usual step, s.
pub(crate) fn longest_gap(step: f64) -> f64 {
    let steps = (LONGEST_GAP / step).clamp(LONGEST_STEP, MOST_STEPS);
    steps * step
}

/// Help for a time that runs backwards by some seconds, between samples with this usual step, s.
pub(crate) fn backward_help(seconds: f64, step: f64) -> &'static str {
    if seconds > longest_gap(step) {
        "the clock starts anew there, or a stamp is wrong: write each recording to its own file"
    } else {
        "the time has to increase: sort the samples, or use another column of the time"
    }
}

/// Whether a rate is lower than that of samples with this step, and needs a low-pass filter.
pub(crate) fn is_lower(step: f64, rate: f64) -> bool {
    rate * step < LOWER
}
