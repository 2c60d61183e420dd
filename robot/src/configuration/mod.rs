//! Tables of the description as settings, prior and scales of an identification.

pub(crate) mod prior;
pub(crate) mod scales;
pub(crate) mod settings;
