//! Recursive Newton-Euler algorithm on the virtual tree and the free platform (1), (6).
//!
//! A body has mass m, first moment s and inertia I about the origin of its frame, whose
//! acceleration is a. It needs
//!
//! - the force f = m (a - g) + ω̇ x s + ω x (ω x s),
//! - the moment n = s x (a - g) + I ω̇ + ω x I ω about the origin.
//!
//! From the tips to the base, a joint carries the sum of the wrenches after it. Its torque is the
//! component along its axis, plus rotor inertia and friction (5). A dependent joint's torque is
//! added to the variables that move it.
//!
//! Everything is linear in the parameters: a column is the same computation with one parameter
//! equal to 1 and all others zero.

use super::closure::State;
use super::elements::add_columns;
use super::kinematics::BodyMotion;
use super::mechanism::{JointKind, Leg, Mechanism};
use super::motors;
use super::parameters::{BODY, INERTIAL, QUADRATIC, element_start, leg_start, platform_start};
use nalgebra::{DMatrix, DVector, Matrix3, Vector3};

/// A force and the moment about the origin of the body's frame, in the base frame.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Wrench {
    /// Force, N.
    pub force: Vector3<f64>,
    /// Moment, N m.
    pub moment: Vector3<f64>,
}

/// Mass, first moment and inertia of a body about its frame's origin, in the base frame.
///
/// `parameters` begins with [xx xy xz yy yz zz mx my mz m] in the body's frame.
#[must_use]
pub fn inertia(rotation: &Matrix3<f64>, parameters: &[f64]) -> (f64, Vector3<f64>, Matrix3<f64>) {
    let [xx, xy, xz, yy, yz, zz, mx, my, mz, m] =
        std::array::from_fn::<f64, INERTIAL, _>(|at| parameters[at]);
    let tensor = Matrix3::new(xx, xy, xz, xy, yy, yz, xz, yz, zz);
    (
        m,
        rotation * Vector3::new(mx, my, mz),
        rotation * tensor * rotation.transpose(),
    )
}

/// Wrench that causes the motion of a body against gravity and inertia.
#[must_use]
pub fn body_wrench(body: &BodyMotion, parameters: &[f64], gravity: &Vector3<f64>) -> Wrench {
    let (mass, moment, inertia) = inertia(&body.frame.rotation, parameters);
    let (spin, growth) = (body.angular_velocity, body.angular_acceleration);
    let acceleration = body.acceleration - gravity;
    Wrench {
        force: mass * acceleration + growth.cross(&moment) + spin.cross(&spin.cross(&moment)),
        moment: moment.cross(&acceleration) + inertia * growth + spin.cross(&(inertia * spin)),
    }
}

/// Sign of a velocity, 0 at rest.
#[must_use]
pub fn sign(velocity: f64) -> f64 {
    if velocity == 0.0 {
        0.0
    } else {
        velocity.signum()
    }
}

impl Wrench {
    const ZERO: Self = Self {
        force: Vector3::new(0.0, 0.0, 0.0),
        moment: Vector3::new(0.0, 0.0, 0.0),
    };

    /// Adds a wrench whose moment is about a point at `arm` from this one's.
    fn add(&mut self, other: &Self, arm: &Vector3<f64>) {
        self.force += other.force;
        self.moment += other.moment + arm.cross(&other.force);
    }
}

