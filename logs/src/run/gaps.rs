//! Gaps in the time of a run, and the stretches of rows between them.
//!
//! A gap is a step of the time too long to be interpolated. Filters must not cross it, so each
//! stretch is read as a run of its own. With separate clocks, a gap of any file ends the stretch of
//! all files.

use crate::{
    error::Error,
    formats::row_range::RowRange,
    resampling::longest_gap,
    run::{
        rows::Joined,
        source::{FileClock, Files, RangeRows},
        time_range::is_absolute,
    },
    significant::significant,
};

/// Largest number of gaps of a log; one with more is refused as a whole.
const MOST_GAPS: usize = 10_000;

/// Rows between two gaps of all tables of a run.
#[derive(Debug, Clone, PartialEq)]
pub(crate) struct Stretch {
    /// Rows of each table.
    pub(crate) tables: Vec<RowRange>,
    /// Bounds of its range of time as in `log.csv[10:60]`; none at the ends of the run.
    pub(crate) bounds: [Option<String>; 2],
    /// Time from the first sample of the run to that of the stretch, s.
    pub(crate) start: f64,
    /// Duration of the stretch, s.
    pub(crate) duration: f64,
}

/// Gaps of a run.
#[derive(Debug, Clone, PartialEq)]
pub(crate) struct Gaps {
    /// Stretches between the gaps, in order.
    pub(crate) stretches: Vec<Stretch>,
    count: usize,
    /// Longest gap, and sum of all gaps, s.
    longest: f64,
    missing: f64,
    /// Time of the last sample before the first gap, as in a range of time, s.
    first: f64,
    /// Time from the first to the last sample of the run, s.
    duration: f64,
}

/// Stretches that are not used.
#[derive(Debug, Clone, Copy, Default, PartialEq)]
pub(crate) struct LeftOut {
    pub(crate) count: usize,
    /// Sum of their durations, s.
    pub(crate) duration: f64,
    /// Samples of the longest one, and samples that a run needs.
    pub(crate) longest: usize,
    pub(crate) needed: usize,
}

impl Gaps {
    /// Sentence on the gaps, and on stretches that are left out.
    pub(crate) fn note(&self, left_out: LeftOut) -> String {
        let of = |seconds: f64| 100.0 * seconds / self.duration;
        let what = match self.count {
            1 => format!("a gap of {} s", shown(self.longest)),
            count => format!("{count} gaps of up to {} s", shown(self.longest)),
        };
        let place = if self.count == 1 { "" } else { " first" };
        let used = self.stretches.len() - left_out.count;
        let mut text = format!(
            "the time has {what},{place} after {} s: the log was split there and read as {used} run{}; {} % of its duration is missing",
            significant(self.first, 7),
            if used == 1 { "" } else { "s" },
            significant(of(self.missing), 2),
        );
        if left_out.count > 0 {
            text += &format!(
                ", and {} % in {} stretch{} of less than {} samples is left out as too short to filter",
                significant(of(left_out.duration), 2),
                left_out.count,
                if left_out.count == 1 { "" } else { "es" },
                left_out.needed,
            );
        }
        text
    }

    /// Sentence on gaps between which no stretch is long enough.
    pub(crate) fn without_stretches(&self, left_out: LeftOut) -> String {
        format!(
            "the time has {} gap{}, and the longest stretch without a gap has {} samples: the filters need at least {}",
            self.count,
            if self.count == 1 { "" } else { "s" },
            left_out.longest,
            left_out.needed,
        )
    }
}

/// A duration for display.
fn shown(seconds: f64) -> String {
    significant(seconds, 3)
}

/// A gap: the times of the samples before and after it.
#[derive(Debug, Clone, Copy, PartialEq)]
struct Gap {
    before: f64,
    after: f64,
}

impl Gap {
    /// The number with the fewest decimals between both samples, not at the first one.
    fn bound(self, origin: f64) -> String {
        let (before, after) = (self.before - origin, self.after - origin);
        let middle = 0.5 * (before + after);
        let candidates = (0..12).map(|decimals| format!("{middle:.decimals$}"));
        let is_inside = |text: &String| {
            let value: f64 = text.parse().unwrap_or(f64::NAN);
            before < value && value <= after
        };
        let mut inside = candidates.filter(is_inside);
        inside.next().unwrap_or_else(|| format!("{middle}"))
    }
}

/// Times of a clock: first and last one, and gaps.
#[derive(Debug, Default)]
struct Times {
    /// Longest step that is no gap, s.
    longest_step: f64,
    first: Option<f64>,
    last: Option<f64>,
    gaps: Vec<Gap>,
}

