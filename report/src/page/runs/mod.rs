//! Sections on runs: data, trajectories and tracking.

pub(crate) mod data;
pub(crate) mod ranges;
pub(crate) mod tracking;
pub(crate) mod trajectories;
