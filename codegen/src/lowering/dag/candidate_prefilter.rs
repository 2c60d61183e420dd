//! Which sums and products of two nodes can have a value at all, by one number in place of an element.
//!
//! A sum of elements is a sum of their projections on the integers modulo the field's prime, and a
//! product a sum of their logarithms modulo a factor of the group's order. To ask whether some node has
//! the difference or the quotient of two values is then a subtraction and a look at one bit, which is
//! zero for all but a few of a hundred values that no node has.

use super::{Dag, Edge};
use crate::cas::field::{Element, LOGARITHMS, Logarithms};

/// Bits for each node: of the values that no node has, about one of 16 passes.
const BITS: usize = 32;

/// Projections and logarithms of all nodes, and which of them there are.
#[derive(Debug, Clone)]
pub(super) struct CandidatePrefilter {
    projections: Vec<u64>,
    /// None for zero.
    logarithms: Vec<Option<u32>>,
    sums: Vec<u64>,
    products: Vec<u64>,
}

impl CandidatePrefilter {
    /// That of a graph's nodes; valid until nodes are added.
    pub(super) fn new(dag: &Dag) -> Self {
        let logarithms = Logarithms::get();
        let value = |node| dag.value(Edge::to(node));
        let values: Vec<Element> = (0..dag.len()).map(value).collect();
        // A power of two of them, so that a mask finds the place.
        let words = (values.len() * BITS / 64).max(1).next_power_of_two();
        let mut prefilter = Self {
            projections: values.iter().map(|v| v.projection()).collect(),
            logarithms: values.iter().map(|v| logarithms.of(*v)).collect(),
            sums: vec![0; words],
            products: vec![0; LOGARITHMS as usize / 64 + 1],
        };
        // A node stands for its negative, too.
        for value in values.iter().flat_map(|v| [*v, -*v]) {
            let (word, bit) = prefilter.place(value.projection());
            prefilter.sums[word] |= bit;
        }
        for logarithm in prefilter.logarithms.iter().flatten() {
            let at = *logarithm as usize;
            prefilter.products[at / 64] |= 1 << (at % 64);
        }
        prefilter
    }

    /// Projections are random, so their own bits are a hash of them.
    fn place(&self, projection: u64) -> (usize, u64) {
        let word = (projection >> 6) as usize & (self.sums.len() - 1);
        (word, 1 << (projection & 63))
    }

    /// Whether some node may be `target` - `other`, or `target` + `other` if that is `negative`, or the
    /// negative of it.
    pub(super) fn may_be_sum(&self, target: usize, other: usize, negative: bool) -> bool {
        let (target, other) = (self.projections[target], self.projections[other]);
        let (word, bit) = self.place(Element::projected_difference(target, other, negative));
        self.sums[word] & bit != 0
    }

    /// Whether some node may be `target` / `other`, or the negative of it.
    pub(super) fn may_be_product(&self, target: usize, other: usize) -> bool {
        let (Some(target), Some(other)) = (self.logarithms[target], self.logarithms[other]) else {
            return false;
        };
        let at = match target.checked_sub(other) {
            Some(difference) => difference,
            None => target + LOGARITHMS - other,
        } as usize;
        self.products[at / 64] & (1 << (at % 64)) != 0
    }
}
