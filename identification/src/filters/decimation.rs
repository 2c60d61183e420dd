//! Parallel decimation, as MATLAB's `decimate` does: an order-8 Chebyshev type I low-pass with
//! 0.05 dB of ripple up to 0.8 f_m/(2 n_d), run forwards and backwards, then one sample in n_d.
//!
//! The last sample is always kept, so the first one kept is number (N - 1) mod n_d. MATLAB filters
//! with polynomials and lowers the order where these lose their digits; sections never need that.

use super::{
    design::{LowPass, chebyshev1},
    zero_phase::{ZeroPhase, filtfilt},
};
use crate::error::{Error, Problem};

/// Order of the Chebyshev low-pass.
pub const DECIMATION_ORDER: usize = 8;

/// Samples that a signal must exceed to be decimated.
pub const DECIMATION_PADDING: usize = 3 * DECIMATION_ORDER;

/// Ripple of the Chebyshev low-pass in its pass band, dB.
const RIPPLE_DB: f64 = 0.05;

/// A decimation by one factor, designed once for all signals.
#[derive(Debug, Clone, PartialEq)]
pub struct Decimator {
    factor: usize,
    filter: Option<LowPass>,
}

impl Decimator {
    /// Designs the low-pass for `factor`; a factor of 1 leaves signals as they are.
    ///
    /// # Errors
    /// A factor of 0.
    pub fn new(factor: usize) -> Result<Self, Error> {
        if factor == 0 {
            return Err(Problem::new("a decimation by 0 is not possible")
                .help("choose 1 to keep every sample")
                .into());
        }
        let filter = if factor == 1 {
            None
        } else {
            Some(chebyshev1(
                DECIMATION_ORDER,
                RIPPLE_DB,
                0.8 / factor as f64,
            )?)
        };
        Ok(Self { factor, filter })
    }

    /// The factor n_d.
    #[must_use]
    pub const fn factor(&self) -> usize {
        self.factor
    }

    /// Number of the first sample that is kept of `samples`.
    #[must_use]
    pub const fn first(&self, samples: usize) -> usize {
        samples.saturating_sub(1) % self.factor
    }

    /// Number of samples that are kept of `samples`.
    #[must_use]
    pub const fn kept(&self, samples: usize) -> usize {
        samples.div_ceil(self.factor)
    }

    /// The decimation of `samples` rows of `width` values that come block by block; none where every
    /// sample is kept as it is.
    ///
    /// # Errors
    /// No more than 24 samples.
    pub fn stream(&self, width: usize, samples: usize) -> Result<Option<ZeroPhase>, Error> {
        let keep = (self.first(samples), self.factor);
        self.filter
            .as_ref()
            .map(|filter| ZeroPhase::new(filter, width, samples, keep))
            .transpose()
    }

    /// Low-passes `signal` and keeps one sample in n_d.
    ///
    /// # Errors
    /// A signal of no more than 24 samples.
    pub fn apply(&self, signal: &[f64]) -> Result<Vec<f64>, Error> {
        let Some(filter) = &self.filter else {
            return Ok(signal.to_vec());
        };
        let filtered = filtfilt(filter, signal)?;
        Ok(filtered
            .into_iter()
            .skip(self.first(signal.len()))
            .step_by(self.factor)
            .collect())
    }
}

/// Decimates one signal by `factor`.
///
/// # Errors
/// A factor of 0, or a signal of no more than 24 samples.
pub fn decimate(signal: &[f64], factor: usize) -> Result<Vec<f64>, Error> {
    Decimator::new(factor)?.apply(signal)
}
