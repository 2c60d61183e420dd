//! Squares of four numbers at four samples, turned.
//!
//! To move numbers one by one between rows and values that lie side by side would take longer than to
//! compute them, so squares are turned in vector registers where the processor has them.

/// Side of a square.
pub(super) const SIDE: usize = 4;

/// A number at four samples, or four numbers at one.
type Side = [f64; SIDE];

/// Four of them; an array would go through memory.
type Turned = (Side, Side, Side, Side);

/// A way of turning squares.
pub(super) trait Turn: Copy {
    /// Columns become rows.
    fn turn(self, a: Side, b: Side, c: Side, d: Side) -> Turned;
}

/// Number by number.
#[derive(Debug, Clone, Copy)]
pub(super) struct Plain;

impl Turn for Plain {
    #[inline(always)]
    fn turn(self, a: Side, b: Side, c: Side, d: Side) -> Turned {
        let row = |k: usize| [a[k], b[k], c[k], d[k]];
        (row(0), row(1), row(2), row(3))
    }
}

/// With AVX: halves of columns are put together, then pairs of numbers interleaved.
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
