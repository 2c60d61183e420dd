//! Columns of tables with Arrow's C interface, as those of pandas, Polars and PyArrow.
//!
//! The interface consists of `__arrow_c_stream__` and `__arrow_c_array__`.

use arrow_array::{
    Array, RecordBatch, RecordBatchReader,
    cast::AsArray,
    types::{
        DurationMicrosecondType, DurationMillisecondType, DurationNanosecondType,
        DurationSecondType, Float32Type, Float64Type, Int8Type, Int16Type, Int32Type, Int64Type,
        UInt8Type, UInt16Type, UInt32Type, UInt64Type,
    },
};
use arrow_pyarrow::FromPyArrow;
use arrow_schema::{DataType, Schema, TimeUnit};
use numpy::PyArray1;
use pyo3::{
    exceptions::{PyTypeError, PyValueError},
    prelude::*,
    types::PyDict,
};
use std::collections::BTreeMap;

/// Column being read: its numbers so far, or the type of its other contents.
enum Column {
    Numbers(Vec<f64>),
    Other(String),
}

/// Numeric columns of a table as float64, and types of the others, by name.
#[pyfunction]
pub(crate) fn columns<'py>(
    py: Python<'py>,
    table: &Bound<'py, PyAny>,
) -> PyResult<(Bound<'py, PyDict>, BTreeMap<String, String>)> {
    let (schema, batches) = read(table)?;
    let mut found: Vec<(String, Column)> = Vec::new();
    for field in schema.fields() {
        if found.iter().any(|(name, _)| name == field.name()) {
            let message = format!("the table has two columns `{}`", field.name());
            return Err(PyValueError::new_err(message));
        }
        found.push((field.name().clone(), Column::Numbers(Vec::new())));
    }
    for batch in &batches {
        for ((_, column), array) in found.iter_mut().zip(batch.columns()) {
            let Column::Numbers(numbers) = column else {
                continue;
            };
            if let Some(at) = (0..array.len()).find(|&at| array.is_null(at)) {
                let at = numbers.len() + at;
                *column = Column::Other(format!("no value at sample {at}"));
                continue;
            }
            match values(array) {
                Some(values) => numbers.extend(values),
                None => *column = Column::Other(format!("{}, not numbers", array.data_type())),
            }
        }
    }
    let numbers = PyDict::new(py);
    let mut others = BTreeMap::new();
    for (name, column) in found {
        match column {
            Column::Numbers(values) => numbers.set_item(name, PyArray1::from_vec(py, values))?,
            Column::Other(what) => {
                others.insert(name, what);
            }
        }
    }
    Ok((numbers, others))
}

/// Reads a table without copying its numbers.
fn read(table: &Bound<'_, PyAny>) -> PyResult<(Schema, Vec<RecordBatch>)> {
    if table.hasattr("__arrow_c_stream__")? {
        let reader = arrow_array::ffi_stream::RecordBatchStreamReader::from_pyarrow_bound(table)?;
        let schema = reader.schema().as_ref().clone();
        let batches: Result<Vec<_>, _> = reader.collect();
        let batches = batches.map_err(|error| PyValueError::new_err(error.to_string()))?;
        return Ok((schema, batches));
    }
    if table.hasattr("__arrow_c_array__")? {
        let batch = RecordBatch::from_pyarrow_bound(table)?;
        return Ok((batch.schema().as_ref().clone(), vec![batch]));
    }
    let message = format!(
        "a {} is not a table: it has neither __arrow_c_stream__ nor __arrow_c_array__",
        table.get_type().name()?
    );
    Err(PyTypeError::new_err(message))
}

/// Numbers of an array; durations in seconds.
fn values(array: &dyn Array) -> Option<Vec<f64>> {
    macro_rules! plain {
        ($kind:ty) => {
            array
                .as_primitive::<$kind>()
                .values()
                .iter()
                .map(|&value| value as f64)
                .collect()
        };
    }
    macro_rules! seconds {
        ($kind:ty, $unit:literal) => {
            array
                .as_primitive::<$kind>()
                .values()
                .iter()
                .map(|&value| value as f64 / $unit)
                .collect()
        };
    }
    Some(match array.data_type() {
        DataType::Float64 => plain!(Float64Type),
        DataType::Float32 => plain!(Float32Type),
        DataType::Int8 => plain!(Int8Type),
        DataType::Int16 => plain!(Int16Type),
        DataType::Int32 => plain!(Int32Type),
        DataType::Int64 => plain!(Int64Type),
        DataType::UInt8 => plain!(UInt8Type),
        DataType::UInt16 => plain!(UInt16Type),
        DataType::UInt32 => plain!(UInt32Type),
        DataType::UInt64 => plain!(UInt64Type),
        DataType::Boolean => {
            let bits = array.as_boolean().values().iter();
            bits.map(|value| f64::from(u8::from(value))).collect()
        }
        DataType::Duration(TimeUnit::Second) => seconds!(DurationSecondType, 1.0),
        DataType::Duration(TimeUnit::Millisecond) => seconds!(DurationMillisecondType, 1e3),
        DataType::Duration(TimeUnit::Microsecond) => seconds!(DurationMicrosecondType, 1e6),
        DataType::Duration(TimeUnit::Nanosecond) => seconds!(DurationNanosecondType, 1e9),
        _ => return None,
    })
}
