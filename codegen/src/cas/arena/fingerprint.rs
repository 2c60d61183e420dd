//! Fingerprints: values of expressions at random points of a finite field and at a real sample
//! point.

use super::super::field::{CIRCLE, Element, canonical, mix};
use super::super::sample::Sample;
use super::{Handle, Op, POINTS, Tables};
use overact_exact::Number;
use std::ops::{Add, Mul, Neg};

/// Values of an expression at the field's two random points and at the real sample point.
///
/// Expressions with equal fingerprints are treated as equal (Schwartz 1980, Zippel 1979).
#[derive(Debug, Clone, Copy)]
pub(crate) struct Fingerprint {
    pub(crate) image: [Element; POINTS],
    pub(crate) sample: Sample,
}

impl Tables {
    fn of(&self, handle: &Handle) -> Fingerprint {
        let fingerprint = self.nodes[handle.index()].fingerprint;
        if handle.is_negative() {
            -fingerprint
        } else {
            fingerprint
        }
    }

    pub(super) fn sample(&self, handle: Handle) -> Sample {
        self.of(&handle).sample
    }

    /// Magnitude relative to which rounding of the node's sample is judged.
    pub(super) fn operand_size(&self, op: &Op) -> f64 {
        match op {
            Op::Add(a, b) | Op::Sub(a, b) => self.sample(*a).size().max(self.sample(*b).size()),
            _ => 0.0,
        }
    }

    pub(super) fn fingerprint(&self, op: &Op) -> Fingerprint {
        let of = |handle| self.of(handle);
        match op {
            Op::Constant(id) => Fingerprint::number(self.constants[*id as usize]),
            Op::Symbol(id) => self.symbols[id.0 as usize].fingerprint,
            Op::Cosine(id) => self.cosine_and_sine(*id).0,
            Op::Sine(id) => self.cosine_and_sine(*id).1,
            Op::Add(a, b) => of(a) + of(b),
            Op::Sub(a, b) => of(a) + -of(b),
            Op::Mul(a, b) => of(a) * of(b),
            Op::Div(a, b) => of(a).over(of(b)),
            Op::Sqrt(a) => of(a).square_root(),
            Op::Sign(a) => of(a).sign(),
            Op::Atan2(y, x) => of(y).arc_tangent(of(x)),
        }
    }

    pub(super) fn cosine_and_sine(&self, direction: u32) -> (Fingerprint, Fingerprint) {
        let points: [_; POINTS] =
            std::array::from_fn(|point| self.circle(direction, point).cosine_and_sine());
        let angle = self.angle_sample(direction);
        let cosine = Fingerprint {
            image: points.map(|(cosine, _)| cosine),
            sample: Sample::real(angle.cos()),
        };
        let sine = Fingerprint {
            image: points.map(|(_, sine)| sine),
            sample: Sample::real(angle.sin()),
        };
        (cosine, sine)
    }

    fn circle(&self, direction: u32, point: usize) -> Element {
        let direction = &self.directions[direction as usize];
        let mut result = direction.offset().circle_point();
        for &(symbol, factor) in direction.terms() {
            let unit = self.symbols[symbol.0 as usize].circle[point];
            let count = factor.numerator().rem_euclid(i128::from(CIRCLE)) as u64;
            let turned = unit.power(count);
            // A fraction of an angle is treated as an independent angle.
            result = result
                * if factor.denominator() == 1 {
                    turned
                } else {
                    Element::circle_point(mix(turned.parts().0 ^ mix(factor.denominator() as u64)))
                };
        }
        result
    }

    fn angle_sample(&self, direction: u32) -> f64 {
        let direction = &self.directions[direction as usize];
        direction
            .terms()
            .iter()
            .fold(direction.offset().value(), |angle, (symbol, factor)| {
                angle + self.symbols[symbol.0 as usize].sample * factor.value()
            })
    }
}

