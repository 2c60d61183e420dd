//! Forces on actuated joints, which their actuators balance directly.

use crate::cas::Expr;
use crate::derivation::robot::Robot;

/// A quasi-velocity that is the rate of an actuated joint.
#[derive(Debug)]
struct ActuatedRate {
    leg: usize,
    /// The quasi-velocity in its leg.
    rate: usize,
    actuator: usize,
}

/// Forces that act on the rates of actuated joints alone.
#[derive(Debug, Default)]
pub(crate) struct ActuatedJointForces<'a> {
    /// The actuated joints whose rate is a quasi-velocity.
    rates: Vec<ActuatedRate>,
    /// Force on each actuator; empty if these forces are not separated.
    forces: Vec<Expr<'a>>,
    /// Number of motors, which are the last actuators.
    motors: usize,
}

impl<'a> ActuatedJointForces<'a> {
    /// No forces yet. They are separated if the robot has as many actuators as independent
    /// coordinates.
    pub(crate) fn of(robot: &Robot<'a>) -> Self {
        let mechanism = robot.mechanism;
        let actuated = mechanism.actuated();
        let count = mechanism.actuator_count();
        if count != mechanism.dof() {
            return Self::default();
        }
        let joints = mechanism.joints();
        let rate = |(actuator, &index): (usize, &usize)| {
            let of = joints[index];
            let own = robot.legs[of.leg].rates.own(&[of.joint]);
            own.first().map(|&rate| ActuatedRate {
                leg: of.leg,
                rate,
                actuator,
            })
        };
        Self {
            rates: actuated.iter().enumerate().filter_map(rate).collect(),
            forces: vec![robot.arena.zero(); count],
            motors: mechanism.motors.len(),
        }
    }

    /// Moves the forces on actuated joints out of the forces on a leg's quasi-velocities.
    pub(crate) fn take(&mut self, leg: usize, forces: &mut [Expr<'a>]) {
        for own in self.rates.iter().filter(|own| own.leg == leg) {
            let force = forces[own.rate];
            self.forces[own.actuator] = self.forces[own.actuator] + force;
            forces[own.rate] = force.arena().zero();
        }
    }

    /// Force on each actuator; empty if these forces are not separated.
    pub(crate) fn forces(&self) -> &[Expr<'a>] {
        &self.forces
    }

    /// Adds a torque at a motor; false if these forces are not separated.
    pub(crate) fn add_at_motor(&mut self, motor: usize, torque: Expr<'a>) -> bool {
        let first = self.forces.len().checked_sub(self.motors);
        let own = first.and_then(|first| self.forces.get_mut(first + motor));
        let Some(own) = own else { return false };
        *own = *own + torque;
        true
    }

    /// Actuator torques: these forces plus those that balance the rest.
    pub(crate) fn with(self, rest: Vec<Expr<'a>>) -> Vec<Expr<'a>> {
        if self.forces.is_empty() {
            return rest;
        }
        let own = self.forces.into_iter().zip(rest);
        own.map(|(own, rest)| own + rest).collect()
    }
}
