//! State of a leg in a derivation: frames, rates, closure.

use super::bias::{BiasTerm, end_bias};
use super::cable::CableCourse;
use super::leg_closure::LegClosure;
use crate::cas::{Arena, Expr, Vector3};
use crate::derivation::kinematics::centres::Centre;
use crate::derivation::kinematics::frames::LegFrames;
use crate::derivation::kinematics::platform::{PlatformMotion, PlatformPose};
use crate::derivation::kinematics::rates::Rates;
use crate::derivation::kinematics::spatial::SpatialMotion;
use crate::derivation::linear_algebra::elimination::Rows;
use crate::mechanism::{End, Leg};

/// Gravity as the acceleration -g of the ground, for one leg.
#[derive(Debug, Default)]
pub(crate) struct LegGravity<'a> {
    /// Acceleration that the closure includes; `None` if the closure excludes gravity.
    pub(crate) ground: Option<GroundAcceleration<'a>>,
    /// Acceleration in the observer's axes, added to that of the leg's end for a mass there.
    ///
    /// `None` for a leg on a moving body and if there are no such masses.
    pub(crate) end_offset: Option<Vector3<'a>>,
}

/// The acceleration -g of the ground in two sets of axes.
#[derive(Debug)]
pub(crate) struct GroundAcceleration<'a> {
    /// In the axes in which the closure expresses the body at the leg's end.
    pub(crate) in_observer_axes: Vector3<'a>,
    /// In the axes of the leg.
    pub(crate) in_leg_axes: Vector3<'a>,
}

/// A leg in a derivation.
#[derive(Debug)]
pub struct LegState<'a> {
    /// Index of the leg's first joint in q_t.
    pub first_joint: usize,
    /// Frames in the base frame.
    pub frames: LegFrames<'a>,
    /// Joint rates as forms of the quasi-velocities.
    pub rates: Rates,
    /// Axes that share the moment about the point where they meet.
    pub centres: Vec<Centre>,
    /// Pose of the body at the leg's end; `None` for a tree.
    pub platform: Option<PlatformPose<'a>>,
    /// The closure; `None` for a tree.
    pub closure: Option<LegClosure<'a>>,
    /// The course of the cable, of a leg that is one.
    pub(crate) cable: Option<CableCourse<'a>>,
    /// Gravity, for a leg on the ground.
    pub(crate) gravity: LegGravity<'a>,
    /// ∂u/∂v, r numbers per u.
    ///
    /// For a chain on a moving body, the rows of the leg that carries it follow: its
    /// quasi-velocities move the chain's bodies, too.
    pub rows: Rows<'a>,
}

impl<'a> LegState<'a> {
    /// Motion of the leg's end body, with gravity as an acceleration if the closure includes it.
    pub(crate) fn less_gravity(&self, end: PlatformMotion<'a>) -> PlatformMotion<'a> {
        match &self.gravity.ground {
            Some(ground) => PlatformMotion {
                acceleration: end.acceleration + ground.in_observer_axes,
                ..end
            },
            None => end,
        }
    }

    /// Acceleration minus gravity of a leg's end, for a mass there; `end` is
    /// [`less_gravity`](Self::less_gravity).
    pub(crate) fn end_less_gravity(
        &self,
        leg: &Leg,
        end: &PlatformMotion<'a>,
    ) -> Option<Vector3<'a>> {
        let (closure, offset) = (self.closure.as_ref()?, self.gravity.end_offset?);
        let Some(End::Point { along, .. }) = &leg.end else {
            return None;
        };
        let there = end.point_acceleration(closure.at, closure.arm);
        let has_gravity = self.gravity.ground.is_some();
        (*along == [true; 3]).then(|| if has_gravity { there } else { there + offset })
    }

    /// Acceleration of the leg's end at u̇ = 0, minus gravity if the closure includes it.
    pub(crate) fn bias(&self, arena: &'a Arena, leg: &Leg, u: &[Expr<'a>]) -> Vec<BiasTerm<'a>> {
        let mut terms = end_bias(arena, leg, &self.frames, &self.rates, u);
        terms.extend(self.gravity.ground.as_ref().map(|ground| BiasTerm {
            scalar: arena.one(),
            acceleration: SpatialMotion {
                linear: ground.in_leg_axes,
                angular: Vector3::zero(arena),
            },
        }));
        terms
    }
}
