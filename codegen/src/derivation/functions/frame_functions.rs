//! Functions of a frame on a body.

use crate::cas::{Expr, Vector3};
use crate::derivation::context::{DerivationContext, column};
use crate::derivation::derivation_error::DerivationError;
use crate::derivation::kinematics::spatial::{SpatialMotion, Wrench};
use crate::derivation::linear_algebra::elimination::Rows;
use crate::mechanism::{Frame, FrameBody};
use overact_core::{FrameFunction, FrameQuantity, Input};

impl<'a> DerivationContext<'a, '_> {
    /// The output of a frame's function.
    ///
    /// # Errors
    /// A body whose orientation does not follow from the inputs.
    pub(super) fn frame_rows(&mut self, of: FrameFunction) -> Result<Rows<'a>, DerivationError> {
        let frame = self.robot.mechanism.frames.get(of.frame);
        let found = frame.and_then(|frame| self.quantity(frame, of.quantity));
        found.ok_or_else(|| DerivationError::InverseKinematics {
            leg: frame.map_or_else(String::new, |frame| self.carrier(frame)),
        })
    }

    /// Name of the leg that carries a frame.
    fn carrier(&self, frame: &Frame) -> String {
        match frame.body {
            FrameBody::Platform => String::new(),
            FrameBody::Joint(body) => self.robot.mechanism.legs[body.leg].name.clone(),
        }
    }

    fn quantity(&mut self, frame: &Frame, quantity: FrameQuantity) -> Option<Rows<'a>> {
        if quantity == FrameQuantity::Pose {
            let pose = self.robot.frame_pose(frame)?;
            self.guards.extend(pose.guard);
            return Some(column(pose.entries));
        }
        let motion = self.robot.frame(frame)?;
        Some(match quantity {
            FrameQuantity::Pose | FrameQuantity::Jacobian => self.robot.frame_jacobian(&motion),
            FrameQuantity::Velocity => {
                let twist = self.twist();
                stacked(self.robot.frame_velocity(&motion, &twist)?)
            }
            FrameQuantity::AccelerationBias => {
                let twist = self.twist();
                stacked(self.robot.frame_bias(&motion, &twist)?)
            }
            FrameQuantity::Torques => {
                let wrench = self.input(Input::Wrench.name(), 6);
                let part = |first: usize| Vector3(std::array::from_fn(|k| wrench[first + k]));
                let wrench = Wrench {
                    force: -part(0),
                    moment: -part(3),
                };
                let forces = self.robot.frame_forces(&motion, wrench);
                let torques = self.actuator_system().torques(&forces);
                column(self.robot.with_tensions(torques))
            }
        })
    }
}

/// Six rows: the linear part, then the angular one.
fn stacked(motion: SpatialMotion<'_>) -> Rows<'_> {
    let entries: Vec<Expr<'_>> = (0..6).map(|row| motion.component(row)).collect();
    column(entries)
}
