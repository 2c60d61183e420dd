//! Total mass, first moment and linear momentum of all bodies, from positions and velocities only.

use super::closure::State;
use super::kinematics::BodyMotion;
use super::mechanism::Mechanism;
use super::newton_euler::inertia;
use super::parameters::{BODY, INERTIAL, leg_start, platform_start};
use nalgebra::{DVector, Vector3};

/// Sums over all bodies, the platform and the payload.
#[derive(Clone, Copy, Debug)]
pub struct Masses {
    /// Mass.
    pub mass: f64,
    /// First moment about the base's origin.
    pub moment: Vector3<f64>,
    /// Linear momentum.
    pub momentum: Vector3<f64>,
}

/// Sums over all bodies in a state.
#[must_use]
pub fn masses(mechanism: &Mechanism, state: &State, parameters: &DVector<f64>) -> Masses {
    let all = parameters.as_slice();
    let mut sum = Masses {
        mass: 0.0,
        moment: Vector3::zeros(),
        momentum: Vector3::zeros(),
    };
    let mut add = |body: &BodyMotion, own: &[f64]| {
        let (mass, moment, _) = inertia(&body.frame.rotation, own);
        sum.mass += mass;
        sum.moment += mass * body.frame.position + moment;
        sum.momentum += mass * body.velocity + body.angular_velocity.cross(&moment);
    };
    for (k, bodies) in state.legs(mechanism).iter().enumerate() {
        for (j, body) in bodies.iter().enumerate() {
            add(body, &all[leg_start(mechanism, k) + BODY * j..]);
        }
    }
    if mechanism.motion.has_platform() {
        let (platform, first) = (state.platform(mechanism), platform_start(mechanism));
        for start in [first, first + INERTIAL] {
            add(&platform, &all[start..]);
        }
    }
    sum
}
