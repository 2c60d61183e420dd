//! The files of a run: opened, gone through once to check and count everything, and again whenever the
//! run is gone through. Several files are joined sample by sample, or by their times where these differ.

use std::path::Path;

use super::{
    clock::Clock,
    follower::{self, Follower, apart},
    mapping::{Mapping, Time},
    problems::{LARGEST_NUMBER_OF_PROBLEMS, display_name},
    samples::Samples,
    signals::Signals,
    table::{self, Table},
    transmission::Transmission,
};
use crate::error::{Error, Problem};

/// Numbers of one run that are kept in memory (8 MB); arrays are in memory anyhow.
const LARGEST_IN_MEMORY: usize = 1 << 20;

/// Bytes after which progress is told.
const STEP: u64 = 1 << 18;

/// The files of a run and what their columns mean.
#[derive(Debug, Clone, PartialEq)]
pub(super) struct Files {
    /// The run as the caller named it.
    name: String,
    tables: Vec<Table>,
    signals: Signals,
    actuators: usize,
    has_velocities: bool,
    /// Where several files have clocks that differ, each of them with the place of its clock and its usual step,
    /// s. The first one's times are those of the run.
    clocks: Vec<(usize, usize, f64)>,
    /// From motors to joints, where the columns are those of motors.
    transmission: Option<Transmission>,
}

/// What is known of a run that has been gone through.
pub(super) struct Summary {
    /// f_m, Hz.
    pub(super) frequency: f64,
    pub(super) count: usize,
    /// All samples, where they are few enough to be kept.
    pub(super) samples: Option<Samples>,
    /// Samples of the first file at which another one, which is joined by time, has none.
    pub(super) left_out: usize,
}

impl Files {
    /// Opens the files of the run `path` and finds their columns.
    ///
    /// # Errors
    /// A mapping that is not right, files that can't be read, missing columns.
    pub(super) fn new(path: &Path, files: &[&Path], mapping: &Mapping) -> Result<Self, Error> {
        mapping.check()?;
        let (mut tables, mut problems) = (Vec::new(), Vec::new());
        for file in files {
            match Table::open(file) {
                Ok(table) => tables.push(table),
                Err(error) => problems.extend(error.problems),
            }
        }
        Error::check(problems)?;
        if let Some(origin) = tables.iter().find_map(Table::origin) {
            tables.iter_mut().for_each(|table| table.set_origin(origin));
        }
        let name = display_name(path);
        let mut files = Self {
            signals: Signals::new(&name, &tables, mapping)?,
            name,
            tables,
            actuators: mapping.positions.len(),
            has_velocities: !mapping.velocities.is_empty(),
            clocks: Vec::new(),
            transmission: Transmission::new(&mapping.transmission, mapping.positions.len())?,
        };
        files.clocks = files.differing_clocks()?;
        Ok(files)
    }

    /// The clocks of the files, unless they agree.
    fn differing_clocks(&self) -> Result<Vec<(usize, usize, f64)>, Error> {
        let columns: Vec<_> = self.signals.columns().collect();
        let open = |&(file, place): &(usize, usize)| {
            let clock = columns[file].get(place..=place).unwrap_or_default();
            self.tables[file].rows(clock)
        };
        let clocks = self.signals.clocks();
        let all: Result<Vec<_>, Error> = clocks.iter().map(open).collect();
        if clocks.is_empty() || !follower::differ(all?) {
            return Ok(Vec::new());
        }
        let with_step = |clock: &(usize, usize)| {
            let step = follower::usual_step(open(clock)?);
            Ok((clock.0, clock.1, step))
        };
        clocks.iter().map(with_step).collect()
    }

    /// What is said of files that are joined by time.
    pub(super) fn note(&self, samples: usize, left_out: usize) -> Option<String> {
        let ((first, ..), others) = self.clocks.split_first()?;
        let others = others.iter().map(|(file, ..)| self.tables[*file].file());
        let others: Vec<&str> = others.collect();
        let left = match left_out {
            0 => String::new(),
            _ => format!(
                "; {left_out} of its {} samples, outside of the others' times, are left out",
                samples + left_out
            ),
        };
        Some(format!(
            "{} was interpolated linearly onto the times of {}, since the clocks differ{left}",
            others.join(", "),
            self.tables[*first].file()
        ))
    }

    /// The run as the caller named it.
    pub(super) fn name(&self) -> &str {
        &self.name
    }

    /// Number of actuators.
    pub(super) const fn actuators(&self) -> usize {
        self.actuators
    }

