//! From expressions to a straight-line [`Program`].
//!
//! | stage | from | to |
//! |---|---|---|
//! | `dag/from_arena` | expressions in their arena | a graph of signed nodes, each with its fingerprint and origin |
//! | `passes` | that graph | the same values in fewer operations; see its list of passes |
//! | `divisors` | that graph | the same with a guard on every divisor |
//! | `schedule` | that graph | the [`Program`], operands first |
//! | `magnitudes` | a program | the same with guards that keep its values finite |
//! | `min_live_order` | a program whose results are written one by one | the same program, ordered for few live values |
//!
//! Unused nodes are not copied. [`SearchLimits`] limit the passes. The invariants of a program are
//! checked once at the end (`Program::verify`), and those of the graph after every pass in
//! development builds. A violation is an [`InternalError`], a bug of the generator. The [`Cost`] of
//! a program is counted by one rule, which the generated documentation and the snapshots quote.
//!
//! The lowering has two evaluators of its own: fingerprints in the field find equal values, and
//! values with random errors at some states compare accuracy. Programs are evaluated by
//! [`evaluation`](crate::interpreter).

mod dag;
mod divisors;
mod limits;
mod magnitudes;
mod min_live_order;
mod passes;
mod program;
mod schedule;
mod simd;
#[cfg(test)]
mod tests;
mod vertex_cut;

pub use dag::test_states::States;
pub use limits::SearchLimits;
pub(crate) use magnitudes::Magnitudes;
pub(crate) use min_live_order::schedule_min_live;
pub use program::{Array, Condition, Cost, Entry, Guard, Operand, Operation, Program, Step};
pub use simd::{Column, Elements, LaneOutput, Lanes, LegRows, OfLegs, Profitable, Sums};
pub(crate) use simd::{fold, scatter};

use crate::cas::{Arena, Expr};
use overact_description::diagnostic::InternalError;

/// A condition on an expression.
#[derive(Debug, Clone)]
pub struct GuardedExpr<'a> {
    /// The expression.
    pub value: Expr<'a>,
    /// The condition.
    pub condition: Condition,
}

/// A function as expressions.
#[derive(Debug)]
pub struct Expressions<'a> {
    /// The arrays whose elements the expressions use.
    pub inputs: Vec<Array>,
    /// The output.
    pub output: Array,
    /// The output's numbers, row-major.
    pub entries: &'a [Expr<'a>],
    /// Guards; one is kept if the program divides by its value or takes its root.
    pub guards: Vec<GuardedExpr<'a>>,
    /// Conditions on all divisors of the entries.
    ///
    /// They keep no node alive in the search; only divisors that remain in the program are guarded.
    pub divisors: Vec<GuardedExpr<'a>>,
}

/// Lowers the expressions of one function; forms are compared at the `states`.
///
/// # Errors
/// A bug of the generator.
pub fn lower<'a>(
    arena: &'a Arena,
    function: &Expressions<'a>,
    limits: &SearchLimits,
    states: &States<'_>,
) -> Result<Program, InternalError> {
    let mut dag = dag::from_arena::from_arena(arena, function.entries, &function.guards);
    if limits.replaces {
        dag.measure_digits(states);
    }
    passes::run(&mut dag, limits)?;
    divisors::guard(&mut dag, arena, &function.divisors)?;
    dag.name_values(|fingerprint| arena.name_of_value(fingerprint));
    let program = schedule::schedule(&dag, &function.inputs, &function.output)?;
    let broken = |broken| InternalError::new("schedule", broken);
    program.verify().map_err(broken)?;
    Ok(program)
}
