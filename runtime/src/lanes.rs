//! Legs that are alike, side by side: as many numbers at once as a vector of the processor holds, one of each leg.
//!
//! A function that works on more legs than a vector has lanes does so in turns, the last of which begins as much earlier as
//! is needed to be full: what it computes once more is the same. Where there are fewer, the lanes that are left have the
//! last leg once more. In builds that are not optimised, where vectors are slower than numbers, there is one lane.

mod guards;
mod number;
mod operators;

pub use guards::{closed, leg, reach};
pub use number::{atan2, sign, signed, sin_cos, sin_cos_all, sqrt};

#[cfg(vectors)]
mod vector {
    #[cfg(target_feature = "avx512f")]
    mod widest {
        pub(in super::super) type Vector = wide::f64x8;
        /// How many legs run side by side.
        pub const WIDTH: usize = 8;
    }
    #[cfg(all(target_feature = "avx", not(target_feature = "avx512f")))]
    mod widest {
        pub(in super::super) type Vector = wide::f64x4;
        /// How many legs run side by side.
        pub const WIDTH: usize = 4;
    }
    #[cfg(not(target_feature = "avx"))]
    mod widest {
        pub(in super::super) type Vector = wide::f64x2;
        /// How many legs run side by side.
        pub const WIDTH: usize = 2;
    }
    pub(super) use widest::Vector;
    pub use widest::WIDTH;
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

/// A turn of a function of `LEGS` legs: which of them are in its lanes.
#[derive(Debug, Clone, Copy)]
pub struct Turn<const LEGS: usize>(usize);

/// Which legs are in the lanes.
pub trait Legs: Copy {
    /// The leg in a lane.
    fn leg(self, lane: usize) -> usize;
}

impl<const LEGS: usize> Legs for Turn<LEGS> {
    #[inline(always)]
    fn leg(self, lane: usize) -> usize {
        let leg = self.0 + lane;
        // Turns of more legs than lanes are full.
        if LEGS < WIDTH { leg.min(LEGS - 1) } else { leg }
    }
}

/// The turns in which `LEGS` legs are gone through.
#[inline(always)]
pub fn places<const LEGS: usize>() -> impl Iterator<Item = Turn<LEGS>> {
    const { assert!(LEGS > 0, "no legs") };
    (0..LEGS.div_ceil(WIDTH)).map(|turn| Turn((turn * WIDTH).min(LEGS.saturating_sub(WIDTH))))
}

/// The numbers of the legs of a turn.
#[inline(always)]
fn load<const LEGS: usize>(numbers: &[f64; LEGS], at: Turn<LEGS>) -> Lanes {
    if LEGS >= WIDTH {
        let rest = numbers.get(at.0..);
        let found = rest.and_then(|rest| rest.first_chunk::<WIDTH>());
        return found.map_or_else(|| Lanes::all(0.0), |numbers| Lanes::of(*numbers));
    }
    let of_lane = |lane: usize| numbers.get(at.leg(lane)).copied();
    Lanes::of(core::array::from_fn(|lane| of_lane(lane).unwrap_or(0.0)))
}

/// Constants of the legs of a turn: each row has those of all legs.
#[inline(always)]
#[must_use]
pub fn constants<const COUNT: usize, const LEGS: usize>(
    of_legs: &[[f64; LEGS]; COUNT],
    at: Turn<LEGS>,
) -> [Lanes; COUNT] {
    of_legs.each_ref().map(|of_leg| load(of_leg, at))
}

/// The elements of an array that belong to the legs of a turn, `COUNT` to each leg.
#[inline(always)]
#[must_use]
pub fn elements<const COUNT: usize>(array: &[f64], at: impl Legs) -> [Lanes; COUNT] {
    core::array::from_fn(|element| {
        let of_lane = |lane: usize| array.get(at.leg(lane) * COUNT + element).copied();
        Lanes::of(core::array::from_fn(|lane| of_lane(lane).unwrap_or(0.0)))
    })
}

/// Writes a column of each of the legs of a turn into a row: that of the first of all legs is `first`, and from one
/// leg's to the next one's there are `stride`.
#[inline(always)]
pub fn put<const COLUMNS: usize, const LEGS: usize>(
    row: &mut [f64; COLUMNS],
    [first, stride]: [usize; 2],
    at: Turn<LEGS>,
    value: impl Into<Lanes>,
) {
    let numbers = value.into().to_array();
    if stride == 1 && LEGS >= WIDTH {
        let place = row.get_mut(first + at.0..);
        if let Some(place) = place.and_then(|rest| rest.first_chunk_mut::<WIDTH>()) {
            *place = numbers;
        }
        return;
    }
    for (lane, number) in numbers.into_iter().enumerate() {
        let is_own = LEGS >= WIDTH || lane < LEGS;
        let place = row.get_mut(first + (at.0 + lane) * stride);
        if let Some(place) = place.filter(|_| is_own) {
            *place = number;
        }
    }
}
