//! Online estimators as Python objects, on flat arrays; `overact/online.py` has their shapes.

use crate::errors;
use numpy::{PyArray1, PyReadonlyArray1, PyReadwriteArray1};
use overact::StandardParameter;
use overact::online::{
    Change, ChangeTest, Error, FilterState, Forgetting, Innovation, PayloadEstimator, PayloadSize,
    SliceFilter, StateVariableFilter, Whitening,
};
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

/// A state-variable filter of any order.
trait Signals: Send + Sync {
    fn update(&mut self, sample: f64) -> Result<[f64; 3], Error>;
    fn restart(&mut self, value: f64);
    fn delay(&self) -> f64;
    fn copied(&self) -> Box<dyn Signals>;
}

impl<const N: usize> Signals for StateVariableFilter<N> {
    fn update(&mut self, sample: f64) -> Result<[f64; 3], Error> {
        let signal = Self::update(self, sample)?;
        Ok([signal.value, signal.velocity, signal.acceleration])
    }

    fn restart(&mut self, value: f64) {
        Self::restart(self, value);
    }

    fn delay(&self) -> f64 {
        Self::delay(self)
    }

    fn copied(&self) -> Box<dyn Signals> {
        Box::new(*self)
    }
}

fn filter<const N: usize>(cutoff: f64, sampling: f64) -> Result<Box<dyn Signals>, Error> {
    Ok(Box::new(StateVariableFilter::<N>::new(cutoff, sampling)?))
}

/// Equal state-variable filters of several signals.
#[pyclass(module = "overact._overact")]
pub(crate) struct OnlineSignals(Vec<Box<dyn Signals>>);

#[pymethods]
impl OnlineSignals {
    #[new]
    fn new(
        py: Python<'_>,
        order: usize,
        cutoff: f64,
        sampling: f64,
        signals: usize,
    ) -> PyResult<Self> {
        let made = match order {
            3 => filter::<3>(cutoff, sampling),
            4 => filter::<4>(cutoff, sampling),
            5 => filter::<5>(cutoff, sampling),
            6 => filter::<6>(cutoff, sampling),
            7 => filter::<7>(cutoff, sampling),
            8 => filter::<8>(cutoff, sampling),
            _ => Err(Error::Setting {
                setting: "order",
                condition: "from 3 to 8",
            }),
        };
        let first = made.map_err(|error| errors::of_online(py, "the filter", None, error))?;
        Ok(Self((0..signals).map(|_| first.copied()).collect()))
    }

    /// Filters samples of all signals: values, velocities and accelerations of each number.
    ///
    /// All samples pass or, with an error, none.
    fn update<'py>(
        &mut self,
        py: Python<'py>,
        samples: PyReadonlyArray1<'_, f64>,
    ) -> PyResult<[Bound<'py, PyArray1<f64>>; 3]> {
        let samples = samples.as_slice()?;
        let before: Vec<_> = self.0.iter().map(|one| one.copied()).collect();
        let mut found: [Vec<f64>; 3] = [const { Vec::new() }; 3];
        let count = self.0.len().max(1);
        for (sample, row) in samples.chunks(count).enumerate() {
            for (own, number) in self.0.iter_mut().zip(row) {
                match own.update(*number) {
                    Ok(numbers) => {
                        for (place, number) in found.iter_mut().zip(numbers) {
                            place.push(number);
                        }
                    }
                    Err(error) => {
                        self.0 = before;
                        return Err(errors::of_online(py, "update", Some(sample), error));
                    }
                }
            }
        }
        Ok(found.map(|numbers| PyArray1::from_vec(py, numbers)))
    }

    /// Sets the filters to rest at values.
    fn restart(&mut self, values: PyReadonlyArray1<'_, f64>) -> PyResult<()> {
        for (own, value) in self.0.iter_mut().zip(values.as_slice()?) {
            own.restart(*value);
        }
        Ok(())
    }

    /// Delay of slow signals, s.
    fn delay(&self) -> f64 {
        self.0.first().map_or(0.0, |one| one.delay())
    }
}
