//! Floating-point types of robots.

use crate::math::{self, single};
use core::fmt::Debug;
use core::iter::Sum;
use core::ops::{Add, AddAssign, Div, DivAssign, Mul, MulAssign, Neg, Sub, SubAssign};
use overact_core::{Limits, limits};

mod sealed {
    /// Restricts the trait to the types of this crate.
    pub trait Sealed {}
    impl Sealed for f32 {}
    impl Sealed for f64 {}
}

/// Floating-point type of generated code, with the operations that iterations and checks need.
///
/// `f64` is used for identification and simulation, `f32` for small controllers.
pub trait Float:
    sealed::Sealed
    + Copy
    + Debug
    + PartialOrd
    + Into<f64>
    + Add<Output = Self>
    + AddAssign
    + Sub<Output = Self>
    + SubAssign
    + Mul<Output = Self>
    + MulAssign
    + Div<Output = Self>
    + DivAssign
    + Neg<Output = Self>
    + Sum<Self>
{
    /// Numerical limits of the type.
    const LIMITS: Limits;
    /// Zero.
    const ZERO: Self;
    /// Infinity.
    const INFINITY: Self;
    /// NaN.
    const NAN: Self;

    /// The nearest number of the type.
    fn of(value: f64) -> Self;
    /// The magnitude.
    fn abs(self) -> Self;
    /// The larger of two numbers; ignores NaN.
    fn max(self, other: Self) -> Self;
    /// The smaller of two numbers; ignores NaN.
    fn min(self, other: Self) -> Self;
    /// Whether it is neither infinite nor NaN.
    fn is_finite(self) -> bool;
    /// Its bits, which are zero for zero only.
    fn bits(self) -> u64;
    /// Square root; NaN of a negative number.
    fn sqrt(self) -> Self;
    /// Sine and cosine of an angle in radians.
    fn sin_cos(self) -> (Self, Self);
    /// The angle wrapped to the one nearest to zero.
    fn wrap_angle(self) -> Self;
}

macro_rules! float {
    ($float:ident, $limits:expr, $of:expr, $math:ident) => {
        impl Float for $float {
            const LIMITS: Limits = $limits;
            const ZERO: Self = 0.0;
            const INFINITY: Self = Self::INFINITY;
            const NAN: Self = Self::NAN;

            #[inline]
            fn of(value: f64) -> Self {
                $of(value)
            }

            #[inline]
            fn abs(self) -> Self {
                self.abs()
            }

            #[inline]
            fn max(self, other: Self) -> Self {
                self.max(other)
            }

            #[inline]
            fn min(self, other: Self) -> Self {
                self.min(other)
            }

            #[inline]
            fn is_finite(self) -> bool {
                self.is_finite()
            }

            #[inline]
            fn bits(self) -> u64 {
                self.to_bits().into()
            }

            #[inline]
            fn sqrt(self) -> Self {
                $math::sqrt(self)
            }

            #[inline]
            fn sin_cos(self) -> (Self, Self) {
                $math::sin_cos(self)
            }

            #[inline]
            fn wrap_angle(self) -> Self {
                $math::wrap_angle(self)
            }
        }
    };
}

float!(f64, limits::DOUBLE, core::convert::identity, math);
float!(f32, limits::SINGLE, |value| value as f32, single);
