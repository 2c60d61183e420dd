//! From where on a configuration counts as singular.

/// A determinant below this fraction of its magnitude in the home configuration counts as zero.
pub const SINGULAR: f64 = 1e-9;

/// By how much a pose may miss what the legs of a platform that moves aside allow, rad, and in units of the
/// robot's length: what a measured pose is off, and little enough for the model.
pub const CLOSED: f64 = 1e-4;
