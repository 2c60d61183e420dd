//! Replaces nodes that are one operation from two others.

#[cfg(test)]
use crate::lowering::SearchLimits;
use crate::lowering::dag::{Dag, Definition};

/// Largest error of a cheaper form, relative to the node's own.
pub(super) const LOSS: f64 = 10.0;

/// The pass for tests: repeats until nothing is saved.
#[cfg(test)]
pub(super) fn run(dag: &mut Dag, limits: &SearchLimits) {
    while limits.replaces && improve(dag) > 0 {}
}

/// Replaces every node for which that saves operations; returns the operations saved.
pub(super) fn improve(dag: &mut Dag) -> i32 {
    let mut saved = 0;
    let mut divisors = dag.divisors();
    for node in 0..dag.len() {
        dag.refresh(node);
        if dag.is_open(node)
            && dag.cone(node) > 1
            && let Some((by, saving)) = best(dag, node, &divisors)
        {
            dag.replace(node, by);
            divisors = dag.divisors();
            saved += saving;
        }
    }
    saved
}

/// The replacement of a node that saves most, if any saves operations.
fn best(dag: &mut Dag, node: usize, divisors: &[usize]) -> Option<(Definition, i32)> {
    let mut best: Option<(Definition, i32)> = None;
    for by in dag.forms(node, divisors) {
        let saving = dag.saving(node, by);
        if saving > best.map_or(0, |(_, saving)| saving) && fits(dag, by, node, LOSS) {
            best = Some((by, saving));
        }
    }
    best
}

/// Whether a form can replace a node.
///
/// It must not depend on the node, must have its value, and an error of at most `loss` times the
/// node's own.
pub(super) fn fits(dag: &Dag, by: Definition, node: usize, loss: f64) -> bool {
    !dag.depend(by.operands(), node) && dag.means(by, node) && dag.loss(by, node) <= loss
}
