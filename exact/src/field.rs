//! A finite field in which expressions have exact values.
//!
//! Elements are a + b i over the integers modulo the prime `P`. Two facts make the field faithful
//! to the reals that occur in robots:
//!
//! - `P` = 3 mod 4, so -1 is no square: every square root of a base-field element exists in GF(P²).
//! - `P` + 1 = 2^14 3^4 5^11 7 13 17 23, the order of the circle a² + b² = 1. An angle π n/d is a
//!   point of the circle if 2d divides that order. So sines and cosines of decimal degrees are
//!   exact, and every identity between them holds: cos(90 deg) is 0 and 2 cos(30 deg) is √3.
//!
//! An identity that holds for all real inputs holds here at random inputs. One that does not hold
//! is false here, except with a probability of about degree / `P` (Schwartz and Zippel).

use super::hasher::QuickMap;
use std::ops::{Add, Mul, Neg, Sub};
use std::sync::OnceLock;

/// The prime.
pub const P: u64 = 2_305_648_799_999_999_999;

/// Order of the circle group, `P` + 1.
pub const CIRCLE: u64 = P + 1;

/// A generator of the circle group, which represents the angle 2π / `CIRCLE`.
///
/// Of a point and its mirror image it is the one whose quarter turn is i.
const GENERATOR: Element = Element {
    re: 1_682_500_475_675_675_674,
    im: 1_433_241_145_945_945_945,
};

/// An element a + b i of GF(P²).
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash, PartialOrd, Ord)]
pub struct Element {
    re: u64,
    im: u64,
}

#[inline]
fn add(a: u64, b: u64) -> u64 {
    let sum = a + b;
    if sum >= P { sum - P } else { sum }
}

#[inline]
fn sub(a: u64, b: u64) -> u64 {
    if a >= b { a - b } else { a + P - b }
}

/// 2^122 / `P`, for Barrett's reduction.
const RECIPROCAL: u64 = ((1_u128 << 122) / P as u128) as u64;

/// Product modulo `P` by Barrett's reduction.
///
/// A 128-bit remainder would take ten times as long as the two multiplications. Barrett's quotient
/// is at most 3 too small.
#[inline]
fn mul(a: u64, b: u64) -> u64 {
    let product = u128::from(a) * u128::from(b);
    let high = (product >> 60) as u64;
    let quotient = ((u128::from(high) * u128::from(RECIPROCAL)) >> 62) as u64;
    let mut rest = (product as u64).wrapping_sub(quotient.wrapping_mul(P));
    while rest >= P {
        rest -= P;
    }
    rest
}

fn power(mut base: u64, mut exponent: u64) -> u64 {
    let mut result = 1;
    while exponent > 0 {
        if exponent & 1 == 1 {
            result = mul(result, base);
        }
        base = mul(base, base);
        exponent >>= 1;
    }
    result
}

/// Inverse modulo `P` by Euclid's extended algorithm; zero for zero.
///
/// A power would take ten times as long for small denominators, which most constants have.
fn invert(a: u64) -> u64 {
    let (mut r0, mut r1) = (P, a);
    // The factors stay below P, which leaves room for a sign.
    let (mut t0, mut t1) = (0_i64, 1_i64);
    while r1 != 0 {
        let quotient = r0 / r1;
        (r0, r1) = (r1, r0 - quotient * r1);
        (t0, t1) = (t1, t0 - quotient as i64 * t1);
    }
    t0.rem_euclid(P as i64) as u64
}

/// A map keyed by values of nodes.
pub type ByValue<T> = QuickMap<Element, T>;

impl Element {
    /// Zero.
    pub const ZERO: Self = Self { re: 0, im: 0 };
    /// One.
    pub const ONE: Self = Self { re: 1, im: 0 };

    /// The image of an integer.
    #[must_use]
    #[inline]
    pub fn integer(value: i128) -> Self {
        // Small integers are their own images. A Euclidean remainder is nonnegative and below P.
        let re = match u64::try_from(value) {
            Ok(small) if small < P => small,
            _ => value.rem_euclid(i128::from(P)) as u64,
        };
        Self { re, im: 0 }
    }

    /// A base-field element from any 64 bits.
    #[must_use]
    #[inline]
    pub fn from_bits(bits: u64) -> Self {
        Self {
            re: bits % P,
            im: 0,
        }
    }

