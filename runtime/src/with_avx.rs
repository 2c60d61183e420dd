//! Straight functions that are also compiled for the vectors of newer processors, and chosen at run
//! time.
//!
//! A build for any x86-64 has 16 registers of two numbers, and instructions that overwrite an
//! operand. Registers of AVX2 have four numbers, and its instructions have a separate destination;
//! AVX-512 has 32 registers. Products and sums are not fused, so results are identical on all
//! processors, except those of sines and cosines.

/// Runs a function with the instructions of the processor, in optimised builds with the feature
/// `dispatch`.
///
/// The closure has to be inlined. Other builds just call it.
#[inline(always)]
pub fn with_avx2<R>(function: impl FnOnce() -> R) -> R {
    #[cfg(dispatch)]
    if let Some(simd) = pulp::x86::V3::try_new() {
        return simd.vectorize(function);
    }
    function()
}

/// The same with AVX-512 if available, which has twice as many registers.
///
/// It is for functions that write hundreds of numbers, for which AVX2 has too few registers.
#[inline(always)]
pub fn with_avx512<R>(function: impl FnOnce() -> R) -> R {
    #[cfg(dispatch)]
    if let Some(simd) = pulp::x86::V4::try_new() {
        return simd.vectorize(function);
    }
    with_avx2(function)
}
