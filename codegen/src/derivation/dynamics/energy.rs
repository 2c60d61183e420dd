//! Kinetic energy from the velocities of all bodies.
//!
//! A body has the energy ½ m V·V + s · (V × Ω) + ½ Ω · I Ω, in its own axes, with the first moment
//! s. Before that, inertia that a joint's motion leaves invariant is moved to the body before the
//! joint, as in the recursion of Newton and Euler, so that later bodies have fewer parameters. A
//! rotor adds ½ ia q̇².

use super::newton_euler::with;
use super::tree_masses::on_carrier;
use crate::cas::{Arena, Expr, Number, Ratio, Vector3};
use crate::derivation::bodies::inertia::Inertia;
use crate::derivation::bodies::motion::RobotMotion;
use crate::derivation::kinematics::joint::link_vector;
use crate::derivation::kinematics::orientation::constant_rotation;
use crate::derivation::kinematics::spatial::SpatialMotion;
use crate::derivation::kinematics::turn::Turn;
use crate::derivation::parameter::BodyParameter;
use crate::derivation::robot::Robot;
use crate::mechanism::{JointKind, Leg, StandardParameter};

impl<'a> Robot<'a> {
    /// Kinetic energy of all bodies and rotors, for a motion with the independent velocities
    /// `twist`.
    ///
    /// `None` if the configuration does not determine a sine or cosine.
    pub(crate) fn kinetic_energy(
        &self,
        twist: &[Expr<'a>],
        motion: &RobotMotion<'a>,
        values: &[(BodyParameter, Expr<'a>)],
    ) -> Option<Expr<'a>> {
        let (arena, legs) = (self.arena, &self.mechanism.legs);
        let mut bodies = self.grouped_bodies(values)?;
        let mut velocities: Vec<Vec<SpatialMotion<'a>>> = Vec::new();
        let mut twice = arena.zero();
        for (index, leg) in legs.iter().enumerate() {
            arena.enter(&leg.name);
            let base = leg.base_body.map(|body| velocities[body.leg][body.joint]);
            let own = self.body_velocities(index, &motion.u[index], base)?;
            for (body, velocity) in bodies[index].drain(..).zip(&own) {
                twice = twice + twice_energy(&body, velocity);
            }
            velocities.push(own);
            twice = twice + self.twice_rotor_energy(index, &motion.u[index], values);
        }
        arena.enter("platform");
        if let Some(pose) = &self.platform {
            let still = vec![arena.zero(); twist.len()];
            let (velocity, acceleration) = self.free_motion(twist, &still);
            let moved = pose.motion(&velocity, &acceleration);
            let body = self.platform_inertia(values);
            let into = pose.rotation.transposed();
            twice = twice + moved.velocity.dot(moved.velocity) * body.mass;
            let own = SpatialMotion {
                linear: into * moved.velocity,
                angular: into * moved.angular_velocity,
            };
            let mass = arena.zero();
            twice = twice + twice_energy(&Inertia { mass, ..body }, &own);
        }
        arena.enter("");
        twice = twice + self.twice_motor_energy(motion, values);
        Some(twice * arena.number(Number::ratio(Ratio::new(1, 2)?)))
    }

    /// The inertias of all bodies of the legs, without what the joints do not move.
    fn grouped_bodies(
        &self,
        values: &[(BodyParameter, Expr<'a>)],
    ) -> Option<Vec<Vec<Inertia<'a>>>> {
        let (arena, legs) = (self.arena, &self.mechanism.legs);
        let chains = (0..legs.len()).map(|index| self.chain(index, values));
        let chains = chains.collect::<Option<Vec<_>>>()?;
        let mut bodies: Vec<Vec<Inertia<'a>>> = chains.iter().map(|chain| chain.bodies()).collect();
        for (index, leg) in legs.iter().enumerate().rev() {
            arena.enter(&leg.name);
            let kept = chains[index].group(&mut bodies[index], leg.base_body.is_some());
            if let Some(carrier) = leg.base_body {
                let body = &mut bodies[carrier.leg][carrier.joint];
                *body = with(&on_carrier(arena, leg, &kept), body);
            }
        }
        arena.enter("");
        Some(bodies)
    }

    /// Velocities of a leg's bodies in their own axes; `base` is that of the body at its start.
    fn body_velocities(
        &self,
        index: usize,
        rates: &[Expr<'a>],
        base: Option<SpatialMotion<'a>>,
    ) -> Option<Vec<SpatialMotion<'a>>> {
        let (arena, leg, state) = (self.arena, &self.mechanism.legs[index], &self.legs[index]);
        let base = base.map_or(SpatialMotion::zero(arena), |body| {
            at_base(arena, leg, &body)
        });
        let mut all: Vec<SpatialMotion<'a>> = Vec::new();
        for (j, joint) in leg.joints.iter().enumerate() {
            let from = joint.antecedent.map_or(base, |before| all[before]);
            let turn = Turn::new(arena, leg, j, state.first_joint, &self.configuration)?;
            let link = link_vector(arena, leg, j, state.first_joint, &self.configuration)?;
            let rate = state.rates.joint[j].value(arena, rates);
            let along = Vector3::unit(arena, 2).scaled(rate);
            let mut own = SpatialMotion {
                linear: turn.apply(from.linear_at(link)),
                angular: turn.apply(from.angular),
            };
            match joint.kind {
                JointKind::Revolute => own.angular = own.angular + along,
                JointKind::Prismatic => own.linear = own.linear + along,
                JointKind::Fixed => {}
            }
            all.push(own);
        }
        Some(all)
    }

    /// Σ ia q̇² of a leg.
    fn twice_rotor_energy(
        &self,
        index: usize,
        rates: &[Expr<'a>],
        values: &[(BodyParameter, Expr<'a>)],
    ) -> Expr<'a> {
        let state = &self.legs[index];
        let of_joint = |j: usize| {
            let own = values.iter().filter(move |(parameter, _)| {
                parameter.of_joint(index, j) == Some(StandardParameter::Ia)
            });
            let zero = self.arena.zero();
            let inertia = own.fold(zero, |sum, (_, value)| sum + *value);
            let rate = state.rates.joint[j].value(self.arena, rates);
            rate.squared() * inertia
        };
        let joints = 0..self.mechanism.legs[index].joints.len();
        joints.fold(self.arena.zero(), |sum, j| sum + of_joint(j))
    }
}

/// Velocity of a leg's base frame, from that of the body on which it is mounted.
fn at_base<'a>(arena: &'a Arena, leg: &Leg, body: &SpatialMotion<'a>) -> SpatialMotion<'a> {
    let into = constant_rotation(arena, leg.base.rotation).transposed();
    let at = Vector3::constant(arena, leg.base.at);
    SpatialMotion {
        linear: into * body.linear_at(at),
        angular: into * body.angular,
    }
}

/// Twice the kinetic energy of a body.
fn twice_energy<'a>(body: &Inertia<'a>, velocity: &SpatialMotion<'a>) -> Expr<'a> {
    let SpatialMotion { linear, angular } = *velocity;
    let moving = linear.dot(linear) * body.mass;
    let across = body.first.dot(linear.cross(angular));
    let turning = angular.dot(body.second * angular);
    moving + across + across + turning
}
