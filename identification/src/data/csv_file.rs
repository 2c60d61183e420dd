//! CSV files with a header; lines that start with `#` are comments.
//!
//! A file is looked through once, from end to end, when it is opened: every cell is checked, samples
//! are counted and the frequency is told. A small one is in memory then; a large one is read again,
//! row by row, whenever its run is gone through.

use std::{
    fs::File,
    io::BufReader,
    path::{Path, PathBuf},
};

use csv::{ByteRecord, ReaderBuilder, StringRecord, Trim};

use super::{
    Gain, LARGEST_NUMBER_OF_PROBLEMS, Log, Mapping, display_name,
    log::{Clock, Samples},
    missing_columns, unreadable,
};
use crate::error::{Error, Problem};

/// Numbers of one file that are kept in memory (8 MB).
const LARGEST_IN_MEMORY: usize = 1 << 20;

/// Bytes that are read at once.
const BUFFER: usize = 1 << 18;

/// Reads a run from a CSV file.
///
/// # Errors
/// A file that can't be read, missing columns, cells that are not finite numbers, a time that is
/// not uniform, or a mapping that is not right.
pub fn read_csv(path: &Path, mapping: &Mapping, payload: bool) -> Result<Log, Error> {
    read_telling(path, mapping, payload, &|_| {})
}

/// Reads a run from CSV; `advance` is told every now and then how many bytes more have been read.
pub(super) fn read_telling(
    path: &Path,
    mapping: &Mapping,
    payload: bool,
    advance: &dyn Fn(u64),
) -> Result<Log, Error> {
    let file = display_name(path);
    mapping.check()?;
    let source = Source {
        gains: constant_gains(&file, mapping)?,
        file,
        path: path.to_owned(),
        mapping: mapping.clone(),
    };
    let mut rows = source.open()?;
    let mut clock = Clock::default();
    let mut samples = Samples::default();
    let mut problems = Vec::new();
    let (mut fits, mut told) = (true, 0);
    loop {
        let bytes = rows.reader.position().byte();
        if bytes - told >= BUFFER as u64 {
            advance(bytes - told);
            told = bytes;
        }
        match rows.next(&mut samples) {
            Ok(true) => clock.push(rows.time, Some(rows.line)),
            Ok(false) => break,
            Err(error) => problems.extend(error.problems),
        }
        if rows.is_broken || problems.len() >= LARGEST_NUMBER_OF_PROBLEMS {
            break;
        }
        if fits && 2 * samples.positions.len() > LARGEST_IN_MEMORY {
            fits = false;
        }
        if !fits {
            samples.positions.clear();
            samples.torques.clear();
        }
    }
    Error::check(problems)?;
    let count = clock.samples();
    let frequency = clock.frequency(&source.file)?;
    let log = if fits {
        let Samples { positions, torques } = samples;
        let actuators = source.actuators();
        Log::new(
            source.file,
            frequency,
            actuators,
            positions,
            torques,
            payload,
        )?
    } else {
        Log::in_file(source, frequency, count, payload)
    };
    Ok(log.without_offsets(&mapping.position_offset))
}

/// The gains of the mapping, which must all be numbers: a CSV file has no scalar variables.
fn constant_gains(file: &str, mapping: &Mapping) -> Result<Vec<f64>, Error> {
    let mut problems = Vec::new();
    let mut gains = Vec::new();
    for gain in &mapping.torque_gain {
        match gain {
            Gain::Value(value) => gains.push(*value),
            Gain::Variable(name) => problems.push(
                Problem::new(format!(
                    "the torque gain is the variable `{name}`, but a CSV file has no variables"
                ))
                .file(file)
                .column(name.as_str())
                .help("give the gain as a number"),
            ),
        }
    }
    Error::check(problems)?;
    Ok(gains)
}

/// A file and what its columns mean.
#[derive(Debug, Clone, PartialEq)]
pub(super) struct Source {
    /// The file as the caller named it.
    file: String,
    path: PathBuf,
    mapping: Mapping,
    gains: Vec<f64>,
}

impl Source {
    /// The file as the caller named it.
    pub(super) fn file(&self) -> &str {
        &self.file
    }

    /// Number of actuators.
    pub(super) fn actuators(&self) -> usize {
        self.mapping.positions.len()
    }

    /// Opens the file and finds its columns.
    pub(super) fn open(&self) -> Result<Rows<'_>, Error> {
        let input = File::open(&self.path).map_err(|error| unreadable(&self.file, &error))?;
        let mut reader = ReaderBuilder::new()
            .trim(Trim::All)
            .flexible(true)
            .comment(Some(b'#'))
            .from_reader(BufReader::with_capacity(BUFFER, input));
        let header = match reader.headers() {
            Ok(header) => header.clone(),
            Err(error) => return Err(self.broken(&error).into()),
        };
        let names = self.mapping.names();
        let indices = find_columns(&self.file, &header, &names)?;
        let ones = std::iter::once(&1.0);
        let scales = ones.chain(&self.mapping.position_scale).chain(&self.gains);
        Ok(Rows {
            source: self,
            scales: scales.copied().collect(),
            names,
            indices,
            reader,
            record: ByteRecord::new(),
            time: 0.0,
            line: 0,
            is_broken: false,
        })
    }

    /// A file that is no CSV.
    fn broken(&self, error: &csv::Error) -> Problem {
        let line = error.position().map(|position| position.line() as usize);
        let problem =
            Problem::new(format!("the file is not CSV: {error}")).file(self.file.as_str());
        match line {
            Some(line) => problem.line(line),
            None => problem,
        }
    }
}

