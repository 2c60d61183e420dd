//! Estimator of a payload.

use super::{Innovations, Samples, forgetting};
use crate::errors;
use numpy::{PyArray1, PyReadonlyArray1};
use overact::StandardParameter;
use overact::online::{Error, Forgetting, Innovation, PayloadEstimator, PayloadSize};
use pyo3::prelude::*;

/// A payload estimator of any number of columns.
trait Payloads: Send + Sync {
    fn update(
        &mut self,
        rows: &[f64],
        residuals: &[f64],
        sigma: &[f64],
        innovations: &mut [Innovation<f64>],
    ) -> Result<(), Error>;
    fn set_forgetting(&mut self, forgetting: Forgetting) -> Result<(), Error>;
    fn discount(&mut self, factor: f64) -> Result<(), Error>;
    fn estimate(&self) -> Result<Vec<f64>, Error>;
    fn covariance(&self) -> Result<Vec<f64>, Error>;
    /// The ten parameters of the nearest body, and whether they are not the estimate's.
    fn payload(&self) -> Result<([f64; 10], bool), Error>;
    fn copied(&self) -> Box<dyn Payloads>;
}

impl<const P: usize> Payloads for PayloadEstimator<P> {
    fn update(
        &mut self,
        rows: &[f64],
        residuals: &[f64],
        sigma: &[f64],
        innovations: &mut [Innovation<f64>],
    ) -> Result<(), Error> {
        let (rows, _) = rows.as_chunks::<P>();
        self.update_slices(rows, residuals, sigma, innovations)
    }

    fn set_forgetting(&mut self, forgetting: Forgetting) -> Result<(), Error> {
        *self = self.with_forgetting(forgetting)?;
        Ok(())
    }

    fn discount(&mut self, factor: f64) -> Result<(), Error> {
        Self::discount(self, factor)
    }

    fn estimate(&self) -> Result<Vec<f64>, Error> {
        Ok(self.filter().estimate()?.to_vec())
    }

    fn covariance(&self) -> Result<Vec<f64>, Error> {
        Ok(self.filter().covariance()?.as_flattened().to_vec())
    }

    fn payload(&self) -> Result<([f64; 10], bool), Error> {
        let payload = Self::payload(self)?;
        Ok((payload.parameters, payload.is_projected))
    }

    fn copied(&self) -> Box<dyn Payloads> {
        Box::new(*self)
    }
}

/// An estimator, or why there is none; nothing if the number of columns is another.
type MadePayloads = Option<Result<Box<dyn Payloads>, Error>>;

/// Makes an estimator of a certain number of columns.
type Made = fn(&[StandardParameter], PayloadSize) -> MadePayloads;

/// An estimator of P columns, if there are P.
fn made<const P: usize>(columns: &[StandardParameter], size: PayloadSize) -> MadePayloads {
    let columns: [StandardParameter; P] = columns.try_into().ok()?;
    let made = PayloadEstimator::new(columns, size);
    Some(made.map(|one| Box::new(one) as Box<dyn Payloads>))
}

/// Estimator of a payload's inertial parameters.
#[pyclass(module = "overact._overact")]
pub(crate) struct OnlinePayload {
    estimator: Box<dyn Payloads>,
    columns: usize,
}

#[pymethods]
impl OnlinePayload {
    /// An estimator of columns by the names of their parameters.
    #[new]
    fn new(py: Python<'_>, columns: Vec<String>, mass: f64, length: f64) -> PyResult<Self> {
        let error = |error| errors::of_online(py, "the payload", None, error);
        let wrong = Error::Setting {
            setting: "columns",
            condition: "different ones of xx, xy, xz, yy, yz, zz, mx, my, mz, m",
        };
        let known = |name: &String| {
            let mut all = StandardParameter::INERTIA.into_iter();
            all.find(|one| one.name() == name)
        };
        let found: Option<Vec<StandardParameter>> = columns.iter().map(known).collect();
        let found = found.ok_or_else(|| error(wrong))?;
        let size = PayloadSize { mass, length };
        let each: [Made; 10] = [
            made::<1>, made::<2>, made::<3>, made::<4>, made::<5>, made::<6>, made::<7>, made::<8>,
            made::<9>, made::<10>,
        ];
        let estimator = each.iter().find_map(|made| made(&found, size));
        Ok(Self {
            estimator: estimator.unwrap_or(Err(wrong)).map_err(error)?,
            columns: found.len(),
        })
    }

    /// Sets the rule of forgetting.
    fn set_forgetting(&mut self, py: Python<'_>, rule: &str, factor: f64) -> PyResult<()> {
        let done = self.estimator.set_forgetting(forgetting(rule, factor));
        done.map_err(|error| errors::of_online(py, "the payload", None, error))
    }

    /// Adds samples of `block` rows each; all or, with an error, none.
    fn update<'py>(
        &mut self,
        py: Python<'py>,
        rows: PyReadonlyArray1<'_, f64>,
        residuals: PyReadonlyArray1<'_, f64>,
        sigma: PyReadonlyArray1<'_, f64>,
        block: usize,
    ) -> PyResult<Innovations<'py>> {
        let samples = Samples {
            rows: rows.as_slice()?,
            y: residuals.as_slice()?,
            sigma: sigma.as_slice()?,
            block,
        };
        let (before, columns) = (self.estimator.copied(), self.columns);
        let estimator = &mut self.estimator;
        let done = py.detach(|| {
            samples.each(columns, |rows, y, sigma, places| {
                estimator.update(rows, y, sigma, places)
            })
        });
        let innovations = done.map_err(|rejected| {
            self.estimator = before;
            errors::of_online(py, "update", Some(rejected.sample), rejected.error)
        })?;
        Ok(Innovations::new(py, &innovations))
    }

    /// Multiplies the information by a factor.
    fn discount(&mut self, py: Python<'_>, factor: f64) -> PyResult<()> {
        let done = self.estimator.discount(factor);
        done.map_err(|error| errors::of_online(py, "the payload", None, error))
    }

    /// The estimate without constraints.
    fn estimate<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyArray1<f64>>> {
        let estimate = self.estimator.estimate();
        let estimate =
            estimate.map_err(|error| errors::of_online(py, "the payload", None, error))?;
        Ok(PyArray1::from_vec(py, estimate))
    }

    /// The covariance of the estimate, row by row.
    fn covariance<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyArray1<f64>>> {
        let covariance = self.estimator.covariance();
        let covariance =
            covariance.map_err(|error| errors::of_online(py, "the payload", None, error))?;
        Ok(PyArray1::from_vec(py, covariance))
    }

    /// The ten parameters of the nearest body, and whether they are not the estimate's.
    fn payload(&self, py: Python<'_>) -> PyResult<([f64; 10], bool)> {
        let payload = py.detach(|| self.estimator.payload());
        payload.map_err(|error| errors::of_online(py, "the payload", None, error))
    }
}
