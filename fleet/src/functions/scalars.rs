//! `parameter(e, name)` and `f_test(e, e, names)`: scalar functions of estimates.

use super::arrays;
use arrow::{
    array::{Array, ArrayRef, AsArray, StructArray},
    compute::cast,
    datatypes::{DataType, Field, Fields},
};
use datafusion::{
    error::{DataFusionError, Result},
    logical_expr::{ColumnarValue, ScalarFunctionArgs, ScalarUDFImpl, Signature, Volatility},
    scalar::ScalarValue,
};
use overact_identification::factors::{Comparison, compare};
use std::sync::Arc;

/// Arguments as columns, the last one as text.
fn columns(args: &ScalarFunctionArgs, name: &str) -> Result<(Vec<ArrayRef>, ArrayRef)> {
    let mut all = ColumnarValue::values_to_arrays(&args.args)?;
    let texts = all.pop().ok_or_else(|| wrong(name))?;
    Ok((all, cast(&texts, &DataType::Utf8)?))
}

fn wrong(name: &str) -> DataFusionError {
    let wanted = match name {
        "parameter" => {
            "an estimate and the name of a parameter: `parameter(estimate(factor), 'm_platform')`"
        }
        _ => {
            "two estimates and names of parameters with commas: `f_test(a.e, b.e, 'fv_1_left,fs_1_left')`"
        }
    };
    DataFusionError::Plan(format!("`{name}` takes {wanted}"))
}

fn structs<'a>(column: &'a ArrayRef, name: &str) -> Result<&'a StructArray> {
    column.as_struct_opt().ok_or_else(|| wrong(name))
}

/// Checks that the types are those of estimates, followed by a text.
fn check(given: &[DataType], estimates: usize, name: &str) -> Result<Vec<DataType>> {
    let (own, text) = given
        .split_at_checked(estimates)
        .ok_or_else(|| wrong(name))?;
    let texts = matches!(
        text,
        [DataType::Utf8 | DataType::Utf8View | DataType::LargeUtf8]
    );
    let wanted = DataType::Struct(arrays::of_estimate());
    if texts && own.iter().all(|kind| kind.equals_datatype(&wanted)) {
        Ok(given.to_vec())
    } else {
        Err(wrong(name))
    }
}

/// `parameter(e, name)`.
#[derive(Debug, PartialEq, Eq, Hash)]
pub(super) struct ParameterOf(Signature);

impl Default for ParameterOf {
    fn default() -> Self {
        Self(Signature::user_defined(Volatility::Immutable))
    }
}

impl ScalarUDFImpl for ParameterOf {
    fn name(&self) -> &str {
        "parameter"
    }

    fn signature(&self) -> &Signature {
        &self.0
    }

    fn coerce_types(&self, given: &[DataType]) -> Result<Vec<DataType>> {
        check(given, 1, self.name())
    }

    fn return_type(&self, _: &[DataType]) -> Result<DataType> {
        Ok(DataType::Struct(arrays::of_parameter()))
    }

    fn invoke_with_args(&self, args: ScalarFunctionArgs) -> Result<ColumnarValue> {
        let (own, names) = columns(&args, self.name())?;
        let (estimates, names) = (structs(&own[0], self.name())?, names.as_string::<i32>());
        let one = |row: usize| {
            let own = arrays::pooled(estimates, row)?;
            let name = names.is_valid(row).then(|| names.value(row))?;
            own.parameters.into_iter().find(|one| one.name == name)
        };
        let values = (0..estimates.len()).map(|row| match one(row) {
            Some(own) => Ok(ScalarValue::Struct(Arc::new(arrays::parameters(&[own])))),
            None => arrays::no_parameter(),
        });
        let values = values.collect::<Result<Vec<_>>>()?;
        Ok(ColumnarValue::Array(if values.is_empty() {
            arrow::array::new_empty_array(&self.return_type(&[])?)
        } else {
            ScalarValue::iter_to_array(values)?
        }))
    }
}

/// `f_test(e, e, names)`.
#[derive(Debug, PartialEq, Eq, Hash)]
pub(super) struct FTest(Signature);

impl Default for FTest {
    fn default() -> Self {
        Self(Signature::user_defined(Volatility::Immutable))
    }
}

/// Fields of a comparison.
fn of_comparison() -> Fields {
    ["ratio", "parameters", "freedom", "probability"]
        .into_iter()
        .map(|name| Field::new(name, DataType::Float64, true))
        .collect()
}

impl ScalarUDFImpl for FTest {
    fn name(&self) -> &str {
        "f_test"
    }

    fn signature(&self) -> &Signature {
        &self.0
    }

    fn coerce_types(&self, given: &[DataType]) -> Result<Vec<DataType>> {
        check(given, 2, self.name())
    }

    fn return_type(&self, _: &[DataType]) -> Result<DataType> {
        Ok(DataType::Struct(of_comparison()))
    }

    fn invoke_with_args(&self, args: ScalarFunctionArgs) -> Result<ColumnarValue> {
        let (own, names) = columns(&args, self.name())?;
        let (first, second) = (
            structs(&own[0], self.name())?,
            structs(&own[1], self.name())?,
        );
        let names = names.as_string::<i32>();
        let one = |row: usize| -> Option<Comparison> {
            let wanted = names.is_valid(row).then(|| names.value(row))?;
            let wanted: Vec<&str> = wanted.split(',').map(str::trim).collect();
            compare(
                &arrays::pooled(first, row)?,
                &arrays::pooled(second, row)?,
                &wanted,
            )
        };
        let found: Vec<Option<Comparison>> = (0..first.len()).map(one).collect();
        let column = |of: fn(&Comparison) -> f64| -> ArrayRef {
            let values = found.iter().map(|own| own.as_ref().map(of));
            Arc::new(values.collect::<arrow::array::Float64Array>())
        };
        let columns = vec![
            column(|own| own.ratio),
            column(|own| own.parameters as f64),
            column(|own| own.freedom),
            column(|own| own.probability),
        ];
        let nulls = found.iter().map(Option::is_some).collect::<Vec<bool>>();
        let nulls = Some(nulls.into());
        Ok(ColumnarValue::Array(Arc::new(StructArray::new(
            of_comparison(),
            columns,
            nulls,
        ))))
    }
}
