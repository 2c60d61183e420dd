//! Reports progress of long work to a Python callable.

use pyo3::prelude::*;
use std::sync::{Mutex, PoisonError};

/// Callable that receives the completed fraction, from 0 to 1, and the current work.
pub(crate) struct Teller {
    callable: Option<Py<PyAny>>,
    failed: Mutex<Option<PyErr>>,
}

impl Teller {
    pub(crate) fn new(callable: Option<Py<PyAny>>) -> Self {
        let failed = Mutex::default();
        Self { callable, failed }
    }

    /// Calls the callable, unless it has failed before.
    pub(crate) fn tell(&self, part: f64, what: &str) {
        let Some(callable) = &self.callable else {
            return;
        };
        let mut failed = self.failed.lock().unwrap_or_else(PoisonError::into_inner);
        if failed.is_none() {
            let told = Python::attach(|py| callable.call1(py, (part, what)).map(drop));
            *failed = told.err();
        }
    }

    /// Ends reporting.
    ///
    /// # Errors
    /// The exception of the callable, if it failed.
    pub(crate) fn end(self) -> PyResult<()> {
        let failed = self.failed.into_inner();
        let failed = failed.unwrap_or_else(PoisonError::into_inner);
        failed.map_or(Ok(()), Err)
    }
}
