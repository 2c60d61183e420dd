//! Reads a run: the rows of its files, joined sample by sample or by time.
//!
//! They are read at their own or at uniform times, as positions, torques and velocities.

use crate::{
    error::{Error, Problem},
    formats::row_range::RowRange,
    resampling::{Irregularities, Place, Resampled, apart},
    run::{
        signals::is_measurable,
        source::{Files, WrapSource},
    },
    samples::Samples,
    unwrapping::{UnwrappedRows, Unwrapper, Wrap},
};
use overact::Code;

/// The remaining rows of a file.
#[derive(Debug)]
struct Part<'a> {
    rows: UnwrappedRows<'a>,
    /// Number of its requested columns.
    columns: usize,
    /// State of resampling, if the file is read at other times than its own.
    resampled: Option<Resampled>,
}

/// The remaining rows of the files of a run.
#[derive(Debug)]
pub(crate) struct Joined<'a> {
    files: &'a Files,
    parts: Vec<Part<'a>>,
    /// Number of rows read.
    count: usize,
    /// First and last time of the first file, if others are joined by time.
    range: Option<(f64, f64)>,
    /// Whether nothing more can be read.
    has_ended: bool,
}

/// Result of reading the next row.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
enum Step {
    Row,
    /// A file that is joined by time has no row at this time.
    Outside,
    End,
}

impl<'a> Joined<'a> {
    /// Starts at the first rows.
    ///
    /// # Errors
    /// A file that cannot be read any more.
    pub(crate) fn new(files: &'a Files) -> Result<Self, Error> {
        let mut parts = Vec::new();
        for own in files.signals.columns().take(files.tables.len()) {
            let rows = files.rows_of(parts.len(), &own)?;
            parts.push(Part {
                rows: UnwrappedRows::new(rows, files.rotations_of(parts.len())),
                columns: own.len(),
                resampled: files.resampled(Some(parts.len())),
            });
        }
        Ok(Self {
            files,
            parts,
            count: 0,
            range: None,
            has_ended: false,
        })
    }

    /// Continues with a later range of rows of each table.
    fn enter(&mut self, ranges: &[RowRange]) {
        for (number, (part, range)) in self.parts.iter_mut().zip(ranges).enumerate() {
            part.rows.enter(*range);
            part.resampled = self.files.resampled(Some(number));
        }
        self.count = 0;
        self.range = None;
        self.has_ended = false;
    }

    /// Reads the next row of files with a common clock; `false` at the end.
    ///
    /// # Errors
    /// As [`advance`](Self::advance).
    pub(crate) fn next(&mut self, values: &mut [f64]) -> Result<bool, Error> {
        Ok(self.advance(values, None)? == Step::Row)
    }

    /// Whether nothing more can be read.
    pub(crate) const fn has_ended(&self) -> bool {
        self.has_ended
    }

    /// The first uniform time at which all files have values, as the start of the first file and
    /// the number of steps from there; `None` if a file is empty.
    fn begin(&mut self, rate: f64) -> Result<Option<(f64, u64)>, Error> {
        let (mut start, mut latest) = (None, f64::NEG_INFINITY);
        for part in &mut self.parts {
            let rows = &mut part.rows;
            let Some(resampled) = &mut part.resampled else {
                continue;
            };
            let begin = resampled.begin(&mut |row| rows.next(row))?;
            let (Some(begin), Some((first, _))) = (begin, resampled.range()) else {
                return Ok(None);
            };
            start = start.or(Some(first));
            latest = latest.max(begin);
        }
        Ok(start.map(|start| (start, steps(start, latest, rate))))
    }

