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

/// Work whose products and sums may be one operation of the processor, with one rounding.
pub(crate) trait Fused {
    /// Does it; inlined.
    fn run<const FUSED: bool>(self);
}

/// Runs `work` with the widest vectors there are, its products and sums fused where the processor does that.
#[inline]
pub(crate) fn fused<W: Fused>(work: W) {
    #[cfg(target_arch = "x86_64")]
    {
        if let Some(simd) = pulp::x86::V4::try_new() {
            return simd.vectorize(Run(work));
        }
        if let Some(simd) = pulp::x86::V3::try_new() {
            return simd.vectorize(Run(work));
        }
    }
    work.run::<false>();
}

/// Fused work.
#[cfg(target_arch = "x86_64")]
struct Run<W>(W);

#[cfg(target_arch = "x86_64")]
impl<W: Fused> NullaryFnOnce for Run<W> {
    type Output = ();

    #[inline(always)]
    fn call(self) {
        self.0.run::<true>();
    }
}

/// a b + c.
#[inline(always)]
pub(crate) fn product_sum<const FUSED: bool>(a: f64, b: f64, c: f64) -> f64 {
    if FUSED { a.mul_add(b, c) } else { a * b + c }
}
