//! The compiled half of the Python package `overact`: robots, their functions on NumPy arrays, virtual
//! experiments and identifications. The other half, `overact/*.py`, gives them names, texts and classes.
//!
//! - `errors`: what is wrong, as exceptions of the package;
//! - `arrays`: NumPy arrays as rows of numbers, without copies where they lie right;
//! - `form`: a function of a robot in one of its forms, evaluated over samples;
//! - `function`: a form as an object that is called;
//! - `operations`: what functions cost, and their programs step by step;
//! - `robot`: a description as an object;
//! - `progress`: how far long work is, told to a callable;
//! - `logs`, `simulation`, `identification`: runs in, records and results out;
//! - `arrow`: columns of tables that speak Arrow's C interface;
//! - `command`: the command line, which the package brings along.

mod arrays;
mod arrow;
mod command;
mod errors;
mod form;
mod function;
mod identification;
mod logs;
mod operations;
mod progress;
mod robot;
mod simulation;

use pyo3::prelude::*;

/// The compiled half of the package.
#[pymodule]
fn _overact(module: &Bound<'_, PyModule>) -> PyResult<()> {
    module.add("__version__", env!("CARGO_PKG_VERSION"))?;
    module.add_class::<robot::Handle>()?;
    module.add_class::<function::Function>()?;
    module.add_class::<identification::Identified>()?;
    module.add_function(wrap_pyfunction!(arrow::columns, module)?)?;
    module.add_function(wrap_pyfunction!(command::command, module)?)?;
    module.add_function(wrap_pyfunction!(function::known_functions, module)?)
}
