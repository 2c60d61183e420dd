//! MATLAB's `.mat` files up to version 7: numeric vectors, matrices, fields of structures, and scalars for gains.

use overact::Code;

use matfile::{Array, MatFile, NumericData};

use super::{arrays::Arrays, medium::Medium, problems::unreadable, structures};
use crate::error::{Error, Problem};

/// Reads all arrays of a file.
///
/// # Errors
/// A file that can't be read.
pub(super) fn open(file: String, medium: &Medium) -> Result<Arrays, Error> {
    let bytes = medium.read().map_err(|error| unreadable(&file, &error))?;
    let mat = MatFile::parse(bytes.as_slice()).map_err(|error| {
        Problem::new(
            Code::LOG_FORMAT,
            format!("the file is not a MATLAB v5 file: {error}"),
        )
        .file(file.as_str())
        .help("save it in MATLAB with `save(..., '-v7')`, or export CSV")
    })?;
    let mut arrays = Arrays::new(file);
    for array in mat.arrays() {
        push(&mut arrays, array.name(), array);
    }
    for (name, field) in structures::fields(&bytes) {
        // Fields that are no numbers are left out, as other variables that are none.
        let field = MatFile::parse(field.as_slice());
        if let Some(array) = field.iter().flat_map(MatFile::arrays).next() {
            push(&mut arrays, &name, array);
        }
    }
    Ok(arrays)
}

/// Adds an array under a name.
fn push(arrays: &mut Arrays, name: &str, array: &Array) {
    let rows = array.size().first().copied().unwrap_or(0);
    let values = values(array.data());
    let columns = values.len().checked_div(rows).unwrap_or(0);
    arrays.push(name, (rows, columns), &values);
}

/// The real parts of an array, in MATLAB's column-major order.
fn values(data: &NumericData) -> Vec<f64> {
    match data {
        NumericData::Int8 { real, .. } => real.iter().map(|&x| f64::from(x)).collect(),
        NumericData::UInt8 { real, .. } => real.iter().map(|&x| f64::from(x)).collect(),
        NumericData::Int16 { real, .. } => real.iter().map(|&x| f64::from(x)).collect(),
        NumericData::UInt16 { real, .. } => real.iter().map(|&x| f64::from(x)).collect(),
        NumericData::Int32 { real, .. } => real.iter().map(|&x| f64::from(x)).collect(),
        NumericData::UInt32 { real, .. } => real.iter().map(|&x| f64::from(x)).collect(),
        NumericData::Int64 { real, .. } => real.iter().map(|&x| x as f64).collect(),
        NumericData::UInt64 { real, .. } => real.iter().map(|&x| x as f64).collect(),
        NumericData::Single { real, .. } => real.iter().map(|&x| f64::from(x)).collect(),
        NumericData::Double { real, .. } => real.clone(),
    }
}
