//! Test for changes in the mean of innovations.

use super::Error;
use crate::float::Float;
use crate::math;

/// Direction of a detected change of the mean.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Change {
    /// Innovations are above zero: the measurement exceeds its prediction.
    Increase,
    /// Innovations are below zero.
    Decrease,
}

/// Two-sided CUSUM test for a change of the mean of normalised innovations e (Page 1954).
///
/// S⁺ = max(0, S⁺ + e - k) and S⁻ = max(0, S⁻ - e - k). An alarm is raised if one of them exceeds h,
/// and both start again from zero. k is half the shift to detect, in standard deviations. h follows
/// from the mean number n of samples between false alarms by Siegmund's formula (*Sequential
/// Analysis*, 1985), with b = h + 1.166:
///
/// 2 n = (exp(2 k b) - 2 k b - 1) / (2 k²).
///
/// The rate holds for independent standard normal innovations. Errors of the model and filtered
/// noise are correlated: test such signals after decimation, and with the standard deviation that
/// residuals really have. An innovation counts at most as h/3, or 4 if that is larger, so that with
/// a usual h one outlier raises no alarm.
///
/// ```
/// use overact::online::{Change, ChangeTest};
///
/// // Detect shifts by one standard deviation, with one false alarm in 100 000 samples.
/// let mut test = ChangeTest::new(1.0, 1e5)?;
/// assert!((test.threshold() - 10.3_f64).abs() < 0.1);
/// assert_eq!(test.update(0.3), None);
/// let steps = (0..1000).position(|_| test.update(1.5) == Some(Change::Increase));
/// assert_eq!(steps, Some(10));
/// # Ok::<(), overact::online::Error>(())
/// ```
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct ChangeTest<T = f64> {
    reference: T,
    threshold: T,
    largest: T,
    above: T,
    below: T,
}

/// Siegmund's correction of the threshold for discrete time, for both ends.
const OVERSHOOT: f64 = 1.166;

impl<T: Float> ChangeTest<T> {
    /// A test for a shift by `shift` standard deviations, with a mean of `samples` samples between
    /// false alarms.
    ///
    /// # Errors
    /// A shift outside 0.01 to 100, or a number of samples outside 10 to 10¹⁵.
    ///
    /// ```
    /// use overact::online::ChangeTest;
    ///
    /// assert!(ChangeTest::new(1.0, 1e6).is_ok());
    /// assert!(ChangeTest::new(0.0, 1e6).is_err());
    /// ```
    pub fn new(shift: T, samples: T) -> Result<Self, Error> {
        let (shift, samples): (f64, f64) = (shift.into(), samples.into());
        for (setting, value, condition, least, most) in [
            ("shift", shift, "from 0.01 to 100", 0.01, 100.0),
            ("samples", samples, "from 10 to 1e15", 10.0, 1e15),
        ] {
            if !(least..=most).contains(&value) {
                return Err(Error::Setting { setting, condition });
            }
        }
        let reference = 0.5 * shift;
        let threshold = threshold(reference, samples);
        Ok(Self {
            reference: T::of(reference),
            threshold: T::of(threshold),
            largest: T::of((threshold / 3.0).max(4.0)),
            above: T::ZERO,
            below: T::ZERO,
        })
    }

    /// The threshold h of the sums.
    ///
    /// ```
    /// use overact::online::ChangeTest;
    ///
    /// let [seldom, often] = [1e6, 1e3].map(|samples| ChangeTest::new(1.0, samples));
    /// assert!(seldom?.threshold() > often?.threshold());
    /// # Ok::<(), overact::online::Error>(())
    /// ```
    #[must_use]
    pub const fn threshold(&self) -> T {
        self.threshold
    }

    /// Adds a normalised innovation; a number that is not finite is left out.
    ///
    /// ```
    /// use overact::online::{Change, ChangeTest};
    ///
    /// let mut test = ChangeTest::new(1.0, 100.0)?;
    /// assert_eq!(test.update(f64::NAN), None);
    /// assert_eq!([0; 3].map(|_| test.update(-3.0))[1], Some(Change::Decrease));
    /// # Ok::<(), overact::online::Error>(())
    /// ```
    pub fn update(&mut self, normalised: T) -> Option<Change> {
        if !normalised.is_finite() {
            return None;
        }
        let e = normalised.max(-self.largest).min(self.largest);
        self.above = (self.above + e - self.reference).max(T::ZERO);
        self.below = (self.below - e - self.reference).max(T::ZERO);
        let change = if self.above > self.threshold {
            Change::Increase
        } else if self.below > self.threshold {
            Change::Decrease
        } else {
            return None;
        };
        self.reset();
        Some(change)
    }

    /// Sets both sums to zero.
    ///
    /// ```
    /// use overact::online::ChangeTest;
    ///
    /// let mut test = ChangeTest::new(1.0, 1e5)?;
    /// test.update(3.0);
    /// test.reset();
    /// assert_eq!(test, ChangeTest::new(1.0, 1e5)?);
    /// # Ok::<(), overact::online::Error>(())
    /// ```
    pub fn reset(&mut self) {
        self.above = T::ZERO;
        self.below = T::ZERO;
    }
}

/// The threshold h of a reference value k and a mean number of samples between false alarms.
///
/// With x = 2 k b, eˣ - x - 1 = 4 k² n. The left side is convex, so Newton's method from above
/// decreases to the root.
fn threshold(reference: f64, samples: f64) -> f64 {
    let target = 4.0 * reference * reference * samples;
    let mut x = 1.0;
    while math::exp(x) - x - 1.0 < target {
        x *= 2.0;
    }
    for _ in 0..60 {
        let exponential = math::exp(x);
        x -= (exponential - x - 1.0 - target) / (exponential - 1.0);
    }
    (x / (2.0 * reference) - OVERSHOOT).max(0.0)
}
