//! Measurements for identifying commands: logs, virtual runs and factor files.

pub(crate) mod dates;
pub(crate) mod factors;
pub(crate) mod payloads;
pub(crate) mod runs;
pub(crate) mod same;
mod streams;
