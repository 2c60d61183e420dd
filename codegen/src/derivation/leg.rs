//! What a derivation knows of a leg: frames, rates, closure.

use super::centres::Centre;
use super::closure::LegClosure;
use super::elimination::Rows;
use super::frames::LegFrames;
use super::platform::PlatformPose;
use super::rates::Rates;

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
    /// ∂u/∂v, r numbers per u. Of a chain that starts from a moving body those of the leg follow that
    /// carries it, whose quasi-velocities move its bodies, too.
    pub rows: Rows<'a>,
}
