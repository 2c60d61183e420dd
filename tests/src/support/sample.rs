//! A state of a robot with all inputs of its functions, by argument name.

use super::Failure;
use crate::reference::closure::displaced;
use crate::reference::linear::pseudo_inverse;
use crate::reference::motors::transmission;
use crate::reference::states::{MAX_CONDITION, random_parameters, random_states};
use crate::reference::units::unitless_condition;
use crate::reference::{Dynamics, Mechanism, State};
use nalgebra::DVector;
use overact::Function;
use rand::{RngExt, SeedableRng};
use rand_pcg::Pcg64;

/// Largest perturbation of actuator velocities, rad/s, and accelerations, rad/s².
const NOISE: f64 = 0.05;

/// The model's parameters among those of the reference.
#[derive(Clone, Debug)]
pub struct Parameters {
    /// Columns of its standard parameters, then the payload's.
    pub columns: Vec<usize>,
    /// For each base parameter, also the payload's: all parameters regrouped into it.
    pub base: Vec<Vec<(usize, f64)>>,
}

impl Parameters {
    /// Values of the model's parameters.
    #[must_use]
    pub fn values(&self, all: &DVector<f64>) -> Vec<f64> {
        self.columns.iter().map(|&at| all[at]).collect()
    }

    /// Values of the model's base parameters and the payload's.
    #[must_use]
    pub fn regrouped(&self, all: &DVector<f64>) -> Vec<f64> {
        let sum = |terms: &Vec<(usize, f64)>| terms.iter().map(|&(at, c)| c * all[at]).sum();
        self.base.iter().map(sum).collect()
    }
}

impl std::ops::Deref for Parameters {
    type Target = [usize];

    fn deref(&self) -> &[usize] {
        &self.columns
    }
}

/// A state with matching inputs.
#[derive(Clone, Debug)]
pub struct Sample {
    /// State of the reference.
    pub state: State,
    /// State with twist and acceleration fitted to `actuator_velocities` and
    /// `actuator_accelerations` by least squares.
    pub fitted: State,
    /// Actuator positions, exact.
    pub actuators: Vec<f64>,
    /// Actuator positions that no pose has exactly, for forward kinematics.
    pub missed: Vec<f64>,
    /// Actuator velocities that no twist gives exactly.
    pub actuator_velocities: Vec<f64>,
    /// Actuator accelerations that no acceleration gives exactly.
    pub actuator_accelerations: Vec<f64>,
    /// Torques.
    pub torques: Vec<f64>,
    /// All standard parameters in the reference's order.
    pub all_parameters: DVector<f64>,
    /// Values of the model's parameters: standard, then payload.
    pub parameters: Vec<f64>,
    /// Values of its base parameters, then the payload's.
    pub base_parameters: Vec<f64>,
    /// Coordinates of the internal torque.
    pub preload: Vec<f64>,
    /// Force and moment on a frame.
    pub wrench: Vec<f64>,
    /// A pose near the sample's, as start of forward kinematics.
    pub start: Vec<f64>,
}

impl Sample {
    /// A sample in a state, with random values of the model's parameters.
    ///
    /// # Errors
    ///
    /// If the reference can't compute the fitted state.
    pub fn new(
        mechanism: &Mechanism,
        state: State,
        parameters: &Parameters,
        seed: u64,
    ) -> Result<Self, Failure> {
        let mut generator = Pcg64::seed_from_u64(seed);
        let mut random = |count: usize, size: f64| -> DVector<f64> {
            DVector::from_fn(count, |_, _| size * generator.random_range(-1.0..1.0))
        };
        let transmission = transmission(mechanism);
        let (n, r) = (transmission.nrows(), mechanism.dof());
        let velocities = &transmission * &state.qd + random(n, NOISE);
        let accelerations = &transmission * &state.qdd + random(n, NOISE);
        let fitted = fit(mechanism, &state, &velocities, &accelerations)?;
        let drawn = random_parameters(mechanism, seed);
        let mut all_parameters = DVector::zeros(drawn.len());
        for &at in parameters.iter() {
            all_parameters[at] = drawn[at];
        }
        let shift = random(r, 0.02);
        let actuators = &transmission * &state.q;
        Ok(Self {
            fitted,
            actuators: actuators.as_slice().to_vec(),
            actuator_velocities: velocities.as_slice().to_vec(),
            actuator_accelerations: accelerations.as_slice().to_vec(),
            torques: random(n, 10.0).as_slice().to_vec(),
            parameters: parameters.values(&all_parameters),
            base_parameters: parameters.regrouped(&all_parameters),
            all_parameters,
            preload: random(n - r, 3.0).as_slice().to_vec(),
            missed: (actuators + random(n, 0.01)).as_slice().to_vec(),
            start: match displaced(mechanism, &state.pose, &state.q, &shift)? {
                Some((pose, _)) if mechanism.has_dependent_joints() => pose,
                _ => mechanism.motion.displace(&state.pose, &shift),
            },
            wrench: random(6, 10.0).as_slice().to_vec(),
            state,
        })
    }

