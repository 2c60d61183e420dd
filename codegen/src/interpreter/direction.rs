//! Angles of directions, atan2(y, x), of several samples at once, as vectorisable loops.
//!
//! The ratio of the smaller to the larger of |x| and |y| is the tangent of an angle of at most π/4.
//! Angles above π/8 are reduced by π/4. The arc tangent of the rest is the rational function of
//! Cephes (S. L. Moshier). Multiples of π/4 are added back in two parts.

use std::f64::consts::{FRAC_PI_2, FRAC_PI_4, PI};

/// π minus the double nearest to it.
const REST: f64 = 1.224_646_799_147_353_2e-16;

/// tan π/8.
const TANGENT: f64 = 0.414_213_562_373_095_03;

/// Rational approximation of (atan t - t) / t³ in t², the highest power first.
const NUMERATOR: [f64; 5] = [
    -0.875_060_860_003_190_4,
    -16.157_537_187_333_652,
    -75.008_557_923_147_05,
    -122.886_668_449_013_61,
    -64.850_219_049_420_25,
];
const DENOMINATOR: [f64; 6] = [
    1.0,
    24.858_464_901_423_062,
    165.027_009_831_698_85,
    432.881_060_491_290_27,
    485.390_399_635_913_7,
    194.550_657_148_261_4,
];

/// Bounds of the larger of |x| and |y| between which neither overflow nor underflow occurs.
const LEAST: f64 = 1e-150;
const MOST: f64 = 1e150;

/// Whether [`angles`] is valid for these directions; false for NaN and for zero vectors.
#[inline(always)]
pub(super) fn are_usual<const N: usize>(y: &[f64; N], x: &[f64; N]) -> bool {
    let mut usual = true;
    for lane in 0..N {
        // `&` instead of `&&`: an early exit would save nothing.
        let (a, b) = (y[lane].abs(), x[lane].abs());
        usual &= (a <= MOST) & (b <= MOST) & ((a >= LEAST) | (b >= LEAST));
    }
    usual
}

/// Angles of usual directions, within three units in the last place.
///
/// `FUSED`: whether products are added with a single rounding.
#[inline(always)]
pub(super) fn angles<const N: usize, const FUSED: bool>(y: [f64; N], x: [f64; N]) -> [f64; N] {
    let mut found = [0.0; N];
    for lane in 0..N {
        found[lane] = angle::<FUSED>(y[lane], x[lane]);
    }
    found
}

#[inline(always)]
fn polynomial<const FUSED: bool, const N: usize>(z: f64, terms: [f64; N]) -> f64 {
    let mut value = terms[0];
    for term in &terms[1..] {
        value = if FUSED {
            value.mul_add(z, *term)
        } else {
            value * z + *term
        };
    }
    value
}

#[inline(always)]
fn angle<const FUSED: bool>(y: f64, x: f64) -> f64 {
    let (a, b) = (y.abs(), x.abs());
    let steep = a > b;
    let (small, large) = if steep { (b, a) } else { (a, b) };
    let beyond = small > TANGENT * large;
    let above = if beyond { small - large } else { small };
    let below = if beyond { small + large } else { large };
    let t = above / below;
    let z = t * t;
    let quotient = polynomial::<FUSED, 5>(z, NUMERATOR) / polynomial::<FUSED, 6>(z, DENOMINATOR);
    let own = t + t * z * quotient;
    let (base, rest) = if beyond {
        (FRAC_PI_4, 0.25 * REST)
    } else {
        (0.0, 0.0)
    };
    // The angle from the other axis, then from the other side.
    let base = if steep { FRAC_PI_2 - base } else { base };
    let rest = if steep { 0.5 * REST - rest } else { rest };
    let own = if steep { -own } else { own };
    let left = x < 0.0;
    let base = if left { PI - base } else { base };
    let rest = if left { REST - rest } else { rest };
    let own = if left { -own } else { own };
    (base + (own + rest)).copysign(y)
}

#[cfg(test)]
mod tests {
    use super::{angles, are_usual};

    /// Largest difference from the library's angles, in units in the last place.
    fn worst<const FUSED: bool>() -> f64 {
        let mut worst = 0.0_f64;
        for scale in [1e-9, 1e-3, 0.1, 1.0] {
            for k in 0..20_000_u32 {
                let sample = |lane: usize| {
                    // A low-discrepancy sequence on the circle, or on a part of it around each
                    // axis.
                    let part = f64::from(8 * k + lane as u32) * 0.618_033_988_749_894_9;
                    let quarter = f64::from(k % 4) * std::f64::consts::FRAC_PI_2;
                    let angle = quarter + scale * std::f64::consts::PI * (2.0 * part.fract() - 1.0);
                    let length = 10.0_f64.powi(k as i32 % 13 - 6);
                    (length * angle.sin(), length * angle.cos())
                };
                let (y, x): ([f64; 8], [f64; 8]) = (
                    std::array::from_fn(|lane| sample(lane).0),
                    std::array::from_fn(|lane| sample(lane).1),
                );
                assert!(are_usual(&y, &x));
                for (lane, found) in angles::<8, FUSED>(y, x).into_iter().enumerate() {
                    let exact = y[lane].atan2(x[lane]);
                    let ulp = f64::from_bits(exact.abs().to_bits() + 1) - exact.abs();
                    worst = worst.max((found - exact).abs() / ulp);
                }
            }
        }
        worst
    }

    #[test]
    fn angles_are_within_three_ulps() {
        for worst in [worst::<false>(), worst::<true>()] {
            assert!(worst <= 3.0, "{worst} ulps");
        }
    }

    #[test]
    fn atan2_is_exact_on_axes_and_diagonals() {
        let y = [0.0, 1.0, 0.0, -1.0, 2.0, -2.0, -0.0, -0.0];
        let x = [1.0, 0.0, -1.0, 0.0, 2.0, -2.0, 1.0, -1.0];
        for (lane, found) in angles::<8, false>(y, x).into_iter().enumerate() {
            assert_eq!(found.to_bits(), y[lane].atan2(x[lane]).to_bits(), "{lane}");
        }
    }

    #[test]
    fn degenerate_directions_are_left_to_the_library() {
        assert!(are_usual(&[0.0, -1.0], &[1e-100, 0.0]));
        for (y, x) in [
            (0.0, 0.0),
            (f64::NAN, 1.0),
            (1.0, f64::NAN),
            (f64::INFINITY, 1.0),
            (1.0, 1e300),
            (1e-300, 1e-300),
        ] {
            assert!(!are_usual(&[1.0, y], &[1.0, x]), "{y}, {x}");
        }
    }
}
