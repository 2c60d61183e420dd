//! A function whose legs are computed side by side.

use super::Vector;

/// A function whose legs are computed side by side, in vectors that are chosen when it runs.
pub trait SideBySide: Sized {
    /// What it gives.
    type Output;

    /// Computes it in vectors of a kind, which `lanes` shows to be there.
    fn run<V: Vector>(self, lanes: V::Proof) -> Self::Output;
}
