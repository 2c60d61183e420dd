//! Writes a run as Parquet, with a column of doubles for each signal.

use overact::Code;
use std::sync::Arc;

use parquet::{
    basic::{Compression, Repetition, Type as Physical},
    data_type::DoubleType,
    errors::ParquetError,
    file::{properties::WriterProperties, writer::SerializedFileWriter},
    schema::types::Type,
};

use crate::error::{Error, Problem};

/// The bytes of a Parquet file with these columns of equal length.
///
/// Equal columns give equal bytes.
///
/// # Errors
/// Columns of different lengths.
pub fn write_parquet(columns: &[(String, Vec<f64>)]) -> Result<Vec<u8>, Error> {
    written(columns).map_err(|error| {
        let message = format!("the run can't be written as Parquet: {error}");
        Problem::new(Code::OUTPUT, message).into()
    })
}

fn written(columns: &[(String, Vec<f64>)]) -> Result<Vec<u8>, ParquetError> {
    let field = |(name, _): &(String, Vec<f64>)| {
        let own = Type::primitive_type_builder(name, Physical::DOUBLE);
        own.with_repetition(Repetition::REQUIRED)
            .build()
            .map(Arc::new)
    };
    let fields = columns.iter().map(field).collect::<Result<Vec<_>, _>>()?;
    let schema = Type::group_type_builder("run")
        .with_fields(fields)
        .build()?;
    let properties = WriterProperties::builder()
        .set_compression(Compression::SNAPPY)
        .set_created_by(String::from("overact"))
        .build();
    let mut writer = SerializedFileWriter::new(Vec::new(), Arc::new(schema), Arc::new(properties))?;
    let mut group = writer.next_row_group()?;
    for (_, values) in columns {
        if let Some(mut column) = group.next_column()? {
            column
                .typed::<DoubleType>()
                .write_batch(values, None, None)?;
            column.close()?;
        }
    }
    group.close()?;
    writer.into_inner()
}
