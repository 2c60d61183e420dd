//! Rows of a Parquet file, some thousand at a time.
//!
//! Memory is independent of the size of the file and of its row groups.

use overact::Code;
use std::{fmt, sync::Arc};

use parquet::{
    basic::Compression,
    column::reader::{ColumnReader, ColumnReaderImpl, get_column_reader},
    data_type::DataType,
    errors::ParquetError,
    file::{
        metadata::{ColumnChunkMetaData, ParquetMetaData},
        reader::Length,
    },
};

use super::{kind::Kind, pages::Pages};
use crate::{
    bytes::byte_source::Opened,
    error::{Error, Problem},
    formats::table_file::RowReader,
    problems::{legible, shown},
};

/// Number of rows of a column in memory.
const BATCH: usize = 4096;

/// A requested column: its leaf, its conversion, and its name for messages.
#[derive(Debug, Clone, Copy)]
pub(super) struct Wanted<'a> {
    pub(super) leaf: usize,
    pub(super) kind: Kind,
    pub(super) name: &'a str,
}

/// The remaining rows of a file.
#[derive(Debug)]
pub(super) struct Rows<'a> {
    /// The file as the caller named it.
    file: &'a str,
    input: Arc<Opened>,
    metadata: &'a ParquetMetaData,
    /// Origin of instants, s since 1970.
    origin: i64,
    columns: Vec<Column<'a>>,
    /// Number of row groups started.
    groups: usize,
    /// Unread rows of the last group.
    left: usize,
    /// Rows of the batch, and number of those returned.
    filled: usize,
    next: usize,
    /// Number of rows returned.
    samples: usize,
    is_broken: bool,
}

impl<'a> Rows<'a> {
    /// Starts at the first row of an open file.
    pub(super) fn new(
        file: &'a str,
        input: Opened,
        metadata: &'a ParquetMetaData,
        wanted: impl Iterator<Item = Wanted<'a>>,
        origin: i64,
    ) -> Self {
        let column = |wanted| Column {
            wanted,
            reader: None,
            levels: Vec::new(),
            values: Vec::new(),
        };
        Self {
            file,
            input: Arc::new(input),
            metadata,
            origin,
            columns: wanted.map(column).collect(),
            groups: 0,
            left: 0,
            filled: 0,
            next: 0,
            samples: 0,
            is_broken: false,
        }
    }

    /// Reads the next rows of all columns; `false` at the end.
    fn fill(&mut self) -> Result<bool, Problem> {
        while self.left == 0 {
            if self.groups == self.metadata.num_row_groups() {
                return Ok(false);
            }
            let group = self.metadata.row_group(self.groups);
            let rows = usize::try_from(group.num_rows());
            self.left = rows.map_err(|_| self.broken(None, "a row group has less than no rows"))?;
            for number in 0..self.columns.len() {
                let Wanted { leaf, .. } = self.columns[number].wanted;
                let chunk = group.columns().get(leaf);
                let reader = chunk
                    .ok_or_else(|| String::from("a row group lacks it"))
                    .and_then(|chunk| open(&self.input, chunk, self.left));
                let reader = reader.map_err(|why| self.broken(Some(number), &why))?;
                self.columns[number].reader = Some(reader);
            }
            self.groups += 1;
        }
        let count = self.left.min(BATCH);
        for number in 0..self.columns.len() {
            let read = self.columns[number].read(count, self.origin);
            read.map_err(|why| self.broken(Some(number), &why))?;
        }
        self.left -= count;
        self.filled = count;
        self.next = 0;
        Ok(true)
    }

    /// The problem of a file that cannot be read further.
    fn broken(&self, column: Option<usize>, why: &str) -> Problem {
        let from = format!("from sample {} on: {}", self.samples, legible(why));
        let help = "if the file was copied or its writer was stopped, copy or write it again; otherwise export CSV";
        let Some(column) = column else {
            let message = format!("the Parquet file can't be read {from}");
            return Problem::new(Code::LOG_FORMAT, message)
                .file(self.file)
                .help(help);
        };
        let name = self.columns[column].wanted.name;
        let message = format!("column `{}` can't be read {from}", shown(name));
        let problem = Problem::new(Code::LOG_FORMAT, message)
            .file(self.file)
            .column(name);
        problem.help(if why.ends_with(NOT_READ) {
            "write it with the compression snappy, zstd, gzip or lz4, or none"
        } else {
            help
        })
    }
}