/// The rows of a file that is being read.
#[derive(Debug)]
pub(super) struct Rows<'a> {
    source: &'a Source,
    /// Of time, positions and torques: names, places among the columns, factors to SI units.
    names: Vec<&'a str>,
    indices: Vec<usize>,
    scales: Vec<f64>,
    reader: csv::Reader<BufReader<File>>,
    record: ByteRecord,
    /// Time of the last row, s, and its line in the file.
    time: f64,
    line: usize,
    /// Whether nothing more can be read.
    is_broken: bool,
}

impl Rows<'_> {
    /// Appends the next row; `false` at the end.
    ///
    /// # Errors
    /// Every cell of the row that is no finite number, or a file that can't be read on.
    pub(super) fn next(&mut self, samples: &mut Samples) -> Result<bool, Error> {
        match self.reader.read_byte_record(&mut self.record) {
            Ok(true) => {}
            Ok(false) => return Ok(false),
            Err(error) => {
                self.is_broken = true;
                return Err(self.source.broken(&error).into());
            }
        }
        // The record's own position is before comments and empty lines that precede it; the
        // reader's is behind its line break, if it has one.
        let before = self.record.position().map_or(0, csv::Position::line);
        let behind = self.reader.position().line().saturating_sub(1);
        self.line = before.max(behind) as usize;
        let n = self.source.actuators();
        let mut problems = Vec::new();
        for (place, (&index, scale)) in self.indices.iter().zip(&self.scales).enumerate() {
            let value = match number(self.record.get(index)) {
                Ok(value) => value * scale,
                Err(message) => {
                    let name = self.names[place];
                    problems.push(
                        Problem::new(format!("column `{name}`: {message}"))
                            .file(self.source.file.as_str())
                            .line(self.line)
                            .column(name),
                    );
                    f64::NAN
                }
            };
            match place {
                0 => self.time = value,
                _ if place <= n => samples.positions.push(value),
                _ => samples.torques.push(value),
            }
        }
        Error::check(problems)?;
        Ok(true)
    }
}

/// The positions of the named columns in the header.
fn find_columns(file: &str, header: &StringRecord, names: &[&str]) -> Result<Vec<usize>, Error> {
    let mut missing: Vec<&str> = Vec::new();
    let mut indices = Vec::new();
    for name in names {
        match header.iter().position(|cell| cell == *name) {
            Some(index) => indices.push(index),
            None if missing.contains(name) => {}
            None => missing.push(name),
        }
    }
    if missing.is_empty() {
        Error::check(repeated(file, header, names))?;
        return Ok(indices);
    }
    if let Some(separator) = other_separator(header) {
        let help = format!("separate the columns by commas, not by {separator}");
        return Err(missing_columns(file, &missing, &[], "column")
            .help(help)
            .into());
    }
    let existing: Vec<&str> = header.iter().filter(|cell| !cell.is_empty()).collect();
    Err(missing_columns(file, &missing, &existing, "column").into())
}

/// Columns that are asked for and stand in the header more than once: nobody knows which one is meant.
fn repeated(file: &str, header: &StringRecord, names: &[&str]) -> Vec<Problem> {
    let count = |name: &str| header.iter().filter(|cell| *cell == name).count();
    let mut repeated: Vec<&str> = names
        .iter()
        .filter(|name| count(name) > 1)
        .copied()
        .collect();
    repeated.sort_unstable();
    repeated.dedup();
    let problem = |name: &str| {
        Problem::new(format!("the file has {} columns `{name}`", count(name)))
            .file(file)
            .column(name)
            .help("give each column a name of its own")
    };
    repeated.into_iter().map(problem).collect()
}

/// What seems to separate the columns of a header that is one cell to a reader of commas.
fn other_separator(header: &StringRecord) -> Option<&'static str> {
    let only = header.get(0).filter(|_| header.len() == 1)?;
    let separators = [(";", "semicolons"), ("\t", "tabs"), (" ", "blanks")];
    let found = separators.into_iter().find(|(mark, _)| only.contains(mark));
    found.map(|(_, words)| words)
}

/// A cell as a finite number, or what is wrong with it.
fn number(cell: Option<&[u8]>) -> Result<f64, String> {
    let Some(cell) = cell else {
        return Err(String::from("the line ends before this column"));
    };
    let text = String::from_utf8_lossy(cell);
    match text.parse::<f64>() {
        Ok(value) if value.is_finite() => Ok(value),
        Ok(_) => Err(format!("`{text}` is not a finite number")),
        Err(_) if text.is_empty() => Err(String::from("the cell is empty")),
        Err(_) => Err(format!("`{text}` is not a number")),
    }
}
