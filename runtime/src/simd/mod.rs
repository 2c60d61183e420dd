//! Equal legs in SIMD lanes: one number of each leg in each lane of a vector.
//!
//! With more legs than lanes a function works in batches. The last batch starts earlier, so that it
//! is full; repeated results are equal. With fewer legs the remaining lanes repeat the last leg.
//! Builds without optimisation, in which vectors are slower than scalars, have one lane.

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
pub use vector::{Narrow, Vector, Wide};

/// One number for each of as many legs as a vector has lanes.
#[derive(Debug, Clone, Copy)]
pub struct Lanes<V>(V);

impl<V: Vector> Lanes<V> {
    /// The same number for every leg.
    #[inline(always)]
    #[must_use]
    pub fn all(proof: V::Proof, number: f64) -> Self {
        Self(V::all(proof, number))
    }
}

/// A number for each leg: individual ones, or a common one.
pub trait OfLegs<V: Vector> {
    /// The number of each leg.
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

/// A batch of a function of `LEGS` legs: the legs in its lanes.
#[derive(Debug, Clone, Copy)]
pub struct Turn<V: Vector, const LEGS: usize>(usize, V::Proof);

impl<V: Vector, const LEGS: usize> Turn<V, LEGS> {
    /// The leg in a lane.
    #[inline(always)]
    fn leg(self, lane: usize) -> usize {
        let leg = self.0 + lane;
        // Batches of functions with more legs than lanes are full.
        if LEGS < V::WIDTH {
            leg.min(LEGS - 1)
        } else {
            leg
        }
    }
}

/// The batches of `LEGS` legs, with as many legs as vectors have lanes.
#[inline(always)]
pub fn places<V: Vector, const LEGS: usize>(
    proof: V::Proof,
) -> impl Iterator<Item = Turn<V, LEGS>> {
    const { assert!(LEGS > 0, "no legs") };
    let last = LEGS.saturating_sub(V::WIDTH);
    let turn = move |turn: usize| Turn((turn * V::WIDTH).min(last), proof);
    (0..LEGS.div_ceil(V::WIDTH)).map(turn)
}

/// The numbers of a batch's legs, from a row with those of all legs.
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

/// The elements of an array that belong to the legs of a batch, `COUNT` for each leg.
#[inline(always)]
#[must_use]
pub fn elements<const COUNT: usize, const LENGTH: usize, V: Vector, const LEGS: usize>(
    array: &[f64; LENGTH],
    at: Turn<V, LEGS>,
) -> [Lanes<V>; COUNT] {
    core::array::from_fn(|element| scattered(array, [element, COUNT], at))
}

/// One element for each leg of a batch, from an array with a stride.
///
/// The first leg's element is at `first`, those of the others at distances of `stride`.
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

/// Like [`scattered`], for an array in which only the first `count` legs have an element; zero for
/// the others.
#[inline(always)]
#[must_use]
pub fn scattered_of_first<const LENGTH: usize, V: Vector, const LEGS: usize>(
    array: &[f64; LENGTH],
    [first, stride]: [usize; 2],
    count: usize,
    at: Turn<V, LEGS>,
) -> Lanes<V> {
    let of_leg = |leg: usize| {
        if leg < count {
            array.get(first + leg * stride).copied()
        } else {
            None
        }
    };
    Lanes(V::of(at.1, |lane| of_leg(at.leg(lane)).unwrap_or(0.0)))
}

/// The sum over all legs by repeated halving, independent of the number of lanes.
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

/// Writes a column of each leg of a batch into a row, like [`put`]; only the first `count` legs
/// have one.
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

/// Writes a column of each leg of a batch into a row.
///
/// The column of the first of all legs is `first`; those of successive legs are `stride` apart.
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
