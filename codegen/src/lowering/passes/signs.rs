//! Moves signs outwards, where they cost nothing.
//!
//! A product with a negative is the negative of a product, and -a - b is -(a + b). The node
//! computes the value without the sign, and the sign moves to its users. Only differences and
//! negative entries remain. Signs of constants are merged into the constants, except in
//! differences.

use crate::cas::hasher::QuickMap;
use crate::lowering::SearchLimits;
use crate::lowering::dag::{Constant, Dag, Definition, Edge, Origin};

/// Moves the signs of all nodes.
pub(super) fn run(dag: &mut Dag, _: &SearchLimits) {
    let mut is_flipped = vec![false; dag.len()];
    let mut negatives = QuickMap::default();
    for node in dag.operands_first() {
        let definition = dag.definition(node);
        let definition = definition.with_edges(|edge| edge.times(is_flipped[edge.node()]));
        let definition = match definition {
            // A difference needs no negative constant.
            Definition::Sum(a, b) if !(a.is_negative() && b.is_negative()) => definition,
            Definition::Sum(a, b) => Definition::Sum(with_its_sign(dag, a, &mut negatives), b),
            _ => definition.with_edges(|edge| with_its_sign(dag, edge, &mut negatives)),
        };
        let (definition, flipped) = outwards(definition);
        is_flipped[node] = flipped;
        dag.redefine(node, definition);
    }
    is_flipped.resize(dag.len(), false);
    dag.flip(&is_flipped);
    dag.measure_depths();
}

/// Replaces a negative edge to a constant by an edge to the negative constant.
fn with_its_sign(dag: &mut Dag, edge: Edge, negatives: &mut QuickMap<usize, usize>) -> Edge {
    let Definition::Constant(constant) = dag.definition(edge.node()) else {
        return edge;
    };
    if !edge.is_negative() {
        return edge;
    }
    let negative = *negatives.entry(edge.node()).or_insert_with(|| {
        let definition = Definition::Constant(Constant::new(-constant.value()));
        let (name, scope) = (None, dag.scope(edge.node()));
        dag.push(definition, dag.fingerprint(edge), Origin { name, scope })
    });
    Edge::to(negative)
}

/// A definition without its sign, and whether its negative is meant.
fn outwards(definition: Definition) -> (Definition, bool) {
    let differ = |a: Edge, b: Edge| a.is_negative() != b.is_negative();
    match definition {
        Definition::Sum(a, b) if a.is_negative() && b.is_negative() => {
            (Definition::Sum(a.positive(), b.positive()), true)
        }
        Definition::Product(a, b) => (
            Definition::Product(a.positive(), b.positive()),
            differ(a, b),
        ),
        Definition::Quotient(a, b) => (
            Definition::Quotient(a.positive(), b.positive()),
            differ(a, b),
        ),
        Definition::Selection(a, b) => (
            Definition::Selection(a.positive(), b.positive()),
            differ(a, b),
        ),
        other => (other, false),
    }
}
