//! Sums, products and quotients of lanes, and of lanes and common numbers.

use super::{Lanes, Vector};
use core::ops::{Add, Div, Mul, Neg, Sub};

macro_rules! operator {
    ($operator:ident, $name:ident) => {
        impl<V: Vector> $operator for Lanes<V> {
            type Output = Self;
            #[inline(always)]
            fn $name(self, other: Self) -> Self {
                Self(self.0.$name(other.0))
            }
        }

        impl<V: Vector> $operator<f64> for Lanes<V> {
            type Output = Self;
            #[inline(always)]
            fn $name(self, other: f64) -> Self {
                self.$name(Self::all(self.0.proof(), other))
            }
        }

        impl<V: Vector> $operator<Lanes<V>> for f64 {
            type Output = Lanes<V>;
            #[inline(always)]
            fn $name(self, other: Lanes<V>) -> Lanes<V> {
                Lanes::all(other.0.proof(), self).$name(other)
            }
        }
    };
}

operator!(Add, add);
operator!(Sub, sub);
operator!(Mul, mul);
operator!(Div, div);

impl<V: Vector> Neg for Lanes<V> {
    type Output = Self;
    #[inline(always)]
    fn neg(self) -> Self {
        Self(-self.0)
    }
}
