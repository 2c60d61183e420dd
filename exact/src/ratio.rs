//! Exact fractions of 128-bit integers.
//!
//! Operations return `None` on overflow, and the caller then continues with a float.

use std::cmp::Ordering;

/// A fraction in lowest terms with a positive denominator.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
pub struct Ratio {
    numerator: i128,
    denominator: i128,
}

/// Greatest common divisor (Euclid).
#[inline]
fn gcd(a: i128, b: i128) -> i128 {
    let (mut a, mut b) = (a.unsigned_abs(), b.unsigned_abs());
    // Most numbers fit into 64 bits. Their remainder is one instruction, that of 128 bits a call.
    if let (Ok(mut a), Ok(mut b)) = (u64::try_from(a), u64::try_from(b)) {
        while b != 0 {
            (a, b) = (b, a % b);
        }
        return a.into();
    }
    while b != 0 {
        (a, b) = (b, a % b);
    }
    i128::try_from(a).unwrap_or(1)
}

impl Ratio {
    /// Zero.
    pub const ZERO: Self = Self {
        numerator: 0,
        denominator: 1,
    };
    /// One.
    pub const ONE: Self = Self {
        numerator: 1,
        denominator: 1,
    };

    /// A fraction in lowest terms; `None` if the denominator is 0 or a number overflows.
    #[must_use]
    pub fn new(numerator: i128, denominator: i128) -> Option<Self> {
        if denominator == 0 {
            return None;
        }
        let divisor = gcd(numerator, denominator).max(1);
        let sign = denominator.signum();
        if divisor == 1 {
            return Some(Self {
                numerator: numerator.checked_mul(sign)?,
                denominator: denominator.checked_mul(sign)?,
            });
        }
        Some(Self {
            numerator: (numerator / divisor).checked_mul(sign)?,
            denominator: (denominator / divisor).checked_mul(sign)?,
        })
    }

    /// An integer.
    #[must_use]
    #[inline]
    pub const fn integer(value: i64) -> Self {
        Self {
            numerator: value as i128,
            denominator: 1,
        }
    }

    /// A decimal number such as `-0.41`, `15.52` or `1e-3`; `None` for other texts and on overflow.
    #[must_use]
    #[inline]
    pub fn decimal(text: &str) -> Option<Self> {
        let text = text.replace('_', "");
        let (mantissa, exponent) = match text.find(['e', 'E']) {
            Some(at) => (&text[..at], text[at + 1..].parse::<i32>().ok()?),
            None => (text.as_str(), 0),
        };
        let (whole, fraction) = mantissa.split_once('.').unwrap_or((mantissa, ""));
        let digits: i128 = format!("{whole}{fraction}").parse().ok()?;
        let exponent = exponent.checked_sub(i32::try_from(fraction.len()).ok()?)?;
        let scale = 10_i128.checked_pow(exponent.unsigned_abs())?;
        if exponent < 0 {
            Self::new(digits, scale)
        } else {
            Self::new(digits.checked_mul(scale)?, 1)
        }
    }

    /// Numerator, with the sign.
    #[must_use]
    #[inline]
    pub const fn numerator(self) -> i128 {
        self.numerator
    }

    /// Denominator, positive.
    #[must_use]
    #[inline]
    pub const fn denominator(self) -> i128 {
        self.denominator
    }

    /// Whether it is 0.
    #[must_use]
    #[inline]
    pub const fn is_zero(self) -> bool {
        self.numerator == 0
    }

    /// Value as a float; two conversions and a division are rounded.
    #[must_use]
    #[inline]
    pub fn value(self) -> f64 {
        match (
            i64::try_from(self.numerator),
            i64::try_from(self.denominator),
        ) {
            (Ok(numerator), Ok(denominator)) => numerator as f64 / denominator as f64,
            _ => self.numerator as f64 / self.denominator as f64,
        }
    }

    /// Sum; `None` on overflow.
    #[must_use]
    #[inline]
    pub fn plus(self, other: Self) -> Option<Self> {
        let a = self.numerator.checked_mul(other.denominator)?;
        let b = other.numerator.checked_mul(self.denominator)?;
        Self::new(
            a.checked_add(b)?,
            self.denominator.checked_mul(other.denominator)?,
        )
    }

    /// Product; `None` on overflow.
    #[must_use]
    #[inline]
    pub fn times(self, other: Self) -> Option<Self> {
        Self::new(
            self.numerator.checked_mul(other.numerator)?,
            self.denominator.checked_mul(other.denominator)?,
        )
    }

    /// Reciprocal; `None` for 0.
    #[must_use]
    #[inline]
    pub fn reciprocal(self) -> Option<Self> {
        Self::new(self.denominator, self.numerator)
    }

    /// Negative.
    #[must_use]
    #[inline]
    pub const fn negative(self) -> Self {
        Self {
            numerator: -self.numerator,
            denominator: self.denominator,
        }
    }

    /// Square root, if it is a fraction.
    ///
    /// Roots of numbers above 2⁵³ may be missed, since candidates are computed with floats.
    #[must_use]
    pub fn square_root(self) -> Option<Self> {
        let root = |n: i128| {
            let r = (n as f64).sqrt().round() as i128;
            (r.checked_mul(r)? == n).then_some(r)
        };
        if self.numerator < 0 {
            return None;
        }
        Self::new(root(self.numerator)?, root(self.denominator)?)
    }
}

/// Compares the rounded values.
impl PartialOrd for Ratio {
    #[inline]
    fn partial_cmp(&self, other: &Self) -> Option<Ordering> {
        self.value().partial_cmp(&other.value())
    }
}

impl std::fmt::Display for Ratio {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        if self.denominator == 1 {
            write!(f, "{}", self.numerator)
        } else {
            write!(f, "{}/{}", self.numerator, self.denominator)
        }
    }
}
