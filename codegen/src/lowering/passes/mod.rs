//! The optimiser: what is done to the DAG of a function, in this order.
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
//! that it adds. The tree of dominators says at once which operations these can be, so that of the
//! millions of sums and products of two nodes only those few are tried that may save something. Where
//! nothing saves any more, a walk among forms of equal cost goes on, and at last factors are collected that
//! products have in common across other terms of their sum. No new divisor is ever introduced, so
//! the function is defined wherever it was, and no sum that cancels near singular configurations where
//! the form that it replaces does not.

mod angles;
mod common_factors;
mod conditions;
mod guards;
mod reciprocals;
mod repair;
mod replacements;
mod requests;
mod restore_original_form;
mod selections;
mod self_cancelling_pairs;
mod shared_pairs;
mod signs;
mod single_replacements;
mod walk;

use super::SearchLimits;
use super::dag::Dag;
use overact_description::diagnostic::InternalError;

/// A transformation of a DAG that keeps the values of all nodes.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Pass {
    pub(crate) name: &'static str,
    pub(crate) run: fn(&mut Dag, &SearchLimits),
}

const fn pass(name: &'static str, run: fn(&mut Dag, &SearchLimits)) -> Pass {
    Pass { name, run }
}

/// All passes, in their order.
pub(crate) const PASSES: [Pass; 13] = [
    pass("replacements", replacements::run),
    pass("repair", repair::run),
    pass("conditions", conditions::run),
    pass("walk", walk::run),
    pass("common factors", common_factors::run),
    pass("restore original form", restore_original_form::run),
    pass("repair", repair::run),
    pass("conditions", conditions::run),
    pass("guards", guards::run),
    pass("angles", angles::run),
    pass("signs", signs::run),
    pass("selections", selections::run),
    pass("reciprocals", reciprocals::run),
];

/// Parts of passes that are tried on their own.
#[cfg(test)]
pub(crate) const PARTS: [Pass; 2] = [
    pass("single replacements", single_replacements::run),
    pass("shared pairs", shared_pairs::run),
];

/// Does all passes. What holds of every DAG is checked after each one in builds for development.
///
/// # Errors
/// The invariant that a pass has broken.
pub(crate) fn run(dag: &mut Dag, limits: &SearchLimits) -> Result<(), InternalError> {
    verify(dag, "from arena")?;
    for pass in PASSES {
        (pass.run)(dag, limits);
        verify(dag, pass.name)?;
    }
    Ok(())
}

fn verify(dag: &Dag, pass: &'static str) -> Result<(), InternalError> {
    if cfg!(debug_assertions) {
        let broken = |broken| InternalError::new(pass, broken);
        return dag.verify().map_err(broken);
    }
    Ok(())
}
