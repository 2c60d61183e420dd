//! Removes dependencies of conditions on values that later conditions protect.
//!
//! The search may express a leg's radicand by another leg's root. If the other leg is out of reach,
//! its root is NaN and so is the radicand, and the error would name the wrong leg. So conditions
//! that are checked first get the derivation's forms back, in which legs are independent.

use super::repair::keep;
use crate::lowering::SearchLimits;
use crate::lowering::dag::{Dag, Definition};
use std::collections::HashMap;

/// Reverts replacements that make conditions depend on later ones.
pub(super) fn run(dag: &mut Dag, limits: &SearchLimits) {
    if limits.replaces {
        improve(dag);
    }
}

/// The pass regardless of the limits.
pub(super) fn improve(dag: &mut Dag) {
    while let Some(culprit) = culprit(dag) {
        keep(dag, culprit);
    }
}

/// The replaced node closest to a condition, on the path to a value that a later condition
/// protects.
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

/// The path from a node down to the first wanted one among its operands.
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
