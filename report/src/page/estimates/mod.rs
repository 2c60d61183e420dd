//! Sections on estimated parameters.

pub(crate) mod consistent;
pub(crate) mod estimators;
pub(crate) mod limits;
pub(crate) mod motors;
pub(crate) mod online;
pub(crate) mod parameters;
