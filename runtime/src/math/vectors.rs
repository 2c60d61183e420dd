//! Sines and cosines of several angles at once, in vector registers.
//!
//! The method and its constants are those of [`overact_core::trigonometry`]. Without branches, four
//! angles cost little more than one, if each operation compiles to one instruction. So this module
//! is used in optimised builds only, and `plain.rs` in others.

use overact_core::trigonometry::{COSINE, HALF_PI, ROUND, SINE};
use wide::{f64x2, f64x4, u64x2, u64x4};

/// Sines and cosines of angles up to [`LARGEST`](overact_core::trigonometry::LARGEST).
#[inline(always)]
pub(super) fn sin_cos_all<const N: usize>(angles: &[f64; N]) -> [(f64, f64); N] {
    let mut pairs = [(0.0, 0.0); N];
    let mut at = 0;
    // Three remaining angles take the time of four.
    while at + 2 < N {
        let (sines, cosines) = four(&core::array::from_fn(|i| lane(angles, at + i)));
        let found = pairs[at..].iter_mut().zip(sines.iter().zip(&cosines));
        found.for_each(|(pair, (&sine, &cosine))| *pair = (sine, cosine));
        at += 4;
    }
    if at < N {
        let (sines, cosines) = two(&core::array::from_fn(|i| lane(angles, at + i)));
        let found = pairs[at..].iter_mut().zip(sines.iter().zip(&cosines));
        found.for_each(|(pair, (&sine, &cosine))| *pair = (sine, cosine));
    }
    pairs
}

/// An angle, or zero after the last.
#[inline(always)]
fn lane<const N: usize>(angles: &[f64; N], at: usize) -> f64 {
    if at < N { angles[at] } else { 0.0 }
}

/// Defines a function of as many angles as a vector has lanes.
macro_rules! sines_and_cosines {
    ($name:ident, $lanes:literal, $float:ident, $bits:ident) => {
        #[doc = concat!("Sines and cosines of ", $lanes, " angles up to those that are reduced.")]
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