    /// Whether velocities were measured.
    pub(super) const fn has_velocities(&self) -> bool {
        self.has_velocities
    }

    /// Goes to the first sample.
    ///
    /// # Errors
    /// A file that can't be read any more.
    pub(super) fn open(&self) -> Result<Rows<'_>, Error> {
        let (mut tables, mut columns) = (Vec::new(), 0);
        for (table, own) in self.tables.iter().zip(self.signals.columns()) {
            let number = tables.len();
            let mut clocks = self.clocks.iter().skip(1);
            let clock = clocks.find(|(file, ..)| *file == number);
            tables.push(Part {
                rows: table.rows(&own)?,
                columns: own.len(),
                follower: clock
                    .map(|(_, place, step)| Follower::new(table.file(), *place, own.len(), *step)),
            });
            columns += own.len();
        }
        Ok(Rows {
            files: self,
            tables,
            values: vec![0.0; columns],
            samples: 0,
            left_out: 0,
            range: None,
            has_ended: false,
        })
    }

    /// Goes through the whole run; `advance` is told every now and then how many bytes more have been read.
    ///
    /// # Errors
    /// Cells that are not finite numbers, a time that is not uniform, fewer than two samples, files of
    /// different lengths or with different times.
    pub(super) fn look_through(
        &self,
        time: &Time,
        advance: &dyn Fn(u64),
    ) -> Result<Summary, Error> {
        let mut rows = self.open()?;
        let mut clock = Clock::default();
        let mut samples = Samples::default();
        let mut problems = Vec::new();
        let (mut fits, mut told, mut last) = (true, 0, None);
        let in_memory = self.tables.iter().all(Table::in_memory);
        loop {
            let bytes = rows.bytes();
            if bytes - told >= STEP {
                advance(bytes - told);
                told = bytes;
            }
            match rows.next(&mut samples) {
                Ok(true) => {
                    let time = self.signals.times(&rows.values).next();
                    if let Some(time) = time {
                        clock.push(time, rows.line());
                        problems.extend(last.and_then(|last| rows.other_time(time - last)));
                    }
                    last = time;
                }
                Ok(false) => break,
                Err(error) => problems.extend(error.problems),
            }
            if rows.has_ended || problems.len() >= LARGEST_NUMBER_OF_PROBLEMS {
                break;
            }
            fits &= in_memory || 2 * samples.positions.len() <= LARGEST_IN_MEMORY;
            if !fits {
                samples.clear();
            }
        }
        if problems.is_empty() {
            problems.extend(rows.apart());
        }
        Error::check(problems)?;
        let frequency = match time {
            Time::Column(_) => clock.frequency(&self.name)?,
            Time::Frequency(frequency) => {
                Clock::check_count(rows.samples, &self.name)?;
                *frequency
            }
        };
        Ok(Summary {
            frequency,
            count: rows.samples,
            samples: fits.then_some(samples),
            left_out: rows.left_out,
        })
    }
}

/// The rest of a file.
#[derive(Debug)]
struct Part<'a> {
    rows: table::Rows<'a>,
    /// The number of its columns that are read.
    columns: usize,
    /// The file at the times of another one, where its clock differs.
    follower: Option<Follower<'a>>,
}

/// The rest of a run.
#[derive(Debug)]
pub(super) struct Rows<'a> {
    files: &'a Files,
    tables: Vec<Part<'a>>,
    /// The numbers of a row, in the columns that are read.
    values: Vec<f64>,
    /// Number of samples that have been read.
    samples: usize,
    /// Samples of the first file at which another one, which is joined by time, has none.
    left_out: usize,
    /// The first and the last time of the first file, where others are joined by time.
    range: Option<(f64, f64)>,
    /// Whether nothing more can be read.
    has_ended: bool,
}

