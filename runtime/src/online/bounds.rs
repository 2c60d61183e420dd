//! Bounds of magnitudes by precision, which prevent overflow and underflow of squares.

use super::Error;
use crate::float::Float;

/// Chooses a bound by the precision of `T`.
#[inline]
fn by_precision<T: Float>(double: f64, single: f64) -> T {
    T::of(if size_of::<T>() == size_of::<f64>() {
        double
    } else {
        single
    })
}

/// Largest magnitude of a weighted number, y/σ or w/σ.
///
/// Rounding stops the growth of R at √(2/ε) times this: a smaller number no longer changes the
/// root of a sum of squares. So squares of R do not overflow.
#[inline]
pub(super) fn largest<T: Float>() -> T {
    by_precision(1e100, 1e9)
}

/// Smallest magnitude that a rotation eliminates: its square is a normal number.
#[inline]
pub(super) fn smallest<T: Float>() -> T {
    by_precision(1e-150, 2e-19)
}

/// Smallest diagonal entry of R, relative to its column, at which R counts as regular.
#[inline]
pub(super) fn regular<T: Float>() -> T {
    by_precision(1.5e-14, 8e-6)
}

/// Smallest diagonal entry of R, relative to its column, that forgetting may leave: √ε.
#[inline]
pub(super) fn remembered<T: Float>() -> T {
    by_precision(1.5e-8, 3.5e-4)
}

/// Smallest diagonal entry of R that forgetting may leave.
#[inline]
pub(super) fn faintest<T: Float>() -> T {
    by_precision(1e-60, 1e-12)
}

/// Checks that numbers divided by a standard deviation are finite and in range.
///
/// # Errors
/// [`Error::NotFinite`] or [`Error::OutOfRange`] with the input's name.
pub(super) fn check<T: Float>(input: &'static str, numbers: &[T], weight: T) -> Result<(), Error> {
    let limit = largest::<T>();
    // The comparison fails for NaN too.
    if numbers
        .iter()
        .all(|number| (*number * weight).abs() <= limit)
    {
        return Ok(());
    }
    if numbers.iter().all(|number| number.is_finite()) {
        Err(Error::OutOfRange { input })
    } else {
        Err(Error::NotFinite { input })
    }
}

/// 1/σ of a standard deviation.
///
/// # Errors
/// One that is not positive and finite, or too small to divide by.
pub(super) fn weight<T: Float>(sigma: T) -> Result<T, Error> {
    let weight = T::of(1.0) / sigma;
    if sigma > T::ZERO && weight > T::ZERO && weight.is_finite() {
        Ok(weight)
    } else {
        Err(Error::Setting {
            setting: "sigma",
            condition: "positive and finite",
        })
    }
}
