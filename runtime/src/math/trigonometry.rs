//! Sines and cosines of all angles of a function.
//!
//! The method and its constants are those of [`overact_core::trigonometry`]. Builds that are
//! optimised for speed compute in vector registers, others one by one; the build script decides.

use super::sin_cos;
use overact_core::trigonometry::LARGEST;

/// Sines and cosines of angles in radians, within 1.6 units in the last place up to 100 rad.
///
/// The error is 2.3 units up to 10⁵ rad. Larger angles, NaN and single angles use the standard
/// library (or `libm` without the feature `std`).
#[inline(always)]
#[must_use]
pub fn sin_cos_all<const N: usize>(angles: [f64; N]) -> [(f64, f64); N] {
    if N < 2 || !are_small(&angles) {
        return one_by_one(angles);
    }
    #[cfg(vectors)]
    {
        super::vectors::sin_cos_all(&angles)
    }
    #[cfg(not(vectors))]
    {
        super::plain::sin_cos_all(&angles)
    }
}

/// Whether all angles are small enough to be reduced.
#[inline(always)]
pub(super) fn are_small<const N: usize>(angles: &[f64; N]) -> bool {
    // One comparison for all: `&` instead of `&&`, because an early exit would save nothing.
    let mut small = true;
    let mut at = 0;
    while at < N {
        small &= angles[at].abs() <= LARGEST;
        at += 1;
    }
    small
}

/// Sines and cosines by the library, kept out of line.
#[cold]
#[inline(never)]
fn one_by_one<const N: usize>(angles: [f64; N]) -> [(f64, f64); N] {
    angles.map(sin_cos)
}

#[cfg(test)]
mod tests {
    use super::super::{plain, vectors};
    use super::{LARGEST, sin_cos_all};

    /// Distance in units in the last place of `exact`.
    fn ulps(found: f64, exact: f64) -> f64 {
        let ulp = f64::from_bits(exact.abs().to_bits() + 1) - exact.abs();
        (found - exact).abs() / ulp
    }

    #[test]
    fn both_forms_are_equal_and_within_two_ulps_of_libm() {
        let mut worst = 0.0_f64;
        for scale in [1e-8, 1.0, 4.0, 100.0, LARGEST] {
            for k in 0..20_000_u32 {
                // A sequence that fills the interval evenly, in all seven lanes.
                let angle = |lane: u32| {
                    let part = f64::from(7 * k + lane) * 0.618_033_988_749_894_9;
                    scale * (2.0 * (part - libm::floor(part)) - 1.0)
                };
                let angles: [f64; 7] = core::array::from_fn(|i| angle(i as u32));
                assert_eq!(plain::sin_cos_all(&angles), vectors::sin_cos_all(&angles));
                #[cfg(all(feature = "dispatch", target_arch = "x86_64"))]
                if let Some(found) = super::super::detected::sin_cos_all(&angles) {
                    for (&x, (sine, cosine)) in angles.iter().zip(found) {
                        let (s, c) = libm::sincos(x);
                        worst = worst.max(ulps(sine, s)).max(ulps(cosine, c));
                    }
                }
                for (&x, (sine, cosine)) in angles.iter().zip(sin_cos_all(angles)) {
                    let (s, c) = libm::sincos(x);
                    worst = worst.max(ulps(sine, s)).max(ulps(cosine, c));
                }
            }
        }
        // The error of libm itself is below one unit.
        assert!(worst <= 2.0, "{worst} ulps");
    }

    #[test]
    fn errors_against_128_bits_are_within_the_stated_ulps() {
        use astro_float_num::{BigFloat, Consts, RoundingMode};
        let mut constants = Consts::new().expect("memory");
        // Error of a double, without rounding the exact value first.
        let off = |found: f64, exact: &BigFloat| {
            let found_exactly = BigFloat::from_f64(found, 128);
            let difference = found_exactly.sub(exact, 128, RoundingMode::ToEven);
            let ulp = f64::from_bits(found.abs().to_bits() + 1) - found.abs();
            let size = difference.abs().to_string().parse::<f64>();
            size.expect("a number") / ulp
        };
        for (scale, allowed) in [(0.7, 1.2), (4.0, 1.6), (100.0, 1.6), (LARGEST, 2.3)] {
            let mut worst = 0.0_f64;
            for k in 0..4_000_u32 {
                let part = f64::from(k) * 0.618_033_988_749_894_9;
                let angle = scale * (2.0 * (part - libm::floor(part)) - 1.0);
                let [(sine, cosine), _] = plain::sin_cos_all(&[angle, 0.0]);
                let exact = BigFloat::from_f64(angle, 128);
                let s = exact.sin(128, RoundingMode::ToEven, &mut constants);
                let c = exact.cos(128, RoundingMode::ToEven, &mut constants);
                worst = worst.max(off(sine, &s)).max(off(cosine, &c));
            }
            assert!(worst <= allowed, "up to {scale} rad: {worst} ulps");
        }
    }

    #[test]
    fn multiples_of_a_quarter_turn_keep_their_precision() {
        for n in -60_000_i32..60_000 {
            let x = f64::from(n) * core::f64::consts::FRAC_PI_2;
            let [(sine, cosine), _] = sin_cos_all([x, 0.0]);
            let (s, c) = libm::sincos(x);
            let close = ulps(sine, s) <= 2.0 && ulps(cosine, c) <= 2.0;
            assert!(close, "{n}: {sine} {s}, {cosine} {c}");
        }
    }

    #[test]
    fn large_and_non_finite_angles_use_the_library() {
        let found = sin_cos_all([1e300, 0.5, f64::NAN, f64::INFINITY, -0.0]);
        assert_eq!(found[0], super::super::sin_cos(1e300));
        assert!(found[2].0.is_nan() && found[3].1.is_nan());
        assert_eq!(found[1], super::super::sin_cos(0.5));
        assert_eq!(sin_cos_all([-0.0, 0.0])[0], (0.0, 1.0));
    }
}
