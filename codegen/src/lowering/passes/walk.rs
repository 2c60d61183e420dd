//! A walk among forms of equal cost.
//!
//! When no replacement saves operations, many cost nothing. From the forms that they lead to,
//! others may save operations again (plateau moves: B. Selman, H. Kautz, B. Cohen, 1994). So every
//! node with other forms of equal cost gets a pseudo-random one of them. The search goes on from
//! there, as long as it saves operations.

use super::single_replacements::fits;
use super::{repair, replacements};
use crate::cas::Stream;
use crate::lowering::SearchLimits;
use crate::lowering::dag::Dag;

/// Largest error of a form of equal cost, relative to the node's own.
const LOSS: f64 = 2.0;

/// Improves a graph in which single replacements save nothing.
pub(super) fn run(dag: &mut Dag, limits: &SearchLimits) {
    if dag.len() > limits.walk_nodes {
        return;
    }
    let mut stream = Stream::new(1);
    let mut best = dag.total();
    let mut fruitless = 0;
    for _ in 0..limits.walk_steps {
        let before = dag.snapshot();
        step(dag, &mut stream);
        replacements::settle(dag, limits, limits.walk_pair_rounds);
        repair::improve(dag);
        let total = dag.total();
        fruitless = if total < best { 0 } else { fruitless + 1 };
        if total > best {
            dag.restore(before);
        }
        best = best.min(total);
        if fruitless == limits.walk_patience {
            return;
        }
    }
}

/// Gives every node a random form among those of equal cost, including its own.
fn step(dag: &mut Dag, stream: &mut Stream) {
    let mut divisors = dag.divisors();
    for node in 0..dag.len() {
        dag.refresh(node);
        if !dag.is_open(node) {
            continue;
        }
        let mut forms = dag.forms(node, &divisors);
        forms.retain(|&by| dag.saving(node, by) >= 0 && fits(dag, by, node, LOSS));
        let drawn = stream.below(forms.len() + 1);
        if let Some(&by) = forms.get(drawn) {
            dag.replace(node, by);
            divisors = dag.divisors();
        }
    }
}