impl Times {
    /// Adds the time of the next row, NaN if it is not known; `false` after too many gaps.
    fn take(&mut self, time: f64) -> bool {
        if !time.is_finite() {
            return true;
        }
        let before = self.last.replace(time);
        self.first.get_or_insert(time);
        if let Some(before) = before
            && time - before > self.longest_step
        {
            self.gaps.push(Gap {
                before,
                after: time,
            });
        }
        self.gaps.len() <= MOST_GAPS
    }
}

impl Files {
    /// Gaps in the times of the run; `None` without any, or with too many.
    ///
    /// # Errors
    /// A file that cannot be read any more.
    pub(crate) fn gaps(&self) -> Result<Option<Gaps>, Error> {
        let mut clocks = Vec::new();
        if self.clocks.is_empty() {
            let step = match self.resampling {
                Some(own) => own.step,
                None => self.usual_step()?,
            };
            clocks.push(self.times_of_run(step)?);
        }
        for clock in &self.clocks {
            clocks.push(self.times_of_file(clock)?);
        }
        let few = |clock: &Times| clock.gaps.len() <= MOST_GAPS;
        let Some((Some(first), Some(last))) = clocks.first().map(|own| (own.first, own.last))
        else {
            return Ok(None);
        };
        let gaps = united(clocks.iter().flat_map(|own| own.gaps.iter().copied()));
        // Gaps of other files outside the times of the first one do not matter.
        let gaps: Vec<Gap> = { gaps.into_iter() }
            .filter(|gap| gap.after > first && gap.before < last)
            .collect();
        let Some(first_gap) = gaps.first() else {
            return Ok(None);
        };
        if !clocks.iter().all(few) {
            return Ok(None);
        }
        let origin = if is_absolute(first) { first } else { 0.0 };
        let tables = self.rows_between(&gaps)?;
        let bounds: Vec<String> = gaps.iter().map(|gap| gap.bound(origin)).collect();
        let bound = |place: Option<usize>| place.and_then(|place| bounds.get(place));
        let stretches = tables
            .into_iter()
            .enumerate()
            .filter_map(|(place, tables)| {
                let start = place
                    .checked_sub(1)
                    .map_or(first, |before| gaps[before].after);
                let end = gaps.get(place).map_or(last, |gap| gap.before);
                Some(Stretch {
                    tables: tables.into_iter().collect::<Option<_>>()?,
                    bounds: [place.checked_sub(1), Some(place)].map(|place| bound(place).cloned()),
                    start: start - first,
                    duration: end - start,
                })
            });
        let durations = || gaps.iter().map(|gap| gap.after - gap.before);
        Ok(Some(Gaps {
            stretches: stretches.collect(),
            count: gaps.len(),
            longest: durations().fold(0.0, f64::max),
            missing: durations().sum(),
            first: first_gap.before - origin,
            duration: last - first,
        }))
    }

    /// Restricts the run to a stretch.
    pub(crate) fn enter(&mut self, stretch: &Stretch) {
        self.range = Some(RangeRows {
            tables: stretch.tables.clone(),
            note: String::new(),
        });
    }

    /// Times of the only clock of a run.
    fn times_of_run(&self, step: f64) -> Result<Times, Error> {
        let mut times = Times {
            longest_step: longest_gap(step),
            ..Times::default()
        };
        self.each_time(&mut |_, time| times.take(time))?;
        Ok(times)
    }

    /// Times of a file with its own clock.
    fn times_of_file(&self, clock: &FileClock) -> Result<Times, Error> {
        let mut times = Times {
            longest_step: longest_gap(clock.step),
            ..Times::default()
        };
        self.each_time_of(clock, &mut |_, time| times.take(time))?;
        Ok(times)
    }

    /// Calls `take` with the number of each row of the run in its tables and its time, which is NaN
    /// if it is not known, until it returns `false`.
    fn each_time(&self, take: &mut dyn FnMut(usize, f64) -> bool) -> Result<(), Error> {
        let mut joined = Joined::new(self)?;
        let mut row = vec![f64::NAN; self.width()];
        let mut number = self.row_range(0).first;
        loop {
            row.fill(f64::NAN);
            // Other problems of rows are reported when the run is read.
            let read = joined.next(&mut row);
            if matches!(read, Ok(false)) || joined.has_ended() {
                return Ok(());
            }
            let time = self.signals.times(&row).next().unwrap_or(f64::NAN);
            if !take(number, time) {
                return Ok(());
            }
            number += 1;
        }
    }

