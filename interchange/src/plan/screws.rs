//! Merges a massless slide that is coupled to the next rotation on one axis into a helical joint.

use super::Joint;
use crate::{
    frames::step::Step,
    geometry::digits::is_zero,
    model::{JointType, Model},
};
use std::f64::consts::TAU;

/// Merges the slides of screws into their rotations.
pub(super) fn join(model: &Model, joints: &mut Vec<Joint>) {
    let mut at = 0;
    while at + 1 < joints.len() {
        let found = lead(model, &joints[at], &joints[at + 1]);
        if let Some(lead) = found {
            let slide = joints.remove(at);
            let turn = &mut joints[at];
            turn.kind = "helical";
            turn.pitch = Some(lead * TAU);
            turn.antecedent = slide.antecedent;
            // The remaining constants of the rotation lie on the axis.
            turn.step = Step {
                theta: slide.step.theta + turn.step.gamma + turn.step.theta,
                r: slide.step.r + turn.step.b + turn.step.r,
                ..slide.step
            };
        }
        at += 1;
    }
}

/// Lead in m/rad if a slide and the next joint form a screw.
fn lead(model: &Model, slide: &Joint, turn: &Joint) -> Option<f64> {
    let (own, other) = (slide.of?, turn.of?);
    let follow = model.joints[own].follow?;
    let are_kinds = model.joints[own].kind == JointType::Prismatic
        && model.joints[other].kind == JointType::Revolute
        && turn.kind == "revolute";
    let is_plain = slide.parameters.as_ref().is_some_and(Vec::is_empty)
        && slide.spring.is_none()
        && turn.follows.is_none()
        && turn.antecedent.is_none();
    let are_one = is_zero(turn.step.alpha) && is_zero(turn.step.d);
    let is_screw = are_kinds && is_plain && are_one && follow.joint == other;
    (is_screw && follow.offset == 0.0).then_some(follow.factor)
}
