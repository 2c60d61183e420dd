//! Writes runs to a Parquet file.

use overact::Code;
use std::sync::Arc;

use parquet::{
    basic::Compression,
    data_type::{ByteArray, ByteArrayType, DoubleType, Int64Type},
    errors::ParquetError,
    file::{properties::WriterProperties, writer::SerializedFileWriter},
    schema::parser::parse_message_type,
};

use super::{
    packed::rows,
    record::Record,
    run::{ModelFactors, RunFactors},
    schema::{Cell, Row, SCHEMA, VERSION},
};
use overact_logs::{Error, Problem};

/// The bytes of a factor file of runs; equal runs give equal bytes.
///
/// # Errors
/// A name that is too long.
pub fn write_factors(runs: &[RunFactors]) -> Result<Vec<u8>, Error> {
    let all: Vec<Row> = runs.iter().flat_map(of_run).collect();
    written(&all).map_err(|error| {
        Problem::new(
            Code::OUTPUT,
            format!("the factors can't be written as Parquet: {error}"),
        )
        .into()
    })
}

fn written(all: &[Row]) -> Result<Vec<u8>, ParquetError> {
    let schema = Arc::new(parse_message_type(SCHEMA)?);
    let properties = WriterProperties::builder()
        .set_compression(Compression::SNAPPY)
        .set_created_by(String::from("overact"))
        .build();
    let mut writer = SerializedFileWriter::new(Vec::new(), schema, Arc::new(properties))?;
    let cells: Vec<Vec<Cell<'_>>> = all.iter().map(Row::cells).collect();
    let mut group = writer.next_row_group()?;
    let mut place = 0;
    while let Some(mut column) = group.next_column()? {
        let own = || cells.iter().filter_map(|row| row.get(place));
        match cells.first().and_then(|row| row.get(place)) {
            Some(Cell::Whole(_)) => {
                let whole = |cell: &Cell<'_>| match cell {
                    Cell::Whole(value) => *value,
                    _ => 0,
                };
                let own: Vec<i64> = own().map(whole).collect();
                column.typed::<Int64Type>().write_batch(&own, None, None)?;
            }
            Some(Cell::Real(_)) => {
                let real = |cell: &Cell<'_>| match cell {
                    Cell::Real(value) => *value,
                    _ => f64::NAN,
                };
                let own: Vec<f64> = own().map(real).collect();
                column.typed::<DoubleType>().write_batch(&own, None, None)?;
            }
            Some(Cell::Instant(_)) | None => {
                let instant = |cell: &Cell<'_>| match cell {
                    Cell::Instant(value) => *value,
                    _ => None,
                };
                let own: Vec<Option<i64>> = own().map(instant).collect();
                let levels: Vec<i16> = own.iter().map(|one| i16::from(one.is_some())).collect();
                let own: Vec<i64> = own.into_iter().flatten().collect();
                let column = column.typed::<Int64Type>();
                column.write_batch(&own, Some(&levels), None)?;
            }
            Some(Cell::Bytes(_)) => {
                let bytes = |cell: &Cell<'_>| match cell {
                    Cell::Bytes(value) => ByteArray::from(value.to_vec()),
                    _ => ByteArray::new(),
                };
                let own: Vec<ByteArray> = own().map(bytes).collect();
                let column = column.typed::<ByteArrayType>();
                column.write_batch(&own, None, None)?;
            }
        }
        column.close()?;
        place += 1;
    }
    group.close()?;
    writer.into_inner()
}

/// Rows of a run.
fn of_run(run: &RunFactors) -> Vec<Row> {
    let summary = &run.summary;
    let standstill = summary.standstill_equations.iter().map(usize::to_string);
    let all = Row {
        version: VERSION,
        settings_hash: run.settings_hash.clone(),
        content: run.content.clone(),
        robot: run.robot.clone(),
        serial: run.serial.clone(),
        time: run.time_us,
        run: summary.name.clone(),
        samples: summary.samples as i64,
        sampling_frequency: summary.sampling_frequency,
        loaded: i64::from(summary.payload),
        payload: summary.payload_name.clone().unwrap_or_default(),
        closure_residual: summary.closure_residual,
        standstill: standstill.collect::<Vec<_>>().join(","),
        flags: run.flags.join("\n"),
        columns: run.columns.join(","),
        session: summary.session.clone().unwrap_or_default(),
        ..Row::default()
    };
    run.models
        .iter()
        .flat_map(|model| of_model(run, &all, model))
        .collect()
}

/// Rows of a model: each line of a part, then of a stretch, or one row with the error.
fn of_model(run: &RunFactors, row: &Row, model: &ModelFactors) -> Vec<Row> {
    let partition = model.partition.as_ref();
    let all = Row {
        model: model.model.name().to_owned(),
        condition: partition.map_or(0.0, |own| own.largest),
        condition_sample: partition.map_or(0, |own| own.sample as i64),
        condition_time: partition.map_or(0.0, |own| own.time),
        crossings: partition.map_or(0, |own| own.crossings as i64),
        ..row.clone()
    };
    if let Err(why) = &model.parts {
        let (kind, problem) = ("missing".to_owned(), why.clone());
        return vec![Row {
            kind,
            problem,
            ..all
        }];
    }
    let name = |line: usize| model.lines.get(line).cloned().unwrap_or_default();
    let records = run.records_of(model);
    let mut rows_of_model: Vec<Row> = records.iter().map(|own| of_record(&all, own)).collect();
    for (part, own) in model.stretches.iter().enumerate() {
        for (line, equations) in own.lines.iter().enumerate() {
            rows_of_model.push(Row {
                kind: "equations".to_owned(),
                part: part as i64,
                line: line as i64,
                line_name: name(line),
                equations: equations.nrows() as i64,
                factor: rows(equations),
                ..all.clone()
            });
        }
    }
    rows_of_model
}

fn of_record(all: &Row, record: &Record) -> Row {
    let factor = &record.factor;
    let last = factor.parameters();
    Row {
        kind: "factor".to_owned(),
        part: i64::from(record.part),
        line: i64::from(record.line),
        line_name: record.line_name.clone(),
        equations: factor.equations() as i64,
        residual_norm: factor.matrix()[(last, last)].abs(),
        measured_norm: factor.measured_norm(),
        factor: record.to_bytes(),
        ..all.clone()
    }
}
