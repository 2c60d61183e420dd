//! Expected derivatives of the dynamics, by central differences of the reference.
//!
//! The formula with eight points has an error of order eight in the step. The step is halved until
//! two of them agree: loads and dry friction jump where a sign changes between the points, and the
//! outer points of a long step may be out of reach.

use super::{Failure, Sample};
use crate::reference::closure;
use crate::reference::dynamics::Dynamics;
use crate::reference::{Mechanism, State};
use nalgebra::{DMatrix, DVector};
use overact::Function;

/// Weights of the points at 1 to 4 steps; those on the other side are their negatives.
const WEIGHTS: [f64; 4] = [4.0 / 5.0, -1.0 / 5.0, 4.0 / 105.0, -1.0 / 280.0];
/// Largest step, m, rad, m/s or rad/s.
const STEP: f64 = 4e-3;
/// Smallest step; below it rounding exceeds the tolerances of the tests.
const SMALLEST: f64 = 3e-5;
/// Largest difference between the results of two steps, relative to the largest entry.
const AGREEMENT: f64 = 2e-10;
/// The same if no two steps agree as well, relative to the tolerance of the comparison.
const SUFFICIENT: f64 = 0.05;

/// Output of a function that is compared within `tolerance`; `None` for those of other kinds.
///
/// # Errors
///
/// If the reference cannot compute a state, or has no derivative near a change of sign.
pub fn output(
    dynamics: &Dynamics<'_>,
    function: Function,
    sample: &Sample,
    tolerance: f64,
) -> Result<Option<DMatrix<f64>>, Failure> {
    let (mechanism, state) = (dynamics.mechanism, dynamics.state);
    let chi = &sample.all_parameters;
    let by_twist = matches!(
        function,
        Function::InverseDynamicsByTwist(_) | Function::ForwardDynamicsByTwist(_)
    );
    let value = |state: &State| -> Result<DVector<f64>, Failure> {
        let dynamics = Dynamics::new(mechanism, state)?;
        if matches!(
            function,
            Function::InverseDynamicsByDisplacement(_) | Function::InverseDynamicsByTwist(_)
        ) {
            return Ok(dynamics.least_norm_torques(chi)?);
        }
        let (mass, bias) = dynamics.mass_matrix_and_bias(chi)?;
        let torques = DVector::from_column_slice(&sample.torques);
        let forces = dynamics.jacobians.inverse.transpose() * torques - bias;
        Ok(mass
            .lu()
            .solve(&forces)
            .ok_or("the mass matrix is singular")?)
    };
    if !function.is_derivative() {
        return Ok(None);
    }
    let moved = |direction: &DVector<f64>| {
        if by_twist {
            faster(mechanism, state, direction)
        } else {
            displaced(mechanism, state, direction)
        }
    };
    differences(mechanism.dof(), &moved, &value, tolerance).map(Some)
}

/// The state at a displaced pose, with the same twist and acceleration.
///
/// # Errors
///
/// If the robot can't reach the pose.
pub fn displaced(
    mechanism: &Mechanism,
    state: &State,
    displacement: &DVector<f64>,
) -> Result<State, Failure> {
    let (twist, acceleration) = (&state.twist, &state.acceleration);
    if let Some((pose, q)) = closure::displaced(mechanism, &state.pose, &state.q, displacement)? {
        return Ok(State::with_joints(
            mechanism,
            &pose,
            &q,
            twist,
            acceleration,
        )?);
    }
    let pose = mechanism.motion.displace(&state.pose, displacement);
    Ok(State::solve_near(
        mechanism,
        &state.q,
        &pose,
        twist,
        acceleration,
    )?)
}

/// The state with a changed twist.
///
/// # Errors
///
/// If the reference cannot compute the rates.
pub fn faster(
    mechanism: &Mechanism,
    state: &State,
    change: &DVector<f64>,
) -> Result<State, Failure> {
    let twist = &state.twist + change;
    Ok(State::with_joints(
        mechanism,
        &state.pose,
        &state.q,
        &twist,
        &state.acceleration,
    )?)
}

/// Derivatives of a quantity along `count` directions, one column for each, to be compared within
/// `tolerance`.
///
/// # Errors
///
/// If a state or value cannot be computed, or no two steps agree.
pub fn differences(
    count: usize,
    moved: &dyn Fn(&DVector<f64>) -> Result<State, Failure>,
    value: &dyn Fn(&State) -> Result<DVector<f64>, Failure>,
    tolerance: f64,
) -> Result<DMatrix<f64>, Failure> {
    let column = |k: usize, step: f64| -> Result<DVector<f64>, Failure> {
        let at = |n: i32| {
            let mut direction = DVector::zeros(count);
            direction[k] = f64::from(n) * step;
            value(&moved(&direction)?)
        };
        let mut sum = at(1)? * 0.0;
        for (n, weight) in (1..).zip(WEIGHTS) {
            sum += (at(n)? - at(-n)?) * (weight / step);
        }
        Ok(sum)
    };
    let matrix = |step: f64| -> Result<DMatrix<f64>, Failure> {
        let columns = (0..count).map(|k| column(k, step));
        Ok(DMatrix::from_columns(
            &columns.collect::<Result<Vec<_>, _>>()?,
        ))
    };
    let mut step = STEP;
    let mut before = matrix(step);
    let mut best = (SUFFICIENT * tolerance, None);
    while step > SMALLEST {
        step *= 0.5;
        let now = matrix(step);
        if let (Ok(now), Ok(before)) = (&now, &before) {
            let disagreement = (now - before).amax() / now.amax().max(1e-3);
            if disagreement <= AGREEMENT {
                return Ok(now.clone());
            }
            if disagreement <= best.0 {
                best = (disagreement, Some(now.clone()));
            }
        }
        before = now;
    }
    match best.1 {
        Some(matrix) => Ok(matrix),
        None => before.and_then(|_| Err("differences of no two steps agree".into())),
    }
}