    /// Reads the next row of all files into `values`, at a given time or that of the first file.
    ///
    /// # Errors
    /// Every cell of the row that is no finite number, a file that cannot be read further, or one
    /// that ends before the others.
    fn advance(&mut self, values: &mut [f64], given: Option<f64>) -> Result<Step, Error> {
        if let ([part], None, []) = (&mut self.parts[..], given, &self.files.clocks[..])
            && part.resampled.is_none()
            && part.columns > 0
        {
            return self.alone(values);
        }
        let (mut problems, mut goes_on, mut ended) = (Vec::new(), None, None);
        let (mut place, mut time) = (Place::Inside, given);
        let clock = self.files.clocks.first();
        let mut rest = values;
        for (number, part) in self.parts.iter_mut().enumerate() {
            let (own, others) = rest.split_at_mut(part.columns);
            rest = others;
            let rows = &mut part.rows;
            let read = match (&mut part.resampled, time) {
                (None, _) => rows.next(own),
                (Some(resampled), Some(time)) => {
                    let found = resampled.at(&mut |row| rows.next(row), time, own);
                    found.map(|found| {
                        if found != Place::Inside {
                            place = found;
                        }
                        true
                    })
                }
                // The file that defines the times has ended.
                (Some(_), None) => continue,
            };
            // A file without requested columns is ignored.
            match read {
                _ if own.is_empty() => {}
                Ok(true) => goes_on = Some(number),
                Ok(false) => ended = Some(number),
                Err(error) => {
                    goes_on = Some(number);
                    self.has_ended |= part.rows.logged().is_broken() || part.resampled.is_some();
                    problems.extend(error.problems);
                    continue;
                }
            }
            let clock =
                clock.filter(|own| own.table == number && ended.is_none() && given.is_none());
            if let Some(clock) = clock {
                time = own.get(clock.column).copied();
            }
        }
        if let (Some(time), None) = (time, given) {
            self.range = Some((self.range.map_or(time, |(first, _)| first), time));
        }
        self.has_ended |= ended.is_some() || (given.is_some() && place == Place::Behind);
        if let (Some(on), Some(ended)) = (goes_on, ended) {
            problems.push(self.shorter(ended, on));
        }
        Error::check(problems)?;
        if goes_on.is_none() || self.has_ended {
            return Ok(Step::End);
        }
        if place == Place::Inside {
            self.count += 1;
            Ok(Step::Row)
        } else {
            Ok(Step::Outside)
        }
    }

    /// Reads the next row of the only file.
    fn alone(&mut self, values: &mut [f64]) -> Result<Step, Error> {
        let rows = &mut self.parts[0].rows;
        match rows.next(values) {
            Ok(true) => {
                self.count += 1;
                Ok(Step::Row)
            }
            Ok(false) => {
                self.has_ended = true;
                Ok(Step::End)
            }
            Err(error) => {
                self.has_ended |= rows.logged().is_broken();
                Err(error)
            }
        }
    }

    /// The problem of files without a common time.
    fn apart(&self) -> Option<Problem> {
        let first = self.files.clocks.first()?.table;
        let name = |number: usize| self.files.tables[number].file();
        let own = self.parts[first].resampled.as_ref();
        let first = (name(first), own.map_or(self.range, Resampled::range)?);
        let parts = self.parts.iter().enumerate();
        let mut ranges =
            parts.filter_map(|(file, part)| Some((name(file), part.resampled.as_ref()?.range()?)));
        let outside =
            |(_, (begin, end)): &(&str, (f64, f64))| *begin > first.1.1 || *end < first.1.0;
        ranges.find(outside).map(|file| apart(first, file))
    }

    /// The problem of a file that ends before another one.
    fn shorter(&self, ended: usize, on: usize) -> Problem {
        let file = |number: usize| self.files.tables[number].file();
        let message = format!(
            "the file ends after {} samples, while {} goes on",
            self.count,
            file(on)
        );
        Problem::new(Code::LOG_FILES, message).file(file(ended)).help(
            "files are joined sample by sample: cut them to the same samples, or check that they are of one run",
        )
    }
}

/// Number of steps from `start` to the first time not before `end`.
fn steps(start: f64, end: f64, rate: f64) -> u64 {
    ((end - start) * rate - 1e-9).ceil().max(0.0) as u64
}

