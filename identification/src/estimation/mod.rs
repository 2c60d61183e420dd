//! Estimation of parameters from an observation system.
//!
//! - `base`: base parameters in the symmetric order (42)-(43);
//! - `estimate`: ordinary or weighted least squares with standard deviations (44)-(48);
//! - `correlation`, `fourier`: standard deviations for residuals correlated over time and lines;
//! - `nonzero`: columns that are not zero in a line;
//! - `periodic_variance`: variance of residual sums in periodic motion;
//! - `intervals`: 95 % intervals that allow for correlation and elimination;
//! - `instruments`: instrumental variables and total least squares, which allow for errors of the
//!   columns;
//! - `column_noise`, `position_noise`: effect of position noise on the columns;
//! - `essential`: backward elimination by the paper's rule;
//! - `recommended`: backward elimination as far as the data do not refute it.

pub(crate) mod base;
pub(crate) mod column_noise;
pub(crate) mod correlation;
pub(crate) mod essential;
pub(crate) mod estimate;
mod fourier;
pub(crate) mod instruments;
pub(crate) mod intervals;
pub(crate) mod nonzero;
pub(crate) mod periodic_variance;
mod position_noise;
pub(crate) mod recommended;
