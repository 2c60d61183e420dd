//! Products with a reciprocal that has no other user become quotients.

use crate::lowering::SearchLimits;
use crate::lowering::dag::{Dag, Definition, Edge};

/// Replaces x × (1 / y) by x / y.
pub(super) fn run(dag: &mut Dag, _: &SearchLimits) {
    for node in 0..dag.len() {
        if let Definition::Product(a, b) = dag.definition(node)
            && let Some(quotient) = quotient(dag, a, b)
        {
            dag.redefine(node, quotient);
        }
    }
    dag.measure_depths();
}

fn quotient(dag: &Dag, a: Edge, b: Edge) -> Option<Definition> {
    let reciprocal_of = |edge: Edge| match dag.definition(edge.node()) {
        Definition::Quotient(one, of) if dag.is_one(one) && dag.uses(edge.node()) == 1 => {
            Some(of.times(edge.is_negative()))
        }
        _ => None,
    };
    let first = reciprocal_of(a).map(|of| Definition::Quotient(b, of));
    first.or_else(|| reciprocal_of(b).map(|of| Definition::Quotient(a, of)))
}
