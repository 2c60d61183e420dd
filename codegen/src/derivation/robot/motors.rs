//! Motors that drive combinations of joints: θ̇ = T q̇.

use super::Robot;
use crate::cas::{Expr, Number};
use crate::derivation::derivation_error::DerivationError;
use crate::derivation::linear_algebra::elimination::Rows;
use crate::mechanism::Actuator;
use std::borrow::Borrow;

impl<'a> Robot<'a> {
    /// Row of a motor, from ∂u/∂(projected coordinates) of every leg: T G.
    pub(crate) fn motor_row(&self, motor: usize, legs: &[impl Borrow<Rows<'a>>]) -> Vec<Expr<'a>> {
        let joints = self.mechanism.joints();
        let mut sum: Vec<Expr<'a>> = Vec::new();
        for (at, factor) in &self.mechanism.motors[motor].terms {
            let of = joints[*at];
            self.arena.enter(&self.mechanism.legs[of.leg].name);
            let form = &self.legs[of.leg].rates.joint[of.joint];
            let row = form.row(self.arena, legs[of.leg].borrow()).into_iter();
            let row = row.map(|entry| entry * Number::ratio(*factor));
            sum = if sum.is_empty() {
                row.collect()
            } else {
                sum.iter()
                    .zip(row)
                    .map(|(sum, entry)| *sum + entry)
                    .collect()
            };
        }
        self.arena.enter("");
        sum
    }

    /// Rate or acceleration of a motor, from the quasi-velocities or their derivatives.
    pub(crate) fn motor_value(&self, motor: usize, u: &[Vec<Expr<'a>>]) -> Expr<'a> {
        let joints = self.mechanism.joints();
        let terms = self.mechanism.motors[motor].terms.iter();
        terms.fold(self.arena.zero(), |sum, (at, factor)| {
            let of = joints[*at];
            let form = &self.legs[of.leg].rates.joint[of.joint];
            sum + form.value(self.arena, &u[of.leg]) * Number::ratio(*factor)
        })
    }

    /// Values of all actuators from those of all joints.
    pub(crate) fn of_actuators(&self, joints: &[Expr<'a>]) -> Vec<Expr<'a>> {
        let value = |actuator| match actuator {
            Actuator::Joint(joint) => joints[joint],
            Actuator::Motor(motor) => {
                let terms = self.mechanism.motors[motor].terms.iter();
                terms.fold(self.arena.zero(), |sum, (joint, factor)| {
                    sum + joints[*joint] * Number::ratio(*factor)
                })
            }
        };
        self.mechanism.actuators().into_iter().map(value).collect()
    }

    /// Checks that the configuration determines the positions of all joints that motors turn.
    ///
    /// # Errors
    /// A joint whose position does not follow from the pose.
    pub(crate) fn check_motors(&self) -> Result<(), DerivationError> {
        for motor in &self.mechanism.motors {
            for (joint, _) in &motor.terms {
                if self.joint_position(*joint).is_none() {
                    let index = self.mechanism.joints()[*joint];
                    return Err(DerivationError::UndeterminedMotor {
                        motor: motor.name.clone(),
                        joint: self.mechanism.joint_name(index),
                    });
                }
            }
        }
        Ok(())
    }
}
