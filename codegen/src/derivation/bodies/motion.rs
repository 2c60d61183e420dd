//! The motion of the whole robot: quasi-velocities, bodies, platform.

use super::body::BodyMotion;
use super::platform_body::PlatformBody;
use crate::cas::{Expr, Vector3};
use crate::derivation::kinematics::platform::PlatformMotion;
use crate::derivation::names::Accelerations;

/// Velocities and accelerations of the whole robot.
#[derive(Debug, Clone)]
pub struct RobotMotion<'a> {
    /// Independent velocities v.
    pub(crate) twist: Vec<Expr<'a>>,
    /// Quasi-velocities of every leg.
    pub u: Vec<Vec<Expr<'a>>>,
    /// Their derivatives.
    pub u_dot: Vec<Vec<Expr<'a>>>,
    /// Bodies of every leg.
    pub bodies: Vec<Vec<BodyMotion<'a>>>,
    /// The bodies of every leg that move with the platform.
    pub platform_bodies: Vec<Vec<Option<PlatformBody<'a>>>>,
    /// Acceleration minus gravity of each leg's end, if a mass there counts as a point of the end
    /// body.
    pub(crate) ends: Vec<Option<Vector3<'a>>>,
    /// The platform.
    pub platform: Option<PlatformBody<'a>>,
}

/// A derived motion of the robot.
#[derive(Debug)]
pub(crate) struct Moved<'a> {
    /// Motion of legs and bodies.
    pub(crate) motion: RobotMotion<'a>,
    /// Motion of the platform.
    pub(crate) platform: Option<PlatformMotion<'a>>,
    /// The accelerations of the motion.
    pub(crate) accelerations: Accelerations,
}
