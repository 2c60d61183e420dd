//! The motion of the whole robot: quasi-velocities, bodies, platform.

use super::body::BodyMotion;
use super::platform_body::PlatformBody;
use crate::cas::{Expr, Vector3};
use crate::derivation::kinematics::platform::PlatformMotion;
use crate::derivation::names::Accelerations;

/// Velocities and accelerations of the whole robot.
#[derive(Debug, Clone)]
pub struct RobotMotion<'a> {
    /// Quasi-velocities of every leg.
    pub u: Vec<Vec<Expr<'a>>>,
    /// Their derivatives.
    pub u_dot: Vec<Vec<Expr<'a>>>,
    /// Bodies of every leg.
    pub bodies: Vec<Vec<BodyMotion<'a>>>,
    /// Those bodies of every leg that move with the platform.
    pub platform_bodies: Vec<Vec<Option<PlatformBody<'a>>>>,
    /// For every leg the acceleration of its end less gravity, if a mass there counts as a point of the body at which the
    /// leg ends.
    pub(crate) ends: Vec<Option<Vector3<'a>>>,
    /// The platform.
    pub platform: Option<PlatformBody<'a>>,
}

/// A motion that was derived.
#[derive(Debug)]
pub(crate) struct Moved<'a> {
    /// Of legs and bodies.
    pub(crate) motion: RobotMotion<'a>,
    /// Of the platform.
    pub(crate) platform: Option<PlatformMotion<'a>>,
    /// Which accelerations it has.
    pub(crate) accelerations: Accelerations,
}
