//! From where on a configuration counts as singular.

/// A determinant below this fraction of its magnitude in the home configuration counts as zero.
pub const SINGULAR: f64 = 1e-9;