    /// The same for the rows of a file with its own clock.
    fn each_time_of(
        &self,
        clock: &FileClock,
        take: &mut dyn FnMut(usize, f64) -> bool,
    ) -> Result<(), Error> {
        let columns: Vec<_> = self.signals.columns().nth(clock.table).unwrap_or_default();
        let mut rows = self.rows_of(clock.table, &columns)?;
        let mut row = vec![f64::NAN; columns.len()];
        let mut number = self.row_range(clock.table).first;
        loop {
            row.fill(f64::NAN);
            let read = rows.next(&mut row);
            if matches!(read, Ok(false)) || rows.logged().is_broken() {
                return Ok(());
            }
            if !take(number, row[clock.column]) {
                return Ok(());
            }
            number += 1;
        }
    }

    /// For each stretch between gaps, the rows of each table; `None` without any.
    fn rows_between(&self, gaps: &[Gap]) -> Result<Vec<Vec<Option<RowRange>>>, Error> {
        let mut all = vec![vec![None; self.tables.len()]; gaps.len() + 1];
        if self.clocks.is_empty() {
            let mut search = Search::new(gaps);
            self.each_time(&mut |number, time| search.take(number, time))?;
            for (tables, found) in all.iter_mut().zip(search.found) {
                tables.fill(found);
            }
            return Ok(all);
        }
        for (place, clock) in self.clocks.iter().enumerate() {
            let mut search = Search::new(gaps);
            self.each_time_of(clock, &mut |number, time| search.take(number, time))?;
            for (tables, found) in all.iter_mut().zip(search.found) {
                if place == 0 {
                    // Files without times have the samples of the first one.
                    tables.fill(found);
                }
                tables[clock.table] = found;
            }
        }
        Ok(all)
    }
}

/// Gaps in order, overlapping ones as one.
fn united(gaps: impl Iterator<Item = Gap>) -> Vec<Gap> {
    let mut all: Vec<Gap> = gaps.collect();
    all.sort_by(|a, b| a.before.total_cmp(&b.before));
    let mut united: Vec<Gap> = Vec::new();
    for gap in all {
        match united.last_mut() {
            Some(last) if gap.before < last.after => last.after = last.after.max(gap.after),
            _ => united.push(gap),
        }
    }
    united
}

/// Searches the rows of each stretch between gaps, row by row.
struct Search<'a> {
    gaps: &'a [Gap],
    /// Number of gaps before the current row.
    passed: usize,
    found: Vec<Option<RowRange>>,
}

impl<'a> Search<'a> {
    fn new(gaps: &'a [Gap]) -> Self {
        Self {
            gaps,
            passed: 0,
            found: vec![None; gaps.len() + 1],
        }
    }

    /// Adds the time of row `number`; rows inside a gap belong to no stretch.
    ///
    /// Rows without a time belong to the stretch of the row before.
    fn take(&mut self, number: usize, time: f64) -> bool {
        let is_over = |gap: &Gap| time >= gap.after;
        while self.gaps.get(self.passed).is_some_and(is_over) {
            self.passed += 1;
        }
        if self
            .gaps
            .get(self.passed)
            .is_none_or(|gap| time.is_nan() || time <= gap.before)
        {
            let range = self.found[self.passed].get_or_insert(RowRange {
                first: number,
                count: 0,
            });
            range.count = number + 1 - range.first;
        }
        true
    }
}

#[cfg(test)]
mod tests {
    use super::{Gap, Search, united};
    use crate::formats::row_range::RowRange;

    fn gap(before: f64, after: f64) -> Gap {
        Gap { before, after }
    }

    #[test]
    fn overlapping_gaps_are_merged() {
        let gaps = [gap(5.0, 7.0), gap(1.0, 2.0), gap(6.0, 8.0), gap(8.0, 9.0)];
        assert_eq!(
            united(gaps.into_iter()),
            [gap(1.0, 2.0), gap(5.0, 8.0), gap(8.0, 9.0)]
        );
    }

    #[test]
    fn gap_bounds_have_few_decimals_and_lie_in_the_gap() {
        assert_eq!(gap(11.9, 13.0).bound(0.0), "12");
        assert_eq!(gap(11.92, 11.98).bound(0.0), "11.95");
        assert_eq!(gap(1.7e9 + 0.2, 1.7e9 + 0.4).bound(1.7e9), "0.3");
    }

    #[test]
    fn rows_inside_a_gap_are_excluded() {
        let gaps = [gap(1.0, 3.0)];
        let mut search = Search::new(&gaps);
        for (number, time) in [0.0, 1.0, f64::NAN, 1.5, 2.9, 3.0, 4.0]
            .into_iter()
            .enumerate()
        {
            assert!(search.take(number, time));
        }
        let rows = |first: usize, count: usize| Some(RowRange { first, count });
        assert_eq!(search.found, [rows(0, 3), rows(5, 2)]);
    }
}