/// Torques of a leg's variables, and the reaction at its base as a wrench about the robot's origin.
///
/// `parameters` has [`BODY`] values per joint; `loads` are additional wrenches on its bodies about
/// the same point.
#[must_use]
fn leg_torques(
    leg: &Leg,
    bodies: &[BodyMotion],
    [q, qd, qdd]: [&[f64]; 3],
    parameters: &[f64],
    gravity: &Vector3<f64>,
    loads: &[(usize, Wrench)],
) -> (DVector<f64>, Wrench) {
    let (rates, growth) = (leg.joint_values(qd), leg.joint_values(qdd));
    let positions = leg.joint_values(q);
    let owners = leg.variables();
    let own = |j: usize| &parameters[BODY * j..BODY * (j + 1)];
    let mut wrenches: Vec<Wrench> = bodies
        .iter()
        .enumerate()
        .map(|(j, body)| body_wrench(body, own(j), gravity))
        .collect();
    for (body, load) in loads {
        wrenches[*body].add(load, &-bodies[*body].frame.position);
    }
    let mut base = Wrench::ZERO;
    let mut torques = DVector::zeros(owners.len());
    for (j, joint) in leg.joints.iter().enumerate().rev() {
        let (wrench, place) = (wrenches[j], bodies[j].frame);
        match joint.antecedent {
            Some(before) => {
                let arm = place.position - bodies[before].frame.position;
                wrenches[before].add(&wrench, &arm);
            }
            None => base.add(&wrench, &place.position),
        }
        let along = match joint.kind {
            JointKind::Revolute => place.z().dot(&wrench.moment),
            JointKind::Prismatic => place.z().dot(&wrench.force),
            JointKind::Fixed => continue,
        };
        let [rotor, viscous, dry, offset, stiffness] =
            std::array::from_fn(|at| own(j)[INERTIAL + at]);
        let friction = friction(rates[j], &own(j)[INERTIAL + 5..], joint.stribeck)
            + own(j)[INERTIAL + 10]
                * joint
                    .load
                    .as_ref()
                    .map_or(0.0, |load| load.torque(positions[j]).abs())
                * sign(rates[j])
            + own(j)[QUADRATIC] * rates[j] * rates[j].abs();
        let spring = joint
            .spring
            .as_ref()
            .map_or(0.0, |spring| spring.torque(positions[j]));
        let drive = rotor * growth[j]
            + viscous * rates[j]
            + dry * sign(rates[j])
            + offset
            + stiffness * spring
            + friction;
        for &(owner, coefficient) in &joint.terms {
            let at = owners.iter().position(|&index| index == owner);
            torques[at.unwrap_or_default()] += coefficient * (along + drive);
        }
    }
    (torques, base)
}

/// Friction with the coefficients [fv_pos fs_pos fv_neg fs_neg fst].
///
/// Each direction has its own law; at rest their mean applies. The excess `fst` falls from
/// standstill to half at the Stribeck velocity.
#[must_use]
pub fn friction(rate: f64, coefficients: &[f64], stribeck: Option<f64>) -> f64 {
    let [viscous_up, dry_up, viscous_down, dry_down, excess] =
        std::array::from_fn(|at| coefficients[at]);
    let directed = if rate > 0.0 {
        dry_up + viscous_up * rate
    } else if rate < 0.0 {
        viscous_down * rate - dry_down
    } else {
        (dry_up - dry_down) / 2.0
    };
    let stribeck_fraction =
        |velocity: f64| velocity * velocity / (velocity * velocity + rate * rate);
    directed + excess * stribeck.map_or(0.0, stribeck_fraction) * sign(rate)
}

/// Known torques of a leg's variables, without parameters.
fn known_torques(leg: &Leg, q: &[f64]) -> DVector<f64> {
    let owners = leg.variables();
    let mut torques = DVector::zeros(owners.len());
    for (joint, position) in leg.joints.iter().zip(leg.joint_values(q)) {
        let Some(known) = &joint.known else { continue };
        for &(owner, coefficient) in &joint.terms {
            let at = owners.iter().position(|&index| index == owner);
            torques[at.unwrap_or_default()] += coefficient * known.torque(position);
        }
    }
    torques
}

/// Torques τ_t of the virtual tree for all parameters (1), plus known torques.
#[must_use]
pub fn tree_torques(
    mechanism: &Mechanism,
    state: &State,
    parameters: &DVector<f64>,
) -> DVector<f64> {
    let mut all = DVector::zeros(mechanism.joints());
    let motions = state.legs(mechanism);
    let mut loads = Vec::new();
    let legs = mechanism
        .legs
        .iter()
        .zip(mechanism.leg_ranges())
        .enumerate();
    // Chains are processed before the legs that carry them.
    for (k, (leg, range)) in legs.rev() {
        let own = &parameters.as_slice()[leg_start(mechanism, k)..leg_start(mechanism, k + 1)];
        let motion = [&state.q, &state.qd, &state.qdd].map(|all| &all.as_slice()[range.clone()]);
        let applied: Vec<(usize, Wrench)> = loads
            .iter()
            .filter(|((of, _), _)| *of == k)
            .map(|((_, body), load)| (*body, *load))
            .collect();
        let (torques, base) =
            leg_torques(leg, &motions[k], motion, own, &mechanism.gravity, &applied);
        let torques = torques + known_torques(leg, motion[0]);
        all.rows_mut(range.start, range.len()).copy_from(&torques);
        loads.extend(leg.carrier.map(|carrier| (carrier, base)));
    }
    all
}