    /// An argument of a function by its name.
    ///
    /// # Errors
    ///
    /// If there is no argument of the name.
    pub fn argument(&self, function: Function, name: &str) -> Result<&[f64], Failure> {
        match (function, name) {
            (Function::PoseStep, "actuators") => Ok(&self.missed),
            _ => self.input(name),
        }
    }

    /// An argument by its name.
    ///
    /// # Errors
    ///
    /// If there is no argument of the name.
    pub fn input(&self, name: &str) -> Result<&[f64], Failure> {
        Ok(match name {
            "pose" => &self.state.pose,
            "joints" => self.state.q.as_slice(),
            "twist" | "joint_velocities" => self.state.twist.as_slice(),
            "acceleration" | "joint_accelerations" => self.state.acceleration.as_slice(),
            "actuators" => &self.actuators,
            "missed" => &self.missed,
            "actuator_velocities" => &self.actuator_velocities,
            "actuator_accelerations" => &self.actuator_accelerations,
            "torques" => &self.torques,
            "parameters" => &self.parameters,
            "base_parameters" => &self.base_parameters,
            "preload" => &self.preload,
            "start" => &self.start,
            "wrench" => &self.wrench,
            _ => return Err(format!("no argument is called `{name}`").into()),
        })
    }
}

/// Least-squares twist and acceleration: eq. (21), and eq. (24) in its J_p^inv form.
fn fit(
    mechanism: &Mechanism,
    state: &State,
    velocities: &DVector<f64>,
    accelerations: &DVector<f64>,
) -> Result<State, Failure> {
    let inverse = pseudo_inverse(&state.jacobians(mechanism)?.inverse);
    let twist = &inverse * velocities;
    let acceleration = fitted_acceleration(mechanism, state, &twist, accelerations)?;
    let state = State::with_joints(mechanism, &state.pose, &state.q, &twist, &acceleration)?;
    Ok(state)
}

/// Least-squares acceleration for the actuators at a twist.
///
/// The actuators' accelerations at zero platform acceleration are the term J̇_p^inv v.
///
/// # Errors
///
/// If the state is singular.
pub fn fitted_acceleration(
    mechanism: &Mechanism,
    state: &State,
    twist: &DVector<f64>,
    measured: &DVector<f64>,
) -> Result<DVector<f64>, Failure> {
    let still = DVector::zeros(mechanism.dof());
    let bias = State::with_joints(mechanism, &state.pose, &state.q, twist, &still)?;
    let inverse = pseudo_inverse(&state.jacobians(mechanism)?.inverse);
    Ok(inverse * (measured - transmission(mechanism) * bias.qdd))
}

/// Random regular samples.
///
/// With `partitions`, J_p^inv of all actuators but any one is well conditioned too, so that every
/// partition is regular.
///
/// # Errors
///
/// If too few regular states are found.
pub fn samples(
    mechanism: &Mechanism,
    parameters: &Parameters,
    count: usize,
    seed: u64,
    partitions: bool,
) -> Result<Vec<Sample>, Failure> {
    let drawn = random_states(mechanism, if partitions { 2 * count } else { count }, seed)?;
    let mut all = Vec::with_capacity(count);
    for (at, state) in drawn.into_iter().enumerate() {
        if all.len() < count && (!partitions || every_partition(mechanism, &state)?) {
            all.push(Sample::new(mechanism, state, parameters, seed + at as u64)?);
        }
    }
    if all.len() == count {
        Ok(all)
    } else {
        Err(format!("only {} of {count} states are regular", all.len()).into())
    }
}

fn every_partition(mechanism: &Mechanism, state: &State) -> Result<bool, Failure> {
    let inverse = Dynamics::new(mechanism, state)?.jacobians.inverse;
    let regular = |without: usize| {
        let kept = inverse.clone().remove_row(without);
        unitless_condition(&mechanism.motion, &kept) < MAX_CONDITION
    };
    Ok((0..inverse.nrows()).all(regular))
}
