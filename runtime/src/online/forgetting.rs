//! How old information loses weight.

use super::Error;
use crate::float::Float;

/// Rule by which old information loses weight before a new row is added.
///
/// Let Λ = RᵀR be the information and w a row over its standard deviation σ.
///
/// | rule | information before the row is added |
/// |---|---|
/// | none | Λ |
/// | exponential | λ Λ |
/// | directional | Λ - (1 - λ) Λ w wᵀ Λ / (wᵀ Λ w) |
///
/// Exponential forgetting loses the information about parameters that the motion does not excite.
/// The directional rule is that of Cao and Schwartz (*Automatica* 36, 2000, 1725-1731): only
/// information along the row's direction loses weight. Kulhavý and Kárný (IFAC World Congress 1984)
/// introduced this restriction.
///
/// With either rule, diagonal entries of R do not fall below those of the prior. Without prior, they
/// stay above √ε of their column. So standard deviations cannot grow without bound. What is added
/// for that purpose does not change the estimate.
///
/// ```
/// use overact::online::{Filter, Forgetting};
///
/// let prior = Filter::<2>::from_standard_deviations(&[0.0, 0.0], &[10.0, 10.0])?;
/// let after = |forgetting| {
///     let mut filter = prior.with_forgetting(forgetting)?;
///     filter.update(&[0.0, 1.0], 2.0, 0.1)?;
///     for _ in 0..1000 {
///         filter.update(&[1.0, 0.0], 3.0, 0.1)?;
///     }
///     filter.standard_deviations()
/// };
/// // Nothing excites the second parameter after the first row.
/// assert!(after(Forgetting::Exponential(0.99))?[1] > 9.9);
/// assert!(after(Forgetting::Directional(0.99))?[1] < 0.11);
/// # Ok::<(), overact::online::Error>(())
/// ```
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub enum Forgetting<T = f64> {
    /// All rows have the same weight: the estimate is that of batch least squares.
    #[default]
    None,
    /// All information is multiplied by this factor λ in (0, 1], once per row or block.
    Exponential(T),
    /// Information along each row's direction is multiplied by this factor λ in (0, 1].
    Directional(T),
}

impl<T: Float> Forgetting<T> {
    /// The factor that makes the weight of a row fall to 1/e after a number of updates: 1 - 1/n.
    ///
    /// ```
    /// use overact::online::Forgetting;
    ///
    /// assert_eq!(Forgetting::<f64>::factor_of_memory(500.0), 0.998);
    /// ```
    #[must_use]
    pub fn factor_of_memory(updates: T) -> T {
        T::of(1.0) - T::of(1.0) / updates.max(T::of(1.0) + T::of(1e-3))
    }

    /// Checks the factor.
    pub(super) fn check(self) -> Result<Self, Error> {
        let factor = match self {
            Self::None => return Ok(self),
            Self::Exponential(factor) | Self::Directional(factor) => factor,
        };
        if factor > T::ZERO && factor <= T::of(1.0) {
            Ok(self)
        } else {
            Err(Error::Setting {
                setting: "forgetting",
                condition: "a factor above 0 and at most 1",
            })
        }
    }
}
