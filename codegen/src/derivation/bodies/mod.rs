//! Bodies of legs and on the platform: motion, inertia, and the wrench of each standard parameter.

pub(crate) mod body;
pub(crate) mod inertia;
pub(crate) mod motion;
pub(crate) mod payload;
pub(crate) mod platform_body;
