//! Legs that are alike, side by side: as many numbers at once as a vector of the processor holds, one of each leg.
//!
//! A function that works on more legs than a vector has lanes does so in turns, the last of which begins as much earlier as
//! is needed to be full: what it computes once more is the same. In builds that are not optimised, where
//! vectors are slower than numbers, there is one lane.

mod guards;
mod number;
mod operators;

pub use guards::{closed, leg, reach};
pub use number::{atan2, sign, signed, sin_cos, sin_cos_all, sqrt};

#[cfg(vectors)]
mod vector {
    #[cfg(target_feature = "avx")]
    pub(super) type Vector = wide::f64x4;
    #[cfg(not(target_feature = "avx"))]
    pub(super) type Vector = wide::f64x2;
    /// How many legs run side by side.
    #[cfg(target_feature = "avx")]
    pub const WIDTH: usize = 4;
    /// How many legs run side by side.
    #[cfg(not(target_feature = "avx"))]
    pub const WIDTH: usize = 2;
}
#[cfg(not(vectors))]
mod vector {
    /// How many legs run side by side.
    pub const WIDTH: usize = 1;
    pub(super) type Vector = f64;
}

use vector::Vector;
pub use vector::WIDTH;

/// A number of each of [`WIDTH`] legs.
#[derive(Debug, Clone, Copy)]
pub struct Lanes(Vector);

#[cfg(vectors)]
impl Lanes {
    /// The numbers of the legs.
    #[inline(always)]
    #[must_use]
    pub fn of(numbers: [f64; WIDTH]) -> Self {
        Self(Vector::new(numbers))
    }

    /// The number of each leg.
    #[inline(always)]
    #[must_use]
    pub fn to_array(self) -> [f64; WIDTH] {
        self.0.to_array()
    }

    /// The same number of every leg.
    #[inline(always)]
    #[must_use]
    pub fn all(number: f64) -> Self {
        Self(Vector::splat(number))
    }
}

#[cfg(not(vectors))]
impl Lanes {
    /// The numbers of the legs.
    #[inline(always)]
    #[must_use]
    pub const fn of(numbers: [f64; WIDTH]) -> Self {
        Self(numbers[0])
    }

    /// The number of each leg.
    #[inline(always)]
    #[must_use]
    pub const fn to_array(self) -> [f64; WIDTH] {
        [self.0]
    }

    /// The same number of every leg.
    #[inline(always)]
    #[must_use]
    pub const fn all(number: f64) -> Self {
        Self(number)
    }
}

impl From<f64> for Lanes {
    #[inline(always)]
    fn from(number: f64) -> Self {
        Self::all(number)
    }
}

/// The first leg of each turn, of `LEGS` of them: at least as many as a vector has lanes.
#[inline(always)]
pub fn places<const LEGS: usize>() -> impl Iterator<Item = usize> {
    const { assert!(LEGS >= WIDTH, "fewer legs than lanes") };
    (0..LEGS.div_ceil(WIDTH)).map(|turn| (turn * WIDTH).min(LEGS - WIDTH))
}

/// The numbers of the legs from `at` on, zero beyond the last.
#[inline(always)]
fn load(numbers: &[f64], at: usize) -> Lanes {
    let found = numbers
        .get(at..)
        .and_then(|rest| rest.first_chunk::<WIDTH>());
    found.map_or_else(|| Lanes::all(0.0), |numbers| Lanes::of(*numbers))
}

/// Constants of the legs from `at` on: each row has those of all legs.
#[inline(always)]
#[must_use]
pub fn constants<const COUNT: usize, const LEGS: usize>(
    of_legs: &[[f64; LEGS]; COUNT],
    at: usize,
) -> [Lanes; COUNT] {
    of_legs.each_ref().map(|of_leg| load(of_leg, at))
}

/// The elements of an array that belong to the legs from `at` on, `COUNT` to each leg.
#[inline(always)]
#[must_use]
pub fn elements<const COUNT: usize>(array: &[f64], at: usize) -> [Lanes; COUNT] {
    core::array::from_fn(|element| {
        let of_lane = |lane: usize| array.get((at + lane) * COUNT + element).copied();
        Lanes::of(core::array::from_fn(|lane| of_lane(lane).unwrap_or(0.0)))
    })
}

/// Writes a column of each of the legs from `at` on into a row: that of the first of all legs is `first`, and from one
/// leg's to the next one's there are `stride`.
#[inline(always)]
pub fn put<const COLUMNS: usize>(
    row: &mut [f64; COLUMNS],
    [first, stride]: [usize; 2],
    at: usize,
    value: impl Into<Lanes>,
) {
    let numbers = value.into().to_array();
    if stride == 1 {
        let place = row.get_mut(first + at..);
        if let Some(place) = place.and_then(|rest| rest.first_chunk_mut::<WIDTH>()) {
            *place = numbers;
        }
        return;
    }
    for (lane, number) in numbers.into_iter().enumerate() {
        if let Some(place) = row.get_mut(first + (at + lane) * stride) {
            *place = number;
        }
    }
}
