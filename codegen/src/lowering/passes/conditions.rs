//! A condition is computed from nothing that a later condition protects.
//!
//! The search may find that a leg's radicand is cheaper in terms of another leg's root. Where the other leg
//! is out of reach that root is no number, the radicand neither, and the wrong leg would be named. So what
//! is checked first gets the derivation's forms back, in which legs stand side by side.

use super::repair::keep;
use crate::lowering::SearchLimits;
use crate::lowering::dag::{Dag, Definition};
use std::collections::HashMap;

/// Undoes what makes conditions depend on later ones.
pub(super) fn run(dag: &mut Dag, limits: &SearchLimits) {
    if limits.replaces {
        improve(dag);
    }
}

/// Whatever the limits are.
pub(super) fn improve(dag: &mut Dag) {
    while let Some(culprit) = culprit(dag) {
        keep(dag, culprit);
    }
}

/// The node nearest to a condition, on the way to what a later one protects, that is written in another way
/// than in the derivation.
fn culprit(dag: &Dag) -> Option<usize> {
    let mut protected = HashMap::new();
    for (place, guard) in dag.guards().iter().enumerate() {
        protected.entry(guard.value.node()).or_insert(place);
    }
    let mut guards = dag.guards().iter().enumerate();
    guards.find_map(|(place, guard)| {
        let is_later = |node: usize| match dag.definition(node) {
            Definition::Root(of) | Definition::Quotient(_, of) => {
                protected.get(&of.node()).is_some_and(|by| *by > place)
            }
            _ => false,
        };
        let way = way(dag, guard.value.node(), is_later)?;
        way.into_iter().find(|&node| dag.own_form(node).is_some())
    })
}

/// The nodes from one down to the first that is wanted among those that it is computed from.
fn way(dag: &Dag, from: usize, is_wanted: impl Fn(usize) -> bool) -> Option<Vec<usize>> {
    let mut reached_from = HashMap::from([(from, from)]);
    let mut stack = vec![from];
    while let Some(node) = stack.pop() {
        if is_wanted(node) {
            let mut way = vec![node];
            let mut at = node;
            while at != from {
                at = reached_from[&at];
                way.push(at);
            }
            way.reverse();
            return Some(way);
        }
        for operand in dag.definition(node).operands() {
            reached_from.entry(operand).or_insert_with(|| {
                stack.push(operand);
                node
            });
        }
    }
    None
}