impl RowReader for Rows<'_> {
    fn is_broken(&self) -> bool {
        self.is_broken
    }

    // Mean over the rows, since columns are stored one after the other.
    fn bytes(&self) -> u64 {
        let rows = self.metadata.file_metadata().num_rows().max(1) as f64;
        let part = (self.samples as f64 / rows).min(1.0);
        (part * self.input.len() as f64) as u64
    }

    fn next(&mut self, values: &mut [f64]) -> Result<bool, Error> {
        if self.columns.is_empty() {
            return Ok(false);
        }
        if self.next == self.filled {
            let filled = self.fill();
            self.is_broken |= filled.is_err();
            if !filled? {
                return Ok(false);
            }
        }
        let mut problems = Vec::new();
        for (column, value) in self.columns.iter().zip(values) {
            let found = column.values[self.next];
            *value = found.unwrap_or(f64::NAN);
            if value.is_finite() {
                continue;
            }
            let what = match found {
                Some(_) => "is not a finite number",
                None => "has no value (null)",
            };
            let name = column.wanted.name;
            let message = format!("`{}`: sample {} {what}", shown(name), self.samples);
            problems.push(
                Problem::new(Code::NOT_A_NUMBER, message)
                    .file(self.file)
                    .column(name),
            );
        }
        self.next += 1;
        self.samples += 1;
        Error::check(problems)?;
        Ok(true)
    }
}

/// Description of an unsupported compression.
const NOT_READ: &str = "which is not supported";

/// Opens a column of a row group.
fn open(
    input: &Arc<Opened>,
    chunk: &ColumnChunkMetaData,
    rows: usize,
) -> Result<ColumnReader, String> {
    match chunk.compression() {
        Compression::BROTLI(_) => return Err(format!("it is compressed by Brotli, {NOT_READ}")),
        Compression::LZO => return Err(format!("it is compressed by LZO, {NOT_READ}")),
        _ => {}
    }
    // The library assumes valid positions of chunks.
    let start = chunk.dictionary_page_offset();
    let start = u64::try_from(start.unwrap_or(chunk.data_page_offset()));
    let size = u64::try_from(chunk.compressed_size());
    let end = start.ok().zip(size.ok());
    let end = end.and_then(|(start, size)| start.checked_add(size));
    if end.is_none_or(|end| end > input.len()) {
        return Err(String::from("it ends after the end of the file"));
    }
    let pages = Pages::new(input, chunk, rows);
    let pages = pages.map_err(|error| error.to_string())?;
    Ok(get_column_reader(chunk.column_descr_ptr(), Box::new(pages)))
}

/// A column that is being read.
struct Column<'a> {
    wanted: Wanted<'a>,
    reader: Option<ColumnReader>,
    /// Definition levels: whether rows have a value.
    levels: Vec<i16>,
    /// Rows of the batch; `None` for missing values.
    values: Vec<Option<f64>>,
}

impl fmt::Debug for Column<'_> {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        self.wanted.fmt(f)
    }
}

impl Column<'_> {
    /// Reads the next `count` rows.
    fn read(&mut self, count: usize, origin: i64) -> Result<(), String> {
        use ColumnReader as Of;
        self.levels.clear();
        self.values.clear();
        let kind = self.wanted.kind;
        let Some(reader) = &mut self.reader else {
            return Ok(());
        };
        let (levels, values) = (&mut self.levels, &mut self.values);
        let read = match reader {
            Of::DoubleColumnReader(own) => batch(own, count, levels, values, |value| *value),
            Of::FloatColumnReader(own) => {
                batch(own, count, levels, values, |value| f64::from(*value))
            }
            Of::Int64ColumnReader(own) => batch(own, count, levels, values, |value| {
                kind.long(*value, origin)
            }),
            Of::Int32ColumnReader(own) => batch(own, count, levels, values, |value| {
                kind.short(*value, origin)
            }),
            Of::Int96ColumnReader(own) => batch(own, count, levels, values, |value| {
                kind.long(value.to_nanos(), origin)
            }),
            Of::BoolColumnReader(own) => {
                batch(own, count, levels, values, |value| f64::from(*value))
            }
            Of::ByteArrayColumnReader(_) | Of::FixedLenByteArrayColumnReader(_) => {
                return Err(String::from("it has no numbers"));
            }
        };
        read.map_err(|error| error.to_string())?;
        if self.values.len() == count {
            Ok(())
        } else {
            Err(String::from("it has fewer values than the file has rows"))
        }
    }
}

/// Reads `count` rows of a column of one type.
fn batch<T: DataType>(
    reader: &mut ColumnReaderImpl<T>,
    count: usize,
    levels: &mut Vec<i16>,
    values: &mut Vec<Option<f64>>,
    number: impl Fn(&T::T) -> f64,
) -> Result<(), ParquetError> {
    let mut found = Vec::with_capacity(count);
    let (rows, ..) = reader.read_records(count, Some(levels), None, &mut found)?;
    let mut found = found.iter().map(number);
    if levels.is_empty() {
        // A required column, in which every row has a value.
        values.extend(found.map(Some).take(rows));
    } else {
        let present = levels.iter().map(|level| *level > 0);
        values.extend(present.map(|present| if present { found.next() } else { None }));
    }
    Ok(())
}
