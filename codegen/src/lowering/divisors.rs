//! Guards on all divisors of a program.
//!
//! The guards that hold their nodes during the search have a meaning for readers. After the search,
//! all other divisors are guarded too, so that no configuration gives 0/0. This adds no operation,
//! since a divisor is computed anyway.

use super::dag::{Dag, Definition, Edge, GuardedEdge};
use super::{Condition, GuardedExpr};
use crate::cas::Arena;
use overact_description::diagnostic::InternalError;

/// Adds the `conditions` to divisors without a guard.
///
/// # Errors
/// A divisor that has no condition.
pub(super) fn guard(
    dag: &mut Dag,
    arena: &Arena,
    conditions: &[GuardedExpr<'_>],
) -> Result<(), InternalError> {
    let mut open = dag.divisors();
    let never = arena.never_zero();
    let is_known = |node: usize| {
        let edges = [false, true].map(|negative| dag.fingerprint(Edge::new(node, negative)));
        never
            .iter()
            .any(|one| edges.iter().any(|edge| edge.agrees(one)))
    };
    open.retain(|&node| !is_never_zero(dag, node) && !is_known(node));
    for GuardedExpr { value, condition } in conditions {
        let wanted = arena.fingerprint_at(value.handle().index());
        // The value itself or its negative.
        let meant = |&node: &usize| {
            let edges = [false, true].map(|negative| Edge::new(node, negative));
            let agrees = |edge: &Edge| dag.fingerprint(*edge).agrees(&wanted);
            edges.into_iter().find(agrees)
        };
        let Some((at, value)) = open
            .iter()
            .enumerate()
            .find_map(|(at, node)| Some((at, meant(node)?)))
        else {
            continue;
        };
        let node = open.remove(at);
        let place = place(dag, node, condition);
        let guard = GuardedEdge {
            value,
            condition: condition.clone(),
        };
        dag.insert_guard(place, guard);
    }
    match open.first() {
        None => Ok(()),
        Some(node) => Err(InternalError::new(
            "divisors",
            format!("node {node} is divided by and has no condition"),
        )),
    }
}

/// Whether a divisor is a constant or guarded already.
///
/// A guard against negative values only does not exclude zero.
fn is_never_zero(dag: &Dag, node: usize) -> bool {
    let is_guarded = dag.guards().iter().any(|guard| {
        guard.value.node() == node
            && !matches!(
                guard.condition,
                Condition::Reach { .. } | Condition::Closed { .. } | Condition::Size { .. }
            )
    });
    is_guarded || matches!(dag.definition(node), Definition::Constant(_))
}

/// Position of a divisor's guard: before the first guard that depends on it, so that a quotient
/// without value is reported as such; otherwise after those of the same leg.
fn place(dag: &Dag, node: usize, condition: &Condition) -> usize {
    let guards = dag.guards();
    let needs = |guard: &GuardedEdge| dag.needed([guard.value.node()].into_iter())[node];
    if let Some(at) = guards.iter().position(needs) {
        return at;
    }
    let own = guards
        .iter()
        .rposition(|guard| leg(&guard.condition) == leg(condition));
    let of_platform = || {
        guards
            .iter()
            .position(|guard| leg(&guard.condition).is_none())
    };
    match own {
        Some(at) => at + 1,
        None => of_platform().unwrap_or(guards.len()),
    }
}

/// The leg of a condition.
fn leg(condition: &Condition) -> Option<&str> {
    match condition {
        Condition::Reach { leg, .. }
        | Condition::Leg { leg, .. }
        | Condition::Closed { leg, .. } => Some(leg),
        Condition::Platform { .. }
        | Condition::Coordinates { .. }
        | Condition::Mass
        | Condition::Size { .. } => None,
    }
}
