//! Detection of changes: CUSUM test and whitening of innovations.

use crate::errors;
use numpy::PyReadwriteArray1;
use overact::online::{Change, ChangeTest, Whitening};
use pyo3::prelude::*;

/// CUSUM test of innovations.
#[pyclass(module = "overact._overact")]
pub(crate) struct OnlineChangeTest(ChangeTest);

#[pymethods]
impl OnlineChangeTest {
    #[new]
    fn new(py: Python<'_>, shift: f64, samples: f64) -> PyResult<Self> {
        let test = ChangeTest::new(shift, samples);
        test.map(Self)
            .map_err(|error| errors::of_online(py, "the test", None, error))
    }

    /// Threshold of the sums.
    fn threshold(&self) -> f64 {
        self.0.threshold()
    }

    /// Adds an innovation.
    fn update(&mut self, normalised: f64) -> Option<&'static str> {
        self.0.update(normalised).map(|change| match change {
            Change::Increase => "increase",
            Change::Decrease => "decrease",
        })
    }

    /// Sets both sums to zero.
    fn reset(&mut self) {
        self.0.reset();
    }
}

/// Whitening of innovations.
#[pyclass(module = "overact._overact")]
pub(crate) struct OnlineWhitening(Whitening);

#[pymethods]
impl OnlineWhitening {
    #[new]
    fn new() -> Self {
        Self(Whitening::new())
    }

    /// Correlation of successive numbers.
    fn correlation(&self) -> f64 {
        self.0.correlation()
    }

    /// Whitens numbers, one after the other.
    fn update(&mut self, mut numbers: PyReadwriteArray1<'_, f64>) -> PyResult<()> {
        for number in numbers.as_slice_mut()? {
            *number = self.0.update(*number);
        }
        Ok(())
    }
}
