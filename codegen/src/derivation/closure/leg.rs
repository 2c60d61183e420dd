//! What a derivation knows of a leg: frames, rates, closure.

use super::bias::{BiasTerm, end_bias};
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
    /// The acceleration that the closure takes into account; `None` if the closure leaves gravity out.
    pub(crate) ground: Option<GroundAcceleration<'a>>,
    /// The acceleration in the observer's axes, to add to that of the leg's end if a mass is there. `None` of a leg that
    /// stands on a moving body, and where there are no such masses.
    pub(crate) end_offset: Option<Vector3<'a>>,
}

/// The acceleration -g of the ground in two sets of axes.
#[derive(Debug)]
pub(crate) struct GroundAcceleration<'a> {
    /// In the axes in which the closure sees the body at the leg's end.
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
    /// Axes that share the moment about the point in which they meet.
    pub centres: Vec<Centre>,
    /// What the leg ends on; `None` for a tree.
    pub platform: Option<PlatformPose<'a>>,
    /// The closure; `None` for a tree.
    pub closure: Option<LegClosure<'a>>,
    /// Gravity, for a leg that stands on the ground.
    pub(crate) gravity: LegGravity<'a>,
    /// ∂u/∂v, r numbers per u. Of a chain that starts from a moving body those of the leg follow that
    /// carries it, whose quasi-velocities move its bodies, too.
    pub rows: Rows<'a>,
}

impl<'a> LegState<'a> {
    /// The motion of what the leg ends on, with gravity as an acceleration if the closure takes it into account.
    pub(crate) fn less_gravity(&self, end: PlatformMotion<'a>) -> PlatformMotion<'a> {
        match &self.gravity.ground {
            Some(ground) => PlatformMotion {
                acceleration: end.acceleration + ground.in_observer_axes,
                ..end
            },
            None => end,
        }
    }

    /// The acceleration less gravity of a leg's end, for a mass that is there; `end` is [`less_gravity`](Self::less_gravity).
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

    /// The acceleration of the leg's end at u̇ = 0, less gravity if the closure takes it into account.
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
