//! Interface of a log's format: an open file as columns of numbers.

use std::fmt::Debug;

use crate::{
    error::{Error, Problem},
    problems::Existing,
};

/// An open file, or a part of one, whose columns are read repeatedly.
pub(crate) trait TableFile: Debug + Send + Sync {
    /// The file as the caller named it.
    fn file(&self) -> &str;

    /// Name in messages, if a file may have several parts.
    fn label(&self) -> String {
        self.file().to_owned()
    }

    /// Name of a column that is unique among the parts of the file.
    fn full_name(&self, column: &str) -> String {
        column.to_owned()
    }

    /// Name of the format.
    fn what(&self) -> &'static str;

    /// Whether it is one of several parts of its file, which are used only if requested.
    fn is_part(&self) -> bool {
        false
    }

    /// Whether the file has no content.
    fn is_empty(&self) -> bool {
        false
    }

    /// Whether the numbers are in memory.
    fn in_memory(&self) -> bool {
        false
    }

    /// Note on content that is not read.
    fn note(&self) -> Option<String> {
        None
    }

    /// Whether numbers must be parsed from text.
    fn is_slow(&self) -> bool {
        false
    }

    /// Number of columns that can be selected by number.
    fn columns(&self) -> usize;

    /// Index of the column with this name.
    ///
    /// # Errors
    /// Several columns with this name.
    fn find(&self, name: &str) -> Result<Option<usize>, Problem>;

    /// Checks that a column contains numbers.
    ///
    /// # Errors
    /// Description of its values otherwise.
    fn check(&self, _place: usize) -> Result<(), Problem> {
        Ok(())
    }

    /// Origin of instants, s since 1970; `None` without instants.
    fn origin(&self) -> Option<i64> {
        None
    }

    /// Sets the origin of instants, to be common to several files.
    fn set_origin(&mut self, _origin: i64) {}

    /// Value of a scalar variable.
    fn variable(&self, _name: &str) -> Option<&[f64]> {
        None
    }

    /// Whether the format supports scalar variables.
    fn has_variables(&self) -> bool {
        false
    }

    /// First column of a matrix that is named like a vector.
    fn first_column(&self, _name: &str) -> Option<&str> {
        None
    }

    /// The existing columns.
    fn existing(&self) -> Existing<'_>;

    /// Reads some columns from the first row on; the names are for messages.
    ///
    /// # Errors
    /// A file that cannot be read any more, or was changed; columns of different lengths.
    fn rows<'a>(&'a self, wanted: &[(usize, &'a str)]) -> Result<Box<dyn RowReader + 'a>, Error>;
}

/// The remaining rows of a file.
pub(crate) trait RowReader: Debug {
    /// Writes the next row to `values`; `false` at the end.
    ///
    /// # Errors
    /// Every cell of the row that is no finite number, or a file that cannot be read further.
    fn next(&mut self, values: &mut [f64]) -> Result<bool, Error>;

    /// Line of the last row, if the file has lines.
    fn line(&self) -> Option<usize> {
        None
    }

    /// Whether nothing more can be read.
    fn is_broken(&self) -> bool {
        false
    }

    /// Number of bytes of the file read.
    fn bytes(&self) -> u64;
}
