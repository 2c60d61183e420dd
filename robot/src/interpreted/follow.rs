//! Forward kinematics by continuation from a distant start pose.

use super::InterpretedRobot;
use overact::{Error, Function, Model, math::wrap_angle};

/// Continuation step of the actuators (rad, m); small steps keep the assembly mode of the start.
const STEP: f64 = 0.05;

/// Largest number of steps.
const STEPS: usize = 200;

impl InterpretedRobot {
    /// Forward kinematics in small steps from the start's actuators to the given ones.
    ///
    /// If the straight path leaves the workspace, the given actuators are tried directly. `pose` is
    /// the start on input and the solution on output.
    ///
    /// # Errors
    /// As [`Model::pose_from_actuators`]; `pose` is unchanged then.
    pub fn follow_actuators(&self, actuators: &[f64], pose: &mut [f64]) -> Result<(), Error> {
        let info = self.info();
        if actuators.len() != info.sizes.actuators {
            // Forward kinematics reports the error.
            return self.pose_from_actuators(actuators, pose);
        }
        let mut from = vec![0.0; actuators.len()];
        let reached = self.evaluate(Function::ActuatorPositions, &[pose], &mut from);
        if reached.is_err() {
            // The robot cannot reach the start pose, so there is no path; a closed form needs none.
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
        // The cast saturates.
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
