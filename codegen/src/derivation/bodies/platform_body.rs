//! Bodies that move with the platform: the platform, its payload, and the last bodies of legs with
//! a rigid end.
//!
//! Their parameters are projected on the twist coordinates directly, not through the joints of a
//! leg. All vectors are in the base's axes, as the twist is. With `U = [ω̇]× + [ω]×[ω]×` and the
//! body's axes r_k, a first moment along r_k has the force U r_k and the moment r_k × a. The
//! acceleration of every platform point contains U r_k, too.

use super::body::second_moment;
use super::inertia::Inertia;
use crate::cas::{Arena, Expr, Matrix3, Number, Vector3};
use crate::derivation::kinematics::orientation::constant_rotation;
use crate::derivation::kinematics::platform::{
    PlatformMotion, PlatformPose, centripetal, on_twist,
};
use crate::derivation::kinematics::spatial::{SpatialMotion, Wrench};
use crate::mechanism::{End, Leg, TwistCoordinate};
use overact_description::StandardParameter;

/// A frame that is fixed on the platform, in the platform frame.
#[derive(Debug, Clone, Copy)]
pub struct Mount<'a> {
    /// Constant orientation.
    rotation: Matrix3<'a>,
    /// Constant origin.
    at: [Number; 3],
}

impl<'a> Mount<'a> {
    /// The platform frame itself.
    #[must_use]
    pub fn platform(arena: &'a Arena) -> Self {
        Self {
            rotation: Matrix3::identity(arena),
            at: [Number::ZERO; 3],
        }
    }

    /// The inertia of a body in this frame, added to that of the platform in the platform frame.
    pub(crate) fn on_platform(
        &self,
        arena: &'a Arena,
        body: &Inertia<'a>,
        onto: &Inertia<'a>,
    ) -> Inertia<'a> {
        let turned = body.rotated(self.rotation);
        turned.moved_onto(onto, Vector3::constant(arena, self.at))
    }

    /// The frames of a leg's joints that are fixed on the platform: the last one if the end is
    /// rigid.
    ///
    /// `None` for the others.
    #[must_use]
    pub fn of_leg(arena: &'a Arena, leg: &Leg) -> Vec<Option<Self>> {
        let mut mounts = vec![None; leg.joints.len()];
        let on_platform = leg.end.as_ref().filter(|_| leg.end_body.is_none());
        if let (Some(End::Rigid(placement)), Some(last)) = (on_platform, mounts.last_mut()) {
            *last = Some(Self {
                rotation: constant_rotation(arena, placement.rotation),
                at: placement.at,
            });
        }
        mounts
    }
}

/// A body that moves with the platform, in the base's axes.
#[derive(Debug, Clone)]
pub struct PlatformBody<'a> {
    /// Orientation of the platform.
    platform: Matrix3<'a>,
    /// Orientation of the body on the platform.
    mounted: Matrix3<'a>,
    /// Angular velocity in the body's axes.
    omega: Vector3<'a>,
    /// Angular acceleration in the body's axes.
    alpha: Vector3<'a>,
    /// `U r_k` as columns.
    centripetal: Matrix3<'a>,
    /// Acceleration of the body frame's origin minus gravity.
    acceleration: Vector3<'a>,
    /// Vector from the platform's origin to the body frame's.
    arm: Vector3<'a>,
}

impl<'a> PlatformBody<'a> {
    /// A body mounted on the platform.
    #[must_use]
    pub fn new(
        pose: &PlatformPose<'a>,
        motion: &PlatformMotion<'a>,
        gravity: Vector3<'a>,
        mount: &Mount<'a>,
    ) -> Self {
        let (omega, alpha) = (motion.angular_velocity, motion.angular_acceleration);
        let arm = pose.arm(mount.at);
        let of_platform = motion
            .centripetal
            .unwrap_or_else(|| centripetal(omega, alpha) * pose.rotation);
        let into_platform = pose.rotation.transposed();
        let into_body = mount.rotation.transposed();
        Self {
            platform: pose.rotation,
            mounted: mount.rotation,
            omega: into_body * (into_platform * omega),
            alpha: into_body * (into_platform * alpha),
            centripetal: of_platform * mount.rotation,
            acceleration: motion.point_acceleration(mount.at, arm) - gravity,
            arm,
        }
    }

    /// Wrench at the body frame's origin per unit of an inertial parameter, in the base's axes.
    #[must_use]
    pub(crate) fn unit_wrench(&self, arena: &'a Arena, parameter: StandardParameter) -> Wrench<'a> {
        use StandardParameter as P;
        let zero = Vector3::zero(arena);
        let axes = || self.platform * self.mounted;
        let first = |k: usize| {
            let moment = axes().column(k).cross(self.acceleration);
            let force = self.centripetal.column(k);
            Wrench { force, moment }
        };
        match parameter {
            P::M => Wrench {
                force: self.acceleration,
                moment: zero,
            },
            P::Mx => first(0),
            P::My => first(1),
            P::Mz => first(2),
            _ => {
                let moment = second_moment(arena, parameter, self.omega, self.alpha);
                Wrench {
                    force: zero,
                    moment: self.platform * (self.mounted * moment),
                }
            }
        }
    }

    /// Wrench of an inertia at the body frame's origin, in the base's axes.
    pub(crate) fn wrench(&self, inertia: &Inertia<'a>) -> Wrench<'a> {
        let axes = self.platform * self.mounted;
        let force = self.acceleration.scaled(inertia.mass) + self.centripetal * inertia.first;
        let moment = inertia.turning_moment(self.omega, self.alpha);
        let turned = (axes * inertia.first).cross(self.acceleration);
        Wrench {
            force,
            moment: turned + axes * moment,
        }
    }

    /// Generalised force per unit of an inertial parameter on some coordinates.
    ///
    /// `partials` are the platform's partial velocities with respect to these coordinates. Moments
    /// are in the body's own axes, where a second moment has few components.
    pub(crate) fn on_partials(
        &self,
        arena: &'a Arena,
        parameter: StandardParameter,
        partials: &[SpatialMotion<'a>],
    ) -> Vec<Expr<'a>> {
        use StandardParameter as P;
        let into = |vector: Vector3<'a>| {
            let on_platform = self.platform.transposed() * vector;
            self.mounted.transposed() * on_platform
        };
        let on = |partial: &SpatialMotion<'a>| {
            let along = |force: Vector3<'a>| force.dot(partial.linear_at(self.arm));
            let first = |k: usize| {
                let lifted = into(self.acceleration).cross(into(partial.angular));
                along(self.centripetal.column(k)) + lifted.0[k]
            };
            match parameter {
                P::M => along(self.acceleration),
                P::Mx => first(0),
                P::My => first(1),
                P::Mz => first(2),
                _ => {
                    let moment = second_moment(arena, parameter, self.omega, self.alpha);
                    moment.dot(into(partial.angular))
                }
            }
        };
        partials.iter().map(on).collect()
    }

    /// Generalised forces on the twist coordinates of a wrench at the body frame's origin.
    #[must_use]
    pub fn project(&self, twist: &[TwistCoordinate], wrench: Wrench<'a>) -> Vec<Expr<'a>> {
        on_twist(twist, self.arm, wrench)
    }
}
