//! States along a path through a given state, and derivatives along it by finite differences.
//!
//! The path keeps v̇ constant: the displacement at time t is v t + v̇ t²/2. For rotations it is a
//! rotation vector, exact up to the second derivative at t = 0, which is sufficient.

use super::Error;
use super::closure::{State, displaced};
use super::mechanism::Mechanism;
use nalgebra::DVector;

/// Largest step of the finite differences, s.
const STEP: f64 = 3e-4;
/// Largest joint motion in a step, rad or m; joints of small robots move fast.
const REACH: f64 = 0.003;

/// Step of the finite differences at a state, s.
#[must_use]
pub fn step(state: &State) -> f64 {
    STEP.min(REACH / state.qd.amax())
}

/// State at time `t` on the path through `state`.
///
/// # Errors
///
/// If the robot can't reach the pose.
pub fn at(mechanism: &Mechanism, state: &State, t: f64) -> Result<State, Error> {
    let displacement = &state.twist * t + &state.acceleration * (0.5 * t * t);
    let twist = &state.twist + &state.acceleration * t;
    if let Some((pose, q)) = displaced(mechanism, &state.pose, &state.q, &displacement)? {
        return State::with_joints(mechanism, &pose, &q, &twist, &state.acceleration);
    }
    let pose = mechanism.motion.displace(&state.pose, &displacement);
    State::solve_near(mechanism, &state.q, &pose, &twist, &state.acceleration)
}

/// First and second derivative along the path of a quantity of the state.
///
/// The seven-point central formulas have an error of order six in the step.
///
/// # Errors
///
/// If the robot can't reach a pose of the stencil.
pub fn derivatives(
    mechanism: &Mechanism,
    state: &State,
    quantity: impl Fn(&State) -> DVector<f64>,
) -> Result<(DVector<f64>, DVector<f64>), Error> {
    const FIRST_DIFFERENCE: [f64; 4] = [0.0, 0.75, -0.15, 1.0 / 60.0];
    const SECOND_DIFFERENCE: [f64; 4] = [-49.0 / 18.0, 1.5, -0.15, 1.0 / 90.0];
    let step = step(state);
    let sample = |n: f64| Ok(quantity(&at(mechanism, state, n * step)?));
    let mut second: DVector<f64> = sample(0.0)? * SECOND_DIFFERENCE[0];
    let mut first = DVector::zeros(second.len());
    for n in 1..4 {
        let (ahead, behind): (DVector<f64>, DVector<f64>) =
            (sample(n as f64)?, sample(-(n as f64))?);
        first += (&ahead - &behind) * FIRST_DIFFERENCE[n];
        second += (ahead + behind) * SECOND_DIFFERENCE[n];
    }
    Ok((first / step, second / (step * step)))
}
