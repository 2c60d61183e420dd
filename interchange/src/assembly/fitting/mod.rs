//! Changes closures and geometry within the tolerance, so that loops move as intended.

pub(crate) mod dimensions;
pub(crate) mod pins;
pub(crate) mod redundant;
pub(crate) mod translating;
