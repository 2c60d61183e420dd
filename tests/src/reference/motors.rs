//! Motors that drive combinations of joints, by virtual work.
//!
//! A motor's position θ is a function of the joint positions. A torque s at the motor does the work
//! s δθ, so the joints of the opened robot need the loads s ∂θ/∂q. Central differences of θ give the
//! derivatives; they are exact, because θ is linear.

use super::closure::State;
use super::mechanism::{Mechanism, Motor};
use super::newton_euler::{friction, sign};
use super::parameters::{BODY, INERTIAL, QUADRATIC, motor_start};
use nalgebra::{DMatrix, DVector};

/// Step of the differences, m and rad.
const STEP: f64 = 0.5;

/// Position of a motor at joint positions; it is linear, so it serves rates alike.
#[must_use]
pub fn position(motor: &Motor, q: &DVector<f64>) -> f64 {
    motor.terms.iter().map(|&(at, factor)| factor * q[at]).sum()
}

/// ∂θ/∂q of a motor.
fn gradient(motor: &Motor, joints: usize) -> DVector<f64> {
    DVector::from_fn(joints, |at, _| {
        let (mut ahead, mut behind) = (DVector::zeros(joints), DVector::zeros(joints));
        ahead[at] = STEP;
        behind[at] = -STEP;
        (position(motor, &ahead) - position(motor, &behind)) / (2.0 * STEP)
    })
}

/// T of all actuators, n × n_t: selected joints above the motors.
#[must_use]
pub fn transmission(mechanism: &Mechanism) -> DMatrix<f64> {
    let (own, joints) = (mechanism.actuated(), mechanism.joints());
    let mut all = DMatrix::zeros(own.len() + mechanism.motors.len(), joints);
    for (row, &at) in own.iter().enumerate() {
        all[(row, at)] = 1.0;
    }
    for (index, motor) in mechanism.motors.iter().enumerate() {
        all.set_row(own.len() + index, &gradient(motor, joints).transpose());
    }
    all
}

/// Torque at a motor for the parameters [… ia fv fs off k fv_pos fs_pos fv_neg fs_neg fst fl fq].
fn torque(motor: &Motor, state: &State, parameters: &[f64]) -> f64 {
    let (rate, growth) = (position(motor, &state.qd), position(motor, &state.qdd));
    let own = &parameters[INERTIAL..BODY];
    own[0] * growth
        + own[1] * rate
        + own[2] * sign(rate)
        + own[3]
        + friction(rate, &own[5..], motor.stribeck)
        + parameters[QUADRATIC] * rate * rate.abs()
}

/// Adds the columns of the motors' parameters to a regressor.
pub(super) fn add_columns(mechanism: &Mechanism, state: &State, columns: &mut DMatrix<f64>) {
    let joints = mechanism.joints();
    for (index, motor) in mechanism.motors.iter().enumerate() {
        let slopes = gradient(motor, joints);
        for at in INERTIAL..BODY {
            let mut unit = vec![0.0; BODY];
            unit[at] = 1.0;
            let own = &slopes * torque(motor, state, &unit);
            let column = motor_start(mechanism) + BODY * index + at;
            columns.view_mut((0, column), (joints, 1)).copy_from(&own);
        }
    }
}

/// Loads [τ_t; τ_pr] of all motors for given parameters.
pub(super) fn all_loads(
    mechanism: &Mechanism,
    state: &State,
    parameters: &DVector<f64>,
    rows: usize,
) -> DVector<f64> {
    let joints = mechanism.joints();
    let mut sum = DVector::zeros(rows);
    for (index, motor) in mechanism.motors.iter().enumerate() {
        let own = &parameters.as_slice()[motor_start(mechanism) + BODY * index..];
        let mut of_joints = sum.rows_mut(0, joints);
        of_joints += gradient(motor, joints) * torque(motor, state, own);
    }
    sum
}

/// Kinetic energy of all rotors.
#[must_use]
pub fn energy(mechanism: &Mechanism, state: &State, parameters: &DVector<f64>) -> f64 {
    let rotor = |(index, motor): (usize, &Motor)| {
        let inertia = parameters[motor_start(mechanism) + BODY * index + INERTIAL];
        0.5 * inertia * position(motor, &state.qd).powi(2)
    };
    mechanism.motors.iter().enumerate().map(rotor).sum()
}