/// Wrench τ_p of the platform and its payload as [force; moment] (6); zero without a platform.
#[must_use]
pub fn platform_wrench(
    mechanism: &Mechanism,
    state: &State,
    parameters: &DVector<f64>,
) -> DVector<f64> {
    if !mechanism.motion.has_platform() {
        return DVector::zeros(0);
    }
    let body = state.platform(mechanism);
    let first = platform_start(mechanism);
    let mut total = DVector::zeros(6);
    for start in [first, first + INERTIAL] {
        let own = &parameters.as_slice()[start..start + INERTIAL];
        let wrench = body_wrench(&body, own, &mechanism.gravity);
        for axis in 0..3 {
            total[axis] += wrench.force[axis];
            total[3 + axis] += wrench.moment[axis];
        }
    }
    total
}

/// Projected platform wrench τ_pr = Dᵀ τ_p (17).
#[must_use]
pub fn projected_platform_wrench(
    mechanism: &Mechanism,
    state: &State,
    parameters: &DVector<f64>,
) -> DVector<f64> {
    if !mechanism.motion.has_platform() {
        return DVector::zeros(mechanism.dof());
    }
    mechanism.motion.free_basis().transpose() * platform_wrench(mechanism, state, parameters)
}

/// Torques and base reaction of a leg that carries loads and has no parameters.
fn carried_torques(
    mechanism: &Mechanism,
    state: &State,
    k: usize,
    bodies: &[BodyMotion],
    load: (usize, Wrench),
) -> (DVector<f64>, Wrench) {
    let leg = &mechanism.legs[k];
    let range = mechanism.leg_ranges()[k].clone();
    let motion = [&state.q, &state.qd, &state.qdd].map(|all| &all.as_slice()[range.clone()]);
    let none = vec![0.0; BODY * leg.joints.len()];
    leg_torques(leg, bodies, motion, &none, &mechanism.gravity, &[load])
}

/// Right-hand side [τ_t; τ_pr] of (16) for every unit parameter, (n_t + r) x n_st.
#[must_use]
pub fn regressor(mechanism: &Mechanism, state: &State) -> DMatrix<f64> {
    let count = super::parameters::count(mechanism);
    let joints = mechanism.joints();
    let dof = if mechanism.motion.has_platform() {
        mechanism.motion.free_basis().ncols()
    } else {
        mechanism.dof()
    };
    let mut columns = DMatrix::zeros(joints + dof, count);
    let motions = state.legs(mechanism);
    for (k, (leg, range)) in mechanism
        .legs
        .iter()
        .zip(mechanism.leg_ranges())
        .enumerate()
    {
        let motion = [&state.q, &state.qd, &state.qdd].map(|all| &all.as_slice()[range.clone()]);
        for at in 0..BODY * leg.joints.len() {
            let mut unit = vec![0.0; BODY * leg.joints.len()];
            unit[at] = 1.0;
            let gravity = &mechanism.gravity;
            let (torques, base) = leg_torques(leg, &motions[k], motion, &unit, gravity, &[]);
            let column = leg_start(mechanism, k) + at;
            columns
                .view_mut((range.start, column), (range.len(), 1))
                .copy_from(&torques);
            let (mut carrier, mut load) = (leg.carrier, base);
            while let Some((of, body)) = carrier {
                let (applied, base) =
                    carried_torques(mechanism, state, of, &motions[of], (body, load));
                let first = mechanism.leg_ranges()[of].start;
                columns
                    .view_mut((first, column), (applied.len(), 1))
                    .copy_from(&applied);
                (carrier, load) = (mechanism.legs[of].carrier, base);
            }
        }
    }
    for at in platform_start(mechanism)..element_start(mechanism) {
        let mut unit = DVector::zeros(count);
        unit[at] = 1.0;
        let platform = projected_platform_wrench(mechanism, state, &unit);
        columns
            .view_mut((joints, at), (dof, 1))
            .copy_from(&platform);
    }
    add_columns(mechanism, state, &mut columns);
    motors::add_columns(mechanism, state, &mut columns);
    columns
}
