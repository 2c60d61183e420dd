//! A file of any format as a table of columns.

use overact::Code;
use std::sync::Arc;

#[cfg(feature = "hdf5")]
use crate::formats::hdf5_file;
#[cfg(feature = "mcap")]
use crate::formats::mcap_file;
use crate::{
    bytes::byte_source::ByteSource,
    error::{Error, Problem},
    formats::{
        arrays::{self, Arrays},
        format::{self, Format},
        json_lines::JsonLines,
        mat_file, numpy,
        parquet_file::Parquet,
        stored::{Stored, StoredRows},
        text::{self, Text},
    },
    problems::Existing,
};

/// An open file, or one of its parts.
#[derive(Debug, Clone)]
pub(crate) enum Table {
    /// Lines of numbers, read repeatedly.
    Text(Text),
    /// Columns, read repeatedly in blocks.
    Stored(Arc<dyn Stored>),
    /// Arrays in memory.
    Arrays(Arrays),
}

impl PartialEq for Table {
    fn eq(&self, other: &Self) -> bool {
        match (self, other) {
            (Self::Text(own), Self::Text(other)) => own == other,
            (Self::Arrays(own), Self::Arrays(other)) => own == other,
            (Self::Stored(own), Self::Stored(other)) => {
                let key =
                    |stored: &Arc<dyn Stored>| (stored.label(), stored.what(), stored.origin());
                key(own) == key(other)
            }
            _ => false,
        }
    }
}

impl Table {
    /// Opens a file of any format: one table, or one for each of its parts.
    ///
    /// # Errors
    /// A file that cannot be read, or of an unsupported format.
    pub(crate) fn open(file: String, medium: &ByteSource) -> Result<Vec<Self>, Error> {
        let (format, unpacked) = format::recognise(&file, medium)?;
        let medium = unpacked.as_ref().unwrap_or(medium);
        let one = match format {
            Format::Text => {
                let parts = Text::open(file, medium)?.into_iter();
                return Ok(parts.map(Self::Text).collect());
            }
            Format::Mat => Self::Arrays(mat_file::open(file, medium)?),
            Format::JsonLines => Self::Stored(Arc::new(JsonLines::open(file, medium)?)),
            Format::Parquet => Self::Stored(Arc::new(Parquet::open(file, medium)?)),
            Format::Array => Self::Arrays(numpy::open_array(file, medium)?),
            Format::Archive => Self::Arrays(numpy::open_archive(file, medium)?),
            #[cfg(feature = "hdf5")]
            Format::Hdf5 => {
                let path = on_disk(&file, medium)?;
                Self::Stored(Arc::new(hdf5_file::Hdf5::open(file, path)?))
            }
            #[cfg(feature = "mcap")]
            Format::Mcap => {
                let topics = mcap_file::open(&file, on_disk(&file, medium)?)?.into_iter();
                return Ok(topics.map(|own| Self::Stored(Arc::new(own))).collect());
            }
        };
        Ok(vec![one])
    }

    /// The file as the caller named it.
    pub(crate) fn file(&self) -> &str {
        match self {
            Self::Text(text) => text.file(),
            Self::Stored(stored) => stored.file(),
            Self::Arrays(arrays) => arrays.file(),
        }
    }

    /// Name in messages, if a file may have several parts.
    pub(crate) fn label(&self) -> String {
        match self {
            Self::Stored(stored) => stored.label(),
            _ => self.file().to_owned(),
        }
    }

    /// Name of a column that is unique among the parts of the file.
    pub(crate) fn full_name(&self, column: &str) -> String {
        match self {
            Self::Stored(stored) => stored.full_name(column),
            _ => column.to_owned(),
        }
    }

    /// Whether it is one of several parts of its file, which are used only if requested.
    pub(crate) fn is_part(&self) -> bool {
        match self {
            Self::Text(text) => text.is_part(),
            Self::Stored(stored) => stored.is_part(),
            Self::Arrays(_) => false,
        }
    }

    /// Whether the numbers are in memory.
    pub(crate) const fn in_memory(&self) -> bool {
        matches!(self, Self::Arrays(_))
    }

    /// Whether numbers must be parsed from text.
    pub(crate) fn is_text(&self) -> bool {
        match self {
            Self::Text(_) => true,
            Self::Stored(stored) => stored.is_slow(),
            Self::Arrays(_) => false,
        }
    }

    /// Number of columns that can be selected by number.
    pub(crate) fn columns(&self) -> usize {
        match self {
            Self::Text(text) => text.columns(),
            Self::Stored(stored) => stored.columns(),
            Self::Arrays(arrays) => arrays.columns(),
        }
    }

    /// Index of the column with this name.
    ///
    /// # Errors
    /// Several columns with this name.
    pub(crate) fn find(&self, name: &str) -> Result<Option<usize>, Problem> {
        match self {
            Self::Text(text) => text.find(name),
            Self::Stored(stored) => stored.find(name),
            Self::Arrays(arrays) => arrays.find(name),
        }
    }

    /// Checks that a column contains numbers.
    ///
    /// # Errors
    /// Description of its values otherwise.
    pub(crate) fn check(&self, place: usize) -> Result<(), Problem> {
        match self {
            // Cells of a text are checked one by one; arrays contain numbers only.
            Self::Text(_) | Self::Arrays(_) => Ok(()),
            Self::Stored(stored) => stored.check(place),
        }
    }

