//! A table that excludes most values that occur only once.
//!
//! Of the millions of values of pairs and requests, nearly all occur once, and a map of all of them
//! is larger than the processor's caches. Here each value has a cell of two bits, which it shares
//! with few others: no value, one, or several. Values are counted by the projection of a field
//! element, without its sign.

use crate::cas::field::Element;

/// Cells for each value: about one in ten values that occur once seems to occur several times.
const CELLS: usize = 8;

/// Cells of a word.
const PER_WORD: usize = u64::BITS as usize / 2;

/// Multiplier that spreads projections, which are sums of others, over the cells.
const SPREAD: u64 = 0x9e37_79b9_7f4a_7c15;

/// Cells that tell whether a value occurs several times.
pub(super) struct RepeatedValues {
    cells: Vec<u64>,
    /// Shift that turns a hash into the number of a cell.
    shift: u32,
}

impl RepeatedValues {
    /// A table for this number of values.
    pub(super) fn new(values: usize) -> Self {
        let size = (values * CELLS).next_power_of_two().max(PER_WORD);
        Self {
            cells: vec![0; size / PER_WORD],
            shift: u64::BITS - size.trailing_zeros(),
        }
    }

    /// Counts a value by its projection.
    pub(super) fn count(&mut self, projection: u64) {
        let (word, bit) = self.place(projection);
        let word = &mut self.cells[word];
        // The second bit of the cell is set if the first one was set before.
        *word |= 1 << bit | (*word >> bit & 1) << (bit + 1);
    }

    /// Whether a value may have been counted several times.
    pub(super) fn may_repeat(&self, projection: u64) -> bool {
        let (word, bit) = self.place(projection);
        self.cells[word] >> bit & 2 != 0
    }

    /// Word and first bit of a value's cell.
    fn place(&self, projection: u64) -> (usize, u32) {
        let hash = Element::projection_without_sign(projection).wrapping_mul(SPREAD);
        let cell = (hash >> self.shift) as usize;
        (cell / PER_WORD, 2 * (cell % PER_WORD) as u32)
    }
}

#[cfg(test)]
mod tests {
    use super::RepeatedValues;
    use crate::cas::field::{Element, mix};

    #[test]
    fn repeated_values_and_few_others_are_found() {
        let value = |k: u64| Element::from_bits(mix(k));
        let mut table = RepeatedValues::new(15_000);
        for k in 0..10_000 {
            table.count(value(k).projection());
        }
        for k in 0..5_000 {
            table.count((-value(k)).projection());
        }
        let found = |from: u64, to: u64| {
            let found = (from..to).filter(|k| table.may_repeat(value(*k).projection()));
            found.count()
        };
        assert_eq!(found(0, 5_000), 5_000);
        assert!(found(5_000, 10_000) < 800, "{}", found(5_000, 10_000));
        assert!(found(10_000, 15_000) < 400, "{}", found(10_000, 15_000));
    }
}
