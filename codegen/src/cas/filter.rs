//! Bloom-like filter: a fast test that a value is not in a set.

use super::field::Element;
use super::hasher::FieldHasher;
use std::hash::{Hash, Hasher};

/// Bits of a filter for each value.
const FILTER_BITS: usize = 32;

/// Excludes, with one access to a small table, that a value is in a set.
///
/// The map of the values itself is large, and misses in it take most of the time if hits are rare.
pub(crate) struct Filter {
    bits: Vec<u64>,
    /// Shift that turns a hash into a bit number.
    shift: u32,
}

impl Filter {
    /// A filter of `count` values.
    pub(crate) fn new<'a>(values: impl Iterator<Item = &'a Element>, count: usize) -> Self {
        let size = (count * FILTER_BITS).next_power_of_two().max(64);
        let mut filter = Self {
            bits: vec![0; size / 64],
            shift: u64::BITS - size.trailing_zeros(),
        };
        for value in values {
            let (word, bit) = filter.place(value);
            filter.bits[word] |= bit;
        }
        filter
    }

    /// Whether the value may be in the set; false positives occur.
    pub(crate) fn may_hold(&self, value: &Element) -> bool {
        let (word, bit) = self.place(value);
        self.bits[word] & bit != 0
    }

    fn place(&self, value: &Element) -> (usize, u64) {
        let mut hasher = FieldHasher::default();
        value.hash(&mut hasher);
        let number = hasher.finish() >> self.shift;
        ((number / 64) as usize, 1 << (number % 64))
    }
}

#[cfg(test)]
mod tests {
    use super::{Element, Filter};

    #[test]
    fn the_filter_contains_its_values_and_few_others() {
        let all: Vec<Element> = (0..20_000).map(|k| Element::integer(k * k + 7)).collect();
        let filter = Filter::new(all[..10_000].iter(), 10_000);
        let held = |part: &[Element]| part.iter().filter(|one| filter.may_hold(one)).count();
        assert_eq!(held(&all[..10_000]), 10_000);
        assert!(held(&all[10_000..]) < 1_000, "{}", held(&all[10_000..]));
    }
}
