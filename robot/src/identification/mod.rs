//! Identification of a robot from runs or factors, and uses of its result.

pub(crate) mod corrections;
pub(crate) mod factors;
pub(crate) mod functions_base;
pub(crate) mod identifier;
pub(crate) mod instruments;
pub(crate) mod motors;
pub(crate) mod partitions;
pub(crate) mod runs;
pub(crate) mod standstill;
pub(crate) mod tracking;
