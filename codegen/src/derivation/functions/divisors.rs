//! Guards of a function's divisors.
//!
//! Determinants of legs and pivots of the actuators' rows are guarded where they arise. Closed
//! forms of joints and of the pose have more divisors: the square of the distance that two links
//! span, and coefficients of an equation that is solved for a turn. If one of them vanishes the
//! function has no value and returns an error.

use crate::cas::{Arena, Expr};
use crate::derivation::guard::{Guard, GuardKind};
use crate::mechanism::Mechanism;
use overact_core::ActuatorGroup;

/// A guard for every divisor of a function's entries, in order of construction.
///
/// `guards` are those that the function has anyway.
pub(crate) fn conditions<'a>(
    arena: &'a Arena,
    mechanism: &Mechanism,
    entries: &[Expr<'a>],
    guards: &[Guard<'a>],
) -> Vec<Guard<'a>> {
    let scopes = arena.scope_names();
    let condition = |value: Expr<'a>| {
        if let Some(guard) = of_multiple(value, guards) {
            return guard;
        }
        let home = mechanism.home.value(arena, value).abs();
        let scope = &scopes[arena.scope_at(value.handle().index()) as usize];
        let leg = mechanism.legs.iter().find(|leg| leg.name == *scope);
        Guard {
            value,
            kind: match leg {
                Some(_) => GuardKind::Leg(home),
                None => GuardKind::Platform {
                    home,
                    actuators: ActuatorGroup::All,
                },
            },
            leg: leg.map_or(String::new(), |leg| leg.name.clone()),
        }
    };
    let divisors = arena.divisors(entries).into_iter();
    divisors.map(condition).collect()
}

/// The guard of a divisor that is a multiple of a guarded value.
fn of_multiple<'a>(value: Expr<'a>, guards: &[Guard<'a>]) -> Option<Guard<'a>> {
    let (factor, base) = value.factor_and_base();
    let scale = factor.value().abs();
    let known = guards.iter().filter(|guard| guard.value == base);
    let kind = known.filter_map(|guard| match guard.kind {
        GuardKind::Reach(_) | GuardKind::Closed(_) => None,
        GuardKind::Mass => Some((GuardKind::Mass, guard)),
        GuardKind::Leg(home) => Some((GuardKind::Leg(home * scale), guard)),
        GuardKind::Coordinates(home) => Some((GuardKind::Coordinates(home * scale), guard)),
        GuardKind::Platform { home, actuators } => {
            let home = home * scale;
            Some((GuardKind::Platform { home, actuators }, guard))
        }
    });
    let (kind, guard) = { kind }.next()?;
    Some(Guard {
        value,
        kind,
        leg: guard.leg.clone(),
    })
}
