//! Prefilter for sums and products of two nodes, with one integer per node instead of a field
//! element.
//!
//! A sum of elements is the sum of their projections on the integers modulo the field's prime. A
//! product is the sum of their logarithms modulo a factor of the group's order. To test whether
//! some node has the difference or quotient of two values takes a subtraction and one bit. The bit
//! is zero for nearly all values that no node has.

use super::{Dag, Edge};
use crate::cas::field::{Element, LOGARITHMS, Logarithms};

/// Bits per node: about one in 16 values that no node has passes.
const BITS: usize = 32;

/// Projections and logarithms of all nodes, and bit tables of the existing ones.
#[derive(Debug, Clone)]
pub(super) struct CandidatePrefilter {
    projections: Vec<u64>,
    /// `None` for zero.
    logarithms: Vec<Option<u32>>,
    sums: Vec<u64>,
    products: Vec<u64>,
}

impl CandidatePrefilter {
    /// The prefilter of a graph's nodes; valid until nodes are added.
    pub(super) fn new(dag: &Dag) -> Self {
        let logarithms = Logarithms::get();
        let value = |node| dag.value(Edge::to(node));
        let values: Vec<Element> = (0..dag.len()).map(value).collect();
        // A power of two, so that a mask gives the place.
        let words = (values.len() * BITS / 64).max(1).next_power_of_two();
        let mut prefilter = Self {
            projections: values.iter().map(|v| v.projection()).collect(),
            logarithms: values.iter().map(|v| logarithms.of(*v)).collect(),
            sums: vec![0; words],
            products: vec![0; LOGARITHMS as usize / 64 + 1],
        };
        // A node represents its negative, too.
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

    /// Projections are random, so their own bits serve as a hash.
    fn place(&self, projection: u64) -> (usize, u64) {
        let word = (projection >> 6) as usize & (self.sums.len() - 1);
        (word, 1 << (projection & 63))
    }

    /// Whether some node or its negative may be `target` - `other`, or `target` + `other` if
    /// `negative`.
    pub(super) fn may_be_sum(&self, target: usize, other: usize, negative: bool) -> bool {
        let (target, other) = (self.projections[target], self.projections[other]);
        let (word, bit) = self.place(Element::projected_difference(target, other, negative));
        self.sums[word] & bit != 0
    }

    /// Whether some node or its negative may be `target` / `other`.
    pub(super) fn may_be_product(&self, target: usize, other: usize) -> bool {
        let (Some(target), Some(other)) = (self.logarithms[target], self.logarithms[other]) else {
            return false;
        };
        self.may_have_logarithm(target + LOGARITHMS - other)
    }

    /// Whether some node or its negative may be `target` times `other`.
    pub(super) fn may_be_quotient(&self, target: usize, other: usize) -> bool {
        let (Some(target), Some(other)) = (self.logarithms[target], self.logarithms[other]) else {
            return true;
        };
        self.may_have_logarithm(target + other)
    }

    /// Whether a node has a logarithm, given below twice the modulus.
    fn may_have_logarithm(&self, logarithm: u32) -> bool {
        let at = match logarithm.checked_sub(LOGARITHMS) {
            Some(reduced) => reduced,
            None => logarithm,
        } as usize;
        self.products[at / 64] & (1 << (at % 64)) != 0
    }
}
