//! Compiled part of the Python package `overact`: robots, functions, experiments, identification.
//!
//! The other part, `overact/*.py`, adds names, documentation and classes.
//!
//! - `errors`: errors as exceptions of the package;
//! - `arrays`: NumPy arrays as rows of numbers, without copies where possible;
//! - `form`: a function of a robot in one of its forms, evaluated over samples;
//! - `function`: a form as a callable object;
//! - `operations`: cost of functions, and their programs step by step;
//! - `robot`: a description as an object;
//! - `progress`: progress of long work, reported to a callable;
//! - `logs`, `simulation`, `identification`: runs in, records and results out;
//! - `online`: estimators for data as they arrive;
//! - `arrow`: columns of tables with Arrow's C interface;
//! - `command`: the command line, which is part of the package.

mod arrays;
mod arrow;
mod command;
mod errors;
mod function;
mod function_form;
mod identification;
mod logs;
mod online;
mod operations;
mod progress;
mod robot;
mod simulation;

use pyo3::prelude::*;

/// Compiled part of the package.
#[pymodule]
fn _overact(module: &Bound<'_, PyModule>) -> PyResult<()> {
    module.add("__version__", env!("CARGO_PKG_VERSION"))?;
    module.add_class::<robot::Handle>()?;
    module.add_class::<function::Function>()?;
    module.add_class::<identification::Identified>()?;
    module.add_class::<online::OnlineFilter>()?;
    module.add_class::<online::OnlinePayload>()?;
    module.add_class::<online::OnlineChangeTest>()?;
    module.add_class::<online::OnlineWhitening>()?;
    module.add_class::<online::OnlineSignals>()?;
    module.add_function(wrap_pyfunction!(arrow::columns, module)?)?;
    module.add_function(wrap_pyfunction!(command::command, module)?)?;
    module.add_function(wrap_pyfunction!(function::known_functions, module)?)
}
