//! Difference of a measurement from its prediction.

use crate::float::Float;

/// Difference of a measurement from the prediction by all rows before it.
///
/// The residual y - w χ has the variance σ² (1 + w Λ⁻¹ wᵀ) with w over σ. Givens rotations give
/// both without solving for χ: what remains of the right side is the normalised residual, and the
/// product of the cosines is σ over the standard deviation.
///
/// ```
/// use overact::online::Filter;
///
/// let mut filter = Filter::<1>::from_standard_deviations(&[1.0], &[3.0])?;
/// let innovation = filter.update(&[1.0], 6.0, 4.0)?;
/// assert!(innovation.is_determined);
/// assert!((innovation.residual - 5.0_f64).abs() < 1e-12);
/// assert!((innovation.standard_deviation - 5.0_f64).abs() < 1e-12);
/// assert!((innovation.normalised - 1.0_f64).abs() < 1e-12);
/// # Ok::<(), overact::online::Error>(())
/// ```
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Innovation<T = f64> {
    /// y - w χ, in the unit of y.
    pub residual: T,
    /// Its standard deviation, in the unit of y, from σ and the covariance of χ.
    pub standard_deviation: T,
    /// The residual over its standard deviation: standard normal if model and σ are right.
    pub normalised: T,
    /// Whether the rows before determine a prediction. If not, the other numbers are zero.
    pub is_determined: bool,
}

impl<T: Float> Innovation<T> {
    /// The innovation of a row whose prediction the rows before do not determine.
    pub(super) const fn undetermined() -> Self {
        Self {
            residual: T::ZERO,
            standard_deviation: T::ZERO,
            normalised: T::ZERO,
            is_determined: false,
        }
    }
}

impl<T: Float> Default for Innovation<T> {
    fn default() -> Self {
        Self::undetermined()
    }
}
