//! Exact constants: a float for values, its image in the field for decisions, and its fraction, if
//! any.
//!
//! Constant folding must not produce 6e-17 instead of zero. So every constant has an image in
//! [`field`](super::field): a difference whose image is zero is zero, and a product whose image is
//! one is one.

use super::field::{Element, mix};
use super::ratio::Ratio;
use std::ops::{Add, Div, Mul, Neg, Sub};

/// A real constant.
#[derive(Debug, Clone, Copy)]
pub struct Number {
    value: f64,
    image: Element,
    ratio: Option<Ratio>,
}

impl Number {
    /// Zero.
    pub const ZERO: Self = Self {
        value: 0.0,
        image: Element::ZERO,
        ratio: Some(Ratio::ZERO),
    };
    /// One.
    pub const ONE: Self = Self {
        value: 1.0,
        image: Element::ONE,
        ratio: Some(Ratio::ONE),
    };

    /// An integer.
    #[must_use]
    #[inline]
    pub fn integer(value: i64) -> Self {
        Self::ratio(Ratio::integer(value))
    }

    /// A fraction.
    #[must_use]
    #[inline]
    pub fn ratio(ratio: Ratio) -> Self {
        let mut image = Element::integer(ratio.numerator());
        if ratio.denominator() != 1 {
            image = image * Element::integer(ratio.denominator()).inverse();
        }
        Self {
            value: ratio.value(),
            image,
            ratio: Some(ratio),
        }
    }

    /// A float of unknown origin; its image is pseudo-random, but equal for equal floats.
    #[must_use]
    #[inline]
    pub fn float(value: f64) -> Self {
        if value.fract() == 0.0 && value.abs() < 9e15 {
            return Self::integer(value as i64);
        }
        Self {
            value,
            image: Element::from_bits(mix(value.to_bits())),
            ratio: None,
        }
    }

    /// A float with a known image, such as the cosine of an exact angle.
    #[must_use]
    #[inline]
    pub fn known(value: f64, image: Element) -> Self {
        match image.to_rational() {
            Some((n, d)) if close(n as f64 / d as f64, value) => Ratio::new(n.into(), d.into())
                .map_or(
                    Self {
                        value,
                        image,
                        ratio: None,
                    },
                    Self::ratio,
                ),
            _ => Self {
                value,
                image,
                ratio: None,
            },
        }
    }

    /// The float.
    #[must_use]
    #[inline]
    pub fn value(self) -> f64 {
        self.value
    }

    /// The image in the field.
    #[must_use]
    #[inline]
    pub fn image(self) -> Element {
        self.image
    }

    /// The fraction, if the constant is rational.
    #[must_use]
    #[inline]
    pub fn as_ratio(self) -> Option<Ratio> {
        self.ratio
    }

    /// Whether the constant is zero.
    #[must_use]
    #[inline]
    pub fn is_zero(self) -> bool {
        self.image == Element::ZERO
    }

    /// Whether the constant is one.
    #[must_use]
    #[inline]
    pub fn is_one(self) -> bool {
        self.image == Element::ONE
    }

    /// Square root; `None` for a negative number.
    #[must_use]
    pub fn square_root(self) -> Option<Self> {
        if self.value < 0.0 {
            return None;
        }
        if let Some(ratio) = self.ratio {
            if let Some(root) = ratio.square_root() {
                return Some(Self::ratio(root));
            }
            return Some(root_of_ratio(ratio, self.value.sqrt()));
        }
        // No relation to other roots is known, so the root gets an image of its own.
        Some(Self::float(self.value.sqrt()))
    }
}

