//! Reads runs from a Parquet file, with errors per run, so that other runs remain usable.

use std::{fs::File, path::Path};

use parquet::{
    file::{reader::FileReader, serialized_reader::SerializedFileReader},
    record::Field,
};

use super::{
    content::content,
    excluded_run::Reason,
    packed::from_rows,
    record::Record,
    run::{ModelFactors, RunFactors},
    schema::{OPTIONAL, Place, Row, SCHEMA, VERSION},
};
use crate::{
    regression::{
        factor::Factor,
        projection::ModelKind,
        system::{PartitionCondition, RunPart, Stretch},
    },
    result::RunSummary,
};

/// Content of a file.
#[derive(Debug, Clone)]
#[non_exhaustive]
pub struct ReadFactors {
    /// Usable runs.
    pub runs: Vec<RunFactors>,
    /// Unusable runs.
    pub damaged: Vec<Damaged>,
}

/// A run, or a whole file, that cannot be used.
#[derive(Debug, Clone, PartialEq, Eq)]
#[non_exhaustive]
pub struct Damaged {
    /// Name of the run; `None` for the whole file.
    pub run: Option<String>,
    /// Kind of damage.
    pub reason: Reason,
    /// Damage in words.
    pub message: String,
}

impl Damaged {
    fn file(reason: Reason, message: impl Into<String>) -> Self {
        let message = message.into();
        Self {
            run: None,
            reason,
            message,
        }
    }

    fn run(run: &str, message: impl Into<String>) -> Self {
        let (run, message) = (Some(run.to_owned()), message.into());
        Self {
            run,
            reason: Reason::Damaged,
            message,
        }
    }
}

/// Reads a factor file.
///
/// # Errors
/// A file that cannot be read as a whole: cut off, of another kind, or of a newer version.
pub fn read_factors(path: &Path) -> Result<ReadFactors, Damaged> {
    let unreadable = |error: &dyn std::fmt::Display| {
        let message = format!("the file can't be read as Parquet: {error}");
        Damaged::file(Reason::Unreadable, message)
    };
    let file = File::open(path).map_err(|error| {
        Damaged::file(
            Reason::Unreadable,
            format!("the file can't be opened: {error}"),
        )
    })?;
    let reader = SerializedFileReader::new(file).map_err(|error| unreadable(&error))?;
    check_columns(&reader)?;
    let mut rows = Vec::new();
    for row in reader
        .get_row_iter(None)
        .map_err(|error| unreadable(&error))?
    {
        let row = row.map_err(|error| unreadable(&error))?;
        let mut own = Row::default();
        for (name, field) in row.get_column_iter() {
            put(&mut own, name, field);
        }
        rows.push(own);
    }
    let other = rows.iter().find(|row| row.version != VERSION);
    if let Some(other) = other {
        let message = format!(
            "the file has version {} of the format, this program reads version {VERSION}",
            other.version
        );
        return Err(Damaged::file(Reason::OtherVersion, message));
    }
    let mut read = ReadFactors {
        runs: Vec::new(),
        damaged: Vec::new(),
    };
    for own in
        rows.chunk_by(|a, b| (&a.content, &a.run, &a.serial) == (&b.content, &b.run, &b.serial))
    {
        match of_rows(own) {
            Ok(run) => read.runs.push(run),
            Err(damaged) => read.damaged.push(damaged),
        }
    }
    Ok(read)
}

/// Checks that all columns exist; unknown ones are ignored.
fn check_columns(reader: &SerializedFileReader<File>) -> Result<(), Damaged> {
    let schema = reader.metadata().file_metadata().schema_descr();
    let has = |name: &str| schema.columns().iter().any(|own| own.name() == name);
    let wanted = SCHEMA
        .lines()
        .filter_map(|line| line.split_whitespace().nth(2));
    let wanted = wanted
        .map(|name| name.trim_end_matches(';'))
        .filter(|name| *name != "{");
    let missing: Vec<&str> = { wanted.filter(|name| !has(name)) }
        .filter(|name| !OPTIONAL.contains(name))
        .collect();
    if missing.is_empty() {
        return Ok(());
    }
    let message = format!(
        "the file has no factors: there is no column `{}`",
        missing[0]
    );
    Err(Damaged::file(Reason::Unreadable, message))
}

/// Stores a value in a row; a value of another type is ignored and found by the hash.
fn put(row: &mut Row, name: &str, field: &Field) {
    match (row.place(name), field) {
        (Some(Place::Whole(to)), Field::Long(from)) => *to = *from,
        (Some(Place::Whole(to)), Field::Int(from)) => *to = i64::from(*from),
        (Some(Place::Real(to)), Field::Double(from)) => *to = *from,
        (Some(Place::Instant(to)), Field::TimestampMicros(from)) => *to = Some(*from),
        (Some(Place::Text(to)), Field::Str(from)) => to.clone_from(from),
        (Some(Place::Bytes(to)), Field::Bytes(from)) => *to = from.data().to_vec(),
        _ => {}
    }
}