/// Uniform times.
#[derive(Debug, Clone, Copy)]
struct Uniform {
    rate: f64,
    start: f64,
    next: u64,
}

/// The remaining rows of a run.
#[derive(Debug)]
pub(crate) struct Rows<'a> {
    files: &'a Files,
    joined: Joined<'a>,
    /// State of resampling, if the whole run is read at other times than its own.
    resampled: Option<Resampled>,
    /// Resampling times, once they have started.
    times: Option<Uniform>,
    /// Values of a row, for the requested columns.
    pub(crate) values: Vec<f64>,
    /// Unwraps positions that are no columns.
    unwrapper: Unwrapper,
    /// Number of samples read.
    pub(crate) samples: usize,
    /// Samples of the first file at which a file joined by time has no values.
    pub(crate) left_out: usize,
}

impl<'a> Rows<'a> {
    /// Starts at the first sample.
    ///
    /// # Errors
    /// A file that cannot be read any more.
    pub(crate) fn new(files: &'a Files) -> Result<Self, Error> {
        Ok(Self {
            files,
            joined: Joined::new(files)?,
            resampled: files.resampled(None),
            times: None,
            values: vec![0.0; files.width()],
            unwrapper: Unwrapper::new(files.rotating_values.clone()),
            samples: 0,
            left_out: 0,
        })
    }

    /// Continues with a later range of rows of each table, as with a run of its own.
    pub(crate) fn enter(&mut self, ranges: &[RowRange]) {
        self.joined.enter(ranges);
        self.resampled = self.files.resampled(None);
        self.times = None;
        self.unwrapper.interrupt();
        self.samples = 0;
        self.left_out = 0;
    }

    /// Time of the last sample of a resampled run, s.
    pub(crate) fn uniform_time(&self) -> Option<f64> {
        let times = self.times?;
        Some(times.start + (times.next - 1) as f64 / times.rate)
    }

    /// Whether nothing more can be read.
    pub(crate) const fn has_ended(&self) -> bool {
        // A resampled run is read ahead.
        self.joined.has_ended && self.resampled.is_none()
    }

    /// Appends the next sample; `false` at the end.
    ///
    /// # Errors
    /// Every cell of the row that is no finite number, a file that cannot be read further, or one
    /// that ends before the others.
    pub(crate) fn next(&mut self, samples: &mut Samples) -> Result<bool, Error> {
        loop {
            let step = match self.files.resampling {
                None => self.joined.advance(&mut self.values, None),
                Some(own) => self.uniform(own.rate),
            };
            match step? {
                Step::End => return Ok(false),
                Step::Row => break,
                Step::Outside => self.left_out += 1,
            }
        }
        self.samples += 1;
        self.take(samples)?;
        Ok(true)
    }

    /// Reads the row at the next uniform time.
    fn uniform(&mut self, rate: f64) -> Result<Step, Error> {
        let joined = &mut self.joined;
        let times = match (self.times, &mut self.resampled) {
            (Some(times), _) => Some(times),
            (None, None) => {
                let begin = joined.begin(rate)?;
                begin.map(|(start, next)| Uniform { rate, start, next })
            }
            (None, Some(resampled)) => {
                let begin = resampled.begin(&mut |row| joined.next(row))?;
                let first = resampled.range().map(|(first, _)| first);
                begin.zip(first).map(|(begin, start)| Uniform {
                    rate,
                    start,
                    next: steps(start, begin, rate),
                })
            }
        };
        let Some(times) = times else {
            return Ok(Step::End);
        };
        self.times = Some(Uniform {
            next: times.next + 1,
            ..times
        });
        let time = times.start + times.next as f64 / times.rate;
        let Some(resampled) = &mut self.resampled else {
            return joined.advance(&mut self.values, Some(time));
        };
        let place = resampled.at(&mut |row| joined.next(row), time, &mut self.values);
        Ok(match place? {
            Place::Inside => Step::Row,
            Place::Before => Step::Outside,
            Place::Behind => Step::End,
        })
    }

