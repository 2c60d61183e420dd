//! Straight functions compiled once or twice more for the vectors of newer processors, and run so where there are some.
//!
//! A build for any processor of the x86-64 has 16 registers of two numbers, and instructions that overwrite one of their
//! operands. Those of AVX2 have four, and a place of their own for the result; those of AVX-512 are 32. Products and sums
//! stay apart, so that but for what is made of sines and cosines, which have fused ones, the numbers are those of any other
//! processor, to the last bit.

/// Runs a function, whose closure is to be inlined, with the instructions of the processor at hand: in optimised builds
/// with the feature `dispatch`. In others it is just called.
#[inline(always)]
pub fn widest<R>(function: impl FnOnce() -> R) -> R {
    #[cfg(dispatch)]
    if let Some(simd) = pulp::x86::V3::try_new() {
        return simd.vectorize(function);
    }
    function()
}

/// The same with AVX-512 where there is some, whose registers are twice as many: for functions that write hundreds of
/// numbers, of which those of AVX2 hold too few.
#[inline(always)]
pub fn roomiest<R>(function: impl FnOnce() -> R) -> R {
    #[cfg(dispatch)]
    if let Some(simd) = pulp::x86::V4::try_new() {
        return simd.vectorize(function);
    }
    widest(function)
}
