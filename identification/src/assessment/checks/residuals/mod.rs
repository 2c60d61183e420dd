//! Checks of residuals in training and validation runs.

pub(crate) mod held_out;
pub(crate) mod partition;
pub(crate) mod regressor_errors;
pub(crate) mod relative_error;
pub(crate) mod residual_correlation;
