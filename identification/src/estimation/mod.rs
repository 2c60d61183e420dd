//! Parameters from an observation system.
//!
//! - `base`: base parameters in the symmetric order (42)-(43);
//! - `estimate`: ordinary or weighted least squares with standard deviations (44)-(48);
//! - `correlation`, `fourier`: deviations under residuals that are correlated over time and lines;
//! - `returning`: how far sums stray by what returns with the motion;
//! - `intervals`: 95 % intervals that admit all of that and what was cancelled;
//! - `instruments`, `total_least_squares`: estimates that allow for errors of the columns;
//! - `column_noise`, `position_noise`: directions of the columns that only noise of the positions separates;
//! - `essential`: backward elimination of parameters that the data do not determine;
//! - `recommended`: the same as far as a test of the data goes.

pub(crate) mod base;
pub(crate) mod column_noise;
pub(crate) mod correlation;
pub(crate) mod essential;
pub(crate) mod estimate;
mod fourier;
pub(crate) mod instruments;
pub(crate) mod intervals;
mod position_noise;
pub(crate) mod recommended;
pub(crate) mod returning;
pub(crate) mod total_least_squares;