    /// The element with its real and imaginary parts modulo P.
    #[must_use]
    #[inline]
    pub fn from_parts(re: u64, im: u64) -> Self {
        Self {
            re: re % P,
            im: im % P,
        }
    }

    /// Real and imaginary part.
    #[must_use]
    #[inline]
    pub fn parts(self) -> (u64, u64) {
        (self.re, self.im)
    }

    /// Multiplicative inverse; zero for zero.
    #[must_use]
    pub fn inverse(self) -> Self {
        if self.im == 0 {
            return Self {
                re: invert(self.re),
                im: 0,
            };
        }
        let norm = add(mul(self.re, self.re), mul(self.im, self.im));
        let inverse = invert(norm);
        Self {
            re: mul(self.re, inverse),
            im: mul(sub(0, self.im), inverse),
        }
    }

    /// The element to a power.
    #[must_use]
    pub fn power(self, mut exponent: u64) -> Self {
        let (mut base, mut result) = (self, Self::ONE);
        while exponent > 0 {
            if exponent & 1 == 1 {
                result = result * base;
            }
            base = base * base;
            exponent >>= 1;
        }
        result
    }

    /// The point on the circle of the angle π `numerator` / `denominator`, as (cosine, sine).
    ///
    /// `None` if the circle has no point of that order.
    #[must_use]
    pub fn half_turns(numerator: i128, denominator: i128) -> Option<(Self, Self)> {
        let order = denominator.checked_mul(2)?;
        if denominator <= 0 || i128::from(CIRCLE) % order != 0 {
            return None;
        }
        let step = i128::from(CIRCLE) / order;
        let exponent = (numerator.rem_euclid(order) * step) as u64;
        Some(GENERATOR.power(exponent).cosine_and_sine())
    }

    /// A point on the circle for a free angle, determined by 64 random bits.
    #[must_use]
    pub fn circle_point(bits: u64) -> Self {
        let t = Self::from_bits(bits | 1);
        let square = t * t;
        let scale = (Self::ONE + square).inverse();
        let cosine = (Self::ONE - square) * scale;
        let sine = (t + t) * scale;
        Self {
            re: cosine.re,
            im: sine.re,
        }
    }

    /// Cosine and sine of the angle that a point on the circle represents.
    #[must_use]
    #[inline]
    pub fn cosine_and_sine(self) -> (Self, Self) {
        (Self { re: self.re, im: 0 }, Self { re: self.im, im: 0 })
    }

    /// A square root of a base-field element, always the same one.
    ///
    /// `None` for an element with an imaginary part, whose root is not needed.
    #[must_use]
    pub fn square_root(self) -> Option<Self> {
        if self.im != 0 {
            return None;
        }
        // P = 3 mod 4: one of a and -a is a square, with the root a^((P+1)/4).
        let root = power(self.re, CIRCLE / 4);
        if mul(root, root) == self.re {
            return Some(Self {
                re: root.min(sub(0, root)),
                im: 0,
            });
        }
        let root = power(sub(0, self.re), CIRCLE / 4);
        Some(Self {
            re: 0,
            im: root.min(sub(0, root)),
        })
    }

    /// The rational n/d that the element represents, with |n| and d below about 2^30, if any.
    ///
    /// Uses Wang's rational reconstruction.
    #[must_use]
    pub fn to_rational(self) -> Option<(i64, i64)> {
        const BOUND: i64 = 1 << 29;
        if self.im != 0 {
            return None;
        }
        // All numbers stay below P, which leaves room for a sign.
        let (mut r0, mut r1) = (P as i64, self.re as i64);
        let (mut t0, mut t1) = (0_i64, 1_i64);
        while r1 > BOUND {
            let quotient = r0 / r1;
            (r0, r1) = (r1, r0 - quotient * r1);
            (t0, t1) = (t1, t0 - quotient * t1);
        }
        if t1 == 0 || t1.abs() > BOUND {
            return None;
        }
        let (numerator, denominator) = if t1 < 0 { (-r1, -t1) } else { (r1, t1) };
        Some((numerator, denominator))
    }
}

impl Element {
    /// A linear image of the element in the base field.
    #[must_use]
    #[inline]
    pub fn projection(self) -> u64 {
        add(self.re, mul(self.im, PROJECTION))
    }

