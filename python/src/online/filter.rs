//! Square-root information filter.

use super::{Innovations, Samples, forgetting};
use crate::errors;
use numpy::{PyArray1, PyReadonlyArray1};
use overact::online::{Error, FilterState, SliceFilter};
use pyo3::prelude::*;

/// Square-root information filter.
#[pyclass(module = "overact._overact", skip_from_py_object)]
#[derive(Clone)]
pub(crate) struct OnlineFilter {
    factor: Vec<f64>,
    vectors: Vec<f64>,
    state: FilterState,
}

impl OnlineFilter {
    /// Calls `work` with the filter; the state is kept if it fails.
    fn with<R>(
        &mut self,
        work: impl FnOnce(&mut SliceFilter<'_>) -> Result<R, Error>,
    ) -> Result<R, Error> {
        let mut filter = SliceFilter::resume(&mut self.factor, &mut self.vectors, self.state)?;
        let result = work(&mut filter)?;
        self.state = filter.state();
        Ok(result)
    }

    fn numbers<'py>(
        &mut self,
        py: Python<'py>,
        count: usize,
        work: impl FnOnce(&mut SliceFilter<'_>, &mut [f64]) -> Result<(), Error>,
    ) -> PyResult<Bound<'py, PyArray1<f64>>> {
        let mut numbers = vec![0.0; count];
        self.with(|filter| work(filter, &mut numbers))
            .map_err(|error| errors::of_online(py, "the filter", None, error))?;
        Ok(PyArray1::from_vec(py, numbers))
    }

    fn parameters(&self) -> usize {
        self.vectors.len() / 4
    }
}

#[pymethods]
impl OnlineFilter {
    /// A filter of a number of parameters, with a prior if one is given.
    #[new]
    #[pyo3(signature = (parameters, prior=None))]
    fn new(
        py: Python<'_>,
        parameters: usize,
        prior: Option<(PyReadonlyArray1<'_, f64>, PyReadonlyArray1<'_, f64>)>,
    ) -> PyResult<Self> {
        let [squared, all] = SliceFilter::<f64>::lengths(parameters);
        let (mut factor, mut vectors) = (vec![0.0; squared], vec![0.0; all]);
        let made = match &prior {
            None => SliceFilter::without_prior(&mut factor, &mut vectors),
            Some((estimate, square_root)) => {
                let (estimate, square_root) = (estimate.as_slice()?, square_root.as_slice()?);
                SliceFilter::with_prior(&mut factor, &mut vectors, estimate, square_root)
            }
        };
        let state = made
            .map_err(|error| errors::of_online(py, "the prior", None, error))?
            .state();
        Ok(Self {
            factor,
            vectors,
            state,
        })
    }

    /// Sets the rule of forgetting.
    fn set_forgetting(&mut self, py: Python<'_>, rule: &str, factor: f64) -> PyResult<()> {
        self.with(|filter| filter.set_forgetting(forgetting(rule, factor)))
            .map_err(|error| errors::of_online(py, "the filter", None, error))
    }

    /// Adds samples of `block` rows each; all or, with an error, none.
    fn update<'py>(
        &mut self,
        py: Python<'py>,
        rows: PyReadonlyArray1<'_, f64>,
        y: PyReadonlyArray1<'_, f64>,
        sigma: PyReadonlyArray1<'_, f64>,
        block: usize,
    ) -> PyResult<Innovations<'py>> {
        let (rows, y, sigma) = (rows.as_slice()?, y.as_slice()?, sigma.as_slice()?);
        let samples = Samples {
            rows,
            y,
            sigma,
            block,
        };
        let before = self.clone();
        let parameters = self.parameters();
        let done = py.detach(|| {
            samples.each(parameters, |rows, y, sigma, places| {
                self.with(|filter| filter.update_block(rows, y, sigma, places))
            })
        });
        let innovations = done.map_err(|rejected| {
            *self = before;
            errors::of_online(py, "update", Some(rejected.sample), rejected.error)
        })?;
        Ok(Innovations::new(py, &innovations))
    }

    /// Multiplies all information by a factor.
    fn discount(&mut self, py: Python<'_>, factor: f64) -> PyResult<()> {
        self.with(|filter| filter.discount(factor))
            .map_err(|error| errors::of_online(py, "the filter", None, error))
    }

    /// The estimate.
    fn estimate<'py>(&mut self, py: Python<'py>) -> PyResult<Bound<'py, PyArray1<f64>>> {
        let count = self.parameters();
        self.numbers(py, count, |filter, place| filter.estimate(place))
    }

    /// The standard deviations.
    fn standard_deviations<'py>(&mut self, py: Python<'py>) -> PyResult<Bound<'py, PyArray1<f64>>> {
        let count = self.parameters();
        self.numbers(py, count, |filter, place| filter.standard_deviations(place))
    }

    /// The covariance, row by row.
    fn covariance<'py>(&mut self, py: Python<'py>) -> PyResult<Bound<'py, PyArray1<f64>>> {
        let count = self.factor.len();
        self.numbers(py, count, |filter, place| filter.covariance(place))
    }

    /// Estimates and standard deviations of determined parameters, one after the other; else NaN.
    fn determined<'py>(&mut self, py: Python<'py>) -> PyResult<Bound<'py, PyArray1<f64>>> {
        let count = self.parameters();
        self.numbers(py, 2 * count, |filter, places| {
            let (values, deviations) = places.split_at_mut(count);
            filter.determined(values, deviations)
        })
    }

    /// R row by row, then z.
    fn triangle<'py>(&mut self, py: Python<'py>) -> PyResult<Bound<'py, PyArray1<f64>>> {
        let count = self.factor.len() + self.parameters();
        self.numbers(py, count, |filter, places| {
            let (factor, side) = filter.factor();
            for (place, number) in places.iter_mut().zip(factor.iter().chain(side)) {
                *place = *number;
            }
            Ok(())
        })
    }

    /// Standard deviation of the normalised residuals.
    fn residual_deviation(&mut self) -> Option<f64> {
        self.with(|filter| Ok(filter.residual_deviation())).ok()?
    }
}
