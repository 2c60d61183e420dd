//! Sections on residuals and predictions.

pub(crate) mod conditioning;
pub(crate) mod correlation;
pub(crate) mod elimination;
pub(crate) mod friction;
pub(crate) mod inputs;
pub(crate) mod residuals;
pub(crate) mod validation;
