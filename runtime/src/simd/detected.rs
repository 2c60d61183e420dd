//! Vectors of AVX2 and AVX-512 in a build for any x86-64, if the processor has them.

use super::{SideBySide, Vector};
use crate::math;
use core::ops::{Add, Div, Mul, Neg, Sub};
use pulp::x86::{V3, V4};
use pulp::{NullaryFnOnce, Simd, bytemuck, f64x4, f64x8};

/// A function, and the proof that the processor has the vectors.
struct By<W, P>(W, P);

macro_rules! vector {
    ($name:ident, $proof:ident, $vector:ident, $width:literal, $found:ident, $run:ident) => {
        /// A vector with the proof that the processor supports it.
        #[derive(Clone, Copy)]
        pub(super) struct $name($proof, $vector);

        /// The proof that the processor has such vectors, if it has.
        #[inline(always)]
        pub(super) fn $found() -> Option<$proof> {
            $proof::try_new()
        }

        /// Runs a function in such vectors.
        #[inline(always)]
        pub(super) fn $run<W: SideBySide>(work: W, proof: $proof) -> W::Output {
            proof.vectorize(By(work, proof))
        }

        impl<W: SideBySide> NullaryFnOnce for By<W, $proof> {
            type Output = W::Output;

            #[inline(always)]
            fn call(self) -> W::Output {
                self.0.run::<$name>(self.1)
            }
        }

        impl $name {
            #[inline(always)]
            fn numbers(self) -> [f64; $width] {
                bytemuck::cast(self.1)
            }
        }

        vector!(operators $name: Add add add_f64s, Sub sub sub_f64s, Mul mul mul_f64s, Div div div_f64s);

        impl Neg for $name {
            type Output = Self;

            #[inline(always)]
            fn neg(self) -> Self {
                Self(self.0, self.0.neg_f64s(self.1))
            }
        }

        impl Vector for $name {
            type Proof = $proof;
            const WIDTH: usize = $width;

            #[inline(always)]
            fn proof(self) -> $proof {
                self.0
            }

            #[inline(always)]
            fn all(proof: $proof, number: f64) -> Self {
                Self(proof, proof.splat_f64s(number))
            }

            #[inline(always)]
            fn of(proof: $proof, number: impl FnMut(usize) -> f64) -> Self {
                let numbers: [f64; $width] = core::array::from_fn(number);
                Self(proof, bytemuck::cast(numbers))
            }

            #[inline(always)]
            fn first_of(proof: $proof, numbers: &[f64]) -> Option<Self> {
                let first = numbers.first_chunk::<$width>()?;
                Some(Self(proof, bytemuck::cast(*first)))
            }

            #[inline(always)]
            fn put(self, numbers: &mut [f64]) {
                if let Some(place) = numbers.first_chunk_mut::<$width>() {
                    *place = self.numbers();
                }
            }

            #[inline(always)]
            fn lane(&self, lane: usize) -> f64 {
                self.numbers().get(lane).copied().unwrap_or_default()
            }

            #[inline(always)]
            fn every(&self, holds: impl FnMut(f64) -> bool) -> bool {
                self.numbers().into_iter().all(holds)
            }

            #[inline(always)]
            fn root(self) -> Self {
                Self(self.0, self.0.sqrt_f64s(self.1))
            }

            #[inline(always)]
            fn sign(self) -> Self {
                let Self(proof, own) = self;
                let all = |number| proof.splat_f64s(number);
                let (zero, one) = (all(0.0), all(1.0));
                let of = |mask| proof.select_f64s(mask, one, zero);
                let (above, below) = (proof.greater_than_f64s(own, zero), proof.less_than_f64s(own, zero));
                Self(proof, proof.sub_f64s(of(above), of(below)))
            }

            #[inline(always)]
            fn sin_cos_all<const N: usize>(angles: [Self; N]) -> [(Self, Self); N] {
                angles.map(|angle| {
                    let pairs: [(f64, f64); $width] = math::wide::sin_cos_all(angle.numbers());
                    let sines = Self(angle.0, bytemuck::cast(pairs.map(|pair| pair.0)));
                    (sines, Self(angle.0, bytemuck::cast(pairs.map(|pair| pair.1))))
                })
            }
        }
    };
    (operators $name:ident: $($operator:ident $function:ident $own:ident),*) => {$(
        impl $operator for $name {
            type Output = Self;

            #[inline(always)]
            fn $function(self, other: Self) -> Self {
                Self(self.0, self.0.$own(self.1, other.1))
            }
        }
    )*};
}

vector!(Avx2, V3, f64x4, 4, avx2, by_four);
vector!(Avx512, V4, f64x8, 8, avx512, by_eight);
