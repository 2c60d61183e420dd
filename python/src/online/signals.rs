//! State-variable filters of several signals.

use crate::errors;
use numpy::{PyArray1, PyReadonlyArray1};
use overact::online::{Error, StateVariableFilter};
use pyo3::prelude::*;

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
