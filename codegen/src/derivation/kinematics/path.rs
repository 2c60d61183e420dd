//! The path between the two bodies that a chain connects, and the relative motion of one as
//! observed from the other.
//!
//! The observer is on the body that the chain starts from. All vectors are in that body's axes, or
//! in those of another frame on the path, in which they have fewer components. The path leads up to
//! the common ancestor of both bodies and down to the end body. It passes the skeleton and earlier
//! chains, whose rates follow from the skeleton's. Against its direction a joint's rate is
//! subtracted: with z its axis and q̇ its rate, ω' = ω - z q̇ from the body after the joint. Both
//! bodies share the joint's origin, except for its slide.

use super::configuration::Configuration;
use super::joint::link_vector;
use super::orientation::{Orientation, constant_rotation, distinct, keep_rows};
use super::rates::{Form, Rates};
use super::spatial::SpatialMotion;
use crate::cas::{Arena, Expr, Matrix3, Vector3};
use crate::derivation::linear_algebra::elimination::Rows;
use crate::derivation::motion_input::MotionInput;
use crate::mechanism::{BodyIndex, JointKind, Leg, Mechanism};

/// Known state of the skeleton and of earlier chains, which paths pass.
#[derive(Debug)]
pub(crate) struct KnownMotion<'r, 'a> {
    pub(crate) arena: &'a Arena,
    pub(crate) mechanism: &'r Mechanism,
    pub(crate) configuration: &'r Configuration<'a>,
    /// For each leg the index of its first joint in q_t, its rates, and ∂u/∂v.
    pub(crate) legs: Vec<(usize, &'r Rates, &'r Rows<'a>)>,
}

/// A joint on the path.
#[derive(Debug, Clone)]
pub(crate) struct Step<'a> {
    pub(crate) kind: JointKind,
    /// Joint rate in the quasi-velocities of its leg.
    pub(crate) rate: Form,
    /// Number of quasi-velocities of the legs before.
    pub(crate) first: usize,
    /// Joint rate per rate of each independent coordinate.
    row: Vec<Expr<'a>>,
    /// Whether the path leads from the joint's antecedent to the joint.
    is_forward: bool,
    /// The joint's axis.
    pub(crate) axis: Vector3<'a>,
    /// Vector from the antecedent's origin to the joint's.
    pub(crate) link: Vector3<'a>,
}

/// The path from one body to another.
#[derive(Debug, Clone)]
pub struct Path<'a> {
    arena: &'a Arena,
    steps: Vec<Step<'a>>,
    /// Origin of the last body's frame, in the first body's.
    pub(crate) origin: Vector3<'a>,
    /// Orientation of the last body's frame.
    pub(crate) rotation: Matrix3<'a>,
    /// ∂(velocity of the origin)/∂v and ∂(angular velocity)/∂v.
    pub(crate) columns: Vec<SpatialMotion<'a>>,
}

/// Relative motion: velocity and acceleration of the origin, angular velocity and acceleration.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Relative<'a> {
    pub(crate) velocity: Vector3<'a>,
    pub(crate) acceleration: Vector3<'a>,
    pub(crate) omega: Vector3<'a>,
    pub(crate) alpha: Vector3<'a>,
}

impl<'a> Path<'a> {
    /// The path between two bodies of the skeleton and of derived chains; `None` is the ground.
    ///
    /// Returns `None` if the configuration does not determine a sine or cosine.
    #[must_use]
    pub(crate) fn new(
        known: &KnownMotion<'_, 'a>,
        from: Option<BodyIndex>,
        to: BodyIndex,
        axes: &Orientation,
    ) -> Option<Self> {
        let (arena, mechanism) = (known.arena, known.mechanism);
        let mut path = Self {
            arena,
            steps: steps(known, from, to, axes)?,
            origin: Vector3::zero(arena),
            rotation: seen(known, axes, Some(to))?,
            columns: Vec::new(),
        };
        // Per independent coordinate, or per joint in the pose until dependent joints are solved.
        let mut rows = known.legs.iter().flat_map(|(_, _, rows)| rows.first());
        let width = rows.next().map_or(mechanism.dof(), Vec::len);
        path.columns = (0..width).map(|i| path.column(i)).collect();
        path.origin = path.steps.iter().fold(path.origin, |sum, step| {
            if step.is_forward {
                sum + step.link
            } else {
                sum - step.link
            }
        });
        Some(path)
    }

