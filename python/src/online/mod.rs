//! Online estimators as Python objects, on flat arrays; `overact/online.py` has their shapes.

mod change;
mod filter;
mod payload;
mod signals;

pub(crate) use change::{OnlineChangeTest, OnlineWhitening};
pub(crate) use filter::OnlineFilter;
pub(crate) use payload::OnlinePayload;
pub(crate) use signals::OnlineSignals;

use numpy::PyArray1;
use overact::online::{Error, Forgetting, Innovation};
use pyo3::prelude::*;

/// Results of an update, in the order of the rows: residuals, their standard deviations,
/// normalised residuals, and whether they are determined.
#[derive(IntoPyObject)]
pub(crate) struct Innovations<'py> {
    residual: Bound<'py, PyArray1<f64>>,
    standard_deviation: Bound<'py, PyArray1<f64>>,
    normalised: Bound<'py, PyArray1<f64>>,
    is_determined: Bound<'py, PyArray1<bool>>,
}

impl<'py> Innovations<'py> {
    fn new(py: Python<'py>, all: &[Innovation<f64>]) -> Self {
        let numbers = |of: fn(&Innovation<f64>) -> f64| PyArray1::from_iter(py, all.iter().map(of));
        Self {
            residual: numbers(|one| one.residual),
            standard_deviation: numbers(|one| one.standard_deviation),
            normalised: numbers(|one| one.normalised),
            is_determined: PyArray1::from_iter(py, all.iter().map(|one| one.is_determined)),
        }
    }
}

/// Rows, right sides and standard deviations of samples with `block` rows each.
struct Samples<'a> {
    rows: &'a [f64],
    y: &'a [f64],
    sigma: &'a [f64],
    block: usize,
}

/// An error at a sample.
struct Rejected {
    sample: usize,
    error: Error,
}

impl Samples<'_> {
    /// Passes the samples to an estimator of `parameters` parameters, one after the other.
    fn each(
        &self,
        parameters: usize,
        mut update: impl FnMut(&[f64], &[f64], &[f64], &mut [Innovation<f64>]) -> Result<(), Error>,
    ) -> Result<Vec<Innovation<f64>>, Rejected> {
        let mut innovations = vec![Innovation::default(); self.y.len()];
        let block = self.block.max(1);
        let rows = self.rows.chunks((block * parameters).max(1));
        let sides = self.y.chunks(block).zip(self.sigma.chunks(block));
        let all = rows.zip(sides).zip(innovations.chunks_mut(block));
        for (sample, ((rows, (y, sigma)), places)) in all.enumerate() {
            update(rows, y, sigma, places).map_err(|error| Rejected { sample, error })?;
        }
        Ok(innovations)
    }
}

/// The rule of forgetting of a name and a factor.
fn forgetting(rule: &str, factor: f64) -> Forgetting {
    match rule {
        "exponential" => Forgetting::Exponential(factor),
        "directional" => Forgetting::Directional(factor),
        _ => Forgetting::None,
    }
}
