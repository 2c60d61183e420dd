//! Rows of a table from a first one on, up to a number of them.

use crate::{error::Error, formats::table_file::RowReader};

/// Range of rows.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) struct RowRange {
    /// Number of rows before the range.
    pub(crate) first: usize,
    pub(crate) count: usize,
}

impl RowRange {
    /// All rows.
    pub(crate) const ALL: Self = Self {
        first: 0,
        count: usize::MAX,
    };
}

/// The remaining rows of a range.
#[derive(Debug)]
pub(crate) struct RangedRows<'a> {
    rows: Box<dyn RowReader + 'a>,
    left: RowRange,
    /// Number of rows read or skipped.
    passed: usize,
}

impl<'a> RangedRows<'a> {
    pub(crate) fn new(rows: Box<dyn RowReader + 'a>, range: RowRange) -> Self {
        Self {
            rows,
            left: range,
            passed: 0,
        }
    }

    /// Continues with a later range, whose rows have not been read yet.
    pub(crate) const fn enter(&mut self, range: RowRange) {
        self.left = RowRange {
            first: range.first.saturating_sub(self.passed),
            count: range.count,
        };
    }

    /// Writes the next row of the range to `values`; `false` at its end.
    ///
    /// # Errors
    /// Numbers of the range that are not finite, or a file that cannot be read further.
    pub(crate) fn next(&mut self, values: &mut [f64]) -> Result<bool, Error> {
        while self.left.first > 0 {
            self.left.first -= 1;
            self.passed += 1;
            match self.rows.next(values) {
                Ok(true) => {}
                Ok(false) => return Ok(false),
                Err(error) if self.rows.is_broken() => return Err(error),
                // Rows before the range may have any content.
                Err(_) => {}
            }
        }
        if self.left.count == 0 {
            return Ok(false);
        }
        self.left.count -= 1;
        self.passed += 1;
        self.rows.next(values)
    }

    /// The rows as stored in the file.
    pub(crate) fn logged(&self) -> &(dyn RowReader + 'a) {
        &*self.rows
    }
}
