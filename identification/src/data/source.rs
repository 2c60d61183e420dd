//! The files of a run: their tables, what is read of them, and at which times.

use super::{
    expression::Expression,
    resampling::Resampled,
    signals::Signals,
    spill::Spill,
    table::Table,
    transmission::Transmission,
    turns::{Rotation, Wrap},
};
use crate::error::Error;

/// Where a wrapped position was found.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum WrapSource {
    /// In a column of the table of this number.
    Table(usize),
    /// Among the positions.
    Position,
}

/// The files of a run and what their columns mean.
#[derive(Debug, Clone, PartialEq)]
pub(super) struct Files {
    /// The run as the caller named it.
    pub(super) name: String,
    pub(super) tables: Vec<Table>,
    pub(super) signals: Signals,
    pub(super) actuators: usize,
    pub(super) has_velocities: bool,
    /// Where several files have clocks that differ, each of them with the place of its clock and its usual step,
    /// s. The first one's times are those of the run.
    pub(super) clocks: Vec<(usize, usize, f64)>,
    /// From motors to joints, where the columns are those of motors.
    pub(super) transmission: Option<Transmission>,
    /// The columns that may hold a position within one turn, and the positions that may be angles within one turn.
    pub(super) rotations: Vec<Rotation>,
    pub(super) rotating_values: Vec<Rotation>,
    /// The rate of uniform times at which the run is resampled, Hz, and the usual step before, s.
    pub(super) resample: Option<(f64, f64)>,
    /// The numbers of the run, where it is large and its files are slow to read.
    pub(super) spill: Option<Spill>,
}

impl Files {
    /// Number of columns that are read of all files.
    pub(super) fn width(&self) -> usize {
        self.signals.columns().map(|own| own.len()).sum()
    }

    /// What is read at other times than its own: the table where clocks differ, else the whole run.
    pub(super) fn resampled(&self, table: Option<usize>) -> Option<Resampled> {
        let Some(table) = table else {
            let (rate, step) = self.resample.filter(|_| self.clocks.is_empty())?;
            let clock = self.signals.first_time()?.clone();
            return Some(Resampled::new(
                self.name.clone(),
                clock,
                self.width(),
                (step, rate),
            ));
        };
        // The first file is read at its own times, unless the run is resampled.
        let mut clocks = self
            .clocks
            .iter()
            .skip(usize::from(self.resample.is_none()));
        let (_, place, step) = clocks.find(|(own, ..)| *own == table)?;
        let rate = match (self.resample, self.clocks.first()) {
            (Some((rate, _)), _) => rate,
            (None, first) => 1.0 / first?.2,
        };
        let width = self.signals.columns().nth(table)?.len();
        let file = self.tables[table].file().to_owned();
        Some(Resampled::new(
            file,
            Expression::Column(*place),
            width,
            (*step, rate),
        ))
    }

    /// The columns of a table that may hold a position within one turn, by their places in the table.
    pub(super) fn rotations_of(&self, table: usize) -> Vec<Rotation> {
        let mut widths = self.signals.columns().map(|own| own.len());
        let before = widths.by_ref().take(table).sum();
        let own = widths.next().unwrap_or_default();
        let all = self.rotations.iter();
        all.filter_map(|one| one.behind(before))
            .filter(|one| one.column < own)
            .collect()
    }

    /// Unwraps columns, or positions, that were found to wrap.
    ///
    /// # Errors
    /// Steps of which the direction is not known.
    pub(super) fn unwrap(&mut self, wraps: &[(WrapSource, Wrap)]) -> Result<(), Error> {
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
        // Of the others it is known that they do not wrap.
        self.rotations.retain(|own| own.period.is_some());
        self.rotating_values.retain(|own| own.period.is_some());
        Error::check(problems)
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
}
