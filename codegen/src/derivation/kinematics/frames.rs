//! Frames of a leg's joints in common axes, and the columns of the leg's Jacobian J_k, eq. (9): the
//! velocity of the leg's end per joint rate.

use super::configuration::Configuration;
use super::joint::{joint_turn, link_vector};
use super::orientation::{ObserverFrame, Orientation};
use super::spatial::SpatialMotion;
use crate::cas::{Arena, Direction, Matrix3, Number, Vector3};
use crate::mechanism::{JointKind, Leg};

/// Position and orientation of a joint's frame, in the axes chosen for its leg.
#[derive(Debug, Clone)]
pub struct Frame<'a> {
    /// The frame's orientation.
    pub rotation: Matrix3<'a>,
    /// Vector from the antecedent frame's origin to this one's.
    pub link: Vector3<'a>,
    /// Origin relative to that of the leg's base frame.
    pub origin: Vector3<'a>,
}

impl<'a> Frame<'a> {
    /// The direction of the joint's axis.
    #[must_use]
    pub fn axis(&self) -> Vector3<'a> {
        self.rotation.column(2)
    }
}

/// The frames of a leg.
///
/// All vectors are in common axes: those of the base, or of a frame on the path along the leg. In
/// the axes of a joint near the middle, most components of the leg's Jacobian are zero and the rest
/// is triangular. In return the end's motion has to be rotated into these axes.
#[derive(Debug, Clone)]
pub struct LegFrames<'a> {
    /// One frame per joint.
    pub frames: Vec<Frame<'a>>,
    /// Orientation of the axes in the robot's base frame, or in the observer's frame.
    pub axes: Matrix3<'a>,
    /// Orientation of the axes in the robot's base frame.
    pub(crate) orientation: Orientation,
}

impl<'a> LegFrames<'a> {
    /// Frames of all joints in the axes of one frame on the path
    /// ([`Orientation::intermediate_frames`]).
    ///
    /// Frame 0 is the base, or the observer's frame if there is one. `None` if there is no such
    /// frame, or the configuration does not determine a sine or cosine.
    #[must_use]
    pub fn new(
        arena: &'a Arena,
        leg: &Leg,
        first_joint: usize,
        configuration: &Configuration<'a>,
        closure_frame: usize,
        observer: Option<&ObserverFrame>,
    ) -> Option<Self> {
        let orientations = Orientation::of_leg(leg, first_joint, configuration)?;
        let whole = |of: &Orientation| match observer {
            Some(observer) => observer.from.followed_by(of),
            None => Some(of.clone()),
        };
        let axes = match observer {
            Some(observer) if closure_frame == 0 => observer.axes.clone(),
            _ => whole(Orientation::intermediate_frames(&orientations).get(closure_frame)?)?,
        };
        let in_axes = |of: &Orientation| whole(of)?.relative(&axes, arena, configuration);
        let base = in_axes(&Orientation::fixed(leg.base.rotation))?;
        let mut frames: Vec<Frame<'a>> = Vec::new();
        for (index, joint) in leg.joints.iter().enumerate() {
            // The joint's own sine and cosine come first: equal values, for instance a determinant,
            // are then represented by them.
            let theta = joint_turn(leg, index, first_joint, configuration)?;
            let _ = configuration.unit(&theta.plus(&Direction::constant(joint.gamma))?)?;
            let (from_rotation, from_origin) = match joint.antecedent {
                Some(a) => (frames[a].rotation, frames[a].origin),
                None => (base, Vector3::zero(arena)),
            };
            let rotation = in_axes(&orientations[index])?;
            let link = from_rotation * link_vector(arena, leg, index, first_joint, configuration)?;
            let origin = from_origin + link;
            frames.push(Frame {
                rotation,
                link,
                origin,
            });
        }
        let seen_from =
            observer.map_or_else(Orientation::default, |observer| observer.axes.clone());
        Some(Self {
            frames,
            axes: axes.relative(&seen_from, arena, configuration)?,
            orientation: axes,
        })
    }

    /// Expresses the orientations of a leg's frames in the observer's axes.
    ///
    /// Directions of links over a divisor are then recognised later. `None` if the configuration
    /// does not determine one.
    pub(crate) fn express_in_observer_frame(
        arena: &'a Arena,
        leg: &Leg,
        first_joint: usize,
        configuration: &Configuration<'a>,
        observer: &ObserverFrame,
    ) -> Option<()> {
        for of in Orientation::of_leg(leg, first_joint, configuration)? {
            let whole = observer.from.followed_by(&of)?;
            let _ = whole.relative(&observer.axes, arena, configuration)?;
        }
        Some(())
    }

    /// Vector from the origin of joint `index` to that of the last joint, along the links.
    #[must_use]
    pub(crate) fn to_end(&self, arena: &'a Arena, leg: &Leg, index: usize) -> Vector3<'a> {
        let mut sum = Vector3::zero(arena);
        let mut at = leg.joints.len() - 1;
        while at != index {
            sum = self.frames[at].link + sum;
            match leg.joints[at].antecedent {
                Some(a) => at = a,
                None => break,
            }
        }
        sum
    }
}

/// ∂Ṗ/∂q̇ and ∂ω/∂q̇ of every joint on the path to the end.
pub(crate) fn joint_columns<'a>(
    arena: &'a Arena,
    leg: &Leg,
    frames: &LegFrames<'a>,
) -> Vec<SpatialMotion<'a>> {
    let zero = Vector3::zero(arena);
    let mut columns = vec![SpatialMotion::zero(arena); leg.joints.len()];
    for index in path_to_end(leg) {
        let axis = frames.frames[index].axis();
        columns[index] = match leg.joints[index].kind {
            JointKind::Revolute => SpatialMotion {
                linear: axis.cross(frames.to_end(arena, leg, index)),
                angular: axis,
            },
            JointKind::Prismatic => SpatialMotion {
                linear: axis,
                angular: zero,
            },
            JointKind::Fixed => SpatialMotion::zero(arena),
        };
    }
    columns
}

/// ∂Ṗ/∂q̇ and ∂ω/∂q̇ of the independent joints; coupled joints are added to those they depend on.
pub(crate) fn independent_columns<'a>(
    arena: &'a Arena,
    leg: &Leg,
    frames: &LegFrames<'a>,
) -> Vec<SpatialMotion<'a>> {
    let joint_columns = joint_columns(arena, leg, frames);
    leg.independent()
        .map(|own| {
            let mut sum = SpatialMotion::zero(arena);
            for (joint, columns) in leg.joints.iter().zip(&joint_columns) {
                for (of, factor) in &joint.variable {
                    if *of == own {
                        let factor = arena.number(Number::ratio(*factor));
                        sum = sum.plus_scaled(columns, factor);
                    }
                }
            }
            sum
        })
        .collect()
}

/// The joints from the base to the end.
pub(crate) fn path_to_end(leg: &Leg) -> Vec<usize> {
    let mut path = Vec::new();
    let mut at = leg.joints.len().checked_sub(1);
    while let Some(index) = at {
        path.push(index);
        at = leg.joints[index].antecedent;
    }
    path
}
