//! Runs code compiled for wide vectors, if the processor has them.

use pulp::NullaryFnOnce;

/// Runs `work`, whose `call` is inlined, with the processor's vector instructions.
///
/// Products and sums are not fused, so the results equal those of other processors.
#[inline]
pub(crate) fn with_avx2<W: NullaryFnOnce>(work: W) -> W::Output {
    #[cfg(target_arch = "x86_64")]
    if let Some(simd) = pulp::x86::V3::try_new() {
        return simd.vectorize(work);
    }
    work.call()
}
