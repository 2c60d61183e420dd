//! Functions of lanes; each applies that of [`math`] to every lane.

use super::{Lanes, OfLegs, Turn, Vector};
use crate::math;

/// Square root.
#[inline(always)]
#[must_use]
pub fn sqrt<V: Vector>(square: Lanes<V>) -> Lanes<V> {
    Lanes(square.0.root())
}

/// Sign of a velocity: -1, 0 or 1.
#[inline(always)]
#[must_use]
pub fn sign<V: Vector>(velocity: Lanes<V>) -> Lanes<V> {
    Lanes(velocity.0.sign())
}

/// A value with the sign of a velocity, for the legs of a batch.
#[inline(always)]
#[must_use]
pub fn signed<V: Vector, const LEGS: usize>(
    value: impl OfLegs<V>,
    velocity: impl OfLegs<V>,
    at: Turn<V, LEGS>,
) -> Lanes<V> {
    Lanes(value.of_legs(at.1) * velocity.of_legs(at.1).sign())
}

/// The angle of the direction (x, y), for the legs of a batch.
#[inline(always)]
#[must_use]
pub fn atan2<V: Vector, const LEGS: usize>(
    y: impl OfLegs<V>,
    x: impl OfLegs<V>,
    at: Turn<V, LEGS>,
) -> Lanes<V> {
    let (y, x) = (y.of_legs(at.1), x.of_legs(at.1));
    Lanes(V::of(at.1, |lane| math::atan2(y.lane(lane), x.lane(lane))))
}

/// Sine and cosine of an angle.
#[inline(always)]
#[must_use]
pub fn sin_cos<V: Vector>(angle: Lanes<V>) -> (Lanes<V>, Lanes<V>) {
    let [pair] = sin_cos_all([angle]);
    pair
}

/// Sines and cosines of angles.
#[inline(always)]
#[must_use]
pub fn sin_cos_all<V: Vector, const N: usize>(angles: [Lanes<V>; N]) -> [(Lanes<V>, Lanes<V>); N] {
    V::sin_cos_all(angles.map(|angle| angle.0)).map(|(sine, cosine)| (Lanes(sine), Lanes(cosine)))
}
