//! Vectors of numbers by width.

use crate::math;
use core::ops::{Add, Div, Mul, Neg, Sub};

/// A register of numbers, one for each leg.
pub trait Vector:
    Copy
    + Add<Output = Self>
    + Sub<Output = Self>
    + Mul<Output = Self>
    + Div<Output = Self>
    + Neg<Output = Self>
{
    /// Proof that the processor has such vectors; empty if the build requires them.
    type Proof: Copy;

    /// Number of lanes.
    const WIDTH: usize;

    /// The proof that such a vector exists.
    fn proof(self) -> Self::Proof;

    /// The same number in every lane.
    fn all(proof: Self::Proof, number: f64) -> Self;

    /// A vector from a function of the lane.
    fn of(proof: Self::Proof, number: impl FnMut(usize) -> f64) -> Self;

    /// The first numbers of a slice, if there are enough.
    fn first_of(proof: Self::Proof, numbers: &[f64]) -> Option<Self>;

    /// Writes all numbers to the front of a slice, if there is room for them.
    fn put(self, numbers: &mut [f64]);

    /// The number of a lane.
    fn lane(&self, lane: usize) -> f64;

    /// Whether a condition holds in all lanes.
    fn every(&self, holds: impl FnMut(f64) -> bool) -> bool;

    /// The square roots.
    #[must_use]
    fn root(self) -> Self;

    /// -1, 0 or 1 in each lane.
    #[must_use]
    fn sign(self) -> Self;

    /// Sines and cosines of angles.
    fn sin_cos_all<const N: usize>(angles: [Self; N]) -> [(Self, Self); N];
}

/// One number, for builds without vectors and without optimisation.
impl Vector for f64 {
    type Proof = ();
    const WIDTH: usize = 1;

    #[inline(always)]
    fn proof(self) {}

    #[inline(always)]
    fn all((): (), number: f64) -> Self {
        number
    }

    #[inline(always)]
    fn of((): (), mut number: impl FnMut(usize) -> f64) -> Self {
        number(0)
    }

    #[inline(always)]
    fn first_of((): (), numbers: &[f64]) -> Option<Self> {
        numbers.first().copied()
    }

    #[inline(always)]
    fn put(self, numbers: &mut [f64]) {
        if let Some(first) = numbers.first_mut() {
            *first = self;
        }
    }

    #[inline(always)]
    fn lane(&self, _: usize) -> f64 {
        *self
    }

    #[inline(always)]
    fn every(&self, mut holds: impl FnMut(f64) -> bool) -> bool {
        holds(*self)
    }

    #[inline(always)]
    fn root(self) -> Self {
        math::sqrt(self)
    }

    #[inline(always)]
    fn sign(self) -> Self {
        math::sign(self)
    }

    #[inline(always)]
    fn sin_cos_all<const N: usize>(angles: [Self; N]) -> [(Self, Self); N] {
        math::sin_cos_all(angles)
    }
}

#[cfg(vectors)]
macro_rules! vector {
    ($vector:ident, $width:literal) => {
        impl Vector for wide::$vector {
            type Proof = ();
            const WIDTH: usize = $width;

            #[inline(always)]
            fn proof(self) {}

            #[inline(always)]
            fn all((): (), number: f64) -> Self {
                Self::splat(number)
            }

            #[inline(always)]
            fn of((): (), number: impl FnMut(usize) -> f64) -> Self {
                Self::new(core::array::from_fn(number))
            }

            #[inline(always)]
            fn first_of((): (), numbers: &[f64]) -> Option<Self> {
                numbers.first_chunk::<$width>().map(|all| Self::new(*all))
            }

            #[inline(always)]
            fn put(self, numbers: &mut [f64]) {
                if let Some(place) = numbers.first_chunk_mut::<$width>() {
                    *place = self.to_array();
                }
            }

            #[inline(always)]
            fn lane(&self, lane: usize) -> f64 {
                self.to_array().get(lane).copied().unwrap_or_default()
            }

            #[inline(always)]
            fn every(&self, holds: impl FnMut(f64) -> bool) -> bool {
                self.to_array().into_iter().all(holds)
            }

            #[inline(always)]
            fn root(self) -> Self {
                self.sqrt()
            }

            #[inline(always)]
            fn sign(self) -> Self {
                let (zero, one) = (Self::splat(0.0), Self::splat(1.0));
                (self.simd_gt(zero) & one) - (self.simd_lt(zero) & one)
            }

            #[inline(always)]
            fn sin_cos_all<const N: usize>(angles: [Self; N]) -> [(Self, Self); N] {
                angles.map(|angle| {
                    let pairs: [(f64, f64); $width] = math::sin_cos_all(angle.to_array());
                    let sines = Self::new(pairs.map(|pair| pair.0));
                    (sines, Self::new(pairs.map(|pair| pair.1)))
                })
            }
        }
    };
}

#[cfg(all(vectors, not(target_feature = "avx")))]
vector!(f64x2, 2);
#[cfg(all(vectors, target_feature = "avx"))]
vector!(f64x4, 4);
#[cfg(all(vectors, target_feature = "avx512f"))]
vector!(f64x8, 8);

/// The widest register.
#[cfg(all(vectors, target_feature = "avx512f"))]
pub type Wide = wide::f64x8;
/// At most four numbers.
#[cfg(all(vectors, target_feature = "avx"))]
pub type Narrow = wide::f64x4;
/// At most four numbers.
#[cfg(all(vectors, not(target_feature = "avx")))]
pub type Narrow = wide::f64x2;
/// One number.
#[cfg(not(vectors))]
pub type Narrow = f64;
/// The widest register.
#[cfg(not(all(vectors, target_feature = "avx512f")))]
pub type Wide = Narrow;
