//! Constant angles, exact as multiples of π plus a fraction of a radian.

use super::field::{Element, mix, mix_name};
use super::number::Number;
use super::ratio::Ratio;
use std::f64::consts::PI;

/// A constant angle π `half_turns` + `radians`.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
pub struct Angle {
    half_turns: Ratio,
    radians: Ratio,
}

impl Angle {
    /// Zero.
    pub const ZERO: Self = Self {
        half_turns: Ratio::ZERO,
        radians: Ratio::ZERO,
    };

    /// π times a fraction.
    #[must_use]
    pub const fn half_turns(half_turns: Ratio) -> Self {
        Self {
            half_turns,
            radians: Ratio::ZERO,
        }
    }

    /// A fraction of degrees; `None` on overflow.
    #[must_use]
    #[inline]
    pub fn degrees(degrees: Ratio) -> Option<Self> {
        Some(Self::half_turns(degrees.times(Ratio::new(1, 180)?)?))
    }

    /// A fraction of radians.
    #[must_use]
    #[inline]
    pub const fn radians(radians: Ratio) -> Self {
        Self {
            half_turns: Ratio::ZERO,
            radians,
        }
    }

    /// The angle in radians.
    #[must_use]
    #[inline]
    pub fn value(self) -> f64 {
        PI * self.half_turns.value() + self.radians.value()
    }

    /// Sum; `None` on overflow.
    #[must_use]
    #[inline]
    pub fn plus(self, other: Self) -> Option<Self> {
        Some(Self {
            half_turns: self.half_turns.plus(other.half_turns)?,
            radians: self.radians.plus(other.radians)?,
        })
    }

    /// The angle times a fraction; `None` on overflow.
    #[must_use]
    #[inline]
    pub fn times(self, factor: Ratio) -> Option<Self> {
        Some(Self {
            half_turns: self.half_turns.times(factor)?,
            radians: self.radians.times(factor)?,
        })
    }

    /// The angle with the opposite sign.
    #[must_use]
    #[inline]
    pub const fn negative(self) -> Self {
        Self {
            half_turns: self.half_turns.negative(),
            radians: self.radians.negative(),
        }
    }

    /// Whether the angle is zero.
    #[must_use]
    #[inline]
    pub const fn is_zero(self) -> bool {
        self.half_turns.is_zero() && self.radians.is_zero()
    }

    /// The multiple of π and the fraction of a radian.
    #[must_use]
    #[inline]
    pub const fn parts(self) -> (Ratio, Ratio) {
        (self.half_turns, self.radians)
    }

    /// Cosine and sine, exact in the field.
    #[must_use]
    #[inline]
    pub fn cosine_and_sine(self) -> (Number, Number) {
        let (sine, cosine) = self.value().sin_cos();
        let image = self.circle_point();
        let (image_cosine, image_sine) = image.cosine_and_sine();
        (exact(cosine, image_cosine), exact(sine, image_sine))
    }

    /// The point on the field's circle that represents the angle.
    #[must_use]
    pub fn circle_point(self) -> Element {
        let turns = Element::half_turns(self.half_turns.numerator(), self.half_turns.denominator())
            .map_or_else(
                || Element::circle_point(hash(self.half_turns)),
                |(cosine, sine)| Element::from_parts(cosine.parts().0, sine.parts().0),
            );
        turns * radian_point(self.radians)
    }
}

/// The constant, which is exactly zero if its image is zero, regardless of rounding.
#[inline]
fn exact(value: f64, image: Element) -> Number {
    if image == Element::ZERO {
        Number::ZERO
    } else {
        Number::known(value, image)
    }
}

#[inline]
fn hash(ratio: Ratio) -> u64 {
    mix(ratio.numerator() as u64 ^ mix(ratio.denominator() as u64))
}

/// The point of a number of radians: that of a nanoradian, which is fixed but arbitrary, to a
/// power.
///
/// So decimal radians add up exactly. A fraction that is not a multiple of a nanoradian gets its
/// own point.
#[inline]
fn radian_point(radians: Ratio) -> Element {
    const UNIT: i128 = 1_000_000_000;
    if radians.is_zero() {
        return Element::ONE;
    }
    match radians.numerator().checked_mul(UNIT) {
        Some(n) if n % radians.denominator() == 0 => {
            let count = (n / radians.denominator()).rem_euclid(i128::from(super::field::CIRCLE));
            Element::circle_point(mix_name("nanoradian")).power(count as u64)
        }
        _ => Element::circle_point(hash(radians)),
    }
}

impl std::fmt::Display for Angle {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        match (self.half_turns.is_zero(), self.radians.is_zero()) {
            (_, true) => {
                let degrees = self.half_turns.value() * 180.0;
                write!(f, "{degrees} deg")
            }
            (true, false) => write!(f, "{} rad", self.radians.value()),
            (false, false) => write!(f, "{} rad", self.value()),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_right_angle_has_cosine_zero() {
        let (cosine, sine) = Angle::degrees(Ratio::integer(90))
            .unwrap()
            .cosine_and_sine();
        assert!(cosine.is_zero() && sine.is_one());
    }

    #[test]
    fn decimal_degrees_obey_the_addition_theorem() {
        let degrees = |text| Angle::degrees(Ratio::decimal(text).unwrap()).unwrap();
        let (c1, s1) = degrees("15.52").cosine_and_sine();
        let (c2, s2) = degrees("164.48").cosine_and_sine();
        assert!((c1 * c2 - s1 * s2 + Number::ONE).is_zero());
        assert!((s1 - s2).is_zero());
    }

    #[test]
    fn decimal_radians_are_additive() {
        let point = |text| Angle::radians(Ratio::decimal(text).unwrap()).circle_point();
        assert_eq!(point("0.1") * point("0.2"), point("0.3"));
        assert_eq!(point("-1.25") * point("1.25"), Element::ONE);
        assert_ne!(point("0.1"), Element::ONE);
    }

    #[test]
    fn non_decimal_fractions_have_their_own_circle_point() {
        let point = |radians| Angle::radians(radians).circle_point();
        let third = Ratio::new(1, 3).unwrap();
        assert_ne!(point(third), point(Ratio::decimal("0.333333333").unwrap()));
    }
}
