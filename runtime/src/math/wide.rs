//! The functions of [`math`](super) for functions that are also compiled for wider vectors: sines
//! and cosines use these if the processor has them. In a short function the detection would cost
//! more than it saves.

pub use super::{atan2, sign, signed, sin_cos, sqrt};

/// Sines and cosines of angles in radians, with the accuracy of
/// [`sin_cos_all`](super::sin_cos_all).
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
