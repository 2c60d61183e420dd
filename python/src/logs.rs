//! Runs from Python: files, arrays by column name, or samples in SI units.

use numpy::{PyReadonlyArrayDyn, PyUntypedArrayMethods};
use overact_identification::Log;
use overact_logs::Array;
use overact_robot::{Error, Robot};
use pyo3::{exceptions::PyValueError, prelude::*, types::PyTuple};
use std::path::{Path, PathBuf};

/// A run.
pub(crate) enum Given {
    /// A file, or several joined by `+`.
    File(PathBuf),
    /// Arrays with the column names of the description.
    Arrays(String, Vec<NamedArray>),
    /// Samples of all actuators in SI units.
    Samples(Samples),
}

/// NamedArray array in column-major order.
pub(crate) struct NamedArray {
    name: String,
    shape: (usize, usize),
    values: Vec<f64>,
}

/// Row-major samples, samples x n.
pub(crate) struct Samples {
    name: String,
    frequency: f64,
    actuators: usize,
    positions: Vec<f64>,
    torques: Vec<f64>,
    velocities: Vec<f64>,
}

/// Run and whether the platform carried the payload.
///
/// The tuple is `("file", payload, path)`, `("arrays", payload, name, [(column, rows, columns,
/// values)])` or `("samples", payload, name, frequency, positions, torques, velocities or None)`.
///
/// # Errors
/// Any other tuple.
pub(crate) fn given(item: &Bound<'_, PyTuple>) -> PyResult<(Given, bool)> {
    let kind: String = item.get_item(0)?.extract()?;
    let payload: bool = item.get_item(1)?.extract()?;
    let run = match kind.as_str() {
        "file" => Given::File(item.get_item(2)?.extract()?),
        "arrays" => {
            let arrays = item.get_item(3)?;
            let arrays = arrays.try_iter()?.map(|one| named(&one?));
            Given::Arrays(
                item.get_item(2)?.extract()?,
                arrays.collect::<PyResult<_>>()?,
            )
        }
        "samples" => Given::Samples(samples(item)?),
        other => {
            let message = format!("there is no run of the kind {other}");
            return Err(PyValueError::new_err(message));
        }
    };
    Ok((run, payload))
}

fn named(item: &Bound<'_, PyAny>) -> PyResult<NamedArray> {
    let (name, rows, columns, values): (String, usize, usize, PyReadonlyArrayDyn<'_, f64>) =
        item.extract()?;
    Ok(NamedArray {
        name,
        shape: (rows, columns),
        values: values.as_slice()?.to_vec(),
    })
}

fn samples(item: &Bound<'_, PyTuple>) -> PyResult<Samples> {
    let array = |at: usize| -> PyResult<(Vec<f64>, usize)> {
        let array: PyReadonlyArrayDyn<'_, f64> = item.get_item(at)?.extract()?;
        let width = array.shape().last().copied().unwrap_or_default();
        Ok((array.as_slice()?.to_vec(), width))
    };
    let (positions, actuators) = array(4)?;
    let velocities = item.get_item(6)?;
    Ok(Samples {
        name: item.get_item(2)?.extract()?,
        frequency: item.get_item(3)?.extract()?,
        actuators,
        positions,
        torques: array(5)?.0,
        velocities: if velocities.is_none() {
            Vec::new()
        } else {
            array(6)?.0
        },
    })
}

/// Converts the runs to logs, in order; those with gaps in their time to several.
///
/// # Errors
/// All errors of all runs.
pub(crate) fn logs(
    robot: &Robot,
    runs: &[(Given, bool)],
    progress: &(dyn Fn(f64) + Sync),
) -> Result<Vec<Log>, Error> {
    let (mut logs, mut errors) = (Vec::new(), Vec::new());
    let files = runs.iter().filter_map(|(run, payload)| match run {
        Given::File(path) => Some((path.as_path(), *payload)),
        _ => None,
    });
    let files: Vec<(&Path, bool)> = files.collect();
    let read = robot.read_runs(&files, progress);
    let mut read = match read {
        Ok(read) => read.into_iter(),
        Err(error) => {
            errors.push(error);
            Vec::new().into_iter()
        }
    };
    for (run, payload) in runs {
        let runs = match run {
            Given::File(_) => match read.next() {
                Some(runs) => Ok(runs),
                None => continue,
            },
            Given::Arrays(name, arrays) => {
                let arrays = arrays.iter().map(|one| Array {
                    name: &one.name,
                    shape: one.shape,
                    values: &one.values,
                });
                robot.runs_of_arrays(name, &arrays.collect::<Vec<_>>(), *payload)
            }
            Given::Samples(samples) => samples.log(*payload).map(|log| vec![log]),
        };
        match runs {
            Ok(runs) => logs.extend(runs),
            Err(error) => errors.push(error),
        }
    }
    if errors.is_empty() {
        Ok(logs)
    } else {
        Err(Error::Several(errors))
    }
}

impl Samples {
    fn log(&self, payload: bool) -> Result<Log, Error> {
        let log = Log::new(
            self.name.as_str(),
            self.frequency,
            self.actuators,
            self.positions.clone(),
            self.torques.clone(),
            payload,
        )?;
        Ok(log.with_velocities(self.velocities.clone()))
    }
}
