//! What a derivation knows of a leg: frames, rates, closure.

use super::bias::{BiasTerm, end_bias};
use super::centres::Centre;
use super::closure::LegClosure;
use super::elimination::Rows;
use super::frames::LegFrames;
use super::platform::{PlatformMotion, PlatformPose};
use super::rates::Rates;
use crate::cas::{Arena, Expr, Vector3};
use crate::mechanism::{End, Leg};

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
    /// Acceleration of the ground less gravity, in the axes in which the closure sees what the leg ends on and in
    /// those of the leg, where the end's acceleration is taken so.
    pub(super) ground: Option<[Vector3<'a>; 2]>,
    /// The ground's acceleration less gravity in the axes in which the closure sees what the leg ends on, where masses at
    /// the leg's end are told there; `None` of a leg that stands on a moving body.
    pub(super) lift: Option<Vector3<'a>>,
    /// ∂u/∂v, r numbers per u. Of a chain that starts from a moving body those of the leg follow that
    /// carries it, whose quasi-velocities move its bodies, too.
    pub rows: Rows<'a>,
}

impl<'a> LegState<'a> {
    /// The motion of what the leg ends on, less gravity where it is taken so.
    pub(super) fn less_gravity(&self, end: PlatformMotion<'a>) -> PlatformMotion<'a> {
        match self.ground {
            Some([ground, _]) => PlatformMotion {
                acceleration: end.acceleration + ground,
                ..end
            },
            None => end,
        }
    }

    /// The acceleration less gravity of a leg's end, from that of what it ends on, [`less gravity`](Self::less_gravity)
    /// where it is taken so: where masses there are told as those of a point of it.
    pub(super) fn end_less_gravity(
        &self,
        leg: &Leg,
        end: &PlatformMotion<'a>,
    ) -> Option<Vector3<'a>> {
        let (closure, lift) = (self.closure.as_ref()?, self.lift?);
        let Some(End::Point { along, .. }) = &leg.end else {
            return None;
        };
        let there = end.point_acceleration(closure.at, closure.arm);
        let is_less = self.ground.is_some();
        (*along == [true; 3]).then(|| if is_less { there } else { there + lift })
    }

    /// The acceleration of the leg's end at u̇ = 0, less gravity where that of what it ends on is.
    pub(super) fn bias(&self, arena: &'a Arena, leg: &Leg, u: &[Expr<'a>]) -> Vec<BiasTerm<'a>> {
        let mut terms = end_bias(arena, leg, &self.frames, &self.rates, u);
        terms.extend(self.ground.map(|[_, ground]| BiasTerm {
            scalar: arena.one(),
            acceleration: SpatialMotion {
                linear: ground,
                angular: Vector3::zero(arena),
            },
        }));
        terms
    }
}
