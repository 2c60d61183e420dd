//! Forward recursion: placements, velocities and accelerations of all bodies in the base frame.
//!
//! From the antecedent i to frame j, l being the vector between the origins and s the rate of the
//! joint along or about its axis z:
//!
//! - ω_j = ω_i + s z (revolute), v_j = v_i + ω_i x l + s z (prismatic);
//! - ω̇_j = ω̇_i + ω_i x s z + ṡ z (revolute);
//! - v̇_j = v̇_i + ω̇_i x l + ω_i x (ω_i x l) + 2 ω_i x s z + ṡ z (prismatic terms last).
//!
//! The offset r along a revolute axis needs no term of its own: the axis doesn't move in i.

use super::mechanism::{End, JointKind, Leg, Mechanism};
use super::motion::Motion;
use super::placement::Frame;
use nalgebra::{DVector, Vector3, Vector6};

/// Placement, velocity and acceleration of a body, for the origin of its frame.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct BodyMotion {
    /// Placement in the base frame.
    pub frame: Frame,
    /// Velocity of the origin.
    pub velocity: Vector3<f64>,
    /// Angular velocity.
    pub angular_velocity: Vector3<f64>,
    /// Acceleration of the origin, gravity not included.
    pub acceleration: Vector3<f64>,
    /// Angular acceleration.
    pub angular_acceleration: Vector3<f64>,
}

impl BodyMotion {
    /// A body at rest.
    #[must_use]
    pub fn at_rest(frame: Frame) -> Self {
        Self {
            frame,
            velocity: Vector3::zeros(),
            angular_velocity: Vector3::zeros(),
            acceleration: Vector3::zeros(),
            angular_acceleration: Vector3::zeros(),
        }
    }

    /// Motion of a frame fixed to the body, its placement given in the body's frame.
    #[must_use]
    pub fn carried(&self, placement: Frame) -> Self {
        let arm = self.frame.rotation * placement.position;
        let spin = self.angular_velocity;
        Self {
            frame: self.frame * placement,
            velocity: self.velocity + spin.cross(&arm),
            acceleration: self.acceleration
                + self.angular_acceleration.cross(&arm)
                + spin.cross(&spin.cross(&arm)),
            ..*self
        }
    }

    /// Velocity of the origin above the angular velocity.
    #[must_use]
    pub fn twist(&self) -> Vector6<f64> {
        stacked(self.velocity, self.angular_velocity)
    }

    /// Acceleration of the origin above the angular acceleration.
    #[must_use]
    pub fn twist_derivative(&self) -> Vector6<f64> {
        stacked(self.acceleration, self.angular_acceleration)
    }
}

/// Motion of every body of a leg for given positions, velocities and accelerations of its
/// variables.
#[must_use]
pub fn leg_motion(leg: &Leg, q: &[f64], qd: &[f64], qdd: &[f64]) -> Vec<BodyMotion> {
    moving_leg(leg, BodyMotion::at_rest(leg.base), [q, qd, qdd])
}

/// The same on a moving base.
fn moving_leg(leg: &Leg, base: BodyMotion, [q, qd, qdd]: [&[f64]; 3]) -> Vec<BodyMotion> {
    let (values, rates, growth) = (
        leg.joint_values(q),
        leg.joint_values(qd),
        leg.joint_values(qdd),
    );
    let mut bodies: Vec<BodyMotion> = Vec::with_capacity(leg.joints.len());
    for (j, joint) in leg.joints.iter().enumerate() {
        let before = joint.antecedent.map_or(base, |at| bodies[at]);
        // Rigid motion of the carried frame first; then only the joint's own motion is added.
        let mut body = before.carried(joint.placement(values[j]));
        let axis = body.frame.z();
        let (rate, acceleration) = (rates[j] * axis, growth[j] * axis);
        let spin = before.angular_velocity;
        match joint.kind {
            JointKind::Revolute => {
                body.angular_velocity += rate;
                body.angular_acceleration += spin.cross(&rate) + acceleration;
            }
            JointKind::Prismatic => {
                body.velocity += rate;
                body.acceleration += 2.0 * spin.cross(&rate) + acceleration;
            }
            JointKind::Fixed => {}
        }
        bodies.push(body);
    }
    bodies
}

/// Motion of the platform; v and v̇ are its twist coordinates (14).
#[must_use]
pub fn platform_motion(
    motion: &Motion,
    pose: &[f64],
    twist: &DVector<f64>,
    acceleration: &DVector<f64>,
) -> BodyMotion {
    let mut body = BodyMotion::at_rest(motion.placement(pose));
    if !motion.has_platform() {
        return body;
    }
    let basis = motion.twist_basis();
    let (t, td) = (&basis * twist, &basis * acceleration);
    body.velocity = Vector3::new(t[0], t[1], t[2]);
    body.angular_velocity = Vector3::new(t[3], t[4], t[5]);
    body.acceleration = Vector3::new(td[0], td[1], td[2]);
    body.angular_acceleration = Vector3::new(td[3], td[4], td[5]);
    body
}

/// Motion of the leg's end frame as the leg moves it.
#[must_use]
pub fn end_from_leg(leg: &Leg, bodies: &[BodyMotion]) -> BodyMotion {
    match leg.end {
        End::Free | End::Cable { .. } => BodyMotion::at_rest(leg.base),
        End::Rigid { joint, .. } | End::Point { joint, .. } => bodies[joint],
    }
}

/// Motion of the leg's end frame as the platform moves it.
#[must_use]
pub fn end_from_platform(leg: &Leg, platform: &BodyMotion) -> BodyMotion {
    match leg.end {
        End::Free => BodyMotion::at_rest(leg.base),
        End::Rigid { attachment, .. } => platform.carried(attachment),
        End::Point { attachment, .. } | End::Cable { attachment, .. } => {
            platform.carried(Frame::at(attachment.x, attachment.y, attachment.z))
        }
    }
}

/// The closure equations of a leg as components of the six-vector (position, orientation): all of
/// them, some of the position, or none.
#[must_use]
pub fn end_components(leg: &Leg) -> Vec<usize> {
    match leg.end {
        End::Free => Vec::new(),
        // The length.
        End::Cable { .. } => vec![0],
        End::Rigid { .. } => (0..6).collect(),
        End::Point { along, .. } => (0..3).filter(|&axis| along[axis]).collect(),
    }
}

/// Number of closure equations of a leg.
#[must_use]
pub fn end_equations(leg: &Leg) -> usize {
    end_components(leg).len()
}

/// Motions of all bodies of all legs; the joint vectors have the layout of the mechanism.
#[must_use]
pub fn all_legs(
    mechanism: &Mechanism,
    q: &DVector<f64>,
    qd: &DVector<f64>,
    qdd: &DVector<f64>,
) -> Vec<Vec<BodyMotion>> {
    let mut all: Vec<Vec<BodyMotion>> = Vec::new();
    for (leg, range) in mechanism.legs.iter().zip(mechanism.leg_ranges()) {
        let base = match leg.carrier {
            Some((of, body)) => all[of][body].carried(leg.base),
            None => BodyMotion::at_rest(leg.base),
        };
        let own = [q, qd, qdd].map(|all| &all.as_slice()[range.clone()]);
        all.push(moving_leg(leg, base, own));
    }
    all
}

fn stacked(above: Vector3<f64>, below: Vector3<f64>) -> Vector6<f64> {
    Vector6::new(above.x, above.y, above.z, below.x, below.y, below.z)
}
