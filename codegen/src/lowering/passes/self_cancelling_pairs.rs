//! Pairs whose value only they themselves request.
//!
//! t = c + m requests m = t - c, and the pair of t and c has that value. Such a pair saves nothing,
//! but a third of all pairs are of this kind. They are excluded before a value is looked up.

use super::requests::{Form, Request};

/// Operation on a pair, as a bit.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum PairOperation {
    Sum = 1,
    Difference = 2,
    Product = 4,
}

/// Two nodes, the smaller first, and the operation on them.
type Pair = ((u32, u32), PairOperation);

/// For each two nodes of a group, the operations whose values only they request.
pub(super) struct SelfCancellingPairs {
    /// Index of each node in the group.
    places: Vec<u32>,
    size: usize,
    /// The bits of a smaller node with all others, for one node after the other.
    bits: Vec<u8>,
}

impl SelfCancellingPairs {
    /// Collects the pairs; `heads` has the last of the requests for each value.
    pub(super) fn new(
        group: &[usize],
        requests: &[Request],
        heads: impl Iterator<Item = u32>,
    ) -> Self {
        let nodes = group.iter().max().map_or(0, |last| last + 1);
        let mut own = Self {
            places: vec![0; nodes],
            size: group.len(),
            bits: vec![0; group.len() * group.len()],
        };
        for (place, &node) in group.iter().enumerate() {
            own.places[node] = place as u32;
        }
        for ((first, second), kind) in heads.filter_map(|head| only_pair(requests, head)) {
            let at = own.row(first as usize) + own.places[second as usize] as usize;
            own.bits[at] |= kind as u8;
        }
        own
    }

    /// Start of the bits of a node with all nodes of the group.
    fn row(&self, node: usize) -> usize {
        self.places[node] as usize * self.size
    }

    /// The bits of a node with the nodes of the group from itself on.
    pub(super) fn with_later(&self, place: usize) -> &[u8] {
        &self.bits[place * self.size + place..(place + 1) * self.size]
    }
}

/// The pair that makes all requests for a value, if there is only one.
fn only_pair(requests: &[Request], head: u32) -> Option<Pair> {
    let first = &requests[head as usize];
    let pair = pair_of(first)?;
    let mut at = first.next;
    while let Some(number) = at {
        let request = &requests[number as usize];
        if pair_of(request) != Some(pair) {
            return None;
        }
        at = request.next;
    }
    Some(pair)
}

/// The pair of a request's target and existing node, if it has the requested value.
fn pair_of(request: &Request) -> Option<Pair> {
    let kind = match request.form {
        Form::Plus if request.with.is_negative() => PairOperation::Sum,
        Form::Plus => PairOperation::Difference,
        Form::Over => PairOperation::Product,
        Form::Times => return None,
    };
    let (target, with) = (request.target, request.with.node() as u32);
    Some(((target.min(with), target.max(with)), kind))
}
