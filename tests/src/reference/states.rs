//! Random regular states and random parameters, the same for the same seed on any machine.
//!
//! Poses lie within the workspace around home, joints in the working mode of the legs' start.
//! A state is rejected if a leg can't reach it or a leg, the inverse Jacobian or the reduced
//! closure is badly conditioned: comparisons there would measure the conditioning, not the model.

use super::Error;
use super::closure::parasitic_motion;
use super::closure::{State, displaced};
use super::mechanism::Mechanism;
use super::motion::Motion;
use super::parameters::{
    BODY, INERTIAL, STIFFNESS, count, element_start, motor_start, platform_start,
};
use super::units::unitless_condition;
use nalgebra::{DMatrix, DVector, Matrix3, Vector3};
use rand::{RngExt, SeedableRng};
use rand_pcg::Pcg64;

/// Largest condition number of a leg's Jacobian, of J_p^inv and of A_p in a regular state.
///
/// The latter two are minimised over the unit of length.
pub const MAX_CONDITION: f64 = 60.0;
/// Largest rate of a joint per unit rate of the independent ones, if others of the pose depend on
/// them: near a dead centre it is infinite.
pub const MAX_GAIN: f64 = 5.0;
/// Largest twist coordinate, m/s and rad/s.
pub const MAX_SPEED: f64 = 1.5;
/// Largest derivative of a twist coordinate, m/s² and rad/s².
pub const MAX_ACCELERATION: f64 = 12.0;

/// `count` random regular states.
///
/// # Errors
///
/// If hardly any pose of the workspace is regular.
pub fn random_states(mechanism: &Mechanism, count: usize, seed: u64) -> Result<Vec<State>, Error> {
    let mut generator = Pcg64::seed_from_u64(seed);
    let mut states = Vec::with_capacity(count);
    for _ in 0..200 * count.max(1) {
        if states.len() == count {
            break;
        }
        let dof = mechanism.dof();
        let scales: Vec<f64> = mechanism.workspace.clone();
        let displacement = random_vector(&mut generator, &scales);
        let twist = random_vector(&mut generator, &vec![MAX_SPEED; dof]);
        let acceleration = random_vector(&mut generator, &vec![MAX_ACCELERATION; dof]);
        let start = parasitic_motion::start(mechanism);
        let solved =
            displaced(mechanism, &mechanism.home, &start, &displacement).and_then(|found| {
                match found {
                    Some((pose, q)) => {
                        State::with_joints(mechanism, &pose, &q, &twist, &acceleration)
                    }
                    None => {
                        let pose = mechanism.motion.displace(&mechanism.home, &displacement);
                        State::solve(mechanism, &pose, &twist, &acceleration)
                    }
                }
            });
        if let Ok(state) = solved
            && is_regular(mechanism, &state)
        {
            states.push(state);
        }
    }
    if states.len() == count {
        Ok(states)
    } else {
        Err(Error::NoRegularState)
    }
}

/// Whether the legs, the inverse Jacobian and the reduced closure are well conditioned, and dependent
/// joints are far from a dead centre.
#[must_use]
pub fn is_regular(mechanism: &Mechanism, state: &State) -> bool {
    state.jacobians(mechanism).is_ok_and(|jacobians| {
        let per_twist = |matrix: &DMatrix<f64>| unitless_condition(&mechanism.motion, matrix);
        let is_far = !mechanism.has_dependent_joints() || jacobians.joints.amax() < MAX_GAIN;
        is_far
            && jacobians.worst_leg_condition(mechanism) < MAX_CONDITION
            && per_twist(&jacobians.inverse) < MAX_CONDITION
            && per_twist(&reduced_closure(mechanism, &jacobians.a_p)) < MAX_CONDITION
    })
}

/// A_p, whose rows come from the legs' adjugates.
///
/// Chains of different types have determinants of different dimensions, so that rows are
/// normalised.
fn reduced_closure(mechanism: &Mechanism, a_p: &DMatrix<f64>) -> DMatrix<f64> {
    let mut rows = a_p.clone();
    if matches!(mechanism.motion, Motion::Joints(_)) {
        for mut row in rows.row_iter_mut() {
            let length = row.norm();
            row /= length;
        }
    }
    rows
}

