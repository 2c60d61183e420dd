//! Joints with `dependent = true`: numbers of the pose that the chains determine.
//!
//! They are joints of a skeleton or of a branch. Chains with fewer joints than the directions in
//! which they hold their ends block directions; the mechanism checks that these determine the
//! dependent joints.

use crate::diagnostic::{Code, Diagnostic};
use crate::robot::joint_shape::JointShape;
use crate::robot::model::{JointKind, Leg};
use crate::robot::shape::Shape;
use crate::toml_text::reader::Context;

/// Reports dependent joints where chains cannot determine them.
pub(crate) fn check(shapes: &[Shape<'_, '_>], has_platform: bool, legs: &[Leg], context: &Context) {
    let has_chains = shapes.iter().any(|shape| shape.end.is_some());
    for shape in shapes {
        for joint in &shape.joints {
            let Some(item) = &joint.dependent else {
                continue;
            };
            if let Some(refusal) = refusal(shape, joint, has_platform, has_chains) {
                let error = item.error(refusal.code, refusal.message);
                context.report(error.help(refusal.help));
            }
        }
    }
    check_coordinates(legs, context);
}

/// Reason for which a joint cannot be dependent.
struct Refusal {
    code: Code,
    message: &'static str,
    help: &'static str,
}

/// The reason for which a joint of a shape cannot be dependent, if there is one.
fn refusal(
    shape: &Shape<'_, '_>,
    joint: &JointShape<'_, '_>,
    has_platform: bool,
    has_chains: bool,
) -> Option<Refusal> {
    let structure = |message, help| {
        Some(Refusal {
            code: Code::STRUCTURE,
            message,
            help,
        })
    };
    if has_platform {
        let message = "the joints of a robot with a platform all follow from its pose";
        let help = "leave `dependent` out; `independent` of [platform] names the independent coordinates of a platform with parasitic motion";
        return structure(message, help);
    }
    if !has_chains {
        let message = "no chain determines this joint: the robot has no loops";
        let help = "leave `dependent` out, or add a chain, a leg with an `end` on a body";
        return structure(message, help);
    }
    if shape.end.is_some() {
        let message = "the joints of a chain always follow from the bodies that it connects";
        let help = "leave `dependent` out: it is for joints of the skeleton and of branches only";
        return structure(message, help);
    }
    if joint.kind.value == JointKind::Fixed {
        return Some(Refusal {
            code: Code::CONTRADICTION,
            message: "a fixed joint has no position",
            help: "leave `dependent` out, or use type = \"revolute\" or \"prismatic\"",
        });
    }
    None
}

/// Reports coupled joints that are dependent, and robots without any independent joint.
fn check_coordinates(legs: &[Leg], context: &Context) {
    let has_chains = legs.iter().any(|leg| leg.end.is_some());
    if !context.is_clean() || !has_chains {
        return;
    }
    let free = || legs.iter().filter(|leg| leg.end.is_none());
    let mut first = None;
    let mut are_all = true;
    for leg in free() {
        for (index, joint) in leg.joints.iter().enumerate() {
            let Some(span) = &joint.dependent else {
                are_all &= !joint.is_independent(index);
                continue;
            };
            if joint.is_independent(index) {
                first = first.or(Some(span));
                continue;
            }
            let message = "a coupled joint follows from other joints already";
            let help = "leave `dependent` out, or write it at the joints whose variables the expression contains";
            context.report(Diagnostic::new(Code::CONTRADICTION, message, span.clone()).help(help));
        }
    }
    if let Some(span) = first.filter(|_| are_all) {
        let message = "all joints of the skeleton are dependent";
        let help = "leave `dependent` out at as many joints as the robot has degrees of freedom, for instance at those with motors";
        context.report(Diagnostic::new(Code::STRUCTURE, message, span.clone()).help(help));
    }
}
