//! CSV files with a header; lines that start with `#` are comments.

use std::{fs::File, io, path::Path};

use csv::{ReaderBuilder, StringRecord, Trim};

use super::{
    Gain, LARGEST_NUMBER_OF_PROBLEMS, Log, Mapping, Table, display_name, missing_columns,
    unreadable,
};
use crate::error::{Error, Problem};

/// Reads a run from a CSV file.
///
/// # Errors
/// A file that can't be read, missing columns, cells that are not finite numbers, a time that is
/// not uniform, or a mapping that is not right.
pub fn read_csv(path: &Path, mapping: &Mapping, payload: bool) -> Result<Log, Error> {
    let file = display_name(path);
    mapping.check()?;
    let gains = constant_gains(&file, mapping)?;
    let input = File::open(path).map_err(|error| unreadable(&file, &error))?;
    let table = read_table(&file, input, mapping)?;
    table.into_log(mapping, &gains, payload)
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

/// Reads the columns that the mapping names.
fn read_table(file: &str, input: impl io::Read, mapping: &Mapping) -> Result<Table, Error> {
    let mut reader = ReaderBuilder::new()
        .trim(Trim::All)
        .flexible(true)
        .comment(Some(b'#'))
        .from_reader(input);
    let broken = |error: csv::Error| -> Problem {
        let line = error.position().map(|position| position.line() as usize);
        let problem = Problem::new(format!("the file is not CSV: {error}")).file(file);
        line.map_or(problem.clone(), |line| problem.line(line))
    };
    let header = reader.headers().map_err(broken)?.clone();
    let names = mapping.names();
    let indices = find_columns(file, &header, &names)?;
    let mut columns: Vec<Vec<f64>> = vec![Vec::new(); names.len()];
    let mut lines = Vec::new();
    let mut problems = Vec::new();
    let mut record = StringRecord::new();
    while reader.read_record(&mut record).map_err(broken)? {
        // The record's own position is before comments and empty lines that precede it; the
        // reader's is behind its line break, if it has one.
        let before = record.position().map_or(0, csv::Position::line);
        let line = before.max(reader.position().line().saturating_sub(1)) as usize;
        lines.push(line);
        for ((name, index), column) in names.iter().zip(&indices).zip(&mut columns) {
            match number(record.get(*index)) {
                Ok(value) => column.push(value),
                Err(message) => {
                    problems.push(
                        Problem::new(format!("column `{name}`: {message}"))
                            .file(file)
                            .line(line)
                            .column(*name),
                    );
                }
            }
        }
        if problems.len() >= LARGEST_NUMBER_OF_PROBLEMS {
            break;
        }
    }
    Error::check(problems)?;
    let mut columns = columns.into_iter();
    Ok(Table {
        file: file.to_owned(),
        lines: Some(lines),
        time: columns.next().unwrap_or_default(),
        positions: columns.by_ref().take(mapping.positions.len()).collect(),
        torques: columns.collect(),
    })
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
        return Ok(indices);
    }
    let existing: Vec<&str> = header.iter().filter(|cell| !cell.is_empty()).collect();
    Err(missing_columns(file, &missing, &existing, "column").into())
}

/// A cell as a finite number, or what is wrong with it.
fn number(cell: Option<&str>) -> Result<f64, String> {
    let Some(cell) = cell else {
        return Err(String::from("the line ends before this column"));
    };
    match cell.parse::<f64>() {
        Ok(value) if value.is_finite() => Ok(value),
        Ok(_) => Err(format!("`{cell}` is not a finite number")),
        Err(_) if cell.is_empty() => Err(String::from("the cell is empty")),
        Err(_) => Err(format!("`{cell}` is not a number")),
    }
}