    /// Projection of a difference from two projections, or of the sum if `negative`.
    #[must_use]
    #[inline]
    pub fn projected_difference(first: u64, second: u64, negative: bool) -> u64 {
        if negative {
            add(first, second)
        } else {
            sub(first, second)
        }
    }

    /// The smaller one of a projection and that of the negative element.
    #[must_use]
    #[inline]
    pub fn projection_without_sign(projection: u64) -> u64 {
        projection.min(sub(0, projection))
    }
}

/// Projection of the imaginary unit, an arbitrary large number.
const PROJECTION: u64 = 0x1bd1_1bda_a9fc_1a22;

/// A prime factor of `P` - 1, the order of the base field's multiplicative group.
pub const LOGARITHMS: u32 = 239_857;

/// Discrete logarithms of elements modulo [`LOGARITHMS`]: that of a product is the sum of those of
/// its factors.
///
/// The norm a² + b² of an element is multiplicative. Its power to (`P` - 1) / [`LOGARITHMS`] is a
/// root of unity, whose exponent is found by baby steps and giant steps.
#[derive(Debug)]
pub struct Logarithms {
    /// Exponents of the first powers of the root of unity.
    small: QuickMap<u64, u32>,
    /// The inverse power of a giant step.
    giant: u64,
}

/// Number of exponents in a giant step.
const SMALL: u32 = 1 << 13;
/// The exponent that maps a norm to a root of unity.
const COFACTOR: u64 = (P - 1) / LOGARITHMS as u64;

impl Logarithms {
    /// The table, which is computed once.
    #[must_use]
    pub fn get() -> &'static Self {
        static TABLE: OnceLock<Logarithms> = OnceLock::new();
        TABLE.get_or_init(Self::new)
    }

    fn new() -> Self {
        // The order is prime, so every root of unity except one is a generator; most numbers give
        // one.
        let roots = (2..).map(|number| power(number, COFACTOR));
        let root = roots.into_iter().find(|root| *root != 1).unwrap_or(1);
        let mut small = QuickMap::default();
        let mut at = 1;
        for exponent in 0..SMALL {
            small.insert(at, exponent);
            at = mul(at, root);
        }
        Self {
            small,
            giant: invert(at),
        }
    }

    /// The logarithm of an element or its negative; `None` for zero.
    #[must_use]
    #[inline]
    pub fn of(&self, element: Element) -> Option<u32> {
        let norm = add(mul(element.re, element.re), mul(element.im, element.im));
        let mut root = power(norm, COFACTOR);
        for step in 0..LOGARITHMS.div_ceil(SMALL) {
            if let Some(exponent) = self.small.get(&root) {
                return Some((step * SMALL + exponent) % LOGARITHMS);
            }
            root = mul(root, self.giant);
        }
        None
    }
}

impl Add for Element {
    type Output = Self;
    #[inline]
    fn add(self, other: Self) -> Self {
        Self {
            re: add(self.re, other.re),
            im: add(self.im, other.im),
        }
    }
}

impl Sub for Element {
    type Output = Self;
    #[inline]
    fn sub(self, other: Self) -> Self {
        Self {
            re: sub(self.re, other.re),
            im: sub(self.im, other.im),
        }
    }
}

impl Neg for Element {
    type Output = Self;
    #[inline]
    fn neg(self) -> Self {
        Self {
            re: sub(0, self.re),
            im: sub(0, self.im),
        }
    }
}

impl Mul for Element {
    type Output = Self;
    #[inline]
    fn mul(self, other: Self) -> Self {
        if self.im == 0 && other.im == 0 {
            return Self {
                re: mul(self.re, other.re),
                im: 0,
            };
        }
        Self {
            re: sub(mul(self.re, other.re), mul(self.im, other.im)),
            im: add(mul(self.re, other.im), mul(self.im, other.re)),
        }
    }
}

/// The smaller of a value and its negative, and whether it is the negative.
///
/// Values at several points change their signs together; the first nonzero one decides.
#[must_use]
#[inline]
pub fn canonical<const POINTS: usize>(value: [Element; POINTS]) -> ([Element; POINTS], bool) {
    let negative = value.map(|element| -element);
    if negative < value {
        (negative, true)
    } else {
        (value, false)
    }
}

