//! Work compiled once more for the wide vectors of newer processors, and run so where there are some.

use pulp::NullaryFnOnce;

/// Runs `work`, whose `call` is inlined, with the instructions of the processor. Products and sums stay apart, so
/// that the numbers are those of any other processor.
#[inline]
pub(crate) fn widest<W: NullaryFnOnce>(work: W) -> W::Output {
    #[cfg(target_arch = "x86_64")]
    if let Some(simd) = pulp::x86::V3::try_new() {
        return simd.vectorize(work);
    }
    work.call()
}
