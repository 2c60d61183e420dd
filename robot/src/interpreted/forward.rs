//! Forward kinematics of an interpreted robot, as in generated code.

use super::InterpretedRobot;
use overact::{
    Error, Function, Model, dependent_joints,
    forward::{self, Measured},
    guard, parasitic_motion,
};
use overact_codegen::{derivation::MotionInput, interpreter::Rows};

/// Working memory of forward kinematics.
#[derive(Debug, Default)]
pub(super) struct Scratch {
    actuators: Vec<f64>,
    inverse_jacobian: Vec<f64>,
    normal: Vec<f64>,
    step: Vec<f64>,
    pose: Vec<f64>,
}

impl InterpretedRobot {
    /// Pose of a robot with loops for given actuators, solved from `start`.
    pub(super) fn found_pose(&self, actuators: &[f64], start: Vec<f64>) -> Result<Vec<f64>, Error> {
        let (sizes, mut start) = (self.names.sizes, start);
        if self.has_quaternion() {
            guard::normalise(&mut start, "start")?;
        }
        if self.independent.is_some() {
            self.displaced(&mut start, &[]);
        }
        let closed = self.pose_in_closed_form(actuators);
        if let (Some(found), true) = (&closed, sizes.actuators == sizes.dof) {
            return Ok(found.clone());
        }
        forward::from_closed_form(closed, start, |mut at| {
            self.fit_pose(actuators, &mut at).map(|()| at)
        })
    }

    /// Pose in closed form, if the robot has one and the spheres intersect.
    fn pose_in_closed_form(&self, actuators: &[f64]) -> Option<Vec<f64>> {
        let function = self
            .model
            .function(Function::PoseInClosedForm, MotionInput::Actuators)?;
        let mut pose = vec![0.0; self.names.sizes.pose];
        let given = [Rows {
            values: actuators,
            shared: false,
        }];
        let found = function.program.evaluate(1, &given, &mut pose);
        found.ok().map(|()| pose)
    }

    /// Least-squares pose, solved from the one in `pose`.
    fn fit_pose(&self, actuators: &[f64], pose: &mut [f64]) -> Result<(), Error> {
        let sizes = self.names.sizes;
        self.scratch.with(Scratch::default, |scratch| {
            scratch.resize(&sizes);
            let Scratch {
                actuators: reached,
                inverse_jacobian,
                normal,
                step,
                pose: at,
            } = scratch;
            at.copy_from_slice(pose);
            if self.steps_at_once(actuators, at, step) {
                pose.copy_from_slice(at);
                return Ok(());
            }
            at.copy_from_slice(pose);
            let is_revolute = &self.names.actuator_is_revolute;
            forward::gauss_newton(
                Measured {
                    positions: actuators,
                    is_revolute,
                },
                at,
                forward::Workspace {
                    actuators: reached,
                    inverse_jacobian,
                    normal,
                    step,
                },
                |pose, reached, jacobian| {
                    self.evaluate(Function::ActuatorPositions, &[pose], reached)
                        .and_then(|()| self.evaluate(Function::InverseJacobian, &[pose], jacobian))
                        .map_err(|error| error.error)
                },
                |pose, step| self.displaced(pose, step),
            )?;
            pose.copy_from_slice(at);
            Ok(())
        })
    }

    /// Newton steps with the combined function of positions and Jacobian, if available; whether
    /// they converged.
    fn steps_at_once(&self, actuators: &[f64], pose: &mut [f64], step: &mut [f64]) -> bool {
        let offered = self.model.served(Function::PoseStep).is_some();
        offered
            && forward::steps(
                pose,
                step,
                |pose, step| {
                    self.evaluate(Function::PoseStep, &[pose, actuators], step)
                        .map_err(|error| error.error)
                },
                |pose, step| self.displaced(pose, step),
            )
    }

    /// Moves a pose along the twist coordinates.
    pub(super) fn displaced(&self, pose: &mut [f64], step: &[f64]) {
        if let Some(independent) = &self.independent
            && self.model.mechanism.has_dependent_joints()
        {
            self.displaced_joints(pose, step, independent);
        } else if let Some(independent) = &self.independent {
            parasitic_motion::displace(pose, step, independent, |pose, errors, jacobian| {
                self.evaluate(Function::BlockedError, &[pose], errors)
                    .and_then(|()| self.evaluate(Function::BlockedJacobian, &[pose], jacobian))
                    .map_err(|error| error.error)
            });
        } else if self.has_quaternion() {
            forward::displace_quaternion(pose, step);
        } else {
            forward::displace(pose, step);
        }
    }
}

impl InterpretedRobot {
    /// Moves the independent joints of a skeleton's pose, and corrects the dependent ones.
    fn displaced_joints(&self, pose: &mut [f64], step: &[f64], independent: &[usize]) {
        let joints = pose.len();
        let count = joints - independent.len();
        let workspace = dependent_joints::Workspace {
            errors: &mut vec![0.0; count],
            jacobian: &mut vec![0.0; count * joints],
            square: &mut vec![0.0; count * count],
        };
        dependent_joints::displace(
            pose,
            step,
            independent,
            workspace,
            |pose, errors, jacobian| {
                self.evaluate(Function::PoseError, &[pose], errors)
                    .and_then(|()| self.evaluate(Function::PoseErrorJacobian, &[pose], jacobian))
                    .map_err(|error| error.error)
            },
        );
    }
}

impl Scratch {
    fn resize(&mut self, sizes: &overact::Sizes) {
        let (n, r) = (sizes.actuators, sizes.dof);
        self.actuators.resize(n, 0.0);
        self.inverse_jacobian.resize(n * r, 0.0);
        self.normal.resize(r * r, 0.0);
        self.step.resize(r, 0.0);
        self.pose.resize(sizes.pose, 0.0);
    }
}
