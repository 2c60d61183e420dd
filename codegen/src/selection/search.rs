//! How far the operations of a robot's functions are searched, and the states at which the search compares
//! the digits of their forms.

use crate::derivation::{Derived, Family};
use crate::effort::Effort;
use crate::lowering::{Array, Condition, GuardedExpr, Program, Reach, States, lower};
use crate::mechanism::Mechanism;
use crate::mechanism::states::{Spread, State, spread_states};
use crate::parallel;
use crate::{cas::Arena, derivation::GuardKind};

/// States of each kind by which the search compares the digits of forms.
const STATES: usize = 16;

/// How far the functions of a robot are searched.
#[derive(Debug, Clone, Default)]
pub struct Search {
    /// How far cheaper ways to write the functions that matter most are searched.
    reach: Reach,
    /// Groups of states at which the digits of forms are compared.
    states: Vec<Vec<State>>,
}

impl Search {
    /// None: programs are as the derivation writes them.
    #[must_use]
    pub fn none() -> Self {
        Self::default()
    }

    /// A short search that compares no digits: it tells which of two programs will be the cheaper one.
    #[must_use]
    pub const fn short() -> Self {
        Self {
            reach: Reach::Singles,
            states: Vec::new(),
        }
    }

    /// The search that an effort asks for.
    #[must_use]
    pub fn with(effort: Effort, mechanism: &Mechanism) -> Self {
        let reach = effort.reach();
        let spreads = match reach {
            Reach::Nothing => &[][..],
            _ => &[Spread::NEAR, Spread::FAR],
        };
        let of = |&spread: &Spread| spread_states(mechanism, STATES, 7, spread);
        Self {
            reach,
            states: parallel::map(spreads, of),
        }
    }

    /// The program of a derived function.
    pub(super) fn lower(
        &self,
        arena: &Arena,
        mechanism: &Mechanism,
        family: Family,
        derived: &Derived<'_>,
    ) -> Program {
        let reach = self.reach_of(family);
        // Of single replacements in functions that matter less, only those near singular states are looked at.
        let compared = match reach {
            Reach::Nothing | Reach::Singles => &[][..],
            _ => &self.states,
        };
        lower(
            arena,
            &inputs(derived),
            output(family, derived.shape),
            &derived.entries,
            &guards(derived),
            reach,
            &States {
                home: &|symbol| at_home(mechanism, symbol),
                groups: &compared.iter().map(Vec::len).collect::<Vec<_>>(),
                regular: &|group, number, symbol| {
                    at_state(mechanism, &compared[group][number], symbol)
                },
            },
        )
    }

    /// How far the search of a function goes: the identification models, which run at every sample of
    /// every log, are searched as far as asked; of the others only the nodes one by one.
    fn reach_of(&self, family: Family) -> Reach {
        match family {
            Family::IdmRedPlatform(_) => self.reach,
            _ => self.reach.min(Reach::Singles),
        }
    }
}

fn inputs(derived: &Derived<'_>) -> Vec<Array> {
    let array = |(name, length): &(&str, usize)| Array {
        name: (*name).to_owned(),
        shape: vec![*length],
    };
    derived.inputs.iter().map(array).collect()
}

fn output(family: Family, (rows, columns): (usize, usize)) -> Array {
    Array {
        name: family.name().to_owned(),
        shape: if family.is_vector() {
            vec![rows]
        } else {
            vec![rows, columns]
        },
    }
}

fn guards<'a>(derived: &Derived<'a>) -> Vec<GuardedExpr<'a>> {
    let condition = |kind: GuardKind, leg: String| match kind {
        GuardKind::Reach => Condition::Reach { leg },
        GuardKind::Leg(home) => Condition::Leg { leg, home },
        GuardKind::Platform { home, actuators } => Condition::Platform { actuators, home },
    };
    let guards = derived.guards.iter().map(|guard| GuardedExpr {
        value: guard.value,
        condition: condition(guard.kind, guard.leg.clone()),
    });
    guards.collect()
}

/// The value of an input, by its symbol `name[index]`, in the home configuration; rates have none.
fn at_home(mechanism: &Mechanism, symbol: &str) -> Option<f64> {
    let (name, index) = indexed(symbol)?;
    let home = &mechanism.home;
    let values = match name {
        "pose" => &home.pose,
        "joints" => &home.joints,
        "actuators" => &home.actuators,
        _ => return None,
    };
    values.get(index).copied()
}

/// The value of an input, by its symbol `name[index]`, at a state.
fn at_state(mechanism: &Mechanism, state: &State, symbol: &str) -> Option<f64> {
    let (name, index) = indexed(symbol)?;
    let values = match name {
        "pose" => &state.pose,
        "joints" => &state.joints,
        "twist" | "joint_velocities" => &state.twist,
        "acceleration" | "joint_accelerations" => &state.acceleration,
        "actuators" => return state.joints.get(*mechanism.actuated().get(index)?).copied(),
        _ => return None,
    };
    values.get(index).copied()
}

/// Name and index of a symbol `name[index]`.
fn indexed(symbol: &str) -> Option<(&str, usize)> {
    let (name, index) = symbol.strip_suffix(']')?.split_once('[')?;
    Some((name, index.parse().ok()?))
}
