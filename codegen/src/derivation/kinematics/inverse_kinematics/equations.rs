//! Scalar equations of a leg's closure in the frames of all its joints (Paul 1981).
//!
//! Let F be the frame of a joint before its own motion. In F, the target X of the leg's end is P =
//! R_Fᵀ (X - O_F), a function of the joints before F. The end of the chain after F is Q, a function
//! of the other joints. P = Q gives three equations, and |P|² = |Q|² a fourth, which is invariant
//! under rotation about F's origin. For a rigid end the same holds for the platform's axes e_i and
//! those of the last frame g_i, with (X - O_F) · e_i = Q · g_i.

use super::super::configuration::Configuration;
use super::super::frames::path_to_end;
use super::super::joint::{joint_slide, joint_turn};
use super::super::orientation::constant_rotation;
use super::super::rates::parallel;
use super::Task;
use crate::cas::{Angle, CosineSine, Direction, Expr, Matrix3, Ratio, Vector3};
use crate::mechanism::Joint;

/// An orientation as a prefix and a rotation about z. Rotations about parallel axes add up.
#[derive(Debug, Clone)]
struct TurnedPrefix<'a> {
    prefix: Matrix3<'a>,
    turn: Direction,
}

/// A frame of the leg with its origin.
#[derive(Debug, Clone)]
struct Frame<'a> {
    orientation: TurnedPrefix<'a>,
    origin: Vector3<'a>,
}

impl<'a> TurnedPrefix<'a> {
    const fn of(prefix: Matrix3<'a>) -> Self {
        Self {
            prefix,
            turn: Direction::constant(Angle::ZERO),
        }
    }

    fn rotation(&self, configuration: &Configuration<'a>) -> Option<Matrix3<'a>> {
        let CosineSine { cosine, sine } = configuration.unit(&self.turn)?;
        Some(self.prefix * Matrix3::rotation(2, cosine, sine))
    }

    /// Orientation of a joint's frame before its own turn θ; `self` is that of the antecedent's
    /// frame.
    fn before_turn_of(&self, joint: &Joint, configuration: &Configuration<'a>) -> Option<Self> {
        let arena = configuration.arena();
        let turn = self.turn.plus(&Direction::constant(joint.gamma))?;
        let tilt = constant_rotation(arena, [joint.alpha, Angle::ZERO, Angle::ZERO]);
        Some(match parallel(joint.alpha) {
            Some(sign) if sign == Ratio::ONE => Self {
                prefix: self.prefix,
                turn,
            },
            Some(_) => Self {
                prefix: self.prefix * tilt,
                turn: turn.negative(),
            },
            None => {
                let CosineSine { cosine, sine } = configuration.unit(&turn)?;
                let turned = self.prefix * Matrix3::rotation(2, cosine, sine);
                Self::of(turned * tilt)
            }
        })
    }
}

impl<'a> Frame<'a> {
    /// The base frame of a leg.
    fn base(task: Task<'a, '_>) -> Self {
        let base = &task.leg.base;
        Self {
            orientation: TurnedPrefix::of(constant_rotation(task.arena, base.rotation)),
            origin: Vector3::constant(task.arena, base.at),
        }
    }
}

/// Expressions that vanish if the leg is closed.
pub(in crate::derivation) fn equations<'a>(
    task: Task<'a, '_>,
    configuration: &Configuration<'a>,
) -> Option<Vec<Expr<'a>>> {
    let leg = task.leg;
    let mut path = path_to_end(leg);
    path.reverse();
    let shared = leg.end.as_ref()?.shared_components();
    if shared.len() < 3 {
        return along_base_axes(task, configuration, &path, &shared);
    }
    let mut frame = Frame::base(task);
    let mut equations = Vec::new();
    for at in 0..path.len() {
        let before = step_to(task, configuration, path[at], &frame)?;
        let rotation = before.orientation.rotation(configuration)?;
        let arm = task.target - before.origin;
        let (end, end_axes) = chain(task, configuration, &path[at..], true)?;
        // Quantities that the joint's own turn does not change are expressed without it.
        let (still, still_axes) = chain(task, configuration, &path[at..], false)?;
        let seen = rotation.transposed() * arm;
        equations.extend((0..3).map(|i| seen.0[i] - end.0[i]));
        equations.push(arm.dot(arm) - still.dot(still));
        if let Some(axes) = task.axes {
            let seen = rotation.transposed() * axes;
            for i in [2, 0, 1] {
                equations.extend((0..3).map(|j| seen.0[j][i] - end_axes.0[j][i]));
                equations.push(arm.dot(axes.column(i)) - still.dot(still_axes.column(i)));
            }
        }
        frame = step_over(task, configuration, path[at], before)?;
    }
    equations.retain(|e| e.as_number().is_none());
    Some(equations)
}

/// Equations of an end that meets the platform's point along some axes of the base frame only.
fn along_base_axes<'a>(
    task: Task<'a, '_>,
    configuration: &Configuration<'a>,
    path: &[usize],
    shared: &[usize],
) -> Option<Vec<Expr<'a>>> {
    let mut frame = Frame::base(task);
    for &joint in path {
        frame = step_to(task, configuration, joint, &frame)?;
        frame = step_over(task, configuration, joint, frame)?;
    }
    let gap = task.target - frame.origin;
    Some(shared.iter().map(|&axis| gap.0[axis]).collect())
}

/// Origin and axes of the last frame, in the frame of the first joint of `path` before its motion.
///
/// The turn of that joint is included or not.
fn chain<'a>(
    task: Task<'a, '_>,
    configuration: &Configuration<'a>,
    path: &[usize],
    turns: bool,
) -> Option<(Vector3<'a>, Matrix3<'a>)> {
    let mut frame = Frame {
        orientation: TurnedPrefix::of(Matrix3::identity(task.arena)),
        origin: Vector3::zero(task.arena),
    };
    for (i, &joint) in path.iter().enumerate() {
        if i > 0 {
            frame = step_to(task, configuration, joint, &frame)?;
        }
        frame = step_over(task, configuration, joint, frame)?;
        if i == 0 && !turns {
            frame.orientation.turn = Direction::constant(Angle::ZERO);
        }
    }
    let axes = frame.orientation.rotation(configuration)?;
    Some((frame.origin, axes))
}

/// Step from a joint's antecedent to the joint before its motion.
fn step_to<'a>(
    task: Task<'a, '_>,
    configuration: &Configuration<'a>,
    joint: usize,
    from: &Frame<'a>,
) -> Option<Frame<'a>> {
    let (arena, this) = (task.arena, &task.leg.joints[joint]);
    let orientation = from.orientation.before_turn_of(this, configuration)?;
    let (cosine, sine) = this.gamma.cosine_and_sine();
    let along = Vector3::constant(arena, [this.d * cosine, this.d * sine, this.b]);
    Some(Frame {
        orientation,
        origin: from.origin + from.orientation.rotation(configuration)? * along,
    })
}

/// Step from a joint before its motion to its frame.
fn step_over<'a>(
    task: Task<'a, '_>,
    configuration: &Configuration<'a>,
    joint: usize,
    before: Frame<'a>,
) -> Option<Frame<'a>> {
    let slide = joint_slide(task.arena, task.leg, joint, task.first_joint, configuration)?;
    let turn = joint_turn(task.leg, joint, task.first_joint, configuration)?;
    Some(Frame {
        orientation: TurnedPrefix {
            prefix: before.orientation.prefix,
            turn: before.orientation.turn.plus(&turn)?,
        },
        origin: before.origin + before.orientation.prefix.column(2).scaled(slide),
    })
}
