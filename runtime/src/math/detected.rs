//! Sines and cosines of several angles at once in AVX2 vectors, in a build for any x86-64.
//!
//! The method and its constants are those of [`overact_core::trigonometry`], with fused
//! multiply-add, which reduces the latency for code that waits for sines.

use overact_core::trigonometry::{COSINE, HALF_PI, ROUND, SINE};
use pulp::x86::V3;
use pulp::{Simd as _, bytemuck, f64x4, u64x4};

/// Sines and cosines of angles up to [`LARGEST`](overact_core::trigonometry::LARGEST), if the
/// processor has AVX2.
#[inline(always)]
pub(super) fn sin_cos_all<const N: usize>(angles: &[f64; N]) -> Option<[(f64, f64); N]> {
    let simd = V3::try_new()?;
    Some(simd.vectorize(
        #[inline(always)]
        || all_of(simd, angles),
    ))
}

/// Loops, because closures and iterators are separate functions that are not compiled for such
/// vectors.
#[inline(always)]
fn all_of<const N: usize>(simd: V3, angles: &[f64; N]) -> [(f64, f64); N] {
    let mut pairs = [(0.0, 0.0); N];
    let mut at = 0;
    while at < N {
        let mut own = [0.0; 4];
        let mut lane = 0;
        while lane < 4 && at + lane < N {
            own[lane] = angles[at + lane];
            lane += 1;
        }
        let (sines, cosines) = four(simd, own);
        lane = 0;
        while lane < 4 && at + lane < N {
            pairs[at + lane] = (sines[lane], cosines[lane]);
            lane += 1;
        }
        at += 4;
    }
    pairs
}

/// a b + c.
#[inline(always)]
fn sum(simd: V3, a: f64x4, b: f64, c: f64x4) -> f64x4 {
    simd.mul_add_f64s(a, simd.splat_f64s(b), c)
}

#[inline(always)]
fn polynomial(simd: V3, z: f64x4, terms: &[f64; 6]) -> f64x4 {
    let mut value = simd.splat_f64s(terms[0]);
    let mut at = 1;
    while at < terms.len() {
        value = simd.mul_add_f64s(value, z, simd.splat_f64s(terms[at]));
        at += 1;
    }
    value
}

#[inline(always)]
fn bits(numbers: f64x4) -> u64x4 {
    bytemuck::cast(numbers)
}

/// The sign of an angle's quadrant, as a bit.
#[inline(always)]
fn turned(simd: V3, quadrant: u64x4) -> u64x4 {
    simd.shl_const_u64x4::<62>(simd.and_u64s(quadrant, simd.splat_u64s(2)))
}

#[inline(always)]
fn four(simd: V3, angles: [f64; 4]) -> ([f64; 4], [f64; 4]) {
    let x: f64x4 = bytemuck::cast(angles);
    let round = simd.splat_f64s(ROUND);
    let shifted = sum(simd, x, core::f64::consts::FRAC_2_PI, round);
    let (n, quadrant) = (simd.sub_f64s(shifted, round), bits(shifted));
    let mut r = x;
    let mut at = 0;
    while at < HALF_PI.len() {
        r = simd.negate_mul_add_f64x4(n, simd.splat_f64s(HALF_PI[at]), r);
        at += 1;
    }
    let z = simd.mul_f64s(r, r);
    let (cubed, fourth) = (simd.mul_f64s(r, z), simd.mul_f64s(z, z));
    let sine = bits(simd.mul_add_f64s(cubed, polynomial(simd, z, &SINE), r));
    let first = sum(simd, z, -0.5, simd.splat_f64s(1.0));
    let cosine = bits(simd.mul_add_f64s(fourth, polynomial(simd, z, &COSINE), first));
    let one = simd.splat_u64s(1);
    // Odd quadrants exchange sine and cosine.
    let odd = simd.sub_u64s(simd.splat_u64s(0), simd.and_u64s(quadrant, one));
    let exchange = simd.and_u64s(simd.xor_u64s(sine, cosine), odd);
    let sine = simd.xor_u64s(simd.xor_u64s(sine, exchange), turned(simd, quadrant));
    let next = simd.add_u64s(quadrant, one);
    let cosine = simd.xor_u64s(simd.xor_u64s(cosine, exchange), turned(simd, next));
    (bytemuck::cast(sine), bytemuck::cast(cosine))
}
