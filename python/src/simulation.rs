//! Virtual experiment of a robot.

use crate::{errors, progress::Teller};
use numpy::{PyArray1, PyArray2, PyArrayMethods};
use overact_robot::{Error, Robot};
use overact_simulation::Record;
use pyo3::prelude::*;
use std::collections::BTreeMap;

/// Run for Python: name, payload, sampling frequency, actuators, time, positions, torques, largest
/// tracking errors.
type Run<'py> = (
    String,
    bool,
    f64,
    Vec<String>,
    Bound<'py, PyArray1<f64>>,
    Bound<'py, PyArray2<f64>>,
    Bound<'py, PyArray2<f64>>,
    Bound<'py, PyArray1<f64>>,
);

/// Runs, and names of true parameters without effect on the model.
pub(crate) type Made<'py> = (Vec<Run<'py>>, Vec<String>);

/// Overrides of the description.
pub(crate) struct Wishes {
    /// Runs to simulate; all if empty.
    pub(crate) runs: Vec<String>,
    pub(crate) seed: Option<u64>,
    /// Standard parameters of the virtual robot.
    pub(crate) parameters: Option<BTreeMap<String, f64>>,
}

/// Simulates the runs.
pub(crate) fn simulate<'py>(
    py: Python<'py>,
    robot: &Robot,
    wishes: &Wishes,
    progress: Option<Py<PyAny>>,
) -> PyResult<Made<'py>> {
    let teller = Teller::new(progress);
    let made = py.detach(|| records(robot, wishes, &teller));
    teller.end()?;
    let (records, without_effect) = made.map_err(|error| errors::of_robot(py, &error))?;
    let runs = records.into_iter().map(|record| run(py, record));
    Ok((runs.collect::<PyResult<_>>()?, without_effect))
}

fn records(
    robot: &Robot,
    wishes: &Wishes,
    teller: &Teller,
) -> Result<(Vec<Record>, Vec<String>), Error> {
    let mut experiment = robot.experiment()?;
    experiment.check_runs(&wishes.runs)?;
    if !wishes.runs.is_empty() {
        let runs = &mut experiment.plan_mut().runs;
        runs.retain(|run| wishes.runs.contains(&run.name));
    }
    if let Some(values) = &wishes.parameters {
        experiment.set_parameters(values);
    }
    if let Some(seed) = wishes.seed {
        experiment.plan_mut().seed = seed;
    }
    let records = experiment.records(&|part, run| teller.tell(part, run))?;
    Ok((records, experiment.without_effect().to_vec()))
}

fn run(py: Python<'_>, record: Record) -> PyResult<Run<'_>> {
    let (samples, n) = (record.time.len(), record.actuators.len());
    let matrix = |values: Vec<f64>| PyArray1::from_vec(py, values).reshape([samples, n]);
    Ok((
        record.name,
        record.payload,
        record.sampling_hz,
        record.actuators,
        PyArray1::from_vec(py, record.time),
        matrix(record.positions)?,
        matrix(record.torques)?,
        PyArray1::from_vec(py, record.tracking_error),
    ))
}
