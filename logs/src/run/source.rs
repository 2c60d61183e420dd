//! Files of a run: tables, requested columns, and times.

use crate::{
    bytes::temporary_store::TemporaryStore,
    error::Error,
    formats::{
        row_range::{RangedRows, RowRange},
        table::Table,
    },
    mapping::{expression::Expression, transmission::Transmission},
    resampling::Resampled,
    run::signals::Signals,
    unwrapping::{Rotation, Wrap},
};

/// Rows of each table of a run in a range of time.
#[derive(Debug, Clone, PartialEq)]
pub(crate) struct RangeRows {
    pub(crate) tables: Vec<RowRange>,
    /// Note to the user.
    pub(crate) note: String,
}

/// Samples of a run in a temporary file, which may have those of other runs before.
#[derive(Debug, Clone, PartialEq)]
pub(crate) struct Spill {
    pub(crate) store: TemporaryStore,
    /// Number of the first sample of the run.
    pub(crate) first: usize,
}

/// Location of a wrapped position.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) enum WrapSource {
    /// A column of the table with this number.
    Table(usize),
    /// A computed position.
    Position,
}

/// Clock of a file.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct FileClock {
    /// Number of the table.
    pub(crate) table: usize,
    /// Index of the time column among the requested columns of the table.
    pub(crate) column: usize,
    /// Usual step, s.
    pub(crate) step: f64,
}

/// Resampling of a run.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct Resampling {
    /// New rate, Hz.
    pub(crate) rate: f64,
    /// Usual step before, s.
    pub(crate) step: f64,
}

/// Files of a run, with the meaning of their columns.
#[derive(Debug, Clone, PartialEq)]
pub(crate) struct Files {
    /// The run as the caller named it.
    pub(crate) name: String,
    pub(crate) tables: Vec<Table>,
    pub(crate) signals: Signals,
    pub(crate) actuators: usize,
    pub(crate) has_velocities: bool,
    /// Clocks of the files if they differ.
    ///
    /// The times of the first one are those of the run. Empty if clocks agree.
    pub(crate) clocks: Vec<FileClock>,
    /// Transformation from motors to joints, if the columns are those of motors.
    pub(crate) transmission: Option<Transmission>,
    /// Columns, and computed positions, that may be wrapped angles.
    pub(crate) rotations: Vec<Rotation>,
    pub(crate) rotating_values: Vec<Rotation>,
    /// Resampling of the run, if requested.
    pub(crate) resampling: Option<Resampling>,
    /// Rows of the tables that are used, if not all.
    pub(crate) range: Option<RangeRows>,
    /// Cached samples of a large run whose files are slow to read.
    pub(crate) spill: Option<Spill>,
}

impl Files {
    /// Number of requested columns of all files.
    pub(crate) fn width(&self) -> usize {
        self.signals.columns().map(|own| own.len()).sum()
    }

    /// The used rows of a table, for some of its columns.
    ///
    /// # Errors
    /// A file that cannot be read any more.
    pub(crate) fn rows_of<'a>(
        &'a self,
        table: usize,
        columns: &[(usize, &'a str)],
    ) -> Result<RangedRows<'a>, Error> {
        let rows = self.tables[table].rows(columns)?;
        Ok(RangedRows::new(rows, self.row_range(table)))
    }

    /// Rows of a table that are used.
    pub(crate) fn row_range(&self, table: usize) -> RowRange {
        let range = self.range.as_ref();
        range.map_or(RowRange::ALL, |range| range.tables[table])
    }

    /// Resampling state of a table if clocks differ, or of the whole run.
    pub(crate) fn resampled(&self, table: Option<usize>) -> Option<Resampled> {
        let Some(table) = table else {
            let Resampling { rate, step } = self.resampling.filter(|_| self.clocks.is_empty())?;
            let clock = self.signals.first_time()?.clone();
            return Some(Resampled::new(
                self.name.clone(),
                clock,
                self.width(),
                step,
                rate,
            ));
        };
        // The first file keeps its own times, unless the run is resampled.
        let skipped = usize::from(self.resampling.is_none());
        let mut clocks = self.clocks.iter().skip(skipped);
        let clock = clocks.find(|own| own.table == table)?;
        let rate = match self.resampling {
            Some(own) => own.rate,
            None => 1.0 / self.clocks.first()?.step,
        };
        let width = self.signals.columns().nth(table)?.len();
        let file = self.tables[table].file().to_owned();
        Some(Resampled::new(
            file,
            Expression::Column(clock.column),
            width,
            clock.step,
            rate,
        ))
    }

    /// Columns of a table that may be wrapped angles, by index in the table.
    pub(crate) fn rotations_of(&self, table: usize) -> Vec<Rotation> {
        let mut widths = self.signals.columns().map(|own| own.len());
        let before = widths.by_ref().take(table).sum();
        let own = widths.next().unwrap_or_default();
        let all = self.rotations.iter();
        all.filter_map(|one| one.behind(before))
            .filter(|one| one.column < own)
            .collect()
    }

    /// Marks columns, or positions, that were found to be wrapped.
    ///
    /// # Errors
    /// Steps of ambiguous direction.
    pub(crate) fn unwrap(&mut self, wraps: &[(WrapSource, Wrap)]) -> Result<(), Error> {
        let mut problems = Vec::new();
        for (source, wrap) in wraps {
            problems.extend(wrap.problem(&self.name));
            let (all, column) = match source {
                WrapSource::Table(table) => {
                    let before: usize = { self.signals.columns().take(*table) }
                        .map(|own| own.len())
                        .sum();
                    (&mut self.rotations, before + wrap.column)
                }
                WrapSource::Position => (&mut self.rotating_values, wrap.column),
            };
            let own = all.iter_mut().find(|own| own.column == column);
            own.into_iter()
                .for_each(|own| own.period = Some(wrap.period));
        }
        // The others are known not to be wrapped.
        self.rotations.retain(|own| own.period.is_some());
        self.rotating_values.retain(|own| own.period.is_some());
        Error::check(problems)
    }

    /// The run as the caller named it.
    pub(crate) fn name(&self) -> &str {
        &self.name
    }

    /// Number of actuators.
    pub(crate) const fn actuators(&self) -> usize {
        self.actuators
    }

    /// Whether velocities were measured.
    pub(crate) const fn has_velocities(&self) -> bool {
        self.has_velocities
    }
}