    /// Velocities for a unit rate of the independent joint `index`.
    fn column(&self, index: usize) -> SpatialMotion<'a> {
        let mut sum = SpatialMotion::zero(self.arena);
        for (at, step) in self.steps.iter().enumerate() {
            let factor = step.row[index];
            if factor.is_zero() {
                continue;
            }
            let factor = if step.is_forward { factor } else { -factor };
            let axis = step.axis.scaled(factor);
            match step.kind {
                JointKind::Revolute => {
                    sum.linear = sum.linear + axis.cross(self.lever(at));
                    sum.angular = sum.angular + axis;
                }
                JointKind::Prismatic => sum.linear = sum.linear + axis,
                JointKind::Fixed => {}
            }
        }
        sum
    }

    /// Vector from the origin of a step's joint to the origin of the last body.
    fn lever(&self, at: usize) -> Vector3<'a> {
        let own = if self.steps[at].is_forward {
            Vector3::zero(self.arena)
        } else {
            -self.steps[at].link
        };
        self.steps[at + 1..].iter().fold(own, |sum, step| {
            if step.is_forward {
                sum + step.link
            } else {
                sum - step.link
            }
        })
    }

    /// Whether the last body rotates about more than one axis.
    pub(crate) fn turns_freely(&self) -> bool {
        let turning = |step: &&Step<'_>| step.kind == JointKind::Revolute;
        self.steps.iter().filter(turning).count() > 1
    }

    /// Motion of the last body for the quasi-velocities of all legs before and their derivatives.
    pub(crate) fn motion(&self, rates: &[Expr<'a>], accelerations: &[Expr<'a>]) -> Relative<'a> {
        let zero = Vector3::zero(self.arena);
        let mut at = Relative {
            velocity: zero,
            acceleration: zero,
            omega: zero,
            alpha: zero,
        };
        for step in &self.steps {
            let of = |all: &[Expr<'a>]| {
                let own = step.rate.value(self.arena, &all[step.first..]);
                step.axis.scaled(own)
            };
            let (rate, rate_dot) = (of(rates), of(accelerations));
            at = if step.is_forward {
                at.moved(step.link).joined(step.kind, rate, rate_dot)
            } else {
                at.left(step.kind, rate, rate_dot).moved(-step.link)
            };
        }
        at
    }
}

impl<'a> Step<'a> {
    /// The step at a joint, in given axes.
    fn new(
        known: &KnownMotion<'_, 'a>,
        axes: &Orientation,
        at: BodyIndex,
        is_forward: bool,
    ) -> Option<Self> {
        let (arena, leg) = (known.arena, &known.mechanism.legs[at.leg]);
        let (first, rates, rows) = known.legs[at.leg];
        let own = link_vector(arena, leg, at.joint, first, known.configuration)?;
        let before = seen(known, axes, antecedent(known.mechanism, at))?;
        let link = on_base_body(arena, leg, at, own);
        let rate = rates.joint[at.joint].clone();
        Some(Self {
            kind: leg.joints[at.joint].kind,
            row: rate.row(arena, rows),
            rate,
            first,
            is_forward,
            axis: seen(known, axes, Some(at))?.column(2),
            link: before * link,
        })
    }
}

/// Vector from the origin of the body before a joint to that of the joint, in the axes of that body.
///
/// `None` if the configuration does not determine a slide.
pub(crate) fn link_from_body<'a>(
    arena: &'a Arena,
    mechanism: &Mechanism,
    configuration: &Configuration<'a>,
    at: BodyIndex,
) -> Option<Vector3<'a>> {
    let leg = &mechanism.legs[at.leg];
    let first = mechanism.leg_range(at.leg).start;
    let own = link_vector(arena, leg, at.joint, first, configuration)?;
    Some(on_base_body(arena, leg, at, own))
}

/// A link vector in the axes of the antecedent, as one from the body before the joint.
fn on_base_body<'a>(arena: &'a Arena, leg: &Leg, at: BodyIndex, own: Vector3<'a>) -> Vector3<'a> {
    match leg.joints[at.joint].antecedent {
        Some(_) => own,
        // The leg's base frame is fixed on the body on which the leg is mounted.
        None => {
            let turned = constant_rotation(arena, leg.base.rotation);
            Vector3::constant(arena, leg.base.at) + turned * own
        }
    }
}

/// The joints on the path between two bodies, in given axes.
pub(crate) fn steps<'a>(
    known: &KnownMotion<'_, 'a>,
    from: Option<BodyIndex>,
    to: BodyIndex,
    axes: &Orientation,
) -> Option<Vec<Step<'a>>> {
    let step = |(joint, is_forward)| Step::new(known, axes, joint, is_forward);
    let steps = way(known.mechanism, from, Some(to)).into_iter();
    steps.map(step).collect()
}

/// The orientation of a body in given axes.
pub(crate) fn seen<'a>(
    known: &KnownMotion<'_, 'a>,
    axes: &Orientation,
    body: Option<BodyIndex>,
) -> Option<Matrix3<'a>> {
    let body = orientation(known.mechanism, known.configuration, body)?;
    body.relative(axes, known.arena, known.configuration)
}

/// The orientation of a body in the robot's base frame; `None` is the ground.
pub(crate) fn orientation(
    mechanism: &Mechanism,
    configuration: &Configuration<'_>,
    body: Option<BodyIndex>,
) -> Option<Orientation> {
    let Some(body) = body else {
        return Some(Orientation::default());
    };
    let leg = &mechanism.legs[body.leg];
    let first_joint = mechanism.leg_range(body.leg).start;
    let all = Orientation::of_leg(leg, first_joint, configuration)?;
    orientation(mechanism, configuration, leg.base_body)?.followed_by(&all[body.joint])
}

