//! Range of time of a run, `log.csv[10:60]`: the rows of its files within these times.
//!
//! The samples of a range are those with start ≤ t < end. The time t is that of the run's own time
//! column. It is counted from the first sample if the log has no time column, or if its first time
//! is an absolute stamp, larger than 1e6 s. A run is read as if its files contained only these rows.

use overact::Code;

use crate::{
    error::{Error, Problem},
    formats::row_range::RowRange,
    mapping::Time,
    run::{
        rows::Joined,
        source::{FileClock, Files, RangeRows},
    },
    significant::significant,
};

/// Smallest first time that is an absolute stamp, s.
const ABSOLUTE: f64 = 1e6;

/// Whether a first time (s) is an absolute stamp, so that times count from it.
pub(crate) const fn is_absolute(first: f64) -> bool {
    first.abs() > ABSOLUTE
}

/// Times of a run that are used, s: start ≤ t < end.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct TimeRange {
    /// First time; −∞ without one.
    pub start: f64,
    /// End; ∞ without one.
    pub end: f64,
}

impl TimeRange {
    /// The range of the text `10:60`, `10:` or `:60`.
    ///
    /// # Errors
    /// A sentence on the defect.
    pub(crate) fn parse(text: &str) -> Result<Self, String> {
        let bound = |text: &str, default: f64| match text.trim() {
            "" => Ok(default),
            text => {
                let value = text.parse().ok().filter(|value: &f64| value.is_finite());
                value.ok_or_else(|| format!("`{text}` is not a number of seconds"))
            }
        };
        let (start, end) = text.split_once(':').unwrap_or((text, ""));
        let range = Self {
            start: bound(start, f64::NEG_INFINITY)?,
            end: bound(end, f64::INFINITY)?,
        };
        if range.start == f64::NEG_INFINITY && range.end == f64::INFINITY {
            Err(String::from("it has neither a start nor an end"))
        } else if range.start >= range.end {
            Err(format!(
                "it ends at {} s, which is not after its start at {} s",
                range.end, range.start
            ))
        } else {
            Ok(range)
        }
    }

    /// Whether two ranges have times in common.
    #[must_use]
    pub const fn overlaps(&self, other: &Self) -> bool {
        self.start < other.end && other.start < self.end
    }

    /// The problem of a range that cannot be used.
    pub(crate) fn problem(file: &str, text: &str, why: &str) -> Problem {
        let message = format!("the range of time `[{text}]` can't be used: {why}");
        Problem::new(Code::LOG_TIME, message)
            .file(file)
            .help("a range is `log.csv[10:60]`, `log.csv[10:]` or `log.csv[:60]`, in s")
    }
}

impl Files {
    /// Restricts a run to a range of its time.
    ///
    /// # Errors
    /// A range without samples, or a file that cannot be read.
    pub(crate) fn restrict(&mut self, range: TimeRange, time: &Time) -> Result<(), Error> {
        let joined = self.search(range, time)?;
        let found = joined.found().ok_or_else(|| joined.outside(&self.name))?;
        let mut tables = vec![found; self.tables.len()];
        for clock in &self.clocks {
            let search = self.search_file(clock, Search::new(range, joined.origin))?;
            let name = self.tables[clock.table].file();
            let found = search.found().ok_or_else(|| search.outside(name))?;
            tables[clock.table] = found;
        }
        self.range = Some(RangeRows {
            tables,
            note: joined.note(time),
        });
        Ok(())
    }

    /// Searches the rows of a file with its own clock.
    fn search_file(&self, clock: &FileClock, mut search: Search) -> Result<Search, Error> {
        let columns: Vec<_> = self.signals.columns().nth(clock.table).unwrap_or_default();
        let mut rows = self.tables[clock.table].rows(&columns)?;
        let mut row = vec![f64::NAN; columns.len()];
        loop {
            row.fill(f64::NAN);
            let read = rows.next(&mut row);
            let is_at_end = matches!(read, Ok(false)) || rows.is_broken();
            if is_at_end || !search.take(row[clock.column]) {
                return Ok(search);
            }
        }
    }

    /// Searches the rows of the first file, or of files with a common clock.
    fn search(&self, range: TimeRange, time: &Time) -> Result<Search, Error> {
        let mut search = Search::new(range, None);
        if let Some(clock) = self.clocks.first() {
            return self.search_file(clock, search);
        }
        let mut joined = Joined::new(self)?;
        let mut row = vec![f64::NAN; self.width()];
        let mut sample = 0;
        loop {
            row.fill(f64::NAN);
            // Problems of rows in the range are reported when the run is read.
            let read = joined.next(&mut row);
            if matches!(read, Ok(false)) || joined.has_ended() {
                return Ok(search);
            }
            let time = match time {
                Time::Frequency(rate) => f64::from(sample) / rate,
                Time::Column(_) => self.signals.times(&row).next().unwrap_or(f64::NAN),
            };
            sample += 1;
            if !search.take(time) {
                return Ok(search);
            }
        }
    }
}

/// Searches the rows of a range of time, row by row.
struct Search {
    range: TimeRange,
    /// Time from which times are counted, once it is known.
    origin: Option<f64>,
    /// First and last time of all rows, and of those in the range.
    all: Option<(f64, f64)>,
    used: Option<(f64, f64)>,
    rows: usize,
    /// First row of the range, and the row after its last one.
    first: Option<usize>,
    end: usize,
}

impl Search {
    const fn new(range: TimeRange, origin: Option<f64>) -> Self {
        Self {
            range,
            origin,
            all: None,
            used: None,
            rows: 0,
            first: None,
            end: 0,
        }
    }

