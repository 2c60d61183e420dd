//! What a node means: its values at the random points of the field and at the real sample point.

use super::super::field::{CIRCLE, Element, mix, mix_name};
use super::super::sample::Sample;
use super::{Fingerprint, Handle, Op, Tables, canonical};
use std::ops::{Add, Mul, Neg};

impl Tables {
    fn image(&self, handle: Handle, point: usize) -> Element {
        let image = self.nodes[handle.index()].fingerprint.image[point];
        if handle.is_negative() { -image } else { image }
    }

    pub(super) fn sample(&self, handle: Handle) -> Sample {
        let sample = self.nodes[handle.index()].fingerprint.sample;
        if handle.is_negative() {
            -sample
        } else {
            sample
        }
    }

    /// The magnitude against which rounding of the node's sample is judged.
    pub(super) fn operand_size(&self, op: &Op) -> f64 {
        match op {
            Op::Add(a, b) | Op::Sub(a, b) => self.sample(*a).size().max(self.sample(*b).size()),
            _ => 0.0,
        }
    }

    pub(super) fn fingerprint(&self, op: &Op) -> Fingerprint {
        Fingerprint {
            image: std::array::from_fn(|point| self.image_of(op, point)),
            sample: self.sample_of(op),
        }
    }

    fn image_of(&self, op: &Op, point: usize) -> Element {
        let image = |handle: &Handle| self.image(*handle, point);
        match op {
            Op::Constant(id) => self.constants[*id as usize].image(),
            Op::Symbol(id) => {
                let name = &self.symbols[id.0 as usize].name;
                Element::from_bits(mix(mix_name(name) ^ (point as u64 + 101)))
            }
            Op::Cosine(id) => self.circle(*id, point).cosine_and_sine().0,
            Op::Sine(id) => self.circle(*id, point).cosine_and_sine().1,
            Op::Add(a, b) => image(a) + image(b),
            Op::Sub(a, b) => image(a) - image(b),
            Op::Mul(a, b) => image(a) * image(b),
            Op::Div(a, b) => image(a) * image(b).inverse(),
            Op::Sqrt(a) => image(a)
                .square_root()
                .unwrap_or_else(|| free(1, &[image(a)])),
            // Odd in its argument: the canonical one of ±a is hashed, the sign put back.
            Op::Sign(a) => {
                let (key, negative) = canonical([image(a), Element::ZERO]);
                let value = free(2, &key);
                if negative { -value } else { value }
            }
            Op::Atan2(y, x) => free(3, &[image(y), image(x)]),
        }
    }

    fn circle(&self, direction: u32, point: usize) -> Element {
        let direction = &self.directions[direction as usize];
        let mut result = direction.offset().circle_point();
        for &(symbol, factor) in direction.terms() {
            let unit = self.symbols[symbol.0 as usize].circle[point];
            let count = factor.numerator().rem_euclid(i128::from(CIRCLE)) as u64;
            let turned = unit.power(count);
            // A part of an angle is a free angle of its own.
            result = result
                * if factor.denominator() == 1 {
                    turned
                } else {
                    Element::circle_point(mix(turned.parts().0 ^ mix(factor.denominator() as u64)))
                };
        }
        result
    }

    fn sample_of(&self, op: &Op) -> Sample {
        let sample = |handle: &Handle| self.sample(*handle);
        match op {
            Op::Constant(id) => Sample::real(self.constants[*id as usize].value()),
            Op::Symbol(id) => Sample::real(self.symbols[id.0 as usize].sample),
            Op::Cosine(id) => Sample::real(self.angle_sample(*id).cos()),
            Op::Sine(id) => Sample::real(self.angle_sample(*id).sin()),
            Op::Add(a, b) => sample(a) + sample(b),
            Op::Sub(a, b) => sample(a) - sample(b),
            Op::Mul(a, b) => sample(a) * sample(b),
            Op::Div(a, b) => sample(a) / sample(b),
            Op::Sqrt(a) => sample(a).sqrt(),
            Op::Sign(a) => Sample::real(sample(a).re().signum()),
            Op::Atan2(y, x) => Sample::real(sample(y).re().atan2(sample(x).re())),
        }
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

/// A value of a function about which nothing is known but its arguments.
fn free(tag: u64, arguments: &[Element]) -> Element {
    let bits = arguments.iter().fold(mix(tag), |bits, argument| {
        let (re, im) = argument.parts();
        mix(mix(bits ^ re) ^ im)
    });
    Element::from_bits(bits)
}

impl Fingerprint {
    /// Of what has none.
    pub(crate) const NONE: Self = Self {
        image: [Element::ZERO; super::POINTS],
        sample: Sample::real(f64::NAN),
    };

    /// The value at the first point.
    pub(crate) const fn value(&self) -> Element {
        self.image[0]
    }

    /// Whether both are the same function, as far as all points tell.
    pub(crate) fn agrees(&self, other: &Self) -> bool {
        self.image == other.image && self.sample.agrees(other.sample)
    }

    /// The quotient of two values.
    pub(crate) fn over(self, other: Self) -> Self {
        let inverse = Self {
            image: other.image.map(Element::inverse),
            sample: Sample::real(1.0) / other.sample,
        };
        self * inverse
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
