//! Energy of all bodies, from positions and velocities only.
//!
//! Kinetic: ½ m v·v + v·(ω x s) + ½ ω·I ω and ½ ia q̇² for every rotor. Potential: -g·(m p + s), and
//! the work against springs, known torques and forces between points, by quadrature.
//! Neither uses accelerations or the inverse dynamics. The frictionless power balance dE/dt = vᵀ Γ¹
//! is therefore an independent check.

use super::closure::State;
use super::elements::length;
use super::kinematics::BodyMotion;
use super::mechanism::{JointKind, Mechanism, Spring};
use super::motors;
use super::newton_euler::inertia;
use super::parameters::{BODY, INERTIAL, STIFFNESS, element_start, leg_start, platform_start};
use nalgebra::{DVector, Vector3};

/// Length from which the work of springs between points is counted, m.
const UNIT_LENGTH: f64 = 1.0;

/// Kinetic and potential energy of a body, its parameters those of [`inertia`].
#[must_use]
pub fn body_energy(body: &BodyMotion, parameters: &[f64], gravity: &Vector3<f64>) -> f64 {
    let (mass, moment, inertia) = inertia(&body.frame.rotation, parameters);
    let (velocity, spin) = (body.velocity, body.angular_velocity);
    let kinetic = 0.5 * mass * velocity.norm_squared()
        + velocity.dot(&spin.cross(&moment))
        + 0.5 * spin.dot(&(inertia * spin));
    kinetic - gravity.dot(&(mass * body.frame.position + moment))
}

/// Energy of the whole robot, rotors included.
#[must_use]
pub fn total_energy(mechanism: &Mechanism, state: &State, parameters: &DVector<f64>) -> f64 {
    let all = parameters.as_slice();
    let mut energy = 0.0;
    let motions = state.legs(mechanism);
    for (k, (leg, range)) in mechanism
        .legs
        .iter()
        .zip(mechanism.leg_ranges())
        .enumerate()
    {
        let rates = leg.joint_values(&state.qd.as_slice()[range.clone()]);
        let positions = leg.joint_values(&state.q.as_slice()[range]);
        let homes = leg.joint_values(&leg.start);
        for (j, body) in motions[k].iter().enumerate() {
            let own = &all[leg_start(mechanism, k) + BODY * j..];
            energy += body_energy(body, own, &mechanism.gravity);
            if leg.joints[j].kind != JointKind::Fixed {
                energy += 0.5 * own[INERTIAL] * rates[j] * rates[j];
            }
            let work = |spring: &Option<Spring>| {
                let spring = spring.as_ref();
                spring.map_or(0.0, |spring| spring.work(homes[j], positions[j]))
            };
            energy += own[STIFFNESS] * work(&leg.joints[j].spring) + work(&leg.joints[j].known);
        }
    }
    if mechanism.motion.has_platform() {
        let (platform, first) = (state.platform(mechanism), platform_start(mechanism));
        for start in [first, first + INERTIAL] {
            energy += body_energy(&platform, &all[start..], &mechanism.gravity);
        }
    }
    for (index, element) in mechanism.elements.iter().enumerate() {
        let coefficient = all[element_start(mechanism) + index];
        for (law, factor) in [(&element.force, coefficient), (&element.known, 1.0)] {
            if let Some(law) = law.clone() {
                let spring = Spring::new(move |length| law.force(length, 0.0));
                energy += factor * spring.work(UNIT_LENGTH, length(mechanism, state, element));
            }
        }
    }
    energy + motors::energy(mechanism, state, parameters)
}
