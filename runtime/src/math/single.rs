//! The functions of [`math`](super) in single precision.
//!
//! On a controller with single precision only, each operation of double precision takes hundreds of
//! instructions, so there are none here.

use overact_core::trigonometry::single::{COSINE, HALF_PI, LARGEST, ROUND, SINE};

/// Sine and cosine of an angle in radians, within 2.5 units in the last place up to 8192 rad.
///
/// Larger angles use the standard library, or `libm` without the feature `std`.
///
/// In four million angles the largest error is 2.34 units, at a reduced angle just above 0.25. Its
/// sine is below 0.25, so the rounding of the angle counts twice: two of the four subtractions of
/// the reduction round. An exactly rounded reduced angle would give 1.54 units; the error of the
/// polynomial is 0.1. Less than 1.5 requires a reduced angle in two parts, and more operations.
#[inline]
#[must_use]
pub fn sin_cos(angle: f32) -> (f32, f32) {
    if angle.abs() <= LARGEST {
        reduced(angle)
    } else {
        library(angle)
    }
}

/// Sines and cosines of angles in radians.
#[inline]
#[must_use]
pub fn sin_cos_all<const N: usize>(angles: [f32; N]) -> [(f32, f32); N] {
    let mut pairs = [(0.0, 0.0); N];
    // Indices instead of iterators, which are calls without optimisation.
    let mut at = 0;
    while at < N {
        pairs[at] = sin_cos(angles[at]);
        at += 1;
    }
    pairs
}

/// Library functions, kept out of line.
#[cold]
#[inline(never)]
fn library(angle: f32) -> (f32, f32) {
    #[cfg(feature = "std")]
    {
        angle.sin_cos()
    }
    #[cfg(all(feature = "libm", not(feature = "std")))]
    {
        libm::sincosf(angle)
    }
}

/// Sine and cosine by the method of [`overact_core::trigonometry`].
///
/// It is not inlined, so that it is optimised with this package even if the rest of a build is not.
#[inline(never)]
fn reduced(x: f32) -> (f32, f32) {
    let shifted = x * core::f32::consts::FRAC_2_PI + ROUND;
    let (n, quadrant) = (shifted - ROUND, shifted.to_bits());
    let [a, b, c, d] = HALF_PI;
    let r = (((x - n * a) - n * b) - n * c) - n * d;
    let z = r * r;
    let sine = r + r * z * polynomial(z, SINE);
    let cosine = (1.0 - 0.5 * z) + z * z * polynomial(z, COSINE);
    // Odd quadrants exchange sine and cosine. The sum cannot overflow: an angle's bits are below it.
    let (sine, cosine) = (sine.to_bits(), cosine.to_bits());
    let exchange = (sine ^ cosine) & 0_u32.wrapping_sub(quadrant & 1);
    let sine = (sine ^ exchange) ^ ((quadrant & 2) << 30);
    let cosine = (cosine ^ exchange) ^ ((quadrant.wrapping_add(1) & 2) << 30);
    (f32::from_bits(sine), f32::from_bits(cosine))
}

#[inline(always)]
fn polynomial(z: f32, terms: [f32; 3]) -> f32 {
    let [a, b, c] = terms;
    (a * z + b) * z + c
}

/// Square root; NaN of a negative number.
#[inline]
#[must_use]
pub fn sqrt(square: f32) -> f32 {
    #[cfg(feature = "std")]
    {
        square.sqrt()
    }
    #[cfg(all(feature = "libm", not(feature = "std")))]
    {
        libm::sqrtf(square)
    }
}

/// The angle in radians of the direction (x, y), in (-π, π].
#[inline]
#[must_use]
pub fn atan2(y: f32, x: f32) -> f32 {
    #[cfg(feature = "std")]
    {
        y.atan2(x)
    }
    #[cfg(all(feature = "libm", not(feature = "std")))]
    {
        libm::atan2f(y, x)
    }
}

/// Sign of a velocity as Coulomb friction wants it: -1, 0 or 1 (0 for NaN).
#[inline]
#[must_use]
pub fn sign(velocity: f32) -> f32 {
    f32::from(u8::from(velocity > 0.0)) - f32::from(u8::from(velocity < 0.0))
}

/// A value with the sign of a velocity; a product, like [`signed`](super::signed).
#[inline]
#[must_use]
pub fn signed(value: f32, velocity: f32) -> f32 {
    value * sign(velocity)
}

/// The angle wrapped to the one nearest to zero.
#[inline]
#[must_use]
pub fn wrap_angle(angle: f32) -> f32 {
    if angle.abs() <= core::f32::consts::PI {
        return angle;
    }
    let (sine, cosine) = sin_cos(angle);
    atan2(sine, cosine)
}

#[cfg(test)]
mod tests {
    use super::{LARGEST, sin_cos, sin_cos_all, wrap_angle};

    /// Distance in units in the last place.
    fn ulps(found: f32, exact: f64) -> f64 {
        let near = exact as f32;
        let ulp = f32::from_bits(near.abs().to_bits() + 1) - near.abs();
        (f64::from(found) - exact).abs() / f64::from(ulp)
    }

    #[test]
    fn errors_are_within_the_stated_ulps() {
        for scale in [0.7, 4.0, 100.0, LARGEST] {
            let mut worst = 0.0_f64;
            for k in 0..200_000_u32 {
                let part = f64::from(k) * 0.618_033_988_749_894_9;
                let angle = scale * (2.0 * (part - libm::floor(part)) - 1.0) as f32;
                let (sine, cosine) = sin_cos(angle);
                let (s, c) = libm::sincos(f64::from(angle));
                worst = worst.max(ulps(sine, s)).max(ulps(cosine, c));
            }
            assert!(worst <= 2.5, "up to {scale} rad: {worst} ulps");
        }
    }

    #[test]
    fn multiples_of_a_quarter_turn_keep_their_precision() {
        for n in -5200_i32..5200 {
            let x = (f64::from(n) * core::f64::consts::FRAC_PI_2) as f32;
            let (sine, cosine) = sin_cos(x);
            let (s, c) = libm::sincos(f64::from(x));
            assert!(
                ulps(sine, s) <= 2.5 && ulps(cosine, c) <= 2.5,
                "{n}: {sine} {s}"
            );
        }
    }

    #[test]
    fn large_and_non_finite_angles_use_the_library() {
        let found = sin_cos_all([1e30, 0.5, f32::NAN, f32::INFINITY, -0.0]);
        assert_eq!(found[0], 1e30_f32.sin_cos());
        assert!(found[2].0.is_nan() && found[3].1.is_nan());
        assert_eq!(found[4], (0.0, 1.0));
        assert!((wrap_angle(7.0) - (7.0 - core::f32::consts::TAU)).abs() < 1e-6);
    }
}