/// Pseudo-random value of an unknown function, determined by its arguments.
fn free(tag: u64, arguments: &[Element]) -> Element {
    let bits = arguments.iter().fold(mix(tag), |bits, argument| {
        let (re, im) = argument.parts();
        mix(mix(bits ^ re) ^ im)
    });
    Element::from_bits(bits)
}

impl Fingerprint {
    /// Fingerprint of a constant.
    pub(crate) fn number(number: Number) -> Self {
        Self {
            image: [number.image(); POINTS],
            sample: Sample::real(number.value()),
        }
    }

    /// The value at the first point.
    pub(crate) const fn value(&self) -> Element {
        self.image[0]
    }

    /// Whether both may be the same function: the field points or the real sample agree.
    ///
    /// A necessary condition, used to detect errors; [`agrees`](Self::agrees) is the sufficient
    /// one.
    pub(crate) fn resembles(&self, other: &Self) -> bool {
        self.image == other.image || self.sample.agrees(other.sample)
    }

    /// Whether both are the same function: the field points and the real sample agree.
    pub(crate) fn agrees(&self, other: &Self) -> bool {
        self.image == other.image && self.sample.agrees(other.sample)
    }

    /// The quotient of two values.
    pub(crate) fn over(self, other: Self) -> Self {
        let image = |a: Element, b: Element| a * b.inverse();
        self.with(other, image, self.sample / other.sample)
    }

    /// The square root.
    pub(crate) fn square_root(self) -> Self {
        let root = |a: Element| a.square_root().unwrap_or_else(|| free(1, &[a]));
        Self {
            image: self.image.map(root),
            sample: self.sample.sqrt(),
        }
    }

    /// The sign, hashed from the canonical one of ±a so that it is an odd function.
    ///
    /// The size of the sample is hashed, too: with ±1, the factors sign(a) ± 1 could vanish there,
    /// and a sample of zero confirms nothing.
    pub(crate) fn sign(self) -> Self {
        let sign = |a: Element| {
            let ([key], negative) = canonical([a]);
            let value = free(2, &[key, Element::ZERO]);
            if negative { -value } else { value }
        };
        let ([key], _) = canonical([self.image[0]]);
        let size = Sample::of_bits(free(6, &[key]).parts().0);
        Self {
            image: self.image.map(sign),
            sample: size * Sample::real(self.sample.re().signum()),
        }
    }

    /// Cosine of a value that is not a known angle of the field.
    ///
    /// For known angles see [`Arena::turn_fingerprints`](super::Arena::turn_fingerprints).
    pub(crate) fn cosine(self) -> Self {
        Self {
            image: self.image.map(|a| free(4, &[a])),
            sample: Sample::real(self.sample.re().cos()),
        }
    }

    /// Sine of a value that is not a known angle of the field.
    pub(crate) fn sine(self) -> Self {
        Self {
            image: self.image.map(|a| free(5, &[a])),
            sample: Sample::real(self.sample.re().sin()),
        }
    }

    /// The angle of the direction (`x`, self).
    pub(crate) fn arc_tangent(self, x: Self) -> Self {
        let angle = self.sample.re().atan2(x.sample.re());
        self.with(x, |y, x| free(3, &[y, x]), Sample::real(angle))
    }

    fn with(
        self,
        other: Self,
        image: impl Fn(Element, Element) -> Element,
        sample: Sample,
    ) -> Self {
        Self {
            image: std::array::from_fn(|point| image(self.image[point], other.image[point])),
            sample,
        }
    }
}

impl Neg for Fingerprint {
    type Output = Self;
    fn neg(self) -> Self {
        Self {
            image: self.image.map(Neg::neg),
            sample: -self.sample,
        }
    }
}

impl Add for Fingerprint {
    type Output = Self;
    fn add(self, other: Self) -> Self {
        self.with(other, |a, b| a + b, self.sample + other.sample)
    }
}

impl Mul for Fingerprint {
    type Output = Self;
    fn mul(self, other: Self) -> Self {
        self.with(other, |a, b| a * b, self.sample * other.sample)
    }
}
