//! Files that stay on the disk: what is asked of every format whose columns are read block by block.

use std::fmt::Debug;

use super::problems::Existing;
use crate::error::{Error, Problem};

/// A file, or a part of one, that has been opened and whose columns are read again and again.
pub(super) trait Stored: Debug + Send + Sync {
    /// The file as the caller named it.
    fn file(&self) -> &str;

    /// What it is called where a file may have several parts.
    fn label(&self) -> String {
        self.file().to_owned()
    }

    /// The name of a column that no other part of the file has.
    fn full_name(&self, column: &str) -> String {
        column.to_owned()
    }

    /// What a file of this format is called.
    fn what(&self) -> &'static str;

    /// Whether it is one of several parts of its file, which are used only where their columns are.
    fn is_part(&self) -> bool {
        false
    }

    /// Number of columns that can be called by number.
    fn columns(&self) -> usize;

    /// The place of a column that is called by its name.
    ///
    /// # Errors
    /// Several columns of this name.
    fn find(&self, name: &str) -> Result<Option<usize>, Problem>;

    /// Whether a column has numbers.
    ///
    /// # Errors
    /// What it has in their place.
    fn check(&self, _place: usize) -> Result<(), Problem> {
        Ok(())
    }

    /// What instants are counted from, s since 1970; none where there are no instants.
    fn origin(&self) -> Option<i64> {
        None
    }

    /// Says what instants are counted from, so that those of several files go together.
    fn set_origin(&mut self, _origin: i64) {}

    /// The values of a variable that is a single number.
    fn variable(&self, _name: &str) -> Option<&[f64]> {
        None
    }

    /// Whether single numbers can stand in the file.
    fn has_variables(&self) -> bool {
        false
    }

    /// The first column of a matrix that is called as if it were a vector.
    fn first_column(&self, _name: &str) -> Option<&str> {
        None
    }

    /// What columns there are.
    fn existing(&self) -> Existing<'_>;

    /// Goes through some columns, whose names are for messages, from the first row on.
    ///
    /// # Errors
    /// A file that can't be read any more, or that was written anew; columns of different lengths.
    fn rows<'a>(&'a self, wanted: &[(usize, &'a str)]) -> Result<Box<dyn StoredRows + 'a>, Error>;
}

/// The rest of a file.
pub(super) trait StoredRows: Debug {
    /// Puts the numbers of the next row into `values`; `false` at the end.
    ///
    /// # Errors
    /// Every cell of the row that is no finite number, or a file that can't be read on.
    fn next(&mut self, values: &mut [f64]) -> Result<bool, Error>;

    /// Whether nothing more can be read.
    fn is_broken(&self) -> bool;

    /// Bytes of the file that have been read.
    fn bytes(&self) -> u64;
}
