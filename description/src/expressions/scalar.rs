//! Exact constants, with separate multiples of π.

use overact_exact::{Angle, Number, Ratio};
use std::f64::consts::PI;

/// A constant. Multiples of π are separate from other numbers, so that 90 deg and pi/2 are the same
/// exact angle.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) enum Scalar {
    /// A number without a multiple of π.
    Number(Number),
    /// π times a nonzero fraction, plus a fraction.
    Angle(Angle),
}

impl Scalar {
    pub(crate) fn number(number: Number) -> Self {
        Self::Number(number)
    }

    pub(crate) fn angle(angle: Angle) -> Self {
        let (half_turns, radians) = angle.parts();
        if half_turns.is_zero() {
            Self::Number(Number::ratio(radians))
        } else {
            Self::Angle(angle)
        }
    }

    /// The scalar as a number, including π.
    pub(crate) fn to_number(self) -> Number {
        match self {
            Self::Number(number) => number,
            Self::Angle(angle) => {
                let (half_turns, radians) = angle.parts();
                Number::ratio(half_turns) * Number::float(PI) + Number::ratio(radians)
            }
        }
    }

    /// The scalar as an angle in radians; irrational numbers become the fraction of their float.
    /// `None` on overflow.
    pub(crate) fn to_angle(self) -> Option<Angle> {
        match self {
            Self::Angle(angle) => Some(angle),
            Self::Number(number) => number
                .as_ratio()
                .or_else(|| ratio_of_float(number.value()))
                .map(Angle::radians),
        }
    }

    fn exact_angle(self) -> Option<Angle> {
        match self {
            Self::Angle(angle) => Some(angle),
            Self::Number(number) => number.as_ratio().map(Angle::radians),
        }
    }

    pub(crate) fn as_ratio(self) -> Option<Ratio> {
        match self {
            Self::Number(number) => number.as_ratio(),
            Self::Angle(_) => None,
        }
    }

    /// The scalar as a fraction; irrational numbers become the fraction of their float. `None` on
    /// overflow.
    pub(crate) fn to_ratio(self) -> Option<Ratio> {
        self.as_ratio().or_else(|| ratio_of_float(self.value()))
    }

    pub(crate) fn value(self) -> f64 {
        match self {
            Self::Number(number) => number.value(),
            Self::Angle(angle) => angle.value(),
        }
    }

    pub(crate) fn is_zero(self) -> bool {
        matches!(self, Self::Number(number) if number.is_zero() || number.value() == 0.0)
    }

    pub(crate) fn plus(self, other: Self) -> Self {
        let exact = self.exact_angle().zip(other.exact_angle());
        let sum = exact.and_then(|(a, b)| a.plus(b));
        sum.map_or_else(
            || Self::Number(self.to_number() + other.to_number()),
            Self::angle,
        )
    }

    pub(crate) fn times(self, other: Self) -> Self {
        let exact = match (self, other) {
            (Self::Angle(angle), factor) | (factor, Self::Angle(angle)) => {
                factor.as_ratio().and_then(|factor| angle.times(factor))
            }
            _ => None,
        };
        exact.map_or_else(
            || Self::Number(self.to_number() * other.to_number()),
            Self::angle,
        )
    }

    /// The reciprocal of a nonzero scalar.
    pub(crate) fn reciprocal(self) -> Self {
        Self::Number(Number::ONE / self.to_number())
    }

    pub(crate) fn negative(self) -> Self {
        match self {
            Self::Number(number) => Self::Number(-number),
            Self::Angle(angle) => Self::Angle(angle.negative()),
        }
    }
}

/// The exact fraction of a float; `None` if it exceeds 128 bits.
fn ratio_of_float(value: f64) -> Option<Ratio> {
    // 2^-80 is far below the rounding of any relevant angle.
    const SHIFT: i32 = 80;
    let scaled = value * 2_f64.powi(SHIFT);
    let fits = scaled.is_finite() && scaled.abs() < 2_f64.powi(126);
    if fits {
        Ratio::new(scaled.round() as i128, 1 << SHIFT)
    } else {
        None
    }
}
