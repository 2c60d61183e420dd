//! MATLAB v5 `.mat` files: numeric vectors, columns of matrices, and scalars for gains.

use std::path::Path;

use matfile::{Array, MatFile, NumericData};

use super::{
    Gain, LARGEST_NUMBER_OF_PROBLEMS, Log, Mapping, display_name, log::Clock, missing_columns,
    unreadable,
};
use crate::error::{Error, Problem};

/// Reads a run from a MATLAB v5 file.
///
/// # Errors
/// A file that can't be read, missing variables, values that are not finite numbers, vectors of
/// different lengths, a time that is not uniform, or a mapping that is not right.
pub fn read_mat(path: &Path, mapping: &Mapping, payload: bool) -> Result<Log, Error> {
    let file = display_name(path);
    mapping.check()?;
    let bytes = std::fs::read(path).map_err(|error| unreadable(&file, &error))?;
    if bytes.starts_with(b"MATLAB 7.3") {
        return Err(
            Problem::new("the file is of MATLAB's version 7.3, which is HDF5")
                .file(file)
                .help("save it in MATLAB with `save(..., '-v7')`, or export CSV")
                .into(),
        );
    }
    let mat = MatFile::parse(bytes.as_slice()).map_err(|error| {
        Problem::new(format!("the file is not a MATLAB v5 file: {error}"))
            .file(file.as_str())
            .help("save it in MATLAB with `save(..., '-v7')`, or export CSV")
    })?;
    let gains = gains(&file, &mat, mapping)?;
    let columns = read_columns(&file, &mat, mapping)?;
    let (time, columns) = columns.split_at(1);
    let mut clock = Clock::default();
    time.iter()
        .flatten()
        .for_each(|time| clock.push(*time, None));
    let samples = clock.samples();
    let frequency = clock.frequency(&file)?;
    let n = mapping.positions.len();
    let interleaved = |columns: &[Vec<f64>], scales: &[f64]| -> Vec<f64> {
        let row = |sample: usize| {
            let columns = columns.iter().zip(scales);
            columns.map(move |(column, scale)| column[sample] * scale)
        };
        (0..samples).flat_map(row).collect()
    };
    let positions = interleaved(&columns[..n], &mapping.position_scale);
    let torques = interleaved(&columns[n..], &gains);
    let log = Log::new(file, frequency, n, positions, torques, payload)?;
    Ok(log.without_offsets(&mapping.position_offset))
}

/// The gains as numbers, read from the file's scalars where the mapping names them.
fn gains(file: &str, mat: &MatFile, mapping: &Mapping) -> Result<Vec<f64>, Error> {
    let mut problems = Vec::new();
    let mut gains = Vec::new();
    for gain in &mapping.torque_gain {
        match gain {
            Gain::Value(value) => gains.push(*value),
            Gain::Variable(name) => {
                match mat.find_by_name(name).map(|array| values(array.data())) {
                    Some(values)
                        if values.len() == 1 && values[0].is_finite() && values[0] != 0.0 =>
                    {
                        gains.push(values[0]);
                    }
                    Some(values) => problems.push(
                        Problem::new(format!(
                            "the torque gain `{name}` is not one finite number but {} numbers",
                            values.len()
                        ))
                        .file(file)
                        .column(name.as_str()),
                    ),
                    None => problems.push(missing_columns(
                        file,
                        &[name.as_str()],
                        &names(mat),
                        "scalar variable",
                    )),
                }
            }
        }
    }
    Error::check(problems)?;
    Ok(gains)
}

/// Names of the file's numeric variables.
fn names(mat: &MatFile) -> Vec<&str> {
    mat.arrays().iter().map(Array::name).collect()
}

/// The variables that the mapping names, all of one length: time, positions, torques.
fn read_columns(file: &str, mat: &MatFile, mapping: &Mapping) -> Result<Vec<Vec<f64>>, Error> {
    let wanted = mapping.names();
    let mut missing: Vec<&str> = Vec::new();
    let mut columns: Vec<Vec<f64>> = Vec::new();
    for name in &wanted {
        match variable(mat, name) {
            Some(column) => columns.push(column),
            None if missing.contains(name) => {}
            None => missing.push(name),
        }
    }
    if !missing.is_empty() {
        return Err(missing_columns(file, &missing, &names(mat), "variable").into());
    }
    let samples = columns.first().map_or(0, Vec::len);
    let mut problems = Vec::new();
    for (name, column) in wanted.iter().zip(&columns) {
        let problem = |message: String| Problem::new(message).file(file).column(*name);
        if column.len() != samples {
            problems.push(problem(format!(
                "`{name}` has {} samples, but `{}` has {samples}",
                column.len(),
                mapping.time
            )));
        }
        if let Some(sample) = column.iter().position(|value| !value.is_finite()) {
            problems.push(problem(format!(
                "`{name}`: sample {sample} is not a finite number"
            )));
        }
    }
    problems.truncate(LARGEST_NUMBER_OF_PROBLEMS);
    Error::check(problems)?;
    Ok(columns)
}

/// A vector by its name, or a column of a matrix written `name(:,2)`.
fn variable(mat: &MatFile, name: &str) -> Option<Vec<f64>> {
    if let Some(array) = mat.find_by_name(name) {
        return Some(values(array.data()));
    }
    let (matrix, rest) = name.split_once("(:,")?;
    let column: usize = rest.strip_suffix(')')?.trim().parse().ok()?;
    let array = mat.find_by_name(matrix.trim())?;
    let rows = *array.size().first()?;
    let all = values(array.data());
    let start = column.checked_sub(1)?.checked_mul(rows)?;
    all.get(start..start.checked_add(rows)?)
        .map(<[f64]>::to_vec)
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
