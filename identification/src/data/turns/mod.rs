//! Positions of rotating joints that were logged within one turn.
//!
//! An encoder of one turn, or a wrapped angle, jumps by the period P of its column where it passes the end of the
//! turn. The step u between two samples that is nearest to zero modulo P undoes the jump,
//!
//! ```text
//! u = d - P round(d/P),   d = x_k - x_(k-1),
//! ```
//!
//! as long as the joint turns by less than half a turn between two samples. Columns are unwrapped as they are read,
//! in their own unit, before expressions, interpolation, filters and differences see them.
//!
//! - `watch`: whether a column wraps, and by which period;
//! - `columns`: which columns can wrap, and the periods that are possible.

mod columns;
mod watch;

use self::watch::Watch;
pub(super) use self::{columns::Position, watch::Wrap};
use super::table;
use crate::error::Error;

/// A column that may hold a position within one turn.
#[derive(Debug, Clone, PartialEq)]
pub(super) struct Rotation {
    /// Its place among the columns that are read.
    pub(super) column: usize,
    /// As messages call it.
    pub(super) name: String,
    /// The periods that are possible, in the unit of the column; that of the joint first.
    pub(super) periods: Vec<f64>,
    /// The period by which it wraps, once that is known.
    pub(super) period: Option<f64>,
}

impl Rotation {
    /// The same column by its place behind the first `before` ones; none if it comes earlier.
    pub(super) fn behind(&self, before: usize) -> Option<Self> {
        let column = self.column.checked_sub(before)?;
        Some(Self {
            column,
            ..self.clone()
        })
    }
}

/// Unwraps the columns of rows that are gone through, and watches those whose period is not known.
#[derive(Debug)]
pub(super) struct Unwrapper {
    columns: Vec<Column>,
}

/// A column that may wrap.
#[derive(Debug)]
struct Column {
    rotation: Rotation,
    /// The value before, as it was logged, and what is added to it.
    last: Option<(f64, f64)>,
    watch: Watch,
}

impl Unwrapper {
    pub(super) fn new(rotations: Vec<Rotation>) -> Self {
        let column = |rotation: Rotation| Column {
            watch: Watch::new(&rotation.periods),
            last: None,
            rotation,
        };
        Self {
            columns: rotations.into_iter().map(column).collect(),
        }
    }

    /// Takes the next row and unwraps its columns.
    pub(super) fn take(&mut self, row: &mut [f64]) {
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

    /// What was found of the columns that were watched: those that wrap.
    pub(super) fn wraps(&self) -> Vec<Wrap> {
        let watched = self.columns.iter();
        watched
            .filter_map(|own| own.watch.wrap(&own.rotation))
            .collect()
    }
}

/// The rest of a table whose columns are unwrapped.
#[derive(Debug)]
pub(super) struct UnwrappedRows<'a> {
    rows: table::Rows<'a>,
    pub(super) unwrapper: Unwrapper,
}

impl<'a> UnwrappedRows<'a> {
    pub(super) fn new(rows: table::Rows<'a>, rotations: Vec<Rotation>) -> Self {
        Self {
            rows,
            unwrapper: Unwrapper::new(rotations),
        }
    }

    /// Puts the numbers of the next sample into `values`; `false` at the end.
    ///
    /// # Errors
    /// Numbers that are not finite, or a file that can't be read on.
    pub(super) fn next(&mut self, values: &mut [f64]) -> Result<bool, Error> {
        let goes_on = self.rows.next(values)?;
        if goes_on {
            self.unwrapper.take(values);
        }
        Ok(goes_on)
    }

    /// The rows as they are in the file.
    pub(super) const fn logged(&self) -> &table::Rows<'a> {
        &self.rows
    }
}

#[cfg(test)]
mod tests;
