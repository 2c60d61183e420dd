//! Parameters from an observation system.
//!
//! - `base`: base parameters in the symmetric order (42)-(43);
//! - `estimate`: ordinary or weighted least squares with standard deviations (44)-(48);
//! - `correlation`, `fourier`: deviations under residuals that are correlated over time and lines;
//! - `essential`: backward elimination of parameters that the data do not determine.

pub(crate) mod base;
pub(crate) mod correlation;
pub(crate) mod essential;
pub(crate) mod estimate;
mod fourier;
