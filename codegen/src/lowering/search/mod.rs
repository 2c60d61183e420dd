//! Cheaper ways to write a function's nodes, found by looking up their values.
//!
//! Every node has a fingerprint, its values at two random points of the field
//! (`cas`). Whatever has the fingerprint of a node can stand for it. So for a node that is
//! expensive, the search asks a table of values: is it the sum, the difference, the product or the
//! quotient of two nodes that are there anyway? And if not: of one node that is there and one that could
//! be had by a single operation, best of all an operation that serves several such nodes
//! at once? These are the tricks a hand finds (1 + cot² = 1/sin², factoring, common parts of sums),
//! found without knowing any of them.
//!
//! What a replacement saves is counted exactly: the operations that nothing else needs any more
//! (the node's *maximal fan-out free cone*, as in the resubstitution of logic synthesis), less those
//! that it adds. The tree of dominators says at once which operations these can be, so that of the
//! millions of sums and products of two nodes only those few are tried that may save something. Where
//! nothing saves any more, a walk among forms of equal cost goes on. No new divisor is ever introduced, so
//! the function is defined wherever it was, and no sum that cancels near singular configurations where
//! the form that it replaces does not.

mod cone;
mod digits;
mod dominators;
mod effort;
mod graph;
mod pairs;
mod rays;
mod repair;
mod sieve;
mod singles;
mod walk;

pub use effort::Reach;
pub use graph::{Overlay, Place, Rewritten};
pub use rays::States;

use crate::cas::{Arena, Expr};
use graph::Graph;

/// Other definitions for some of the nodes that the entries need. Forms are compared at the `states`.
#[must_use]
pub fn search<'a>(
    arena: &'a Arena,
    entries: &[Expr<'a>],
    guards: &[Expr<'a>],
    reach: Reach,
    states: &States<'_>,
) -> Overlay {
    if reach == Reach::Nothing {
        return Overlay::default();
    }
    let mut graph = Graph::new(arena, entries, guards, states);
    let mut known = singles::Known::new(&graph);
    let rounds = reach.rounds(graph.len());
    settle(&mut graph, &mut known, reach, rounds);
    repair::improve(&mut graph);
    walk::improve(&mut graph, &mut known, reach);
    walk::come_home(&mut graph);
    repair::improve(&mut graph);
    graph.overlay()
}

/// Replaces nodes as long as that saves anything, with so many rounds of pairs at most.
fn settle(graph: &mut Graph, known: &mut singles::Known, reach: Reach, mut rounds: usize) {
    loop {
        let mut saved = singles::improve(graph, known);
        if rounds > 0 {
            rounds -= 1;
            let by_pairs = pairs::improve(graph, reach.whole());
            if by_pairs > 0 {
                // There are new nodes.
                *known = singles::Known::new(graph);
            }
            saved += by_pairs;
        }
        if saved == 0 {
            return;
        }
    }
}
