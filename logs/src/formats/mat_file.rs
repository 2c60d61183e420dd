//! MATLAB's `.mat` files up to version 7: numeric arrays, also in structures and cell arrays.

use overact::Code;

use matfile::{Array, MatFile, NumericData};

use crate::{
    bytes::{budget::Budget, byte_source::ByteSource},
    error::{Error, Problem},
    formats::{arrays::Arrays, structures},
    problems::unreadable,
};

/// Reads all arrays of a file.
///
/// # Errors
/// A file that cannot be read.
pub(crate) fn open(file: String, medium: &ByteSource) -> Result<Arrays, Error> {
    let bytes = medium.read().map_err(|error| unreadable(&file, &error))?;
    let broken = |why: String| -> Error {
        let message = format!("the file is not a MATLAB v5 file: {why}");
        let problem = Problem::new(Code::LOG_FORMAT, message).file(file.as_str());
        let help = "save it in MATLAB with `save(..., '-v7')`, or export CSV";
        problem.help(help).into()
    };
    let header = &bytes[..bytes.len().min(structures::HEADER)];
    MatFile::parse(header).map_err(|error| broken(error.to_string()))?;
    let mut arrays = Arrays::new(file.clone());
    let mut budget = Budget::of_file(&bytes);
    // Small integers need more memory as floats than unpacked.
    let mut of_numbers = Budget::of_file(&bytes);
    let read = structures::arrays(&bytes, &mut budget, &mut |one| {
        let mat = match MatFile::parse(one.file) {
            Ok(mat) => mat,
            Err(_) if one.name.is_some() => return Ok(()),
            Err(error) => return Err(error.to_string()),
        };
        if let Some(array) = mat.arrays().first() {
            if one.is_packed {
                of_numbers.take(array.size().iter().product::<usize>() as u64 * 8)?;
            }
            let name = one.name.unwrap_or(array.name());
            push(&mut arrays, name, array);
            if let Some(label) = one.label {
                arrays.label(label, name);
            }
        }
        Ok(())
    });
    arrays.objects = read.map_err(broken)?;
    Ok(arrays)
}

/// Adds an array under a name.
fn push(arrays: &mut Arrays, name: &str, array: &Array) {
    let rows = array.size().first().copied().unwrap_or(0);
    let values = values(array.data());
    let columns = values.len().checked_div(rows).unwrap_or(0);
    arrays.push(name, rows, columns, &values);
}

/// Real parts of an array, in MATLAB's column-major order.
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