    /// Adds the time of the next row, NaN if it is not known; `false` after the range.
    fn take(&mut self, time: f64) -> bool {
        self.rows += 1;
        if !time.is_finite() {
            // Rows without a time belong to the range if rows on both sides do.
            return true;
        }
        let origin = *self
            .origin
            .get_or_insert(if is_absolute(time) { time } else { 0.0 });
        let tolerance = 1e-9 + 4.0 * f64::EPSILON * time.abs();
        let own = time - origin;
        let extend = |range: Option<(f64, f64)>| Some((range.map_or(own, |(first, _)| first), own));
        self.all = extend(self.all);
        if own >= self.range.end - tolerance {
            return self.first.is_none();
        }
        if self.first.is_some() || own >= self.range.start - tolerance {
            self.used = extend(self.used);
            self.first = self.first.or(Some(self.rows - 1));
            self.end = self.rows;
        }
        true
    }

    /// The rows of the range; `None` without any.
    fn found(&self) -> Option<RowRange> {
        let first = self.first?;
        // Rows without a time at the end of the file are reported when they are read.
        let is_last = self.all == self.used || self.range.end == f64::INFINITY;
        Some(RowRange {
            first,
            count: if is_last {
                usize::MAX
            } else {
                self.end - first
            },
        })
    }

    /// The problem of a range without samples.
    fn outside(&self, file: &str) -> Problem {
        let TimeRange { start, end } = self.range;
        let to = match end {
            f64::INFINITY => String::new(),
            end => end.to_string(),
        };
        let from = match start {
            f64::NEG_INFINITY => String::new(),
            start => start.to_string(),
        };
        let log = self.all.map_or_else(
            || String::from("the log has no times"),
            |(first, last)| format!("its times go from {} s to {} s", shown(first), shown(last)),
        );
        let counted = match self.origin {
            Some(origin) if origin != 0.0 => {
                format!(", counted from its first sample at {} s", shown(origin))
            }
            _ => String::new(),
        };
        let message =
            format!("the log has no sample in the range of time `[{from}:{to}]`: {log}{counted}");
        let problem = Problem::new(Code::LOG_TIME, message).file(file);
        problem.help("give a range within these times, in s")
    }

    /// Note on the samples that are used.
    fn note(&self, time: &Time) -> String {
        let (first, last) = self.used.unwrap_or((f64::NAN, f64::NAN));
        let clock = match (time, self.origin) {
            (Time::Frequency(_), _) => "since its first sample",
            (_, Some(origin)) if origin != 0.0 => "since its first sample",
            _ => "of its own time",
        };
        format!(
            "the log was read in part, from {} s to {} s {clock}",
            shown(first),
            shown(last)
        )
    }
}

/// Name of a run and the bounds of its range of time, which are empty without one.
pub(crate) fn name_and_bounds(name: &str) -> (&str, [&str; 2]) {
    let bracketed = name.strip_suffix(']').and_then(|own| own.rsplit_once('['));
    match bracketed {
        Some((own, range)) if TimeRange::parse(range).is_ok() => {
            let (start, end) = range.split_once(':').unwrap_or((range, ""));
            (own, [start, end])
        }
        _ => (name, ["", ""]),
    }
}

/// A time for display.
fn shown(time: f64) -> String {
    significant(time, 12)
}

#[cfg(test)]
mod tests {
    use super::{Search, TimeRange};

    #[test]
    fn time_ranges_are_parsed_or_rejected() {
        let range = |start, end| Ok(TimeRange { start, end });
        assert_eq!(TimeRange::parse("10:60"), range(10.0, 60.0));
        assert_eq!(TimeRange::parse(" 1e1 : "), range(10.0, f64::INFINITY));
        assert_eq!(TimeRange::parse(":-.5"), range(f64::NEG_INFINITY, -0.5));
        for (text, what) in [
            (":", "neither a start nor an end"),
            (
                "60:10",
                "ends at 10 s, which is not after its start at 60 s",
            ),
            ("5:5", "not after its start"),
            ("1:2:3", "`2:3` is not a number"),
            ("nan:1", "`nan` is not a number"),
            ("a:", "`a` is not a number"),
        ] {
            let why = TimeRange::parse(text).expect_err(text);
            assert!(why.contains(what), "{why}");
        }
    }

    /// First row and number of rows of the range 2 ≤ t < 4.
    fn found(times: &[f64]) -> Option<(usize, usize)> {
        let range = TimeRange::parse("2:4").expect("a range");
        let mut search = Search::new(range, None);
        for time in times {
            if !search.take(*time) {
                break;
            }
        }
        search.found().map(|own| (own.first, own.count))
    }

    #[test]
    fn rows_of_a_time_range_are_found() {
        const NONE: f64 = f64::NAN;
        assert_eq!(found(&[0.0, 1.0, 2.0, 3.0, 4.0, 5.0]), Some((2, 2)));
        assert_eq!(found(&[0.0, NONE, 2.0, NONE, 3.0, NONE, 4.0]), Some((2, 3)));
        assert_eq!(found(&[5.0, 6.0, 7.0]), None);
        // Absolute stamps count from the first sample.
        let stamps = [0.0, 1.0, 2.0, 3.0, 4.0, 5.0].map(|time| 1.7e9 + time);
        assert_eq!(found(&stamps), Some((2, 2)));
        // A range that the log does not reach is used as far as the log goes.
        assert_eq!(found(&[0.0, 2.5]), Some((1, 1)));
    }
}
