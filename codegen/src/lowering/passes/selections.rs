//! A product with the sign of something is a selection, not a multiplication.

use crate::lowering::SearchLimits;
use crate::lowering::dag::{Dag, Definition, Edge};

/// Writes x × sign(y) as x with the sign of y.
pub(super) fn run(dag: &mut Dag, _: &SearchLimits) {
    for node in 0..dag.len() {
        if let Definition::Product(a, b) = dag.definition(node)
            && let Some(selection) = selection(dag, a, b)
        {
            dag.redefine(node, selection);
        }
    }
    dag.measure_depths();
}

fn selection(dag: &Dag, a: Edge, b: Edge) -> Option<Definition> {
    let sign_of = |edge: Edge| match dag.definition(edge.node()) {
        Definition::Sign(of) => Some(of.times(edge.is_negative())),
        _ => None,
    };
    let by = |value: Edge, of: Edge| Definition::Selection(value, of);
    let first = sign_of(a).map(|of| by(b, of));
    first.or_else(|| sign_of(b).map(|of| by(a, of)))
}