/// A run from its rows.
fn of_rows(rows: &[Row]) -> Result<RunFactors, Damaged> {
    let Some(first) = rows.first() else {
        return Err(Damaged::file(Reason::Damaged, "a run without rows"));
    };
    let names = |text: &str| -> Vec<String> {
        let all = text.split(',').filter(|one| !one.is_empty());
        all.map(str::to_owned).collect()
    };
    let columns = names(&first.columns);
    let mut models = Vec::new();
    for own in rows.chunk_by(|a, b| a.model == b.model) {
        models.push(of_model(own, columns.len())?);
    }
    let count = |text: &String| text.parse().unwrap_or(0);
    let run = RunFactors {
        robot: first.robot.clone(),
        serial: first.serial.clone(),
        time_us: first.time,
        settings_hash: first.settings_hash.clone(),
        content: first.content.clone(),
        summary: RunSummary {
            name: first.run.clone(),
            samples: usize::try_from(first.samples).unwrap_or(0),
            sampling_frequency: first.sampling_frequency,
            payload: first.loaded != 0,
            payload_name: Some(first.payload.clone()).filter(|name| !name.is_empty()),
            session: Some(first.session.clone()).filter(|name| !name.is_empty()),
            closure_residual: first.closure_residual,
            standstill_equations: names(&first.standstill).iter().map(count).collect(),
        },
        flags: first.flags.lines().map(str::to_owned).collect(),
        columns,
        models,
    };
    if content(&run) == run.content {
        Ok(run)
    } else {
        let message = "its numbers were changed: their hash does not match";
        Err(Damaged::run(&first.run, message))
    }
}

/// Factors of a run in one model; `columns` is the number of its columns.
fn of_model(rows: &[Row], columns: usize) -> Result<ModelFactors, Damaged> {
    let first = &rows[0];
    let damaged = |message: &str| Damaged::run(&first.run, message);
    let kinds = [ModelKind::Platform, ModelKind::Actuators, ModelKind::Joints];
    let kind = kinds.into_iter().find(|kind| kind.name() == first.model);
    let model = kind.ok_or_else(|| damaged("it has an unknown model"))?;
    let (mut parts, mut stretches, mut missing) = (Vec::new(), Vec::new(), None);
    let groups = rows.chunk_by(|a, b| (&a.kind, a.part) == (&b.kind, b.part));
    for own in groups {
        match own[0].kind.as_str() {
            "factor" => {
                let lines = own.iter().map(|row| of_factor(row, columns));
                let lines = lines.collect::<Option<Vec<Factor>>>();
                let lines = lines.ok_or_else(|| damaged(NOT_NUMBERS))?;
                parts.push(RunPart { run: 0, lines });
            }
            "equations" => {
                let lines = own.iter().map(|row| {
                    let count = usize::try_from(row.equations).ok()?;
                    let own = from_rows(&row.factor, count, columns + 1)?;
                    own.iter().all(|value| value.is_finite()).then_some(own)
                });
                let lines = lines.collect::<Option<Vec<_>>>();
                let lines = lines.ok_or_else(|| damaged(NOT_NUMBERS))?;
                stretches.push(Stretch {
                    run: 0,
                    lines,
                    instruments: Vec::new(),
                });
            }
            _ => missing = Some(own[0].problem.clone()),
        }
    }
    let mut lines: Vec<(i64, &str)> = rows
        .iter()
        .map(|row| (row.line, row.line_name.as_str()))
        .collect();
    lines.sort_unstable();
    lines.dedup();
    Ok(ModelFactors {
        model,
        lines: lines.into_iter().map(|(_, name)| name.to_owned()).collect(),
        parts: missing.map_or(Ok(parts), Err),
        stretches,
        partition: (first.condition > 0.0).then(|| PartitionCondition {
            largest: first.condition,
            run: first.run.clone(),
            sample: usize::try_from(first.condition_sample).unwrap_or(0),
            time: first.condition_time,
            crossings: usize::try_from(first.crossings).unwrap_or(0),
        }),
    })
}

/// Message for bytes that are no factor.
const NOT_NUMBERS: &str = "a factor has numbers that are not finite, or too few or too many";

/// The factor of a row, whose record must belong to this run.
fn of_factor(row: &Row, columns: usize) -> Option<Factor> {
    let own = Record::one(&row.factor)?;
    let same = own.factor.parameters() == columns
        && own.columns == row.columns
        && format!("{:032x}", own.content) == row.content;
    same.then_some(own.factor)
}
