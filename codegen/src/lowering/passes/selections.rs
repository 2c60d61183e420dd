//! Replaces products x × sign(y) by one operation, `Selection`.
//!
//! The backends write it as a call of `signed`. It counts as one operation, as the product did.

use crate::lowering::SearchLimits;
use crate::lowering::dag::{Dag, Definition, Edge};

/// Replaces the products of all nodes.
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

/// The selection that equals a × b, if a or b is a sign.
fn selection(dag: &Dag, a: Edge, b: Edge) -> Option<Definition> {
    let sign_of = |edge: Edge| match dag.definition(edge.node()) {
        Definition::Sign(of) => Some(of.times(edge.is_negative())),
        _ => None,
    };
    let by = |value: Edge, of: Edge| Definition::Selection(value, of);
    let first = sign_of(a).map(|of| by(b, of));
    first.or_else(|| sign_of(b).map(|of| by(a, of)))
}
