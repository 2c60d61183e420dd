//! A file of a run that has a clock of its own: its rows at the times of another file, between two of its own.

use super::{problems::shown, table::Rows};
use crate::error::{Error, Problem};

/// Steps of a clock from which the usual one is told.
const FIRST_STEPS: usize = 256;

/// Usual steps over which a line is drawn, at most: what is missing in between can't be known.
const LONGEST_STEP: f64 = 3.5;

/// A file that is read at the times of another one.
#[derive(Debug)]
pub(super) struct Follower<'a> {
    file: &'a str,
    /// The place of the time among the columns that are read.
    clock: usize,
    /// The longest step between two rows, s.
    longest: f64,
    /// The rows around the last time that was asked for; none before the first one.
    before: Option<Vec<f64>>,
    after: Vec<f64>,
    has_ended: bool,
    /// The first time, and the last that was read.
    range: Option<(f64, f64)>,
}

impl<'a> Follower<'a> {
    /// A file whose usual step, s, is known.
    pub(super) fn new(file: &'a str, clock: usize, columns: usize, step: f64) -> Self {
        Self {
            file,
            clock,
            longest: LONGEST_STEP * step,
            before: None,
            after: vec![f64::NAN; columns],
            has_ended: false,
            range: None,
        }
    }

    /// The first time, and the last that was read.
    pub(super) const fn range(&self) -> Option<(f64, f64)> {
        self.range
    }

    /// Puts the numbers at a time into `values`; `false` before the first and behind the last row. Times are
    /// asked for one after the other.
    ///
    /// # Errors
    /// Cells that are no numbers, a clock that stands or leaps.
    pub(super) fn at(
        &mut self,
        rows: &mut Rows<'_>,
        time: f64,
        values: &mut [f64],
    ) -> Result<bool, Error> {
        while !self.has_ended && self.range.is_none_or(|(_, last)| last < time) {
            self.advance(rows)?;
        }
        let Some((first, last)) = self.range else {
            return Ok(false);
        };
        if time < first || time > last {
            return Ok(false);
        }
        let Some(before) = &self.before else {
            values.copy_from_slice(&self.after);
            return Ok(true);
        };
        let part = (time - before[self.clock]) / (last - before[self.clock]);
        for ((value, before), after) in values.iter_mut().zip(before).zip(&self.after) {
            *value = before + part * (after - before);
        }
        Ok(true)
    }

    /// Goes on by one row.
    fn advance(&mut self, rows: &mut Rows<'_>) -> Result<(), Error> {
        let mut next = vec![f64::NAN; self.after.len()];
        let read = rows.next(&mut next);
        self.has_ended |= read.is_err() && rows.is_broken();
        if !read? {
            self.has_ended = true;
            return Ok(());
        }
        let time = next[self.clock];
        let Some((first, last)) = self.range else {
            self.range = Some((time, time));
            self.after = next;
            return Ok(());
        };
        let step = time - last;
        // Written so that a step that is not a number counts as bad.
        if !(step > 0.0 && step <= self.longest) {
            self.has_ended = true;
            let message = format!("the time steps from {last} s to {time} s");
            let problem = Problem::new(message).file(self.file);
            let help = "files with clocks of their own are joined by time, which needs times that grow without gaps: cut the run there";
            return Err(problem.help(help).into());
        }
        self.range = Some((first, time));
        self.before = Some(std::mem::replace(&mut self.after, next));
        Ok(())
    }
}

/// The usual step of a clock, s, from its first rows.
pub(super) fn usual_step(mut clock: Rows<'_>) -> f64 {
    let mut times = Vec::new();
    let mut time = [0.0];
    // What is wrong with the clock is told where the file is gone through.
    while times.len() <= FIRST_STEPS && clock.next(&mut time) == Ok(true) {
        times.push(time[0]);
    }
    let mut steps: Vec<f64> = times.windows(2).map(|pair| pair[1] - pair[0]).collect();
    steps.sort_by(f64::total_cmp);
    steps.get(steps.len() / 2).copied().unwrap_or(f64::NAN)
}

/// Whether clocks differ: whether they are off by more than a fiftieth of a step, or one ends before the others.
pub(super) fn differ(mut clocks: Vec<Rows<'_>>) -> bool {
    let mut last = None;
    loop {
        let mut times = Vec::new();
        for clock in &mut clocks {
            let mut time = [0.0];
            match clock.next(&mut time) {
                Ok(true) => times.push(time[0]),
                Ok(false) => {}
                // What is wrong with the clock is told where the file is gone through.
                Err(_) => return false,
            }
        }
        let Some(&first) = times.first() else {
            return false;
        };
        let step = last.map(|last: f64| (first - last).abs());
        let is_off = |time: &f64| step.is_some_and(|step| (time - first).abs() > 0.02 * step);
        if times.len() < clocks.len() || times.iter().any(is_off) {
            return true;
        }
        last = Some(first);
    }
}

/// What is said of two files of which one ends before the other begins; `first` is the file whose times are taken.
pub(super) fn apart(
    (first, (begin, end)): (&str, (f64, f64)),
    (file, (own_begin, own_end)): (&str, (f64, f64)),
) -> Problem {
    let message = if own_begin > end {
        format!(
            "the file begins at {own_begin} s, when {} has ended at {end} s",
            shown(first)
        )
    } else {
        format!(
            "the file ends at {own_end} s, before {} begins at {begin} s",
            shown(first)
        )
    };
    Problem::new(message).file(file).help(
        "files are joined by time: check that they are of one run and that their clocks count from the same start",
    )
}
