//! The optimiser: passes over the DAG of a function, in order.
//!
//! Every node has a fingerprint, its values at two random points of a finite field
//! ([`cas`](crate::cas)). An expression with the same fingerprint can replace the node. For an
//! expensive node, a table of values shows whether it is the sum, difference, product or quotient
//! of two existing nodes. Otherwise one operand may be new if a single operation on existing nodes
//! computes it. New operands that several nodes can use are preferred. The search has no rules for
//! identities: it finds factorings, common subsums and 1 + cot² = 1/sin² by their values.
//!
//! The saving of a replacement is exact: the operations that become unused minus those that it
//! adds. The former are the node's *maximal fan-out free cone*, as in the resubstitution of logic
//! synthesis. The dominator tree gives these cones. They exclude most of the millions of possible
//! sums and products. When no replacement saves operations, the search walks among forms of equal
//! cost. Then factors that products share across terms of a sum are collected. The
//! remaining passes restore accuracy and simplify guards, angles and signs.
//!
//! No new divisor is introduced, so the function's domain stays the same. Near singular
//! configurations, no replacement loses digits by cancellation if the original form does not.

mod angles;
mod common_factors;
mod conditions;
mod guards;
mod reciprocals;
mod repair;
mod repeated_values;
mod replacements;
mod requests;
mod restore_original_form;
mod selections;
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

/// Parts of passes that are tested separately.
#[cfg(test)]
pub(crate) const PARTS: [Pass; 2] = [
    pass("single replacements", single_replacements::run),
    pass("shared pairs", shared_pairs::run),
];

/// Runs all passes; development builds check the invariants after each.
///
/// # Errors
/// The invariant that a pass violates.
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
