//! Sines and cosines of several angles at once, as vectorisable loops.
//!
//! The method and its constants are those of [`overact_core::trigonometry`], as in generated code.
//! Results may differ in the last digit on processors with fused multiply-add.

use overact_core::trigonometry::{COSINE, HALF_PI, LARGEST, ROUND, SINE};

/// The bit of the sign.
const SIGN: u64 = 1 << 63;

/// Whether [`sines_and_cosines`] is valid for these angles; false for NaN.
#[inline(always)]
pub(super) fn are_small<const N: usize>(angles: &[f64; N]) -> bool {
    // `&` instead of `&&`: an early exit would save nothing.
    angles
        .iter()
        .fold(true, |all, angle| all & (angle.abs() <= LARGEST))
}

/// Sines and cosines of small angles in radians, within two units in the last place.
///
/// `FUSED`: whether products are added with a single rounding, on processors with such an
/// instruction.
#[inline(always)]
pub(super) fn sines_and_cosines<const N: usize, const FUSED: bool>(
    angles: [f64; N],
) -> ([f64; N], [f64; N]) {
    let (mut sines, mut cosines) = ([0.0; N], [0.0; N]);
    for lane in 0..N {
        (sines[lane], cosines[lane]) = sine_and_cosine::<FUSED>(angles[lane]);
    }
    (sines, cosines)
}

/// a b + c.
#[inline(always)]
fn add<const FUSED: bool>(a: f64, b: f64, c: f64) -> f64 {
    if FUSED { a.mul_add(b, c) } else { a * b + c }
}

#[inline(always)]
fn polynomial<const FUSED: bool>(z: f64, terms: [f64; 6]) -> f64 {
    let mut value = terms[0];
    for term in &terms[1..] {
        value = add::<FUSED>(value, z, *term);
    }
    value
}

#[inline(always)]
fn sine_and_cosine<const FUSED: bool>(x: f64) -> (f64, f64) {
    let shifted = add::<FUSED>(x, std::f64::consts::FRAC_2_PI, ROUND);
    let (n, quadrant) = (shifted - ROUND, shifted.to_bits());
    let reduced = |r: f64, part: f64| add::<FUSED>(n, -part, r);
    let r = HALF_PI.into_iter().fold(x, reduced);
    let z = r * r;
    let sine = add::<FUSED>(r * z, polynomial::<FUSED>(z, SINE), r);
    let cosine = add::<FUSED>(z, polynomial::<FUSED>(z, COSINE), -0.5);
    let cosine = add::<FUSED>(z, cosine, 1.0);
    // Odd quadrants exchange sine and cosine; the second bit of the quadrant, or of the next one,
    // is the sign.
    let (sine, cosine) = if quadrant & 1 == 0 {
        (sine, cosine)
    } else {
        (cosine, sine)
    };
    let sign = quadrant << 62;
    let turned = |x: f64, sign: u64| f64::from_bits(x.to_bits() ^ (sign & SIGN));
    (
        turned(sine, sign),
        turned(cosine, sign.wrapping_add(SIGN >> 1)),
    )
}

#[cfg(test)]
mod tests {
    use super::{LARGEST, are_small, sines_and_cosines};

    /// Distance in units in the last place of `exact`.
    fn ulps(found: f64, exact: f64) -> f64 {
        let ulp = f64::from_bits(exact.abs().to_bits() + 1) - exact.abs();
        (found - exact).abs() / ulp
    }

    #[test]
    fn sines_and_cosines_are_within_two_ulps() {
        assert_near::<false>();
        assert_near::<true>();
    }

    fn assert_near<const FUSED: bool>() {
        let mut worst = 0.0_f64;
        for scale in [1e-8, 1.0, 4.0, 100.0, LARGEST] {
            for k in 0..20_000_u32 {
                let angles: [f64; 8] = std::array::from_fn(|lane| {
                    // A sequence that fills the interval evenly.
                    let part = f64::from(8 * k + lane as u32) * 0.618_033_988_749_894_9;
                    scale * (2.0 * part.fract() - 1.0)
                });
                let (sines, cosines) = sines_and_cosines::<8, FUSED>(angles);
                for (lane, x) in angles.iter().enumerate() {
                    worst = worst.max(ulps(sines[lane], x.sin()));
                    worst = worst.max(ulps(cosines[lane], x.cos()));
                }
            }
        }
        assert!(worst <= 2.0, "{worst} ulps");
    }

    #[test]
    fn large_and_non_finite_angles_are_left_to_the_library() {
        assert!(are_small(&[0.0, -LARGEST, LARGEST]));
        for angle in [1e300, f64::NAN, f64::INFINITY, -2.0 * LARGEST] {
            assert!(!are_small(&[0.5, angle]), "{angle}");
        }
    }
}