    /// Appends the values of a row to `samples`.
    fn take(&mut self, samples: &mut Samples) -> Result<(), Error> {
        let n = self.files.actuators;
        let values = self.files.signals.values(&self.values);
        let mut sound = true;
        let mut values = values.inspect(|value| sound &= is_measurable(*value));
        let first = samples.positions.len();
        samples.positions.extend(values.by_ref().take(n));
        samples.torques.extend(values.by_ref().take(n));
        samples.velocities.extend(values);
        self.unwrapper.take(&mut samples.positions[first..]);
        if let Some(transmission) = &self.files.transmission {
            transmission.to_joints(samples);
        }
        if sound {
            return Ok(());
        }
        let bad = self.files.signals.immeasurable(&self.values);
        let (text, value) = bad.unwrap_or(("", f64::NAN));
        let sample = self.samples - 1;
        let problem = Problem::new(
            Code::NOT_A_NUMBER,
            if value.is_finite() {
                format!("sample {sample}: `{text}` is {value:e}, which is not plausible")
            } else {
                format!("sample {sample}: `{text}` is not a finite number")
            },
        );
        let problem = if value.is_finite() {
            problem.help("cut the run there, or check how the log was written")
        } else {
            problem
        };
        let problem = problem.file(self.files.name()).column(text);
        Err(match self.line() {
            Some(line) => problem.line(line),
            None => problem,
        }
        .into())
    }

    /// Irregularities of the samples so far.
    pub(crate) fn irregularities(&self) -> Irregularities {
        let parts = self.joined.parts.iter();
        let of_files = parts.filter_map(|part| part.resampled.as_ref());
        of_files
            .chain(&self.resampled)
            .map(Resampled::irregularities)
            .fold(Irregularities::default(), Irregularities::and)
    }

    /// Columns and positions that were logged within one turn and are not yet unwrapped.
    pub(crate) fn wraps(&self) -> Vec<(WrapSource, Wrap)> {
        let parts = self.joined.parts.iter().enumerate();
        let of_tables = parts.flat_map(|(table, part)| {
            let own = part.rows.unwrapper.wraps().into_iter();
            own.map(move |wrap| (WrapSource::Table(table), wrap))
        });
        let own = self.unwrapper.wraps().into_iter();
        of_tables
            .chain(own.map(|wrap| (WrapSource::Position, wrap)))
            .collect()
    }

    /// The problem of files without a common time, at the end.
    pub(crate) fn apart(&self) -> Option<Problem> {
        if self.samples > 0 {
            return None;
        }
        self.joined.apart()
    }

    /// The problem if times of the last row in two files differ by half a `step` or more.
    pub(crate) fn other_time(&self, step: f64) -> Option<Problem> {
        let mut times = self.files.signals.times(&self.values);
        let first = times.next()?;
        let other = times.find(|time| (time - first).abs() > 0.5 * step.abs())?;
        let message = format!(
            "sample {}: the time is {first} s in one file and {other} s in another one",
            self.samples - 1
        );
        let problem = Problem::new(Code::LOG_FILES, message).file(self.files.name());
        Some(problem.help(
            "files are joined sample by sample: cut them to the same samples, or take one of the times, `file1.NAME`",
        ))
    }

    /// Line of the last sample, if the run is one file with lines.
    pub(crate) fn line(&self) -> Option<usize> {
        match &self.joined.parts[..] {
            [part] if self.files.resampling.is_none() => part.rows.logged().line(),
            _ => None,
        }
    }

    /// Number of bytes of all files read.
    pub(crate) fn bytes(&self) -> u64 {
        let parts = self.joined.parts.iter();
        parts.map(|part| part.rows.logged().bytes()).sum()
    }
}
