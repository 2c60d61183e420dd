//! Functions of lanes; each is that of [`math`] in every lane.

use super::{Lanes, WIDTH};
use crate::math;

#[cfg(not(vectors))]
fn each(value: impl Into<Lanes>, f: impl Fn(f64) -> f64) -> Lanes {
    Lanes::of(value.into().to_array().map(f))
}

/// Square root.
#[inline(always)]
#[must_use]
pub fn sqrt(square: impl Into<Lanes>) -> Lanes {
    #[cfg(vectors)]
    {
        Lanes(square.into().0.sqrt())
    }
    #[cfg(not(vectors))]
    {
        each(square, math::sqrt)
    }
}

/// Sign of a velocity: -1, 0 or 1.
#[inline(always)]
#[must_use]
pub fn sign(velocity: impl Into<Lanes>) -> Lanes {
    #[cfg(vectors)]
    {
        let velocity = velocity.into();
        let (zero, one) = (Lanes::all(0.0).0, Lanes::all(1.0).0);
        let (positive, negative) = (velocity.0.simd_gt(zero), velocity.0.simd_lt(zero));
        Lanes((positive & one) - (negative & one))
    }
    #[cfg(not(vectors))]
    {
        each(velocity, math::sign)
    }
}

/// A value with the sign of a velocity.
#[inline(always)]
#[must_use]
pub fn signed(value: impl Into<Lanes>, velocity: impl Into<Lanes>) -> Lanes {
    value.into() * sign(velocity)
}

/// The angle of the direction (x, y).
#[inline(always)]
#[must_use]
pub fn atan2(y: impl Into<Lanes>, x: impl Into<Lanes>) -> Lanes {
    let (y, x) = (y.into().to_array(), x.into().to_array());
    Lanes::of(core::array::from_fn(|lane| math::atan2(y[lane], x[lane])))
}

/// Sine and cosine of an angle.
#[inline(always)]
#[must_use]
pub fn sin_cos(angle: impl Into<Lanes>) -> (Lanes, Lanes) {
    let [pair] = sin_cos_all([angle.into()]);
    pair
}

/// Sines and cosines of angles.
#[inline(always)]
#[must_use]
pub fn sin_cos_all<const N: usize>(angles: [Lanes; N]) -> [(Lanes, Lanes); N] {
    angles.map(|angle| {
        let pairs: [(f64, f64); WIDTH] = math::sin_cos_all(angle.to_array());
        (
            Lanes::of(pairs.map(|pair| pair.0)),
            Lanes::of(pairs.map(|pair| pair.1)),
        )
    })
}