/// The root of a fraction as the product of the roots of its primes, so that √2 √3 is √6.
///
/// The roots of 2, 3 and 5 are consistent with the points on the circle (√3 = 2 cos 30 deg).
#[inline]
fn root_of_ratio(ratio: Ratio, value: f64) -> Number {
    let square_free = match ratio.numerator().checked_mul(ratio.denominator()) {
        Some(n) if n < 1 << 40 => n,
        _ => return Number::float(value),
    };
    let mut image = Element::integer(ratio.denominator()).inverse();
    let mut rest = square_free;
    let mut prime = 2;
    while rest > 1 {
        if prime * prime > rest {
            prime = rest;
        }
        let mut count = 0;
        while rest % prime == 0 {
            rest /= prime;
            count += 1;
        }
        for _ in 0..count / 2 {
            image = image * Element::integer(prime);
        }
        if count % 2 == 1 {
            image = image * root_of_prime(prime);
        }
        prime += 1;
    }
    Number {
        value,
        image,
        ratio: None,
    }
}

#[inline]
fn root_of_prime(prime: i128) -> Element {
    let twice_cosine = |n, d| Element::half_turns(n, d).map(|(c, _)| c + c);
    let root = match prime {
        2 => twice_cosine(1, 4),
        3 => twice_cosine(1, 6),
        5 => twice_cosine(1, 5).map(|c| c + c - Element::ONE),
        _ => Element::integer(prime).square_root(),
    };
    root.unwrap_or_else(|| Element::from_bits(mix(prime as u64)))
}

#[inline]
fn close(a: f64, b: f64) -> bool {
    (a - b).abs() <= 1e-12 * (1.0 + a.abs())
}

/// Combines two numbers: as exact fractions if both are rational, otherwise by value and image.
#[inline]
fn combine(ratio: Option<Ratio>, value: f64, image: Element) -> Number {
    if let Some(ratio) = ratio {
        return Number {
            value: ratio.value(),
            image,
            ratio: Some(ratio),
        };
    }
    if image == Element::ZERO && value.abs() < 1e-9 {
        return Number::ZERO;
    }
    Number::known(value, image)
}

impl Add for Number {
    type Output = Self;
    #[inline]
    fn add(self, other: Self) -> Self {
        let ratio = self.ratio.zip(other.ratio).and_then(|(a, b)| a.plus(b));
        combine(ratio, self.value + other.value, self.image + other.image)
    }
}

impl Sub for Number {
    type Output = Self;
    #[inline]
    fn sub(self, other: Self) -> Self {
        self + -other
    }
}

impl Mul for Number {
    type Output = Self;
    #[inline]
    fn mul(self, other: Self) -> Self {
        let ratio = self.ratio.zip(other.ratio).and_then(|(a, b)| a.times(b));
        combine(ratio, self.value * other.value, self.image * other.image)
    }
}

impl Div for Number {
    type Output = Self;
    /// The quotient; the caller ensures that the divisor is not zero.
    #[inline]
    fn div(self, other: Self) -> Self {
        let ratio = self
            .ratio
            .zip(other.ratio)
            .and_then(|(a, b)| a.times(b.reciprocal()?));
        combine(
            ratio,
            self.value / other.value,
            self.image * other.image.inverse(),
        )
    }
}

impl Neg for Number {
    type Output = Self;
    #[inline]
    fn neg(self) -> Self {
        Self {
            value: -self.value,
            image: -self.image,
            ratio: self.ratio.map(Ratio::negative),
        }
    }
}

impl PartialEq for Number {
    #[inline]
    fn eq(&self, other: &Self) -> bool {
        self.image == other.image && close(self.value, other.value)
    }
}

impl std::fmt::Display for Number {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        match self.ratio {
            Some(ratio) if ratio.denominator() < 10_000 => write!(f, "{ratio}"),
            _ => write!(f, "{}", self.value),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn products_of_roots_are_exact() {
        let root = |n| Number::integer(n).square_root().unwrap();
        assert!((root(2) * root(3) - root(6)).is_zero());
        assert!((root(12) - Number::integer(2) * root(3)).is_zero());
        assert_eq!((root(8) * root(2)).as_ratio(), Some(Ratio::integer(4)));
    }

    #[test]
    fn decimals_are_exact() {
        let a = Number::ratio(Ratio::decimal("0.1").unwrap());
        let b = Number::ratio(Ratio::decimal("0.2").unwrap());
        let c = Number::ratio(Ratio::decimal("0.3").unwrap());
        assert!((a + b - c).is_zero());
        assert_eq!((a + b).value(), 0.3);
    }
}
