//! Floating-point samples that confirm identities found in the field.
//!
//! Samples are complex numbers: square roots of negative values exist, so identities of square
//! roots can be confirmed at any random point.

use super::field::mix;
use std::ops::{Add, Div, Mul, Neg, Sub};

/// A complex number.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct Sample {
    re: f64,
    im: f64,
}

impl Sample {
    /// A real sample.
    pub(crate) const fn real(re: f64) -> Self {
        Self { re, im: 0.0 }
    }

    /// A real sample in (0.2, 1.2), where sums, products and angles are all well-behaved.
    pub(crate) fn of_bits(bits: u64) -> Self {
        Self::real(0.2 + (mix(bits) >> 11) as f64 / (1_u64 << 53) as f64)
    }

    /// The real part.
    pub(crate) const fn re(self) -> f64 {
        self.re
    }

    /// The magnitude.
    pub(crate) fn size(self) -> f64 {
        self.re.hypot(self.im)
    }

    /// The principal square root.
    pub(crate) fn sqrt(self) -> Self {
        if self.im == 0.0 {
            let root = self.re.abs().sqrt();
            return if self.re < 0.0 {
                Self { re: 0.0, im: root }
            } else {
                Self::real(root)
            };
        }
        let size = self.size();
        let re = (0.5 * (size + self.re)).sqrt();
        let im = (0.5 * (size - self.re)).sqrt();
        Self {
            re,
            im: im.copysign(self.im),
        }
    }

    /// Whether two samples agree up to rounding. NaN agrees with nothing.
    pub(crate) fn agrees(self, other: Self) -> bool {
        (self - other).size() <= 1e-6 * (1e-6 + self.size().max(other.size()))
    }
}

impl Add for Sample {
    type Output = Self;
    fn add(self, other: Self) -> Self {
        Self {
            re: self.re + other.re,
            im: self.im + other.im,
        }
    }
}

impl Sub for Sample {
    type Output = Self;
    fn sub(self, other: Self) -> Self {
        Self {
            re: self.re - other.re,
            im: self.im - other.im,
        }
    }
}

impl Neg for Sample {
    type Output = Self;
    fn neg(self) -> Self {
        Self {
            re: -self.re,
            im: -self.im,
        }
    }
}

impl Mul for Sample {
    type Output = Self;
    fn mul(self, other: Self) -> Self {
        Self {
            re: self.re * other.re - self.im * other.im,
            im: self.re * other.im + self.im * other.re,
        }
    }
}

impl Div for Sample {
    type Output = Self;
    fn div(self, other: Self) -> Self {
        let square = other.re * other.re + other.im * other.im;
        let product = self
            * Self {
                re: other.re,
                im: -other.im,
            };
        Self {
            re: product.re / square,
            im: product.im / square,
        }
    }
}
