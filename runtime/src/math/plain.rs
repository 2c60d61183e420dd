//! Sines and cosines of single angles, fast at every optimisation level.
//!
//! Vector types are fast only if all of their operations are inlined. In builds for size or without
//! optimisation, each operation is a call, and a dozen angles take microseconds. Here the same
//! operations run on scalars without branches, so that all builds give the same digits.

use overact_core::trigonometry::{COSINE, HALF_PI, ROUND, SINE};

/// Sines and cosines of angles up to [`LARGEST`](overact_core::trigonometry::LARGEST).
#[inline]
pub(super) fn sin_cos_all<const N: usize>(angles: &[f64; N]) -> [(f64, f64); N] {
    let mut pairs = [(0.0, 0.0); N];
    // Indices instead of iterators, which are calls without optimisation.
    let mut at = 0;
    while at < N {
        pairs[at] = sine_and_cosine(angles[at]);
        at += 1;
    }
    pairs
}

/// Sine and cosine of one angle.
///
/// It is not inlined. So it is optimised with this package, even if the rest of a build is not, and
/// a function of many angles contains its code once.
#[inline(never)]
fn sine_and_cosine(x: f64) -> (f64, f64) {
    let shifted = product_and_sum(x, core::f64::consts::FRAC_2_PI, ROUND);
    let (n, quadrant) = (shifted - ROUND, shifted.to_bits());
    let r = product_and_sum(-n, HALF_PI[0], x);
    let r = product_and_sum(-n, HALF_PI[1], r);
    let r = product_and_sum(-n, HALF_PI[2], r);
    let z = r * r;
    let sine = product_and_sum(r * z, polynomial(z, SINE), r);
    let cosine = product_and_sum(z, -0.5, 1.0);
    let cosine = product_and_sum(z * z, polynomial(z, COSINE), cosine);
    let (sine, cosine) = (sine.to_bits(), cosine.to_bits());
    // Odd quadrants exchange sine and cosine. The sum cannot overflow: an angle's bits are below
    // it.
    let exchange = (sine ^ cosine) & 0_u64.wrapping_sub(quadrant & 1);
    let sine = (sine ^ exchange) ^ ((quadrant & 2) << 62);
    let cosine = (cosine ^ exchange) ^ ((quadrant.wrapping_add(1) & 2) << 62);
    (f64::from_bits(sine), f64::from_bits(cosine))
}

/// A polynomial of six terms by Horner's rule, the highest power first.
#[inline(always)]
fn polynomial(z: f64, terms: [f64; 6]) -> f64 {
    let [a, b, c, d, e, f] = terms;
    let p = product_and_sum(product_and_sum(a, z, b), z, c);
    product_and_sum(product_and_sum(product_and_sum(p, z, d), z, e), z, f)
}

/// a b + c, with a single rounding on processors with such an instruction, as in vectors.
#[inline(always)]
fn product_and_sum(a: f64, b: f64, c: f64) -> f64 {
    #[cfg(all(feature = "std", target_feature = "fma"))]
    {
        a.mul_add(b, c)
    }
    #[cfg(not(all(feature = "std", target_feature = "fma")))]
    {
        a * b + c
    }
}
