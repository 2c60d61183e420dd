//! Unwraps positions of rotating joints that were logged within one turn.
//!
//! A single-turn encoder, or a wrapped angle, jumps by the period P of its column at the end of the
//! turn. The smallest step u modulo P between two samples removes the jump,
//!
//! ```text
//! u = d - P round(d/P),   d = x_k - x_(k-1),
//! ```
//!
//! if the joint moves by less than half a turn between two samples. Columns are unwrapped on
//! reading, in their own unit, before expressions, interpolation, filters and differences.
//!
//! - `watch`: detects whether a column wraps, and its period;
//! - `columns`: columns that can wrap, and their possible periods.

mod columns;
mod watch;

use self::watch::Watch;
pub(crate) use self::{columns::Position, watch::Wrap};
use crate::{
    error::Error,
    formats::{
        row_range::{RangedRows, RowRange},
        table_file::RowReader,
    },
};

/// A column that may be a wrapped angle.
#[derive(Debug, Clone, PartialEq)]
pub(crate) struct Rotation {
    /// Index among the requested columns.
    pub(crate) column: usize,
    /// Name in messages.
    pub(crate) name: String,
    /// Possible periods, in the unit of the column; that of the joint first.
    pub(crate) periods: Vec<f64>,
    /// Period of the wrapped angle, once it is known.
    pub(crate) period: Option<f64>,
}

impl Rotation {
    /// The same column, with its index reduced by `before`; `None` if that is negative.
    pub(crate) fn behind(&self, before: usize) -> Option<Self> {
        let column = self.column.checked_sub(before)?;
        Some(Self {
            column,
            ..self.clone()
        })
    }
}

/// Unwraps columns with known periods, and watches the others.
#[derive(Debug)]
pub(crate) struct Unwrapper {
    columns: Vec<Column>,
}

/// A column that may wrap.
#[derive(Debug)]
struct Column {
    rotation: Rotation,
    /// The previous logged value, and the offset added to it.
    last: Option<(f64, f64)>,
    watch: Watch,
}

impl Unwrapper {
    pub(crate) fn new(rotations: Vec<Rotation>) -> Self {
        let column = |rotation: Rotation| Column {
            watch: Watch::new(&rotation.periods),
            last: None,
            rotation,
        };
        Self {
            columns: rotations.into_iter().map(column).collect(),
        }
    }

    /// Unwraps the columns of the next row.
    pub(crate) fn take(&mut self, row: &mut [f64]) {
        for own in &mut self.columns {
            let Some(value) = row.get_mut(own.rotation.column) else {
                continue;
            };
            let Some(period) = own.rotation.period else {
                own.watch.take(*value);
                continue;
            };
            let logged = *value;
            let (before, turns) = own.last.unwrap_or((logged, 0.0));
            let turns = turns - ((logged - before) / period).round();
            own.last = Some((logged, turns));
            *value += turns * period;
        }
    }

    /// Forgets the last row, since the next one does not follow it.
    pub(crate) fn interrupt(&mut self) {
        for own in &mut self.columns {
            own.last = None;
            own.watch.interrupt();
        }
    }

    /// The watched columns that wrap.
    pub(crate) fn wraps(&self) -> Vec<Wrap> {
        let watched = self.columns.iter();
        watched
            .filter_map(|own| own.watch.wrap(&own.rotation))
            .collect()
    }
}

/// The remaining rows of a table, with unwrapped columns.
#[derive(Debug)]
pub(crate) struct UnwrappedRows<'a> {
    rows: RangedRows<'a>,
    pub(crate) unwrapper: Unwrapper,
}

impl<'a> UnwrappedRows<'a> {
    pub(crate) fn new(rows: RangedRows<'a>, rotations: Vec<Rotation>) -> Self {
        Self {
            rows,
            unwrapper: Unwrapper::new(rotations),
        }
    }

    /// Continues with a later range of rows, which do not follow the last one.
    pub(crate) fn enter(&mut self, range: RowRange) {
        self.rows.enter(range);
        self.unwrapper.interrupt();
    }

    /// Writes the next sample to `values`; `false` at the end.
    ///
    /// # Errors
    /// Numbers that are not finite, or a file that cannot be read further.
    pub(crate) fn next(&mut self, values: &mut [f64]) -> Result<bool, Error> {
        let goes_on = self.rows.next(values)?;
        if goes_on {
            self.unwrapper.take(values);
        }
        Ok(goes_on)
    }

    /// The rows as stored in the file.
    pub(crate) fn logged(&self) -> &(dyn RowReader + 'a) {
        self.rows.logged()
    }
}

#[cfg(test)]
mod tests;
