//! Legs that are alike, side by side: as many numbers at once as a vector of the processor holds, one of each leg.
//!
//! A function that works on more legs than a vector has lanes does so in turns, the last of which begins as much earlier as
//! is needed to be full: what it computes once more is the same. Where there are fewer, the lanes that are left have the
//! last leg once more. In builds that are not optimised, where vectors are slower than numbers, there is one lane.

mod chosen;
#[cfg(dispatch)]
mod detected;
mod guards;
mod number;
mod operators;
mod side_by_side;
mod vector;

pub use chosen::{few, four, many};
pub use guards::{Failed, closed, leg, reach, size};
pub use number::{atan2, sign, signed, sin_cos, sin_cos_all, sqrt};
pub use side_by_side::SideBySide;
pub use vector::{Few, Many, Vector};

/// A number of each of as many legs as a vector has lanes.
#[derive(Debug, Clone, Copy)]
pub struct Lanes<V>(V);

impl<V: Vector> Lanes<V> {
    /// The same number of every leg.
    #[inline(always)]
    #[must_use]
    pub fn all(proof: V::Proof, number: f64) -> Self {
        Self(V::all(proof, number))
    }
}

/// What is a number of each leg: one of each, or the same one of all.
pub trait OfLegs<V: Vector> {
    /// The number of each.
    fn of_legs(self, proof: V::Proof) -> V;
}

impl<V: Vector> OfLegs<V> for Lanes<V> {
    #[inline(always)]
    fn of_legs(self, _: V::Proof) -> V {
        self.0
    }
}

impl<V: Vector> OfLegs<V> for f64 {
    #[inline(always)]
    fn of_legs(self, proof: V::Proof) -> V {
        V::all(proof, self)
    }
}

/// A turn of a function of `LEGS` legs: which of them are in its lanes.
#[derive(Debug, Clone, Copy)]
pub struct Turn<V: Vector, const LEGS: usize>(usize, V::Proof);

impl<V: Vector, const LEGS: usize> Turn<V, LEGS> {
    /// The leg in a lane.
    #[inline(always)]
    fn leg(self, lane: usize) -> usize {
        let leg = self.0 + lane;
        // Turns of more legs than lanes are full.
        if LEGS < V::WIDTH {
            leg.min(LEGS - 1)
        } else {
            leg
        }
    }
}

/// The turns in which `LEGS` legs are gone through, as many at once as vectors have lanes.
#[inline(always)]
pub fn places<V: Vector, const LEGS: usize>(
    proof: V::Proof,
) -> impl Iterator<Item = Turn<V, LEGS>> {
    const { assert!(LEGS > 0, "no legs") };
    let last = LEGS.saturating_sub(V::WIDTH);
    let turn = move |turn: usize| Turn((turn * V::WIDTH).min(last), proof);
    (0..LEGS.div_ceil(V::WIDTH)).map(turn)
}

/// The numbers of the legs of a turn, of a row that has those of all legs.
#[inline(always)]
#[must_use]
pub fn row<V: Vector, const LEGS: usize>(numbers: &[f64; LEGS], at: Turn<V, LEGS>) -> Lanes<V> {
    if LEGS >= V::WIDTH {
        let own = numbers.get(at.0..);
        let found = own.and_then(|own| V::first_of(at.1, own));
        return Lanes(found.unwrap_or_else(|| V::all(at.1, 0.0)));
    }
    scattered(numbers, [0, 1], at)
}

/// The elements of an array that belong to the legs of a turn, `COUNT` to each leg.
#[inline(always)]
#[must_use]
pub fn elements<const COUNT: usize, const LENGTH: usize, V: Vector, const LEGS: usize>(
    array: &[f64; LENGTH],
    at: Turn<V, LEGS>,
) -> [Lanes<V>; COUNT] {
    core::array::from_fn(|element| scattered(array, [element, COUNT], at))
}

/// An element of each of the legs of a turn, of an array that has the first leg's at `first` and those of the others at
/// distances of `stride`.
#[inline(always)]
#[must_use]
pub fn scattered<const LENGTH: usize, V: Vector, const LEGS: usize>(
    array: &[f64; LENGTH],
    [first, stride]: [usize; 2],
    at: Turn<V, LEGS>,
) -> Lanes<V> {
    let of_lane = |lane: usize| array.get(first + at.leg(lane) * stride).copied();
    Lanes(V::of(at.1, |lane| of_lane(lane).unwrap_or(0.0)))
}

/// An element of each of the legs of a turn, as [`scattered`], of an array in which only the first `count` legs have one;
/// zero for the others.
#[inline(always)]
#[must_use]
pub fn scattered_of_first<const LENGTH: usize, V: Vector, const LEGS: usize>(
    array: &[f64; LENGTH],
    [first, stride]: [usize; 2],
    count: usize,
    at: Turn<V, LEGS>,
) -> Lanes<V> {
    let of_leg = |leg: usize| match leg < count {
        true => array.get(first + leg * stride).copied(),
        false => None,
    };
    Lanes(V::of(at.1, |lane| of_leg(at.leg(lane)).unwrap_or(0.0)))
}

/// The sum over all legs: halves are added until one number is left, whatever the number of lanes.
#[inline(always)]
#[must_use]
pub fn sum<const LEGS: usize>(of_legs: &[f64; LEGS]) -> f64 {
    let mut sums = *of_legs;
    let mut length = LEGS;
    while length > 1 {
        let half = length.next_power_of_two() / 2;
        let (kept, added) = sums.split_at_mut(half);
        for (kept, added) in kept.iter_mut().zip(added.iter().take(length - half)) {
            *kept += *added;
        }
        length = half;
    }
    sums.first().copied().unwrap_or(0.0)
}

/// Writes a column of each of the legs of a turn into a row, as [`put`], in which only the first `count` legs have one.
#[inline(always)]
pub fn put_of_first<const COLUMNS: usize, V: Vector, const LEGS: usize>(
    row: &mut [f64; COLUMNS],
    [first, stride]: [usize; 2],
    count: usize,
    at: Turn<V, LEGS>,
    value: impl OfLegs<V>,
) {
    let numbers = value.of_legs(at.1);
    for lane in 0..V::WIDTH.min(LEGS) {
        let leg = at.0 + lane;
        if leg >= count {
            return;
        }
        if let Some(place) = row.get_mut(first + leg * stride) {
            *place = numbers.lane(lane);
        }
    }
}

/// Writes a column of each of the legs of a turn into a row: that of the first of all legs is `first`, and from one
/// leg's to the next one's there are `stride`.
#[inline(always)]
pub fn put<const COLUMNS: usize, V: Vector, const LEGS: usize>(
    row: &mut [f64; COLUMNS],
    [first, stride]: [usize; 2],
    at: Turn<V, LEGS>,
    value: impl OfLegs<V>,
) {
    let numbers = value.of_legs(at.1);
    if stride == 1 && LEGS >= V::WIDTH {
        if let Some(place) = row.get_mut(first + at.0..) {
            numbers.put(place);
        }
        return;
    }
    for lane in 0..V::WIDTH.min(LEGS) {
        if let Some(place) = row.get_mut(first + (at.0 + lane) * stride) {
            *place = numbers.lane(lane);
        }
    }
}
