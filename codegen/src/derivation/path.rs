//! The way through the skeleton between the two bodies that a chain joins, and the motion of the one as it
//! is seen from the other.
//!
//! The observer stands on the body that the chain starts from, in whose frame all vectors are written. The
//! way goes up to the body that both follow and down to the one that the chain ends on. Against its
//! direction a joint takes its rate away: with z its axis and q̇ its rate, from the body behind it
//! ω' = ω - z q̇, and the joint's origin belongs to both bodies but for its slide.

use super::configuration::Configuration;
use super::joint::link_vector;
use super::orientation::{Orientation, constant_rotation};
use super::rates::{Form, Rates};
use crate::cas::{Arena, Expr, Matrix3, Vector3};
use crate::mechanism::{JointKind, Leg};

/// A joint on the way.
#[derive(Debug, Clone)]
struct Step<'a> {
    kind: JointKind,
    /// Its rate in the rates of the independent joints.
    rate: Form,
    /// Whether the way goes from the joint's antecedent to the joint.
    is_forward: bool,
    /// The joint's axis.
    axis: Vector3<'a>,
    /// From the antecedent's origin to the joint's.
    link: Vector3<'a>,
}

/// The way from one body to another.
#[derive(Debug, Clone)]
pub struct Path<'a> {
    arena: &'a Arena,
    steps: Vec<Step<'a>>,
    /// Origin of the last body's frame, in the first one's.
    pub(super) origin: Vector3<'a>,
    /// Its orientation.
    pub(super) rotation: Matrix3<'a>,
    /// ∂(velocity of the origin)/∂v and ∂(angular velocity)/∂v.
    pub(super) columns: Vec<[Vector3<'a>; 2]>,
}

/// A relative motion: velocity and acceleration of the origin, angular velocity and acceleration.
#[derive(Debug, Clone, Copy)]
pub(super) struct Relative<'a> {
    pub(super) velocity: Vector3<'a>,
    pub(super) acceleration: Vector3<'a>,
    pub(super) omega: Vector3<'a>,
    pub(super) alpha: Vector3<'a>,
}

impl<'a> Path<'a> {
    /// The way between two bodies of the skeleton, joints of `skeleton`; `None` is the ground. `None` if a
    /// sine or cosine does not follow from the configuration.
    #[must_use]
    pub(super) fn new(
        arena: &'a Arena,
        skeleton: &Leg,
        configuration: &Configuration<'a>,
        from: Option<usize>,
        to: Option<usize>,
    ) -> Option<Self> {
        let orientations = Orientation::of_leg(skeleton, 0, configuration)?;
        let ground = Orientation::default();
        let of = |body: Option<usize>| body.map_or(&ground, |body| &orientations[body]);
        let seen = |body| of(body).relative(of(from), arena, configuration);
        let rates = Rates::new(skeleton, false);
        let mut steps = Vec::new();
        for (joint, is_forward) in way(skeleton, from, to) {
            let antecedent = skeleton.joints[joint].antecedent;
            let mut link = link_vector(arena, skeleton, joint, 0, configuration)?;
            let mut before = seen(antecedent)?;
            if antecedent.is_none() {
                // The skeleton's own base frame stands in the ground.
                let base = &skeleton.base;
                let turned = constant_rotation(arena, base.rotation);
                before = seen(None)?;
                link = Vector3::constant(arena, base.at) + turned * link;
            }
            steps.push(Step {
                kind: skeleton.joints[joint].kind,
                rate: rates.joint[joint].clone(),
                is_forward,
                axis: seen(Some(joint))?.column(2),
                link: before * link,
            });
        }
        let mut path = Self {
            arena,
            steps,
            origin: Vector3::zero(arena),
            rotation: seen(to)?,
            columns: Vec::new(),
        };
        let count = skeleton.independent().count();
        path.columns = (0..count).map(|i| path.column(i)).collect();
        path.origin = path
            .steps
            .iter()
            .fold(path.origin, |sum, step| match step.is_forward {
                true => sum + step.link,
                false => sum - step.link,
            });
        Some(path)
    }

    /// The velocities for a unit rate of the independent joint `index`.
    fn column(&self, index: usize) -> [Vector3<'a>; 2] {
        let mut sum = [Vector3::zero(self.arena); 2];
        for (at, step) in self.steps.iter().enumerate() {
            let factor = self.arena.number(step.rate.coefficient(index));
            if factor.is_zero() {
                continue;
            }
            let factor = if step.is_forward { factor } else { -factor };
            let axis = step.axis.scaled(factor);
            match step.kind {
                JointKind::Revolute => {
                    sum[0] = sum[0] + axis.cross(self.lever(at));
                    sum[1] = sum[1] + axis;
                }
                JointKind::Prismatic => sum[0] = sum[0] + axis,
                JointKind::Fixed => {}
            }
        }
        sum
    }

    /// From the origin of the joint at a step to the origin of the last body.
    fn lever(&self, at: usize) -> Vector3<'a> {
        let own = match self.steps[at].is_forward {
            true => Vector3::zero(self.arena),
            false => -self.steps[at].link,
        };
        self.steps[at + 1..]
            .iter()
            .fold(own, |sum, step| match step.is_forward {
                true => sum + step.link,
                false => sum - step.link,
            })
    }

    /// Whether the last body turns about more than one axis.
    pub(super) fn turns_freely(&self) -> bool {
        let turning = |step: &&Step<'_>| step.kind == JointKind::Revolute;
        self.steps.iter().filter(turning).count() > 1
    }

    /// The motion of the last body for rates of the skeleton and their derivatives.
    pub(super) fn motion(&self, rates: &[Expr<'a>], accelerations: &[Expr<'a>]) -> Relative<'a> {
        let zero = Vector3::zero(self.arena);
        let mut at = Relative {
            velocity: zero,
            acceleration: zero,
            omega: zero,
            alpha: zero,
        };
        for step in &self.steps {
            let rate = step.axis.scaled(step.rate.value(self.arena, rates));
            let rate_dot = step.axis.scaled(step.rate.value(self.arena, accelerations));
            at = match step.is_forward {
                true => at.moved(step.link).joined(step.kind, rate, rate_dot),
                false => at.left(step.kind, rate, rate_dot).moved(-step.link),
            };
        }
        at
    }
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

    /// The motion of the body behind a joint, from that of the body before it at the same point.
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

    /// The motion of the body before a joint, from that of the body behind it at the same point.
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

/// The joints between two bodies in order, each with whether it is passed from its antecedent on.
fn way(skeleton: &Leg, from: Option<usize>, to: Option<usize>) -> Vec<(usize, bool)> {
    let line = |start: Option<usize>| {
        let mut joints = Vec::new();
        let mut at = start;
        while let Some(joint) = at {
            joints.push(joint);
            at = skeleton.joints[joint].antecedent;
        }
        joints
    };
    let (up, down) = (line(from), line(to));
    let back = up.iter().filter(|joint| !down.contains(joint));
    let mut way: Vec<(usize, bool)> = back.map(|&joint| (joint, false)).collect();
    let forth = down.iter().filter(|joint| !up.contains(joint));
    way.extend(forth.rev().map(|&joint| (joint, true)));
    way
}
