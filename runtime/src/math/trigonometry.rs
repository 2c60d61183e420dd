//! Sines and cosines of several angles at once, in vector registers.
//!
//! The method and its numbers are those of [`overact_core::trigonometry`]. Without a branch, four angles
//! cost little more than one.

use super::sin_cos;
use overact_core::trigonometry::{COSINE, HALF_PI, LARGEST, ROUND, SINE};
use wide::{f64x2, f64x4, u64x2, u64x4};

/// Whether the target computes with several numbers at once.
const HAS_VECTORS: bool = cfg!(any(
    target_arch = "x86_64",
    target_arch = "aarch64",
    target_feature = "sse2",
    target_feature = "simd128"
));

/// Sines and cosines of angles in radians, within two units in the last place.
///
/// Angles beyond 10⁵ rad and those that are no numbers take the standard library's functions (`libm`'s
/// without the feature `std`), as all angles do on a target without vector registers.
#[inline(always)]
#[must_use]
pub fn sin_cos_all<const N: usize>(angles: [f64; N]) -> [(f64, f64); N] {
    // One comparison for all: `&` rather than `&&`, for there is nothing to gain from an early end.
    let small = angles.iter().fold(true, |ok, a| ok & (a.abs() <= LARGEST));
    if !HAS_VECTORS || N < 2 || !small {
        return one_by_one(angles);
    }
    let mut pairs = [(0.0, 0.0); N];
    let mut at = 0;
    // Three angles left over take the time of four.
    while at + 2 < N {
        let (sines, cosines) = four(&core::array::from_fn(|i| lane(&angles, at + i)));
        let found = pairs[at..].iter_mut().zip(sines.iter().zip(&cosines));
        found.for_each(|(pair, (&sine, &cosine))| *pair = (sine, cosine));
        at += 4;
    }
    if at < N {
        let (sines, cosines) = two(&core::array::from_fn(|i| lane(&angles, at + i)));
        let found = pairs[at..].iter_mut().zip(sines.iter().zip(&cosines));
        found.for_each(|(pair, (&sine, &cosine))| *pair = (sine, cosine));
    }
    pairs
}

/// Sines and cosines by the library, out of the way of what is usual.
#[cold]
#[inline(never)]
fn one_by_one<const N: usize>(angles: [f64; N]) -> [(f64, f64); N] {
    angles.map(sin_cos)
}

/// An angle, or zero beyond the last.
#[inline(always)]
fn lane<const N: usize>(angles: &[f64; N], at: usize) -> f64 {
    if at < N { angles[at] } else { 0.0 }
}

/// A function of as many angles as a vector holds.
macro_rules! sines_and_cosines {
    ($name:ident, $lanes:literal, $float:ident, $bits:ident) => {
        #[doc = concat!("Sines and cosines of ", $lanes, " angles up to [`LARGEST`].")]
        #[inline(always)]
        fn $name(angles: &[f64; $lanes]) -> ([f64; $lanes], [f64; $lanes]) {
            let all = $float::splat;
            let bits = |x: $float| $bits::new(x.to_array().map(f64::to_bits));
            let floats = |x: $bits| x.to_array().map(f64::from_bits);
            let polynomial = |z: $float, terms: &[f64; 6]| {
                let [first, rest @ ..] = terms;
                rest.iter().fold(all(*first), |p, &c| p.mul_add(z, all(c)))
            };
            let x = $float::new(*angles);
            let shifted = x.mul_add(all(core::f64::consts::FRAC_2_PI), all(ROUND));
            let (n, quadrant) = (shifted - all(ROUND), bits(shifted));
            let parts = HALF_PI.iter();
            let r = parts.fold(x, |r, &part| n.mul_neg_add(all(part), r));
            let z = r * r;
            let sine = (r * z).mul_add(polynomial(z, &SINE), r);
            let cosine = z.mul_add(all(-0.5), all(1.0));
            let cosine = (z * z).mul_add(polynomial(z, &COSINE), cosine);
            let (one, two) = ($bits::splat(1), $bits::splat(2));
            let (sine, cosine) = (bits(sine), bits(cosine));
            // Odd quadrants exchange sine and cosine.
            let exchange = (sine ^ cosine) & ($bits::splat(0) - (quadrant & one));
            let turned = |x: $bits| (x & two) << 62_u64;
            let sine = (sine ^ exchange) ^ turned(quadrant);
            let cosine = (cosine ^ exchange) ^ turned(quadrant + one);
            (floats(sine), floats(cosine))
        }
    };
}

sines_and_cosines!(two, 2, f64x2, u64x2);
sines_and_cosines!(four, 4, f64x4, u64x4);

#[cfg(test)]
mod tests {
    use super::{LARGEST, sin_cos_all};

    /// Distance in units in the last place of `exact`.
    fn ulps(found: f64, exact: f64) -> f64 {
        let ulp = f64::from_bits(exact.abs().to_bits() + 1) - exact.abs();
        (found - exact).abs() / ulp
    }

    #[test]
    fn all_lanes_are_within_two_ulps_of_libm() {
        let mut worst = 0.0_f64;
        for scale in [1e-8, 1.0, 4.0, 100.0, LARGEST] {
            for k in 0..20_000_u32 {
                // A sequence that fills the interval evenly, in all seven lanes.
                let angle = |lane: u32| {
                    let part = f64::from(7 * k + lane) * 0.618_033_988_749_894_9;
                    scale * (2.0 * (part - libm::floor(part)) - 1.0)
                };
                let angles: [f64; 7] = core::array::from_fn(|i| angle(i as u32));
                for (&x, (sine, cosine)) in angles.iter().zip(sin_cos_all(angles)) {
                    let (s, c) = libm::sincos(x);
                    worst = worst.max(ulps(sine, s)).max(ulps(cosine, c));
                }
            }
        }
        // libm is itself within one unit of the truth.
        assert!(worst <= 2.0, "{worst} ulps");
    }

    #[test]
    fn multiples_of_a_quarter_turn_lose_no_digits() {
        for n in -60_000_i32..60_000 {
            let x = f64::from(n) * core::f64::consts::FRAC_PI_2;
            let [(sine, cosine), _] = sin_cos_all([x, 0.0]);
            let (s, c) = libm::sincos(x);
            let close = ulps(sine, s) <= 2.0 && ulps(cosine, c) <= 2.0;
            assert!(close, "{n}: {sine} {s}, {cosine} {c}");
        }
    }

    #[test]
    fn large_angles_and_those_that_are_no_numbers_are_the_library_s() {
        let found = sin_cos_all([1e300, 0.5, f64::NAN, f64::INFINITY, -0.0]);
        assert_eq!(found[0], super::super::sin_cos(1e300));
        assert!(found[2].0.is_nan() && found[3].1.is_nan());
        assert_eq!(found[1], super::super::sin_cos(0.5));
        assert_eq!(sin_cos_all([-0.0, 0.0])[0], (0.0, 1.0));
    }
}
