//! Thresholds for singular configurations.

/// A determinant below this fraction of its magnitude in the home configuration counts as zero.
pub const SINGULAR: f64 = 1e-9;

/// Largest closure error of a pose of a platform with parasitic motion, rad and in units of the
/// robot's length.
///
/// It covers the errors of measured poses, and is small enough for the model.
pub const CLOSED: f64 = 1e-4;
