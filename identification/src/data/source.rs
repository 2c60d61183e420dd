//! The file of a run: opened, gone through once to check and count everything, and again whenever its
//! run is gone through.

use std::path::Path;

use super::{
    clock::Clock,
    mapping::{Mapping, Time},
    problems::LARGEST_NUMBER_OF_PROBLEMS,
    samples::Samples,
    signals::Signals,
    table::{self, Table},
};
use crate::error::Error;

/// Numbers of one run that are kept in memory (8 MB); arrays are in memory anyhow.
const LARGEST_IN_MEMORY: usize = 1 << 20;

/// Bytes after which progress is told.
const STEP: u64 = 1 << 18;

/// A file and what its columns mean.
#[derive(Debug, Clone, PartialEq)]
pub(super) struct Files {
    table: Table,
    signals: Signals,
    actuators: usize,
}

/// What is known of a run that has been gone through.
pub(super) struct Summary {
    /// f_m, Hz.
    pub(super) frequency: f64,
    pub(super) count: usize,
    /// All samples, where they are few enough to be kept.
    pub(super) samples: Option<Samples>,
}

impl Files {
    /// Opens a file and finds its columns.
    ///
    /// # Errors
    /// A mapping that is not right, a file that can't be read, missing columns.
    pub(super) fn new(path: &Path, mapping: &Mapping) -> Result<Self, Error> {
        mapping.check()?;
        let table = Table::open(path)?;
        Ok(Self {
            signals: Signals::new(&table, mapping)?,
            table,
            actuators: mapping.positions.len(),
        })
    }

    /// The run as the caller named it.
    pub(super) fn name(&self) -> &str {
        self.table.file()
    }

    /// Number of actuators.
    pub(super) const fn actuators(&self) -> usize {
        self.actuators
    }

    /// Goes to the first sample.
    ///
    /// # Errors
    /// A file that can't be read any more.
    pub(super) fn open(&self) -> Result<Rows<'_>, Error> {
        let columns = self.signals.columns();
        Ok(Rows {
            files: self,
            table: self.table.rows(&columns)?,
            values: vec![0.0; columns.len()],
            time: None,
        })
    }

    /// Goes through the whole run; `advance` is told every now and then how many bytes more have been read.
    ///
    /// # Errors
    /// Cells that are not finite numbers, a time that is not uniform, fewer than two samples.
    pub(super) fn look_through(
        &self,
        time: &Time,
        advance: &dyn Fn(u64),
    ) -> Result<Summary, Error> {
        let mut rows = self.open()?;
        let mut clock = Clock::default();
        let mut samples = Samples::default();
        let mut problems = Vec::new();
        let (mut fits, mut told, mut count) = (true, 0, 0);
        loop {
            let bytes = rows.table.bytes();
            if bytes - told >= STEP {
                advance(bytes - told);
                told = bytes;
            }
            match rows.next(&mut samples) {
                Ok(true) => {
                    count += 1;
                    if let Some(time) = rows.time {
                        clock.push(time, rows.table.line());
                    }
                }
                Ok(false) => break,
                Err(error) => problems.extend(error.problems),
            }
            if rows.table.is_broken() || problems.len() >= LARGEST_NUMBER_OF_PROBLEMS {
                break;
            }
            let few = self.table.in_memory() || 2 * samples.positions.len() <= LARGEST_IN_MEMORY;
            fits &= few;
            if !fits {
                samples.positions.clear();
                samples.torques.clear();
            }
        }
        Error::check(problems)?;
        let frequency = match time {
            Time::Column(_) => clock.frequency(self.name())?,
            Time::Frequency(frequency) => {
                Clock::check_count(count, self.name())?;
                *frequency
            }
        };
        Ok(Summary {
            frequency,
            count,
            samples: fits.then_some(samples),
        })
    }
}

/// The rest of a run.
#[derive(Debug)]
pub(super) struct Rows<'a> {
    files: &'a Files,
    table: table::Rows<'a>,
    /// The numbers of a row, in the columns that are read.
    values: Vec<f64>,
    /// Time of the last row, s, if there is a column of it.
    time: Option<f64>,
}

impl Rows<'_> {
    /// Appends the next sample; `false` at the end.
    ///
    /// # Errors
    /// Every cell of the row that is no finite number, or a file that can't be read on.
    pub(super) fn next(&mut self, samples: &mut Samples) -> Result<bool, Error> {
        if !self.table.next(&mut self.values)? {
            return Ok(false);
        }
        let n = self.files.actuators;
        let (time, mut values) = self.files.signals.evaluate(&self.values);
        samples.positions.extend(values.by_ref().take(n));
        samples.torques.extend(values);
        self.time = time;
        Ok(true)
    }
}