/// Sixty-four well-mixed bits from a seed (SplitMix64's finaliser), the source of all random points.
#[must_use]
#[inline]
pub fn mix(seed: u64) -> u64 {
    let mut z = seed.wrapping_add(0x9e37_79b9_7f4a_7c15);
    z = (z ^ (z >> 30)).wrapping_mul(0xbf58_476d_1ce4_e5b9);
    z = (z ^ (z >> 27)).wrapping_mul(0x94d0_49bb_1331_11eb);
    z ^ (z >> 31)
}

/// Bits from a name (FNV-1a, mixed), the same on every machine.
#[must_use]
#[inline]
pub fn mix_name(name: &str) -> u64 {
    let hash = name.bytes().fold(0xcbf2_9ce4_8422_2325_u64, |h, b| {
        (h ^ u64::from(b)).wrapping_mul(0x0100_0000_01b3)
    });
    mix(hash)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_cosine_of_thirty_degrees_is_half_the_root_of_three() {
        let (cosine, sine) = Element::half_turns(1, 6).unwrap();
        assert_eq!((cosine + cosine) * (cosine + cosine), Element::integer(3));
        assert_eq!(sine + sine, Element::ONE);
        assert_eq!(
            Element::half_turns(1, 2).unwrap(),
            (Element::ZERO, Element::ONE)
        );
    }

    #[test]
    fn every_base_field_element_has_a_root() {
        for n in 1..50 {
            let root = Element::integer(n).square_root().unwrap();
            assert_eq!(root * root, Element::integer(n));
        }
    }

    #[test]
    fn logarithms_and_projections_are_additive() {
        let logarithms = Logarithms::get();
        let element = |seed| Element::from_parts(mix(seed), mix(!seed) * (seed & 1));
        let mut found = std::collections::HashSet::new();
        for seed in 0..2000 {
            let (a, b) = (element(seed), element(7 * seed + 1));
            let [log_a, log_b, product] = [a, b, a * b].map(|e| logarithms.of(e).unwrap());
            assert_eq!(product, (log_a + log_b) % LOGARITHMS);
            assert_eq!(logarithms.of(-a), Some(log_a));
            let difference = |by: Element, negative| {
                Element::projected_difference(a.projection(), by.projection(), negative)
            };
            assert_eq!(difference(b, false), (a - b).projection());
            assert_eq!(difference(b, true), (a + b).projection());
            let without_sign = |e: Element| Element::projection_without_sign(e.projection());
            assert_eq!(without_sign(a), without_sign(-a));
            found.insert(log_a);
        }
        assert!(found.len() > 1900, "{} logarithms", found.len());
        assert_eq!(logarithms.of(Element::ZERO), None);
    }

    #[test]
    fn products_are_reduced_modulo_the_prime() {
        for seed in 0..10_000 {
            let (a, b) = (mix(seed) % P, mix(!seed) % P);
            assert_eq!(
                u128::from(mul(a, b)),
                u128::from(a) * u128::from(b) % u128::from(P)
            );
        }
        assert_eq!(mul(P - 1, P - 1), 1);
    }

    #[test]
    fn elements_times_their_inverses_are_one() {
        assert_eq!(Element::ZERO.inverse(), Element::ZERO);
        for re in [1, 2, 7, 2800, P - 1, P / 2] {
            let element = Element::from_parts(re, 0);
            assert_eq!(element * element.inverse(), Element::ONE, "{re}");
        }
        for seed in 0..10_000 {
            let real = Element::from_bits(mix(seed));
            assert_eq!(real * real.inverse(), Element::ONE);
            let complex = Element::from_parts(mix(seed), mix(!seed));
            assert_eq!(complex * complex.inverse(), Element::ONE);
        }
    }

    #[test]
    fn rationals_round_trip() {
        let value = Element::integer(121) * Element::integer(2800).inverse();
        assert_eq!(value.to_rational(), Some((121, 2800)));
        assert_eq!((-value).to_rational(), Some((-121, 2800)));
        assert_eq!(Element::from_bits(mix(7)).to_rational(), None);
    }

    #[test]
    fn cosine_and_sine_of_a_free_angle_lie_on_the_circle() {
        let (cosine, sine) = Element::circle_point(mix(3)).cosine_and_sine();
        assert_eq!(cosine * cosine + sine * sine, Element::ONE);
    }
}
