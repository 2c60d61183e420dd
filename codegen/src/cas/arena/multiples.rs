//! Nodes that are multiples of other nodes.

use super::super::field::Element;
use super::super::sample::Sample;
use super::{Arena, Fingerprint, Handle, Op, Tables};
use overact_exact::Number;
use overact_exact::Ratio;

impl Arena {
    /// Enables reuse of nodes that differ by a fraction of a known irrational constant.
    ///
    /// Multiples by fractions are always reused.
    pub(crate) fn find_irrational_multiples(&self) {
        self.tables.borrow_mut().finds_irrational = true;
    }

    /// A rational multiple of an existing node if there is one, otherwise a new node.
    pub(super) fn multiple_or_new(&self, op: Op, fingerprint: Fingerprint) -> Handle {
        let scaled = match op {
            Op::Mul(a, b) => self.is_constant(a) || self.is_constant(b),
            Op::Constant(_) => true,
            _ => false,
        };
        let key = if scaled {
            None
        } else {
            ratio_key(&fingerprint)
        };
        let multiple = match op {
            Op::Symbol(_) => None,
            _ => key.and_then(|key| self.proportional(key, &fingerprint)),
        };
        let multiple = multiple.filter(|h| self.fits(&op, *h));
        multiple.unwrap_or_else(|| self.push(op, fingerprint, key))
    }

    /// The existing node of which this is a multiple, scaled.
    pub(super) fn multiple(&self, fingerprint: &Fingerprint) -> Option<Handle> {
        self.proportional(ratio_key(fingerprint)?, fingerprint)
    }

    /// This value as an existing node times a fraction or a known constant.
    fn proportional(&self, key: Element, fingerprint: &Fingerprint) -> Option<Handle> {
        let (other, factor) = {
            let tables = self.tables.borrow();
            let other = *tables.by_ratio.get(&key)?;
            let theirs = tables.nodes[other as usize].fingerprint;
            let ratio = fingerprint.image[0] * theirs.image[0].inverse();
            if ratio * theirs.image[1] != fingerprint.image[1] {
                return None;
            }
            let factor = match ratio.to_rational() {
                Some((n, d)) => Number::ratio(Ratio::new(n.into(), d.into())?),
                None if tables.finds_irrational => tables.fraction_of_constant(ratio)?,
                None => return None,
            };
            if !(theirs.sample * Sample::real(factor.value())).agrees(fingerprint.sample) {
                return None;
            }
            (other, factor)
        };
        let factor = self.constant(factor);
        let product = Op::Mul(factor.positive(), Handle::new(other as usize, false));
        Some(self.intern(product).with_sign_of(factor.is_negative()))
    }
}

impl Tables {
    /// The constant of this value, as a fraction of a known constant or of its reciprocal.
    ///
    /// From √3/2, for instance, it finds 2/√3, 1/√3 and √3.
    fn fraction_of_constant(&self, value: Element) -> Option<Number> {
        /// Larger numerators and denominators may match by chance.
        const LARGEST: i64 = 1 << 20;
        let irrational = self.constants.iter().filter(|own| own.as_ratio().is_none());
        irrational.copied().find_map(|own| {
            let inverse = own.image().inverse();
            [(inverse, own), (own.image(), Number::ONE / own)]
                .into_iter()
                .find_map(|(image, number)| {
                    let (n, d) = (value * image).to_rational()?;
                    let is_small = n.abs() < LARGEST && d < LARGEST;
                    is_small.then_some(())?;
                    Some(Number::ratio(Ratio::new(n.into(), d.into())?) * number)
                })
        })
    }
}

/// Ratio of the values at the two points, equal for nodes that differ by a constant factor.
fn ratio_key(fingerprint: &Fingerprint) -> Option<Element> {
    (fingerprint.image[1] != Element::ZERO)
        .then(|| fingerprint.image[0] * fingerprint.image[1].inverse())
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::cas::CosineSine;
    use crate::cas::Direction;
    use overact_exact::Angle;

    /// c (√3/2 c q) + s (√3/2 s q) is √3/2 q once multiples of constants are looked for.
    #[test]
    fn a_determinant_of_a_rotated_leg_is_a_multiple_of_its_length() {
        let sixty = Direction::constant(Angle::half_turns(Ratio::new(1, 3).unwrap_or(Ratio::ONE)));
        let by_length = |finds: bool| {
            let arena = Arena::new();
            if finds {
                arena.find_irrational_multiples();
            }
            let q = arena.input("joints", 0);
            let CosineSine { cosine: c, sine: s } =
                arena.cosine_and_sine(&arena.input_angle("joints", 1));
            let root = arena.cosine_and_sine(&sixty).sine;
            let determinant = c * (root * (c * q)) + s * (root * (s * q));
            let (factor, base) = determinant.factor_and_base();
            (factor.value(), base == q)
        };
        let (factor, is_length) = by_length(true);
        assert!(is_length);
        assert!((factor - 0.75_f64.sqrt()).abs() < 1e-15, "{factor}");
        assert!(!by_length(false).1);
    }
}
