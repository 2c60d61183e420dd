//! Frames on bodies, such as tools: pose, Jacobian, velocity, and acceleration at v̇ = 0.
//!
//! A frame on the platform has the platform's velocity at the frame's origin; so has one on a
//! leg's last body that is rigidly connected to the platform. A frame on another body moves with
//! the joints on the path from the base to the body ([`joint_frame`]). Orientations are composed
//! from half angles or from the pose's quaternion ([`pose`]). All vectors are in the base's axes.

mod joint_frame;
mod pose;

use self::joint_frame::JointFrame;
use crate::cas::{Expr, Vector3};
use crate::derivation::kinematics::orientation::constant_rotation;
use crate::derivation::kinematics::path::KnownMotion;
use crate::derivation::kinematics::spatial::{SpatialMotion, Wrench};
use crate::derivation::linear_algebra::elimination::Rows;
use crate::derivation::robot::Robot;
use crate::mechanism::{BodyIndex, End, Frame, FrameBody, Mechanism, Placement};

/// The body that carries a frame, with the frame's placement on it.
enum Carrier<'m> {
    /// The platform; the placements follow each other.
    Platform(Vec<&'m Placement>),
    /// The body after a joint.
    Joint(BodyIndex, &'m Placement),
}

impl<'m> Carrier<'m> {
    /// The carrier of a frame. The last body of a leg with a rigid end is part of the platform.
    fn of(mechanism: &'m Mechanism, frame: &'m Frame) -> Self {
        let body = match frame.body {
            FrameBody::Platform => return Self::Platform(vec![&frame.placement]),
            FrameBody::Joint(body) => body,
        };
        let leg = &mechanism.legs[body.leg];
        let is_last = body.joint + 1 == leg.joints.len();
        match &leg.end {
            Some(End::Rigid(end)) if is_last && leg.end_body.is_none() => {
                Self::Platform(vec![end, &frame.placement])
            }
            _ => Self::Joint(body, &frame.placement),
        }
    }
}

/// A frame in a derivation.
pub(crate) enum FrameMotion<'a> {
    /// On the platform, at this vector from the platform's origin.
    Platform(Vector3<'a>),
    /// On a body that joints move.
    Joint(Box<JointFrame<'a>>),
}

impl<'a> Robot<'a> {
    /// The motion of a frame.
    ///
    /// `None` if the configuration does not determine a sine or cosine.
    pub(crate) fn frame(&self, frame: &Frame) -> Option<FrameMotion<'a>> {
        Some(match Carrier::of(self.mechanism, frame) {
            Carrier::Platform(placements) => {
                let platform = self.platform.as_ref()?;
                FrameMotion::Platform(platform.rotation * self.point(&placements))
            }
            Carrier::Joint(body, placement) => {
                let known = self.known_motion();
                let at = Vector3::constant(self.arena, placement.at);
                FrameMotion::Joint(Box::new(JointFrame::new(&known, body, at)?))
            }
        })
    }

    /// The origin of the last of several frames on each other, in the axes of the first body.
    fn point(&self, placements: &[&Placement]) -> Vector3<'a> {
        let start = Vector3::zero(self.arena);
        placements.iter().rev().fold(start, |inner, placement| {
            let turned = constant_rotation(self.arena, placement.rotation) * inner;
            Vector3::constant(self.arena, placement.at) + turned
        })
    }

    /// The motion of all legs, for paths to their bodies.
    fn known_motion(&self) -> KnownMotion<'_, 'a> {
        let legs = self.legs.iter();
        KnownMotion {
            arena: self.arena,
            mechanism: self.mechanism,
            configuration: &self.configuration,
            legs: legs
                .map(|own| (own.first_joint, &own.rates, &own.rows))
                .collect(),
        }
    }

    /// ∂u/∂v of the quasi-velocities of all legs, leg by leg.
    fn rows_of_rates(&self) -> Rows<'a> {
        let legs = self.mechanism.legs.iter().zip(&self.legs);
        legs.flat_map(|(leg, state)| state.rows[..leg.independent().count()].to_vec())
            .collect()
    }

    /// J of a frame, 6 × r.
    pub(crate) fn frame_jacobian(&self, frame: &FrameMotion<'a>) -> Rows<'a> {
        let columns = match frame {
            FrameMotion::Platform(arm) => self.platform_columns(*arm),
            FrameMotion::Joint(frame) => frame.columns(&self.rows_of_rates(), self.mechanism.dof()),
        };
        (0..6)
            .map(|row| columns.iter().map(|c| c.component(row)).collect())
            .collect()
    }

    /// Velocities of a platform point and of the platform's rotation, per independent velocity.
    fn platform_columns(&self, arm: Vector3<'a>) -> Vec<SpatialMotion<'a>> {
        let at = |partial: SpatialMotion<'a>| SpatialMotion {
            linear: partial.linear_at(arm),
            angular: partial.angular,
        };
        match (&self.parasitic_motion, &self.platform) {
            (Some(parasitic), _) => {
                let partials = parasitic.partials(self.arena).into_iter();
                partials.map(at).collect()
            }
            (None, Some(platform)) => platform.directions().columns(self.arena, arm),
            (None, None) => Vec::new(),
        }
    }

    /// J v of a frame.
    pub(crate) fn frame_velocity(
        &self,
        frame: &FrameMotion<'a>,
        twist: &[Expr<'a>],
    ) -> Option<SpatialMotion<'a>> {
        let still = vec![self.arena.zero(); self.mechanism.dof()];
        match frame {
            FrameMotion::Platform(arm) => {
                let platform = self.platform.as_ref()?;
                let (velocity, acceleration) = self.free_motion(twist, &still);
                let motion = platform.motion(&velocity, &acceleration);
                Some(SpatialMotion {
                    linear: motion.point_velocity(*arm),
                    angular: motion.angular_velocity,
                })
            }
            FrameMotion::Joint(frame) => {
                let motion = self.motion(twist, &still)?;
                Some(frame.velocity(&motion.u.concat()))
            }
        }
    }

    /// J̇ v of a frame: its acceleration at v̇ = 0.
    pub(crate) fn frame_bias(
        &self,
        frame: &FrameMotion<'a>,
        twist: &[Expr<'a>],
    ) -> Option<SpatialMotion<'a>> {
        let still = vec![self.arena.zero(); self.mechanism.dof()];
        match frame {
            FrameMotion::Platform(arm) => {
                let platform = self.platform.as_ref()?;
                let (velocity, acceleration) = self.free_motion(twist, &still);
                let motion = platform.motion(&velocity, &acceleration);
                let omega = motion.angular_velocity;
                let tangential = motion.angular_acceleration.cross(*arm);
                let centripetal = omega.cross(omega.cross(*arm));
                Some(SpatialMotion {
                    linear: motion.acceleration + tangential + centripetal,
                    angular: motion.angular_acceleration,
                })
            }
            FrameMotion::Joint(frame) => {
                let motion = self.motion(twist, &still)?;
                Some(frame.acceleration(&motion.u.concat(), &motion.u_dot.concat()))
            }
        }
    }

    /// Jᵀ w of a frame: generalised forces of a wrench at its origin.
    pub(crate) fn frame_forces(
        &self,
        frame: &FrameMotion<'a>,
        wrench: Wrench<'a>,
    ) -> Vec<Expr<'a>> {
        match frame {
            FrameMotion::Platform(arm) => {
                let Some(platform) = &self.platform else {
                    return Vec::new();
                };
                self.on_independent(platform.directions().components(*arm, wrench))
            }
            FrameMotion::Joint(frame) => {
                let rows = self.rows_of_rates();
                self.combine(&rows, &frame.forces(rows.len(), wrench))
            }
        }
    }
}
