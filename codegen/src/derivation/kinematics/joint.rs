//! A joint in a configuration, in the notation of Khalil and Kleinfinger: its turn, its slide, and
//! the step from its antecedent's frame to its own.

use super::configuration::Configuration;
use crate::cas::{Arena, Direction, Expr, Number, Vector3};
use crate::mechanism::{JointKind, Leg};

/// The turn θ of a joint about its z axis.
pub(crate) fn joint_turn(
    leg: &Leg,
    index: usize,
    first_joint: usize,
    configuration: &Configuration<'_>,
) -> Option<Direction> {
    let joint = &leg.joints[index];
    let mut turn = Direction::constant(joint.theta);
    if joint.kind == JointKind::Revolute {
        for (of, factor) in &joint.variable {
            let at = first_joint + leg.independent().position(|i| i == *of)?;
            turn = turn.plus(&configuration.joint_angle(at).times(*factor)?)?;
        }
    }
    Some(turn)
}

/// Position of a prismatic joint.
pub(crate) fn joint_slide<'a>(
    arena: &'a Arena,
    leg: &Leg,
    index: usize,
    first_joint: usize,
    configuration: &Configuration<'a>,
) -> Option<Expr<'a>> {
    let joint = &leg.joints[index];
    let mut slide = arena.number(joint.r);
    if joint.kind == JointKind::Prismatic {
        for (of, factor) in &joint.variable {
            let at = first_joint + leg.independent().position(|i| i == *of)?;
            slide = slide + configuration.joint_position(at)? * Number::ratio(*factor);
        }
    }
    Some(slide)
}

/// Vector from the antecedent frame's origin to the joint's, in the antecedent frame.
///
/// It is Rot(z, γ) (d, 0, b) + r z_j.
pub(crate) fn link_vector<'a>(
    arena: &'a Arena,
    leg: &Leg,
    index: usize,
    first_joint: usize,
    configuration: &Configuration<'a>,
) -> Option<Vector3<'a>> {
    let joint = &leg.joints[index];
    let (cg, sg) = joint.gamma.cosine_and_sine();
    let along = Vector3::constant(arena, [joint.d * cg, joint.d * sg, joint.b]);
    let axis = joint_axis(arena, leg, index);
    let slide = joint_slide(arena, leg, index, first_joint, configuration)?;
    Some(along + axis.scaled(slide))
}

/// The joint's z axis in the antecedent frame.
fn joint_axis<'a>(arena: &'a Arena, leg: &Leg, index: usize) -> Vector3<'a> {
    let joint = &leg.joints[index];
    let (cg, sg) = joint.gamma.cosine_and_sine();
    let (ca, sa) = joint.alpha.cosine_and_sine();
    Vector3::constant(arena, [sg * sa, -(cg * sa), ca])
}
