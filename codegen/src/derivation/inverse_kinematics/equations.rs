//! The scalar equations of a leg's closure in the frames of all its joints (Paul 1981).
//!
//! Let F be the frame of a joint before its own motion. Seen from F, the point X that the leg's end
//! has to meet is P = R_Fᵀ (X - O_F), which the joints before F decide; the end of the chain behind F
//! is Q, which the others decide. P = Q gives three equations and |P|² = |Q|² a fourth that no turn
//! about F's origin changes. A rigid end gives the same for the platform's axes e_i, with those of the
//! last frame g_i, and (X - O_F) · e_i = Q · g_i.

use super::super::configuration::Configuration;
use super::super::frames::path_to_end;
use super::super::joint::{joint_slide, joint_turn};
use super::super::orientation::constant_rotation;
use super::super::rates::parallel;
use super::Task;
use crate::cas::{Angle, Arena, Direction, Expr, Matrix3, Ratio, Vector3};
use crate::mechanism::Joint;

/// Orientation, as prefix and turn about z, and origin of a frame.
#[derive(Debug, Clone)]
struct Frame<'a> {
    prefix: Matrix3<'a>,
    turn: Direction,
    origin: Vector3<'a>,
}

impl<'a> Frame<'a> {
    fn rotation(&self, configuration: &Configuration<'a>) -> Option<Matrix3<'a>> {
        let (cosine, sine) = configuration.unit(&self.turn)?;
        Some(self.prefix * Matrix3::rotation(2, cosine, sine))
    }
}

/// Expressions that vanish where the leg closes.
pub(in crate::derivation) fn equations<'a>(
    task: Task<'a, '_>,
    configuration: &Configuration<'a>,
) -> Option<Vec<Expr<'a>>> {
    let Task { arena, leg, .. } = task;
    let mut path = path_to_end(leg);
    path.reverse();
    let shared = leg.end.as_ref()?.shared_components();
    if shared.len() < 3 {
        return along_base_axes(task, configuration, &path, &shared);
    }
    let mut frame = Frame {
        prefix: constant_rotation(arena, leg.base.rotation),
        turn: Direction::constant(Angle::ZERO),
        origin: Vector3::constant(arena, leg.base.at),
    };
    let mut equations = Vec::new();
    for at in 0..path.len() {
        let before = step_to(task, configuration, path[at], &frame)?;
        let rotation = before.rotation(configuration)?;
        let arm = task.target - before.origin;
        let (end, end_axes) = chain(task, configuration, &path[at..], true)?;
        // What the joint's own turn does not change is written without it.
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

/// The equations of an end that meets the platform's point along some axes of the base frame only.
fn along_base_axes<'a>(
    task: Task<'a, '_>,
    configuration: &Configuration<'a>,
    path: &[usize],
    shared: &[usize],
) -> Option<Vec<Expr<'a>>> {
    let mut frame = Frame {
        prefix: constant_rotation(task.arena, task.leg.base.rotation),
        turn: Direction::constant(Angle::ZERO),
        origin: Vector3::constant(task.arena, task.leg.base.at),
    };
    for &joint in path {
        frame = step_to(task, configuration, joint, &frame)?;
        frame = step_over(task, configuration, joint, frame)?;
    }
    let gap = task.target - frame.origin;
    Some(shared.iter().map(|&axis| gap.0[axis]).collect())
}

/// Origin and axes of the last frame, seen from the first joint of `path` before its motion, with or
/// without that joint's turn.
fn chain<'a>(
    task: Task<'a, '_>,
    configuration: &Configuration<'a>,
    path: &[usize],
    turns: bool,
) -> Option<(Vector3<'a>, Matrix3<'a>)> {
    let mut frame = Frame {
        prefix: Matrix3::identity(task.arena),
        turn: Direction::constant(Angle::ZERO),
        origin: Vector3::zero(task.arena),
    };
    for (i, &joint) in path.iter().enumerate() {
        if i > 0 {
            frame = step_to(task, configuration, joint, &frame)?;
        }
        frame = step_over(task, configuration, joint, frame)?;
        if i == 0 && !turns {
            frame.turn = Direction::constant(Angle::ZERO);
        }
    }
    Some((frame.origin, frame.rotation(configuration)?))
}

/// From a joint's antecedent to the joint before its motion.
fn step_to<'a>(
    task: Task<'a, '_>,
    configuration: &Configuration<'a>,
    joint: usize,
    from: &Frame<'a>,
) -> Option<Frame<'a>> {
    let (arena, this) = (task.arena, &task.leg.joints[joint]);
    let start = (from.prefix, &from.turn);
    let (prefix, turn) = before_turn(arena, this, start, configuration)?;
    let (cosine, sine) = this.gamma.cosine_and_sine();
    let along = Vector3::constant(arena, [this.d * cosine, this.d * sine, this.b]);
    Some(Frame {
        prefix,
        turn,
        origin: from.origin + from.rotation(configuration)? * along,
    })
}

/// From a joint before its motion to its frame.
fn step_over<'a>(
    task: Task<'a, '_>,
    configuration: &Configuration<'a>,
    joint: usize,
    before: Frame<'a>,
) -> Option<Frame<'a>> {
    let slide = joint_slide(task.arena, task.leg, joint, task.first_joint, configuration)?;
    let turn = joint_turn(task.leg, joint, task.first_joint, configuration)?;
    Some(Frame {
        turn: before.turn.plus(&turn)?,
        origin: before.origin + before.prefix.column(2).scaled(slide),
        prefix: before.prefix,
    })
}

/// Orientation of a joint's frame before its own turn θ, as prefix and turn about z, from the same of
/// its antecedent. Turns about parallel axes add up.
fn before_turn<'a>(
    arena: &'a Arena,
    joint: &Joint,
    (prefix, turn): (Matrix3<'a>, &Direction),
    configuration: &Configuration<'a>,
) -> Option<(Matrix3<'a>, Direction)> {
    let turned = turn.plus(&Direction::constant(joint.gamma))?;
    let tilt = constant_rotation(arena, [joint.alpha, Angle::ZERO, Angle::ZERO]);
    Some(match parallel(joint.alpha) {
        Some(sign) if sign == Ratio::ONE => (prefix, turned),
        Some(_) => (prefix * tilt, turned.negative()),
        None => {
            let (cosine, sine) = configuration.unit(&turned)?;
            let turned = prefix * Matrix3::rotation(2, cosine, sine);
            (turned * tilt, Direction::constant(Angle::ZERO))
        }
    })
}
