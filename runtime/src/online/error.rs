//! Errors of online estimation, which leave the state unchanged.

use core::fmt;

/// Reason why an online estimator rejects an input or has no estimate.
///
/// ```
/// use overact::online::{Error, Filter};
///
/// let mut filter = Filter::<1>::without_prior();
/// assert_eq!(filter.estimate(), Err(Error::NotDetermined));
/// let rejected = filter.update(&[f64::NAN], 1.0, 0.1);
/// assert_eq!(rejected, Err(Error::NotFinite { input: "row" }));
/// assert_eq!(rejected.unwrap_err().to_string(), "`row` has a number that is not finite");
/// ```
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
#[non_exhaustive]
pub enum Error {
    /// A number of an input is NaN or infinite.
    NotFinite {
        /// The input's name.
        input: &'static str,
    },
    /// A number of an input, divided by its standard deviation, is so large that its square might
    /// overflow.
    OutOfRange {
        /// The input's name.
        input: &'static str,
    },
    /// A standard deviation, frequency, factor or length is not in its range.
    Setting {
        /// The setting's name.
        setting: &'static str,
        /// Condition that it violates.
        condition: &'static str,
    },
    /// The information or covariance of a prior is not positive definite.
    NotPositiveDefinite,
    /// The rows so far do not determine all parameters, and there is no prior.
    NotDetermined,
    /// A result is too large for a number.
    Overflow,
    /// A slice has the wrong number of elements.
    Length {
        /// Number of elements required.
        expected: usize,
        /// Number of elements given.
        found: usize,
    },
}

impl fmt::Display for Error {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match *self {
            Self::NotFinite { input } => write!(f, "`{input}` has a number that is not finite"),
            Self::OutOfRange { input } => write!(
                f,
                "`{input}` has a number that is too large for its standard deviation"
            ),
            Self::Setting { setting, condition } => write!(f, "`{setting}` must be {condition}"),
            Self::NotPositiveDefinite => write!(
                f,
                "the prior is not positive definite: give each parameter a finite standard deviation, or use no prior"
            ),
            Self::NotDetermined => write!(
                f,
                "the rows so far do not determine all parameters: add rows of other motions, or a prior"
            ),
            Self::Overflow => write!(f, "a value is too large for a number"),
            Self::Length { expected, found } => {
                write!(f, "expected {expected} numbers, found {found}")
            }
        }
    }
}

impl core::error::Error for Error {}
