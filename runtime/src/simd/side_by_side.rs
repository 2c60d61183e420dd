//! A function whose legs are computed in SIMD lanes.

use super::Vector;

/// A function whose legs are computed in SIMD lanes, with vectors chosen at run time.
pub trait SideBySide: Sized {
    /// Type of the result.
    type Output;

    /// Runs the function in a type of vectors; `lanes` proves that the processor has them.
    fn run<V: Vector>(self, lanes: V::Proof) -> Self::Output;
}
