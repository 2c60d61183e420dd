//! Removes guards whose value is neither a divisor nor a radicand; guards on the pose are kept.

use crate::lowering::SearchLimits;
use crate::lowering::dag::{Dag, Definition};

/// Removes unneeded guards, with nodes that only they use.
pub(super) fn run(dag: &mut Dag, _: &SearchLimits) {
    let needed = dag.needed(dag.entries().iter().map(|entry| entry.node()));
    let mut matters = vec![false; dag.len()];
    for node in (0..dag.len()).filter(|&node| needed[node]) {
        if let Definition::Quotient(_, of) | Definition::Root(of) = dag.definition(node) {
            matters[of.node()] = true;
        }
    }
    dag.retain_guards(|guard| guard.condition.is_of_pose() || matters[guard.value.node()]);
}