/// The axes in which a chain's closure may express its end body: those of the frames on the path to
/// it.
///
/// The first are those of the body at the chain's start.
pub(crate) fn observer_frames(
    mechanism: &Mechanism,
    configuration: &Configuration<'_>,
    index: usize,
) -> Option<Vec<Orientation>> {
    let leg = &mechanism.legs[index];
    let of = |body| orientation(mechanism, configuration, body);
    let from = of(leg.base_body)?;
    let mut bodies = Vec::new();
    for (at, is_forward) in way(mechanism, leg.base_body, Some(leg.end_body?)) {
        bodies.push(of(if is_forward {
            Some(at)
        } else {
            antecedent(mechanism, at)
        })?);
    }
    let before = Orientation::intermediate_frames(std::slice::from_ref(&from));
    let mut all = vec![from];
    let met = Orientation::intermediate_frames(&bodies).into_iter();
    for axes in met.filter(|axes| !before.contains(axes)) {
        if !all.contains(&axes) {
            all.push(axes);
        }
    }
    Some(all)
}

/// Indices of the [`observer_frames`] to choose from.
///
/// It is the first alone for legs of a platform. The same holds for chains whose closure uses only
/// some components of a velocity, if other axes would mix them with the rest.
#[must_use]
pub(crate) fn observer_frame_choices(mechanism: &Mechanism, leg: usize) -> Vec<usize> {
    if mechanism.skeleton().is_none() || mechanism.blocking.contains(&leg) {
        return vec![0];
    }
    let arena = Arena::new();
    let configuration = Configuration::new(&arena, mechanism, MotionInput::Joints);
    observer_frames(mechanism, &configuration, leg)
        .filter(|observer_frames| {
            keep_rows(mechanism, leg, &arena, &configuration, observer_frames)
        })
        .map_or(vec![0], |observer_frames| {
            distinct(&observer_frames, &arena, &configuration)
        })
}

impl<'a> Relative<'a> {
    /// The motion of another point of the body.
    fn moved(self, arm: Vector3<'a>) -> Self {
        let turned = self.omega.cross(arm);
        Self {
            velocity: self.velocity + turned,
            acceleration: self.acceleration + self.alpha.cross(arm) + self.omega.cross(turned),
            ..self
        }
    }

    /// Motion of the body after a joint, from that of the body before it at the same point.
    fn joined(self, kind: JointKind, rate: Vector3<'a>, rate_dot: Vector3<'a>) -> Self {
        let swept = self.omega.cross(rate);
        match kind {
            JointKind::Revolute => Self {
                omega: self.omega + rate,
                alpha: self.alpha + swept + rate_dot,
                ..self
            },
            JointKind::Prismatic => Self {
                velocity: self.velocity + rate,
                acceleration: self.acceleration + swept + swept + rate_dot,
                ..self
            },
            JointKind::Fixed => self,
        }
    }

    /// Motion of the body before a joint, from that of the body after it at the same point.
    fn left(self, kind: JointKind, rate: Vector3<'a>, rate_dot: Vector3<'a>) -> Self {
        let swept = self.omega.cross(rate);
        match kind {
            JointKind::Revolute => Self {
                omega: self.omega - rate,
                alpha: self.alpha - swept - rate_dot,
                ..self
            },
            JointKind::Prismatic => Self {
                velocity: self.velocity - rate,
                acceleration: self.acceleration - swept - swept - rate_dot,
                ..self
            },
            JointKind::Fixed => self,
        }
    }
}

/// The body before a joint: its antecedent, or the base body of its leg; `None` is the ground.
pub(crate) fn antecedent(mechanism: &Mechanism, at: BodyIndex) -> Option<BodyIndex> {
    let leg = &mechanism.legs[at.leg];
    match leg.joints[at.joint].antecedent {
        Some(joint) => Some(BodyIndex { joint, ..at }),
        None => leg.base_body,
    }
}

/// The joints between two bodies in order, each with whether it is passed from its antecedent on.
pub(crate) fn way(
    mechanism: &Mechanism,
    from: Option<BodyIndex>,
    to: Option<BodyIndex>,
) -> Vec<(BodyIndex, bool)> {
    let line = |start: Option<BodyIndex>| {
        std::iter::successors(start, |&at| antecedent(mechanism, at)).collect::<Vec<_>>()
    };
    let (up, down) = (line(from), line(to));
    let back = up.iter().filter(|joint| !down.contains(joint));
    let mut way: Vec<(BodyIndex, bool)> = back.map(|&joint| (joint, false)).collect();
    let forth = down.iter().filter(|joint| !up.contains(joint));
    way.extend(forth.rev().map(|&joint| (joint, true)));
    way
}
