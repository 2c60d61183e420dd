//! The command line.

use pyo3::prelude::*;
use std::ffi::OsString;

/// Runs the command `overact` with its arguments, the program's name first; returns its exit code.
#[pyfunction]
pub(crate) fn command(py: Python<'_>, arguments: Vec<OsString>) -> u8 {
    py.detach(|| overact_cli::run_with(arguments))
}
