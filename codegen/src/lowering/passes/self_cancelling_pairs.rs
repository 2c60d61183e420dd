//! Pairs whose value only they themselves ask for.
//!
//! t = c + m asks for m = t - c, and the pair of t and c has that value. Nothing is saved by it, but a third
//! of all pairs are such ones: they are known before a value is looked up.

use super::requests::{Form, Request};

/// What is done with a pair, as a bit.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum Kind {
    Sum = 1,
    Difference = 2,
    Product = 4,
}

/// Two nodes, the smaller first, and what is done with them.
type Pair = ((u32, u32), Kind);

/// For each two of a group's nodes which of their values only they ask for.
pub(super) struct SelfCancellingPairs {
    /// The number of each node in the group.
    places: Vec<u32>,
    size: usize,
    /// The bits of a smaller node with all others, for one node after the other.
    bits: Vec<u8>,
}

impl SelfCancellingPairs {
    /// Of the requests that have a value in common, the last of each in `heads`.
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

    /// Where the bits of a node with all nodes of the group begin.
    fn row(&self, node: usize) -> usize {
        self.places[node] as usize * self.size
    }

    /// The bits of a node with the nodes of the group from itself on.
    pub(super) fn with_later(&self, place: usize) -> &[u8] {
        &self.bits[place * self.size + place..(place + 1) * self.size]
    }
}

/// The pair that has the value which a request and those before it ask for, if they are all its own.
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

/// The pair of a request's target and the node with which it asks, if that has the value asked for.
fn pair_of(request: &Request) -> Option<Pair> {
    let kind = match request.form {
        Form::Plus if request.with.is_negative() => Kind::Sum,
        Form::Plus => Kind::Difference,
        Form::Over => Kind::Product,
        Form::Times => return None,
    };
    let (target, with) = (request.target, request.with.node() as u32);
    Some(((target.min(with), target.max(with)), kind))
}
