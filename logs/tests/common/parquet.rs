//! Writes Parquet files column by column.
#![allow(dead_code, reason = "each test file uses its part")]

use std::{io::Write, sync::Arc};

use parquet::{
    data_type::{
        BoolType, ByteArray, ByteArrayType, DataType, DoubleType, FixedLenByteArrayType, FloatType,
        Int32Type, Int64Type, Int96, Int96Type,
    },
    file::{
        properties::WriterProperties,
        writer::{SerializedColumnWriter, SerializedFileWriter},
    },
    schema::parser::parse_message_type,
};

/// Values of a column.
pub(crate) enum Cells<'a> {
    Double(&'a [f64]),
    Float(&'a [f32]),
    Int(&'a [i32]),
    Long(&'a [i64]),
    Flag(&'a [bool]),
    Text(&'a [&'a str]),
    Fixed(&'a [&'a str]),
    /// Nanoseconds since 1970, in the obsolete type.
    Old(&'a [i64]),
    Optional(&'a [Option<f64>]),
    Maybe(&'a [Option<f32>]),
}

impl Cells<'_> {
    fn len(&self) -> usize {
        match self {
            Self::Double(own) => own.len(),
            Self::Float(own) => own.len(),
            Self::Int(own) => own.len(),
            Self::Long(own) | Self::Old(own) => own.len(),
            Self::Flag(own) => own.len(),
            Self::Text(own) | Self::Fixed(own) => own.len(),
            Self::Optional(own) => own.len(),
            Self::Maybe(own) => own.len(),
        }
    }

    fn write(&self, column: &mut SerializedColumnWriter<'_>, rows: std::ops::Range<usize>) {
        match self {
            Self::Double(own) => put::<DoubleType>(column, &own[rows]),
            Self::Float(own) => put::<FloatType>(column, &own[rows]),
            Self::Int(own) => put::<Int32Type>(column, &own[rows]),
            Self::Long(own) => put::<Int64Type>(column, &own[rows]),
            Self::Flag(own) => put::<BoolType>(column, &own[rows]),
            Self::Text(own) => {
                let own: Vec<ByteArray> = own[rows].iter().map(|text| (*text).into()).collect();
                put::<ByteArrayType>(column, &own);
            }
            Self::Fixed(own) => {
                let own = own[rows].iter().map(|text| ByteArray::from(*text).into());
                put::<FixedLenByteArrayType>(column, &own.collect::<Vec<_>>());
            }
            Self::Old(own) => {
                let own: Vec<Int96> = own[rows].iter().map(|nanos| old(*nanos)).collect();
                put::<Int96Type>(column, &own);
            }
            Self::Optional(own) => put_some::<DoubleType>(column, &own[rows]),
            Self::Maybe(own) => put_some::<FloatType>(column, &own[rows]),
        }
    }
}

/// Nanoseconds since 1970 as day and nanoseconds of the Julian calendar.
fn old(nanos: i64) -> Int96 {
    const DAY: i64 = 86_400_000_000_000;
    let (day, rest) = (nanos.div_euclid(DAY), nanos.rem_euclid(DAY));
    let mut value = Int96::new();
    value.set_data(rest as u32, (rest >> 32) as u32, (2_440_588 + day) as u32);
    value
}

fn put<T: DataType>(column: &mut SerializedColumnWriter<'_>, values: &[T::T]) {
    column
        .typed::<T>()
        .write_batch(values, None, None)
        .expect("written");
}

fn put_some<T: DataType>(column: &mut SerializedColumnWriter<'_>, values: &[Option<T::T>]) {
    let levels: Vec<i16> = values
        .iter()
        .map(|value| i16::from(value.is_some()))
        .collect();
    let values: Vec<T::T> = values.iter().flatten().cloned().collect();
    column
        .typed::<T>()
        .write_batch(&values, Some(&levels), None)
        .expect("written");
}

/// A file of these columns, in one row group.
pub(crate) fn written(schema: &str, columns: &[Cells<'_>]) -> Vec<u8> {
    written_with(
        WriterProperties::builder().build(),
        schema,
        columns,
        usize::MAX,
    )
}

/// A file of these columns, with `rows` rows per group.
pub(crate) fn written_with(
    properties: WriterProperties,
    schema: &str,
    columns: &[Cells<'_>],
    rows: usize,
) -> Vec<u8> {
    let mut file = Vec::new();
    write_into(&mut file, properties, schema, columns, rows);
    file
}

/// Writes these columns, with `rows` rows per group.
pub(crate) fn write_into(
    output: impl Write + Send,
    properties: WriterProperties,
    schema: &str,
    columns: &[Cells<'_>],
    rows: usize,
) {
    let schema = Arc::new(parse_message_type(schema).expect("a schema"));
    let mut writer =
        SerializedFileWriter::new(output, schema, Arc::new(properties)).expect("a writer");
    let all = columns.first().map_or(0, Cells::len);
    for start in (0..all).step_by(rows.min(all.max(1))) {
        let end = all.min(start.saturating_add(rows));
        let mut group = writer.next_row_group().expect("a group");
        let mut columns = columns.iter();
        while let Some(mut column) = group.next_column().expect("a column") {
            let cells = columns.next().expect("as many columns as the schema has");
            cells.write(&mut column, start..end);
            column.close().expect("written");
        }
        group.close().expect("written");
    }
    writer.close().expect("written");
}
