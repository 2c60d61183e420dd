//! Extent of the search for fewer operations, and the states at which it compares rounding errors
//! of forms.

use crate::cas::{Arena, InputElement};
use crate::derivation::{Derived, Guard, GuardKind, rounded_magnitude};
use crate::lowering::{
    Array, Condition, Expressions, GuardedExpr, Program, SearchLimits, States, lower,
};
use crate::mechanism::Mechanism;
use crate::mechanism::states::{Spread, State, spread_states};
use crate::parallel;
use overact_core::Function;
use overact_description::Effort;
use overact_description::diagnostic::InternalError;

/// States of each kind at which rounding errors are compared.
const STATES: usize = 16;

/// Extent of the search for the functions of a robot.
#[derive(Debug, Clone, Default)]
pub struct Search {
    /// Search limits of the most important functions.
    limits: SearchLimits,
    /// Groups of states at which rounding errors of forms are compared.
    states: Vec<Vec<State>>,
}

impl Search {
    /// No search: programs are as derived.
    #[must_use]
    pub fn none() -> Self {
        Self::default()
    }

    /// A short search without comparison of rounding errors, to predict which of two programs will
    /// be cheaper.
    #[must_use]
    pub const fn short() -> Self {
        Self {
            limits: SearchLimits::SINGLE_REPLACEMENTS,
            states: Vec::new(),
        }
    }

    /// The search of a given effort.
    #[must_use]
    pub fn with(effort: Effort, mechanism: &Mechanism) -> Self {
        let limits = SearchLimits::of(effort);
        let spreads = if limits.compares_regular_states {
            &[Spread::NEAR, Spread::FAR][..]
        } else {
            &[]
        };
        let of = |&spread: &Spread| spread_states(mechanism, STATES, 7, spread);
        Self {
            limits,
            states: parallel::map(spreads, of),
        }
    }

    /// Whether other forms of every function are tried to save operations.
    #[must_use]
    pub(super) const fn is_thorough(&self) -> bool {
        self.limits.is_thorough()
    }

    /// Whether programs are searched at all.
    #[must_use]
    pub(super) const fn is_searched(&self) -> bool {
        self.limits.replaces
    }

    /// The program of a derived function.
    pub(super) fn lower<'a>(
        &self,
        arena: &'a Arena,
        mechanism: &Mechanism,
        function: Function,
        derived: &Derived<'a>,
    ) -> Result<Program, InternalError> {
        self.lower_with(arena, mechanism, function, derived, &|_| None)
    }

    /// The program of a derived function in which inputs replace constants of these values.
    pub(super) fn lower_with<'a>(
        &self,
        arena: &'a Arena,
        mechanism: &Mechanism,
        function: Function,
        derived: &Derived<'a>,
        standing: &dyn Fn(InputElement) -> Option<f64>,
    ) -> Result<Program, InternalError> {
        let limits = self.limits_of(function);
        // Among a controller's functions, the one that runs in every cycle.
        let again = match function {
            Function::InverseDynamics(_) => self.limits.of_control_again(),
            _ => None,
        };
        let compared = if limits.compares_regular_states {
            &self.states[..]
        } else {
            &[]
        };
        let function = Expressions {
            inputs: inputs(derived),
            output: output(function, derived),
            entries: &derived.entries,
            guards: guards(&derived.guards),
            divisors: guards(&derived.divisors),
        };
        let states = States {
            home: &|element| mechanism.home.input(element).or_else(|| standing(element)),
            groups: &compared.iter().map(Vec::len).collect::<Vec<_>>(),
            regular: &|group, number, element| {
                let state = &compared[group][number];
                at_state(mechanism, state, element).or_else(|| standing(element))
            },
        };
        let program = lower(arena, &function, &limits, &states)?;
        let Some(again) = again else {
            return Ok(program);
        };
        let other = lower(arena, &function, &again, &states)?;
        Ok(if is_cheaper(&other, &program) {
            other
        } else {
            program
        })
    }

    /// Search limits of a function.
    ///
    /// Identification models, which run at every sample of every log, are searched as far as
    /// requested. Functions of a controller are searched a step less. In all others only single
    /// nodes are replaced.
    const fn limits_of(&self, function: Function) -> SearchLimits {
        match function {
            Function::IdmRedPlatform(_) => self.limits,
            _ if is_of_control(function) => self.limits.of_control(),
            _ => self.limits.of_lesser_functions(),
        }
    }
}

/// Whether a controller evaluates a function.
const fn is_of_control(function: Function) -> bool {
    matches!(
        function,
        Function::InverseDynamics(_)
            | Function::MassMatrix(_)
            | Function::Bias(_)
            | Function::ForwardDynamics(_)
            | Function::Frame(_)
    ) || function.is_derivative()
}

/// Whether a program takes fewer operations than another, and no more sines and roots.
pub(super) fn is_cheaper(program: &Program, other: &Program) -> bool {
    let (of_program, of_other) = (program.cost(), other.cost());
    of_program.operations() < of_other.operations()
        && of_program.trigonometric_pairs <= of_other.trigonometric_pairs
        && of_program.square_roots <= of_other.square_roots
}

fn inputs(derived: &Derived<'_>) -> Vec<Array> {
    let array = |(name, length): &(&str, usize)| Array {
        name: (*name).to_owned(),
        shape: vec![*length],
    };
    derived.inputs.iter().map(array).collect()
}

fn output(function: Function, derived: &Derived<'_>) -> Array {
    let (rows, columns) = derived.shape;
    Array {
        name: function.name().to_owned(),
        shape: if function.is_vector() {
            vec![rows]
        } else {
            vec![rows, columns]
        },
    }
}

fn guards<'a>(guards: &[Guard<'a>]) -> Vec<GuardedExpr<'a>> {
    let condition = |kind: GuardKind, leg: String| match kind {
        GuardKind::Reach(home) => Condition::Reach {
            leg,
            home: rounded_magnitude(home),
        },
        GuardKind::Leg(home) => Condition::Leg {
            leg,
            home: rounded_magnitude(home),
        },
        GuardKind::Mass => Condition::Mass,
        GuardKind::Closed(within) => Condition::Closed {
            leg,
            within: rounded_magnitude(within),
        },
        GuardKind::Coordinates(home) => Condition::Coordinates {
            home: rounded_magnitude(home),
        },
        GuardKind::Platform { home, actuators } => Condition::Platform {
            actuators,
            home: rounded_magnitude(home),
        },
    };
    let guarded = guards.iter().map(|guard| GuardedExpr {
        value: guard.value,
        condition: condition(guard.kind, guard.leg.clone()),
    });
    guarded.collect()
}

/// The value of an element of an input array at a state.
fn at_state(mechanism: &Mechanism, state: &State, element: InputElement) -> Option<f64> {
    let values = match element.array {
        "pose" => &state.pose,
        "joints" => &state.joints,
        "twist" | "joint_velocities" => &state.twist,
        "acceleration" | "joint_accelerations" => &state.acceleration,
        "actuators" => {
            let actuators = mechanism.actuator_positions(&state.joints);
            return actuators.get(element.index).copied();
        }
        _ => return None,
    };
    values.get(element.index).copied()
}
