//! The functions of [`math`](super) for functions that are compiled for wider vectors, too: sines and cosines take these
//! where the processor has them. A short function would lose more by asking for them than it gains.

pub use super::{atan2, sign, signed, sin_cos, sqrt};

/// Sines and cosines of angles in radians, as [`sin_cos_all`](super::sin_cos_all), which has the errors.
#[inline(always)]
#[must_use]
pub fn sin_cos_all<const N: usize>(angles: [f64; N]) -> [(f64, f64); N] {
    #[cfg(dispatch)]
    if N > 1
        && super::trigonometry::are_small(&angles)
        && let Some(pairs) = super::detected::sin_cos_all(&angles)
    {
        return pairs;
    }
    super::sin_cos_all(angles)
}
