//! Cheaper ways to write a function's nodes, found by looking up their values.
//!
//! Every node has a fingerprint, its values at two random points of the field
//! ([`cas`](crate::cas)). Whatever has the fingerprint of a node can stand for it. So for a node that is
//! expensive, the search asks a table of values: is it the sum, the difference, the product or the
//! quotient of two nodes that are there anyway? And if not: of one node that is there and one that could
//! be had by a single operation, best of all an operation that serves several such nodes
//! at once? These are the tricks a hand finds (1 + cot² = 1/sin², factoring, common parts of sums),
//! found without knowing any of them.
//!
//! What a replacement saves is counted exactly: the operations that nothing else needs any more
//! (the node's *maximal fan-out free cone*, as in the resubstitution of logic synthesis), less those
//! that it adds. No new divisor is ever introduced, so the function is defined wherever it was, and no sum
//! that cancels near singular configurations where the form that it replaces does not.

mod cone;
mod digits;
mod graph;
mod pairs;
mod sieve;
mod singles;

pub use digits::Home;
pub use graph::{Overlay, Place, Rewritten};

use crate::cas::{Arena, Expr};
use graph::Graph;

/// How often pairs are searched at most: a later round has only what the earlier ones opened up.
const ROUNDS: usize = 4;

/// How hard a function's operations are searched.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default, PartialOrd, Ord)]
pub enum Effort {
    /// Not at all: the derivation's own form.
    None,
    /// Nodes that are one operation away from others.
    #[default]
    Quick,
    /// Also those that are two operations away, and operations that serve several nodes.
    Thorough,
}

impl Effort {
    /// All, the least first.
    pub const ALL: [Self; 3] = [Self::None, Self::Quick, Self::Thorough];

    /// The name in descriptions, attributes and on the command line.
    #[must_use]
    pub const fn name(self) -> &'static str {
        match self {
            Self::None => "none",
            Self::Quick => "quick",
            Self::Thorough => "thorough",
        }
    }

    /// The effort of that name.
    #[must_use]
    pub fn named(name: &str) -> Option<Self> {
        Self::ALL.into_iter().find(|effort| effort.name() == name)
    }
}

/// Other definitions for some of the nodes that the entries need. `home` are the inputs in the home
/// configuration.
#[must_use]
pub fn search<'a>(
    arena: &'a Arena,
    entries: &[Expr<'a>],
    guards: &[Expr<'a>],
    effort: Effort,
    home: Home<'_>,
) -> Overlay {
    if effort == Effort::None {
        return Overlay::default();
    }
    let mut graph = Graph::new(arena, entries, guards, home);
    let mut rounds = if effort == Effort::Thorough {
        ROUNDS
    } else {
        0
    };
    let mut known = singles::Known::new(&graph);
    loop {
        let mut saved = singles::improve(&mut graph, &mut known);
        if rounds > 0 {
            rounds -= 1;
            saved += pairs::improve(&mut graph);
            // There are new nodes.
            known = singles::Known::new(&graph);
        }
        if saved == 0 {
            return graph.overlay();
        }
    }
}