/// Random parameters of physically consistent bodies.
///
/// Masses, friction and rotor inertias are positive; each central inertia is that of point masses.
#[must_use]
pub fn random_parameters(mechanism: &Mechanism, seed: u64) -> DVector<f64> {
    let mut generator = Pcg64::seed_from_u64(seed);
    let mut of_directions = Pcg64::seed_from_u64(seed.wrapping_add(1 << 40));
    let mut all = Vec::with_capacity(count(mechanism));
    for joint in mechanism.legs.iter().flat_map(|leg| &leg.joints) {
        all.extend(random_body(&mut generator));
        let mut within = |low: f64, high: f64| generator.random_range(low..high);
        all.extend([
            within(0.01, 0.1),
            within(0.1, 1.0),
            within(0.1, 1.0),
            within(-0.3, 0.3),
        ]);
        all.push(joint.spring.as_ref().map_or(0.0, |_| within(1.0, 10.0)));
        let mut friction = || of_directions.random_range(0.1..1.0);
        all.extend([friction(), friction(), friction(), friction()]);
        all.push(joint.stribeck.map_or(0.0, |_| friction()));
        all.push(joint.load.as_ref().map_or(0.0, |_| friction()));
        all.push(friction());
    }
    if mechanism.motion.has_platform() {
        all.extend(random_body(&mut generator));
        all.extend(random_body(&mut generator));
    }
    let coefficient = |_| generator.random_range(1.0..10.0);
    all.extend(mechanism.elements.iter().map(coefficient));
    for motor in &mechanism.motors {
        let mut within = |low: f64, high: f64| generator.random_range(low..high);
        all.extend([0.0; INERTIAL]);
        all.extend([
            within(0.01, 0.1),
            within(0.1, 1.0),
            within(0.1, 1.0),
            within(-0.3, 0.3),
            0.0,
        ]);
        all.extend([(); 4].map(|()| within(0.1, 1.0)));
        all.extend([motor.stribeck.map_or(0.0, |_| within(0.1, 1.0)), 0.0]);
        all.push(within(0.1, 1.0));
    }
    DVector::from_vec(all)
}

/// Parameters without dissipation: friction, offset and dampers are zero, springs stay.
#[must_use]
pub fn frictionless(mechanism: &Mechanism, parameters: &DVector<f64>) -> DVector<f64> {
    let mut kept = parameters.clone();
    for at in 0..platform_start(mechanism) {
        if at % BODY > INERTIAL && at % BODY != STIFFNESS {
            kept[at] = 0.0;
        }
    }
    for at in motor_start(mechanism)..kept.len() {
        if (at - motor_start(mechanism)) % BODY > INERTIAL {
            kept[at] = 0.0;
        }
    }
    for (index, element) in mechanism.elements.iter().enumerate() {
        let law = element.force.as_ref();
        if law.is_some_and(|law| law.force(1.0, 0.0) != law.force(1.0, 1.0)) {
            kept[element_start(mechanism) + index] = 0.0;
        }
    }
    kept
}

/// Four random point masses make a general body: [xx xy xz yy yz zz mx my mz m].
fn random_body(generator: &mut Pcg64) -> [f64; INERTIAL] {
    let (mut mass, mut moment, mut inertia) = (0.0, Vector3::zeros(), Matrix3::zeros());
    for _ in 0..4 {
        let part: f64 = generator.random_range(0.1..0.5);
        let at = Vector3::from_fn(|_, _| generator.random_range(-0.2..0.2));
        mass += part;
        moment += part * at;
        inertia += part * (at.norm_squared() * Matrix3::identity() - at * at.transpose());
    }
    let [xx, xy, xz] = [inertia[(0, 0)], inertia[(0, 1)], inertia[(0, 2)]];
    let [yy, yz, zz] = [inertia[(1, 1)], inertia[(1, 2)], inertia[(2, 2)]];
    [xx, xy, xz, yy, yz, zz, moment.x, moment.y, moment.z, mass]
}

fn random_vector(generator: &mut Pcg64, scales: &[f64]) -> DVector<f64> {
    let entry = |scale: &f64| scale * generator.random_range(-1.0..1.0);
    DVector::from_vec(scales.iter().map(entry).collect())
}
