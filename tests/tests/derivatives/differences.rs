//! Finite differences of the generated functions themselves.

use super::{Failure, Robot, all_robots, each};
use nalgebra::{DMatrix, DVector};
use overact::Function;
use overact_codegen::CompiledFunction;
use overact_tests::reference::State;
use overact_tests::reference::linear::relative_difference;
use overact_tests::support::Sample;
use overact_tests::support::backend::{evaluate, matrix};
use overact_tests::support::derivatives::{differences, displaced, faster};
use overact_tests::support::sample::samples;
use overact_tier::by_tiers;

/// Largest difference, relative to the largest entry of a matrix.
const TOLERANCE: f64 = 1e-7;
/// States of each robot in the default, full and nightly tier.
const STATES: [usize; 3] = [1, 3, 10];

all_robots!(differ);

/// The function of which another is the derivative, and whether it is by the twist.
const fn differentiated(function: Function) -> Option<(Function, bool)> {
    Some(match function {
        Function::InverseDynamicsByDisplacement(of) => (Function::InverseDynamics(of), false),
        Function::InverseDynamicsByTwist(of) => (Function::InverseDynamics(of), true),
        Function::ForwardDynamicsByDisplacement(of) => (Function::ForwardDynamics(of), false),
        Function::ForwardDynamicsByTwist(of) => (Function::ForwardDynamics(of), true),
        _ => return None,
    })
}

/// Output of a function in a state.
fn value(
    function: &CompiledFunction,
    state: &State,
    sample: &Sample,
) -> Result<DMatrix<f64>, Failure> {
    let input = |name: &str| match name {
        "pose" => Some(state.pose.as_slice()),
        "joints" => Some(state.q.as_slice()),
        "twist" | "joint_velocities" => Some(state.twist.as_slice()),
        name => sample.input(name).ok(),
    };
    Ok(matrix(
        &function.program,
        &evaluate(&function.program, &input)?,
    ))
}

fn differ(robot: &Robot) -> Result<(), Failure> {
    let parameters = robot.expected.parameters();
    let mechanism = &robot.expected.mechanism;
    for sample in samples(mechanism, &parameters, by_tiers(STATES), 43, false)? {
        for function in &robot.model.functions {
            let Some((of, by_twist)) = differentiated(function.computes) else {
                continue;
            };
            let of = robot
                .model
                .plain(of)
                .ok_or("no function to differentiate")?;
            let state = &sample.state;
            let moved = |direction: &DVector<f64>| {
                if by_twist {
                    faster(mechanism, state, direction)
                } else {
                    displaced(mechanism, state, direction)
                }
            };
            let own = |state: &State| Ok(value(of, state, &sample)?.column(0).into_owned());
            // Next to a change of sign there are no differences.
            let Ok(wanted) = differences(mechanism.dof(), &moved, &own, TOLERANCE) else {
                continue;
            };
            let found = value(function, state, &sample)?;
            let worst = if wanted.amax().max(found.amax()) < 1e-9 {
                0.0
            } else {
                relative_difference(&found, &wanted)
            };
            if worst.is_nan() || worst > TOLERANCE {
                return Err(format!("`{}` differs by {worst:.1e}", function.name).into());
            }
        }
    }
    Ok(())
}