impl Rows<'_> {
    /// Appends the next sample; `false` at the end.
    ///
    /// # Errors
    /// Every cell of the row that is no finite number, a file that can't be read on or that ends before
    /// the others.
    pub(super) fn next(&mut self, samples: &mut Samples) -> Result<bool, Error> {
        loop {
            match self.advance()? {
                None => return Ok(false),
                Some(true) => break,
                // A time at which a file that is joined by time has no rows.
                Some(false) => self.left_out += 1,
            }
        }
        self.samples += 1;
        let n = self.files.actuators;
        let values = self.files.signals.values(&self.values);
        let mut finite = true;
        let mut values = values.inspect(|value| finite &= value.is_finite());
        samples.positions.extend(values.by_ref().take(n));
        samples.torques.extend(values.by_ref().take(n));
        samples.velocities.extend(values);
        if let Some(transmission) = &self.files.transmission {
            transmission.to_joints(samples);
        }
        if finite {
            return Ok(true);
        }
        let text = self
            .files
            .signals
            .not_finite(&self.values)
            .unwrap_or_default();
        let message = format!(
            "sample {}: `{text}` is not a finite number",
            self.samples - 1
        );
        let problem = Problem::new(message)
            .file(self.files.name.as_str())
            .column(text);
        Err(match self.line() {
            Some(line) => problem.line(line),
            None => problem,
        }
        .into())
    }

    /// Reads the next row of all files; `None` at the end, `false` where a file that is joined by time has none.
    fn advance(&mut self) -> Result<Option<bool>, Error> {
        let (mut problems, mut goes_on, mut ended) = (Vec::new(), None, None);
        let (mut is_within, mut time) = (true, None);
        let clock = self.files.clocks.first();
        let mut rest = self.values.as_mut_slice();
        for (number, part) in self.tables.iter_mut().enumerate() {
            let (own, others) = rest.split_at_mut(part.columns);
            rest = others;
            let read = match (&mut part.follower, time) {
                (None, _) => part.rows.next(own),
                (Some(follower), Some(time)) => {
                    let found = follower.at(&mut part.rows, time, own);
                    found.map(|found| {
                        is_within &= found;
                        true
                    })
                }
                // The file with the times has none.
                (Some(_), None) => continue,
            };
            // A file of which nothing is read has no part in the run.
            match read {
                _ if own.is_empty() => {}
                Ok(true) => goes_on = Some(number),
                Ok(false) => ended = Some(number),
                Err(error) => {
                    goes_on = Some(number);
                    self.has_ended |= part.rows.is_broken() || part.follower.is_some();
                    problems.extend(error.problems);
                    continue;
                }
            }
            let place = clock.filter(|(file, ..)| *file == number && ended.is_none());
            if let Some(&(_, place, _)) = place {
                time = own.get(place).copied();
            }
        }
        if let Some(time) = time {
            self.range = Some((self.range.map_or(time, |(first, _)| first), time));
        }
        self.has_ended |= ended.is_some();
        if let (Some(on), Some(ended)) = (goes_on, ended) {
            problems.push(self.shorter(ended, on));
        }
        Error::check(problems)?;
        let goes_on = goes_on.is_some() && !self.has_ended;
        Ok(goes_on.then_some(is_within))
    }

    /// What is said at the end of files that have no time in common.
    fn apart(&self) -> Option<Problem> {
        let (first, ..) = self.files.clocks.first()?;
        let name = |number: usize| self.files.tables[number].file();
        if self.samples > 0 {
            return None;
        }
        let first = (name(*first), self.range?);
        let tables = self.tables.iter().enumerate();
        let mut ranges =
            tables.filter_map(|(file, part)| Some((name(file), part.follower.as_ref()?.range()?)));
        let outside =
            |(_, (begin, end)): &(&str, (f64, f64))| *begin > first.1.1 || *end < first.1.0;
        ranges.find(outside).map(|file| apart(first, file))
    }

    /// What is said of a file that ends while another one goes on.
    fn shorter(&self, ended: usize, on: usize) -> Problem {
        let file = |number: usize| self.files.tables[number].file();
        let message = format!(
            "the file ends after {} samples, while {} goes on",
            self.samples,
            file(on)
        );
        Problem::new(message).file(file(ended)).help(
            "files are joined sample by sample: cut them to the same samples, or check that they are of one run",
        )
    }

    /// What is said if the last row has, in another file, a time that is off by half a `step` or more.
    fn other_time(&self, step: f64) -> Option<Problem> {
        let mut times = self.files.signals.times(&self.values);
        let first = times.next()?;
        let other = times.find(|time| (time - first).abs() > 0.5 * step.abs())?;
        let message = format!(
            "sample {}: the time is {first} s in one file and {other} s in another one",
            self.samples - 1
        );
        let problem = Problem::new(message).file(self.files.name.as_str());
        Some(problem.help(
            "files are joined sample by sample: cut them to the same samples, or take one of the times, `file1.NAME`",
        ))
    }

    /// Line of the last sample, where the run is one file that has lines.
    fn line(&self) -> Option<usize> {
        match &self.tables[..] {
            [part] => part.rows.line(),
            _ => None,
        }
    }

    /// Bytes of all files that have been read.
    fn bytes(&self) -> u64 {
        self.tables.iter().map(|part| part.rows.bytes()).sum()
    }
}
