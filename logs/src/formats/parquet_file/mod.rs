//! Parquet files of PyArrow, pandas, Polars, DuckDB and Spark.
//!
//! Columns are named and read some thousand rows at a time, so large files stay on disk. Numbers,
//! booleans, times and durations are supported. Text, dates and nested columns are rejected only if
//! they are requested.

mod durations;
mod kind;
mod packed;
mod pages;
mod rows;
mod writing;

use overact::Code;
use std::sync::Arc;

use parquet::{
    basic::Type,
    file::metadata::{FileMetaData, ParquetMetaData, ParquetMetaDataReader},
};

pub use writing::write_parquet;

use self::{
    durations::durations,
    kind::Kind,
    rows::{Rows, Wanted},
};
use crate::{
    bytes::byte_source::ByteSource,
    error::{Error, Problem},
    formats::table_file::{RowReader, TableFile},
    problems::{Existing, legible, only, shown, unreadable},
};

/// A Parquet file and its columns.
#[derive(Debug, Clone)]
pub(crate) struct Parquet {
    /// The file as the caller named it.
    file: String,
    medium: ByteSource,
    metadata: Arc<ParquetMetaData>,
    columns: Vec<Column>,
    /// Origin of instants, s since 1970; `None` without instants.
    origin: Option<i64>,
}

/// A top-level column of the schema.
#[derive(Debug, Clone, PartialEq)]
struct Column {
    name: String,
    /// Index among all leaf columns, including nested ones.
    leaf: usize,
    /// Conversion of its values, or a description of unsupported ones.
    kind: Result<Kind, String>,
}

impl Parquet {
    /// Opens a file.
    ///
    /// # Errors
    /// A file that cannot be read, is truncated or broken.
    pub(crate) fn open(file: String, medium: &ByteSource) -> Result<Self, Error> {
        let input = medium.open().map_err(|error| unreadable(&file, &error))?;
        let metadata = ParquetMetaDataReader::new().parse_and_finish(&input);
        let metadata = metadata.map_err(|error| broken(&file, &error.to_string()))?;
        let columns = columns(metadata.file_metadata());
        let mut opened = Self {
            file,
            medium: medium.clone(),
            metadata: Arc::new(metadata),
            columns,
            origin: None,
        };
        opened.origin = opened.beginning();
        Ok(opened)
    }

    /// Whole second of the first instant of the file; `None` without instants.
    fn beginning(&self) -> Option<i64> {
        let mut places = self.columns.iter();
        let place = places.position(|column| matches!(column.kind, Ok(Kind::Instant(_))))?;
        let mut first = [0.0];
        // Errors in the column are reported when it is requested.
        let found = self
            .rows(&[(place, "")])
            .and_then(|mut rows| rows.next(&mut first));
        (found == Ok(true)).then_some(first[0].floor() as i64)
    }
}

impl TableFile for Parquet {
    fn origin(&self) -> Option<i64> {
        self.origin
    }

    fn set_origin(&mut self, origin: i64) {
        self.origin = self.origin.map(|_| origin);
    }

    fn what(&self) -> &'static str {
        "a Parquet file"
    }

    fn file(&self) -> &str {
        &self.file
    }

    fn columns(&self) -> usize {
        self.columns.len()
    }

    fn find(&self, name: &str) -> Result<Option<usize>, Problem> {
        let names = self.columns.iter().map(|own| own.name.as_str());
        only(&self.file, name, names)
    }

    fn check(&self, place: usize) -> Result<(), Problem> {
        let Some(Column { name, kind, .. }) = self.columns.get(place) else {
            return Ok(());
        };
        let Err(what) = kind else {
            return Ok(());
        };
        let problem = Problem::new(Code::LOG_FORMAT, format!("column `{}` {what}", shown(name)));
        let problem = problem.file(self.file.as_str()).column(name.as_str());
        let help = "write a column of numbers (float64) for each signal and each actuator";
        Err(problem.help(help))
    }

    fn existing(&self) -> Existing<'_> {
        Existing {
            names: self.columns.iter().map(|own| own.name.as_str()).collect(),
            columns: self.columns(),
            what: "column",
        }
    }

    fn rows<'a>(&'a self, wanted: &[(usize, &'a str)]) -> Result<Box<dyn RowReader + 'a>, Error> {
        let input = self
            .medium
            .open()
            .map_err(|error| unreadable(&self.file, &error))?;
        let wanted = wanted.iter().filter_map(|&(place, name)| {
            let Column { leaf, kind, .. } = self.columns.get(place)?;
            let kind = *kind.as_ref().ok()?;
            Some(Wanted {
                leaf: *leaf,
                kind,
                name,
            })
        });
        let origin = self.origin.unwrap_or(0);
        let rows = Rows::new(&self.file, input, &self.metadata, wanted, origin);
        Ok(Box::new(rows))
    }
}

/// Top-level columns of a schema.
fn columns(metadata: &FileMetaData) -> Vec<Column> {
    let stored = metadata.key_value_metadata().into_iter().flatten();
    let arrow = stored.filter(|pair| pair.key == durations::KEY);
    let durations: Vec<(String, i64)> = arrow
        .filter_map(|pair| pair.value.as_deref())
        .flat_map(durations)
        .collect();
    let schema = metadata.schema_descr();
    let mut columns = Vec::new();
    let mut last = None;
    for (leaf, own) in schema.columns().iter().enumerate() {
        let number = schema.get_column_root_idx(leaf);
        if last.replace(number) == Some(number) {
            continue;
        }
        let root = schema.get_column_root(leaf);
        let parts = durations.iter().find(|(name, _)| name == root.name());
        let kind = match parts {
            _ if root.is_group() || own.max_rep_level() > 0 => {
                Err(String::from("is nested (a list or a structure)"))
            }
            Some((_, parts)) if own.physical_type() == Type::INT64 => Ok(Kind::Parts(*parts)),
            _ => Kind::of(own),
        };
        columns.push(Column {
            name: root.name().to_owned(),
            leaf,
            kind,
        });
    }
    columns
}

/// The problem of a file that cannot be opened.
fn broken(file: &str, why: &str) -> Problem {
    let message = format!(
        "the file starts like Parquet, but can't be read: {}",
        legible(why)
    );
    Problem::new(Code::LOG_FORMAT, message).file(file).help(
        "if it was copied or its writer was stopped, copy or write it again; otherwise export CSV",
    )
}
