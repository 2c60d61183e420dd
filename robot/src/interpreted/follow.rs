//! Forward kinematics from a pose that may be far from the wanted one.

use super::InterpretedRobot;
use overact::{Error, Function, Model, math::wrap_angle};

/// Forward kinematics walks towards far actuators in steps of this size (rad, m), so that the
/// assembly mode stays that of the start.
const STEP: f64 = 0.05;

/// Most steps of such a walk.
const STEPS: usize = 200;

impl InterpretedRobot {
    /// Forward kinematics in small steps from the start's actuators to the wanted ones. Should the
    /// straight way leave the workspace, the wanted ones are tried at once. `pose` is the start, and then
    /// what was found.
    ///
    /// # Errors
    /// As [`Model::pose_from_actuators`]; `pose` is unchanged then.
    pub fn follow_actuators(&self, actuators: &[f64], pose: &mut [f64]) -> Result<(), Error> {
        let info = self.info();
        if actuators.len() != info.sizes.actuators {
            // Forward kinematics says what is wrong with it.
            return self.pose_from_actuators(actuators, pose);
        }
        let mut from = vec![0.0; actuators.len()];
        let reached = self.evaluate(Function::ActuatorPositions, &[pose], &mut from);
        if reached.is_err() {
            // There is no way from a pose that the robot has not; a closed form needs none.
            return self.pose_from_actuators(actuators, pose);
        }
        let difference = |((to, from), revolute): ((&f64, &f64), &bool)| {
            if *revolute {
                wrap_angle(to - from)
            } else {
                to - from
            }
        };
        let way: Vec<f64> = actuators
            .iter()
            .zip(&from)
            .zip(info.actuator_is_revolute)
            .map(difference)
            .collect();
        let far = way.iter().fold(0.0_f64, |far, step| far.max(step.abs()));
        // A cast from a float saturates.
        let steps = ((far / STEP).ceil() as usize).clamp(1, STEPS);
        let mut at = pose.to_vec();
        for step in 1..steps {
            let part = step as f64 / steps as f64;
            let target: Vec<f64> = from.iter().zip(&way).map(|(f, w)| f + part * w).collect();
            if self.pose_from_actuators(&target, &mut at).is_err() {
                return self.pose_from_actuators(actuators, pose);
            }
        }
        self.pose_from_actuators(actuators, &mut at)?;
        pose.copy_from_slice(&at);
        Ok(())
    }
}