    /// Origin of instants, s since 1970; `None` without instants.
    pub(crate) fn origin(&self) -> Option<i64> {
        match self {
            Self::Text(text) => text.origin(),
            Self::Stored(stored) => stored.origin(),
            Self::Arrays(_) => None,
        }
    }

    /// Sets the origin of instants, unless the table is shared.
    pub(crate) fn set_origin(&mut self, origin: i64) {
        match self {
            Self::Text(text) => text.set_origin(origin),
            Self::Stored(stored) => {
                if let Some(stored) = Arc::get_mut(stored) {
                    stored.set_origin(origin);
                }
            }
            Self::Arrays(_) => {}
        }
    }

    /// Note on parts of the file that are not read.
    pub(crate) fn note(&self) -> Option<String> {
        match self {
            Self::Text(text) => text.note(),
            Self::Stored(_) | Self::Arrays(_) => None,
        }
    }

    /// The problem of a text without a line.
    pub(crate) fn without_lines(&self) -> Option<Problem> {
        let Self::Text(text) = self else {
            return None;
        };
        let problem = Problem::new(Code::LOG_TOO_SHORT, "the file is empty").file(text.file());
        let help = "give a log with the samples of a whole motion";
        text.is_empty().then(|| problem.help(help))
    }

    /// Name of the format.
    pub(crate) fn what(&self) -> &'static str {
        match self {
            Self::Text(_) => "a text",
            Self::Stored(stored) => stored.what(),
            Self::Arrays(_) => "a file of arrays",
        }
    }

    /// Whether the format supports scalar variables.
    pub(crate) fn has_variables(&self) -> bool {
        match self {
            Self::Text(_) => false,
            Self::Stored(stored) => stored.has_variables(),
            Self::Arrays(_) => true,
        }
    }

    /// Values of a variable, possibly a scalar; only arrays are variables.
    pub(crate) fn variable(&self, name: &str) -> Option<&[f64]> {
        match self {
            Self::Text(_) => None,
            Self::Stored(stored) => stored.variable(name),
            Self::Arrays(arrays) => arrays.values(name),
        }
    }

    /// The existing columns.
    pub(crate) fn existing(&self) -> Existing<'_> {
        match self {
            Self::Text(text) => text.existing(),
            Self::Stored(stored) => stored.existing(),
            Self::Arrays(arrays) => arrays.existing(),
        }
    }

    /// First column of a matrix that is named like a vector.
    pub(crate) fn first_column(&self, name: &str) -> Option<&str> {
        match self {
            Self::Text(_) => None,
            Self::Stored(stored) => stored.first_column(name),
            Self::Arrays(arrays) => arrays.first_column(name),
        }
    }

    /// Reads some columns from the first sample on; the names are for messages.
    ///
    /// # Errors
    /// A file that cannot be read any more, or columns of different lengths.
    pub(crate) fn rows<'a>(&'a self, wanted: &[(usize, &'a str)]) -> Result<Rows<'a>, Error> {
        Ok(match self {
            Self::Text(text) => Rows::Text(text.rows(wanted)?),
            Self::Stored(stored) => Rows::Stored(stored.rows(wanted)?),
            Self::Arrays(arrays) => Rows::Arrays(arrays.rows(wanted)?),
        })
    }
}

/// Path of a file whose format can only be read from disk.
#[cfg(any(feature = "hdf5", feature = "mcap"))]
fn on_disk<'m>(file: &str, medium: &'m ByteSource) -> Result<&'m std::path::Path, Error> {
    medium.path().ok_or_else(|| {
        let message = "files of this format can be read from a disk only";
        Problem::new(overact::Code::LOG_FORMAT, message)
            .file(file)
            .help("export CSV")
            .into()
    })
}

/// The remaining rows of a table.
#[derive(Debug)]
pub(crate) enum Rows<'a> {
    Text(text::Rows<'a>),
    Stored(Box<dyn StoredRows + 'a>),
    Arrays(arrays::Rows<'a>),
}

impl Rows<'_> {
    /// Writes the next sample to `values`; `false` at the end.
    ///
    /// # Errors
    /// Numbers that are not finite, or a file that cannot be read further.
    pub(crate) fn next(&mut self, values: &mut [f64]) -> Result<bool, Error> {
        match self {
            Self::Text(rows) => rows.next(values),
            Self::Stored(rows) => rows.next(values),
            Self::Arrays(rows) => rows.next(values),
        }
    }

    /// Line of the last sample, if the file has lines.
    pub(crate) fn line(&self) -> Option<usize> {
        match self {
            Self::Text(rows) => Some(rows.line()),
            Self::Stored(rows) => rows.line(),
            Self::Arrays(_) => None,
        }
    }

    /// Whether nothing more can be read.
    pub(crate) fn is_broken(&self) -> bool {
        match self {
            Self::Text(rows) => rows.is_broken(),
            Self::Stored(rows) => rows.is_broken(),
            Self::Arrays(_) => false,
        }
    }

    /// Number of bytes of the file read.
    pub(crate) fn bytes(&self) -> u64 {
        match self {
            Self::Text(rows) => rows.bytes(),
            Self::Stored(rows) => rows.bytes(),
            Self::Arrays(_) => 0,
        }
    }
}
