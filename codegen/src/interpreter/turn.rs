//! Transposition of 4 × 4 blocks: four numbers at four samples.
//!
//! Moving single numbers between rows and contiguous values would take longer than computing them.
//! So blocks are transposed in vector registers, if the processor has them.

/// Size of a block.
pub(super) const SIDE: usize = 4;

/// A number at four samples, or four numbers at one.
type Side = [f64; SIDE];

/// The four sides of a block; an array would go through memory.
type Turned = (Side, Side, Side, Side);

/// An implementation of the transposition.
pub(super) trait Turn: Copy {
    /// Transposes a block.
    fn turn(self, a: Side, b: Side, c: Side, d: Side) -> Turned;
}

/// Element by element.
#[derive(Debug, Clone, Copy)]
pub(super) struct Plain;

impl Turn for Plain {
    #[inline(always)]
    fn turn(self, a: Side, b: Side, c: Side, d: Side) -> Turned {
        let row = |k: usize| [a[k], b[k], c[k], d[k]];
        (row(0), row(1), row(2), row(3))
    }
}

/// With AVX: merges halves of columns, then interleaves pairs of numbers.
#[cfg(target_arch = "x86_64")]
impl Turn for pulp::x86::V3 {
    #[inline(always)]
    fn turn(self, a: Side, b: Side, c: Side, d: Side) -> Turned {
        let avx = &self.avx;
        let (a, b) = (pulp::cast(a), pulp::cast(b));
        let (c, d) = (pulp::cast(c), pulp::cast(d));
        let (ac, bd) = (
            avx._mm256_permute2f128_pd::<0x20>(a, c),
            avx._mm256_permute2f128_pd::<0x20>(b, d),
        );
        let (ca, db) = (
            avx._mm256_permute2f128_pd::<0x31>(a, c),
            avx._mm256_permute2f128_pd::<0x31>(b, d),
        );
        (
            pulp::cast(avx._mm256_unpacklo_pd(ac, bd)),
            pulp::cast(avx._mm256_unpackhi_pd(ac, bd)),
            pulp::cast(avx._mm256_unpacklo_pd(ca, db)),
            pulp::cast(avx._mm256_unpackhi_pd(ca, db)),
        )
    }
}
