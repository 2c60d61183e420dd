//! Converts estimates to SQL values and back.

use arrow::{
    array::{
        Array, ArrayRef, AsArray, Float64Array, ListArray, StringArray, StructArray, UInt64Array,
    },
    buffer::OffsetBuffer,
    datatypes::{DataType, Field, Fields, Float64Type, UInt64Type},
};
use datafusion::{error::Result, scalar::ScalarValue};
use overact_identification::factors::{Pooled, PooledParameter};
use std::sync::Arc;

fn field(name: &str, kind: DataType) -> Field {
    Field::new(name, kind, true)
}

fn list(kind: DataType) -> DataType {
    DataType::List(Arc::new(Field::new("item", kind, true)))
}

/// Fields of a parameter.
pub(super) fn of_parameter() -> Fields {
    let numbers = ["value", "deviation", "freedom", "white_deviation"];
    let numbers = numbers.map(|name| field(name, DataType::Float64));
    std::iter::once(field("name", DataType::Utf8))
        .chain(numbers)
        .collect()
}

/// Fields of an estimate.
pub(super) fn of_estimate() -> Fields {
    let counts = ["runs", "equations", "groups", "twice", "damaged", "unlike"];
    let counts = counts.map(|name| field(name, DataType::UInt64));
    let others = [
        field("relative_error_percent", DataType::Float64),
        field("parameters", list(DataType::Struct(of_parameter()))),
        field("not_determined", list(DataType::Utf8)),
        field("covariance", list(DataType::Float64)),
    ];
    std::iter::once(field("problem", DataType::Utf8))
        .chain(counts)
        .chain(others)
        .collect()
}

/// A list of one row.
fn row(kind: DataType, values: ArrayRef) -> ArrayRef {
    let item = Arc::new(Field::new("item", kind, true));
    let offsets = OffsetBuffer::from_lengths([values.len()]);
    Arc::new(ListArray::new(item, offsets, values, None))
}

/// Parameters as a struct array.
pub(super) fn parameters(all: &[PooledParameter]) -> StructArray {
    let numbers = |of: fn(&PooledParameter) -> f64| -> ArrayRef {
        Arc::new(all.iter().map(of).collect::<Float64Array>())
    };
    let names = all.iter().map(|own| Some(own.name.as_str()));
    let columns: Vec<ArrayRef> = vec![
        Arc::new(names.collect::<StringArray>()),
        numbers(|own| own.value),
        numbers(|own| own.deviation),
        numbers(|own| own.freedom),
        numbers(|own| own.white_deviation),
    ];
    StructArray::new(of_parameter(), columns, None)
}

/// Estimate as a value.
pub(super) fn value(own: &Pooled) -> ScalarValue {
    let count = |value: u64| -> ArrayRef { Arc::new(UInt64Array::from(vec![value])) };
    let problem = Some(own.problem.as_str()).filter(|text| !text.is_empty());
    let not_determined = own.not_determined.iter().map(|name| Some(name.as_str()));
    let columns: Vec<ArrayRef> = vec![
        Arc::new(StringArray::from(vec![problem])),
        count(own.runs),
        count(own.equations),
        count(own.groups),
        count(own.twice),
        count(own.damaged),
        count(own.unlike),
        Arc::new(Float64Array::from(vec![own.relative_error_percent])),
        row(
            DataType::Struct(of_parameter()),
            Arc::new(parameters(&own.parameters)),
        ),
        row(
            DataType::Utf8,
            Arc::new(not_determined.collect::<StringArray>()),
        ),
        row(
            DataType::Float64,
            Arc::new(Float64Array::from(own.covariance.clone())),
        ),
    ];
    ScalarValue::Struct(Arc::new(StructArray::new(of_estimate(), columns, None)))
}

/// Estimate in a row of a column; `None` if it is null or the column has another type.
#[must_use]
pub fn pooled(column: &StructArray, row: usize) -> Option<Pooled> {
    if column.is_null(row) {
        return None;
    }
    let number = |name: &str| {
        Some(
            column
                .column_by_name(name)?
                .as_primitive_opt::<UInt64Type>()?
                .value(row),
        )
    };
    let rows = |name: &str| {
        Some(
            column
                .column_by_name(name)?
                .as_list_opt::<i32>()?
                .value(row),
        )
    };
    let problem = column.column_by_name("problem")?.as_string_opt::<i32>()?;
    let mut own = Pooled::default();
    if problem.is_valid(row) {
        own.problem = problem.value(row).to_owned();
    }
    own.runs = number("runs")?;
    own.equations = number("equations")?;
    own.groups = number("groups")?;
    own.twice = number("twice")?;
    own.damaged = number("damaged")?;
    own.unlike = number("unlike")?;
    let error = column.column_by_name("relative_error_percent")?;
    own.relative_error_percent = error.as_primitive_opt::<Float64Type>()?.value(row);
    let covariance = rows("covariance")?;
    own.covariance = covariance
        .as_primitive_opt::<Float64Type>()?
        .values()
        .to_vec();
    let missing = rows("not_determined")?;
    let missing = missing.as_string_opt::<i32>()?.iter().flatten();
    own.not_determined = missing.map(str::to_owned).collect();
    let parameters = rows("parameters")?;
    let parameters = parameters.as_struct_opt()?;
    let numbers = |name: &str| -> Option<Vec<f64>> {
        let column = parameters.column_by_name(name)?;
        Some(column.as_primitive_opt::<Float64Type>()?.values().to_vec())
    };
    let names = parameters
        .column_by_name("name")?
        .as_string_opt::<i32>()?
        .clone();
    let (values, deviations) = (numbers("value")?, numbers("deviation")?);
    let (freedoms, white) = (numbers("freedom")?, numbers("white_deviation")?);
    for place in 0..names.len() {
        let mut one = PooledParameter::default();
        names.value(place).clone_into(&mut one.name);
        one.value = values[place];
        one.deviation = deviations[place];
        one.freedom = freedoms[place];
        one.white_deviation = white[place];
        own.parameters.push(one);
    }
    Some(own)
}

/// Null parameter as a value.
pub(super) fn no_parameter() -> Result<ScalarValue> {
    ScalarValue::try_from(&DataType::Struct(of_parameter()))
}
