//! Zero-phase filters, decimation and differentiation, with MATLAB's semantics at the ends of a
//! signal.
//!
//! A low-pass is a cascade of second-order sections: at the low cutoff frequencies of a decimation
//! the expanded polynomials lose digits (2e-8 at a factor of 10, 8e-4 at 50), sections do not.
//! [`filtfilt`] runs it forwards and backwards, so that no phase is lost between positions,
//! torques and the columns of the regressor, and the parallel decimation of section 4.1 of the
//! paper introduces no error into the linear relation (40). Long signals pass block by block
//! ([`ZeroPhase`], [`Decimation`]), so memory does not grow with them.

mod cascade;
mod decimation;
mod design;
mod differences;
mod groups;
mod modes;
mod zero_phase;

pub(crate) use cascade::settling;
pub use decimation::{DECIMATION_ORDER, DECIMATION_PADDING, Decimation, Decimator, decimate};
pub use design::{LowPass, Section, butterworth, chebyshev1};
pub(crate) use differences::central_differences;
pub use zero_phase::{ZeroPhase, filtfilt};
