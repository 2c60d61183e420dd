//! Columns of a factor file: one row for each line of each part of a run.
//!
//! Every row contains the metadata of the run, so a database can group and select without other
//! tables. Parquet's dictionaries store repeated values once.

/// Version of the format; readers reject others. In version 1, factors were no records.
pub(super) const VERSION: i64 = 2;

/// A row.
#[derive(Debug, Clone, Default, PartialEq)]
pub(super) struct Row {
    pub(super) version: i64,
    pub(super) settings_hash: String,
    pub(super) content: String,
    pub(super) robot: String,
    pub(super) serial: String,
    pub(super) time: Option<i64>,
    pub(super) run: String,
    pub(super) samples: i64,
    pub(super) sampling_frequency: f64,
    /// 1 if the robot carried the payload.
    pub(super) loaded: i64,
    /// Name of the payload, if it has one.
    pub(super) payload: String,
    pub(super) closure_residual: f64,
    /// Numbers of equations, separated by commas.
    pub(super) standstill: String,
    /// One line each.
    pub(super) flags: String,
    /// Names, separated by commas.
    pub(super) columns: String,
    pub(super) model: String,
    /// `factor`, `equations` or `missing`.
    pub(super) kind: String,
    /// Number of the part, or of the stretch.
    pub(super) part: i64,
    pub(super) line: i64,
    pub(super) line_name: String,
    pub(super) equations: i64,
    /// Smallest ||Y - W χ|| of these equations alone, and ||Y||.
    pub(super) residual_norm: f64,
    pub(super) measured_norm: f64,
    /// Largest condition number of the kept actuators, or 0.
    ///
    /// Then follow its sample and time, and the number of crossings.
    pub(super) condition: f64,
    pub(super) condition_sample: i64,
    pub(super) condition_time: f64,
    pub(super) crossings: i64,
    /// Reason for a missing factor.
    pub(super) problem: String,
    /// A record of the factor, or equations row by row as little-endian doubles.
    pub(super) factor: Vec<u8>,
    /// Name of the recording session; empty without one. Older files lack it.
    pub(super) session: String,
}

/// Columns that older files of this version lack.
pub(super) const OPTIONAL: [&str; 1] = ["session"];

/// Schema, in the order of the fields of a row.
pub(super) const SCHEMA: &str = "message factors {
  required int64 version;
  required binary like (UTF8);
  required binary content (UTF8);
  required binary robot (UTF8);
  required binary serial (UTF8);
  optional int64 time (TIMESTAMP(MICROS,true));
  required binary run (UTF8);
  required int64 samples;
  required double sampling_frequency;
  required int64 loaded;
  required binary payload (UTF8);
  required double closure_residual;
  required binary standstill (UTF8);
  required binary flags (UTF8);
  required binary columns (UTF8);
  required binary model (UTF8);
  required binary kind (UTF8);
  required int64 part;
  required int64 line;
  required binary line_name (UTF8);
  required int64 equations;
  required double residual_norm;
  required double measured_norm;
  required double condition;
  required int64 condition_sample;
  required double condition_time;
  required int64 crossings;
  required binary problem (UTF8);
  required binary factor;
  required binary session (UTF8);
}";

/// A value of a row for writing.
pub(super) enum Cell<'a> {
    Whole(i64),
    Real(f64),
    Instant(Option<i64>),
    Bytes(&'a [u8]),
}

/// Target of a value when reading.
pub(super) enum Place<'a> {
    Whole(&'a mut i64),
    Real(&'a mut f64),
    Instant(&'a mut Option<i64>),
    Text(&'a mut String),
    Bytes(&'a mut Vec<u8>),
}

impl Row {
    /// Values in the order of the schema.
    pub(super) fn cells(&self) -> Vec<Cell<'_>> {
        use Cell::{Bytes, Instant, Real, Whole};
        vec![
            Whole(self.version),
            Bytes(self.settings_hash.as_bytes()),
            Bytes(self.content.as_bytes()),
            Bytes(self.robot.as_bytes()),
            Bytes(self.serial.as_bytes()),
            Instant(self.time),
            Bytes(self.run.as_bytes()),
            Whole(self.samples),
            Real(self.sampling_frequency),
            Whole(self.loaded),
            Bytes(self.payload.as_bytes()),
            Real(self.closure_residual),
            Bytes(self.standstill.as_bytes()),
            Bytes(self.flags.as_bytes()),
            Bytes(self.columns.as_bytes()),
            Bytes(self.model.as_bytes()),
            Bytes(self.kind.as_bytes()),
            Whole(self.part),
            Whole(self.line),
            Bytes(self.line_name.as_bytes()),
            Whole(self.equations),
            Real(self.residual_norm),
            Real(self.measured_norm),
            Real(self.condition),
            Whole(self.condition_sample),
            Real(self.condition_time),
            Whole(self.crossings),
            Bytes(self.problem.as_bytes()),
            Bytes(&self.factor),
            Bytes(self.session.as_bytes()),
        ]
    }

    /// Target of a column's value; `None` for an unknown column.
    pub(super) fn place(&mut self, name: &str) -> Option<Place<'_>> {
        use Place::{Bytes, Instant, Real, Text, Whole};
        Some(match name {
            "version" => Whole(&mut self.version),
            "like" => Text(&mut self.settings_hash),
            "content" => Text(&mut self.content),
            "robot" => Text(&mut self.robot),
            "serial" => Text(&mut self.serial),
            "time" => Instant(&mut self.time),
            "run" => Text(&mut self.run),
            "samples" => Whole(&mut self.samples),
            "sampling_frequency" => Real(&mut self.sampling_frequency),
            "loaded" => Whole(&mut self.loaded),
            "payload" => Text(&mut self.payload),
            "closure_residual" => Real(&mut self.closure_residual),
            "standstill" => Text(&mut self.standstill),
            "flags" => Text(&mut self.flags),
            "columns" => Text(&mut self.columns),
            "model" => Text(&mut self.model),
            "kind" => Text(&mut self.kind),
            "part" => Whole(&mut self.part),
            "line" => Whole(&mut self.line),
            "line_name" => Text(&mut self.line_name),
            "equations" => Whole(&mut self.equations),
            "residual_norm" => Real(&mut self.residual_norm),
            "measured_norm" => Real(&mut self.measured_norm),
            "condition" => Real(&mut self.condition),
            "condition_sample" => Whole(&mut self.condition_sample),
            "condition_time" => Real(&mut self.condition_time),
            "crossings" => Whole(&mut self.crossings),
            "problem" => Text(&mut self.problem),
            "factor" => Bytes(&mut self.factor),
            "session" => Text(&mut self.session),
            _ => return None,
        })
    }
}
