//! Joints of several axes are what is otherwise written axis by axis.

use super::{good, listed};
use crate::cas::{Angle, Number};
use crate::description::{Joint, JointKind};
use overact_core::StandardParameter;

/// A leg of one joint of a type, with more keys, between a turn and a slide.
fn leg(word: &str, keys: &str) -> String {
    format!(
        r#"name = "Arm"
[[leg.arm.joint]]
type = "revolute"
actuated = true
[[leg.arm.joint]]
name = "wrist"
type = "{word}"
{keys}
[[leg.arm.joint]]
name = "hand"
type = "prismatic"
d = 0.2
[[place]]
name = "arm"
shape = "arm"
"#
    )
}

/// The axes of a leg, written one by one.
fn written(axes: &str) -> String {
    let text = leg("fixed", "");
    let (before, after) = (
        text.find("[[leg.arm.joint]]\nname = \"wrist\""),
        text.find("[[leg.arm.joint]]\nname = \"hand\""),
    );
    let (Some(before), Some(after)) = (before, after) else {
        panic!("no such joints");
    };
    format!("{}{axes}\n{}", &text[..before], &text[after..])
}

/// What makes a joint, without where it is written.
type Made = (
    String,
    JointKind,
    Option<usize>,
    [Angle; 3],
    [Number; 3],
    Vec<StandardParameter>,
);

fn made(text: &str) -> Vec<Made> {
    let of_joint = |joint: &Joint| {
        (
            joint.name.value.clone(),
            joint.kind.value,
            joint.antecedent,
            [joint.gamma.value, joint.alpha.value, joint.theta.value],
            [joint.b.value, joint.d.value, joint.r.value],
            joint.parameters.clone(),
        )
    };
    good(text).legs[0].joints.iter().map(of_joint).collect()
}

/// A further axis in the x direction of the one before.
fn axis(name: &str, kind: &str, parameters: &str) -> String {
    format!(
        "[[leg.arm.joint]]\nname = \"{name}\"\ntype = \"{kind}\"\ngamma = \"90 deg\"\nalpha = \"90 deg\"\n{parameters}\n"
    )
}

const FRICTION: &str = "parameters = [\"friction\"]";
const PLACED: &str = "alpha = \"30 deg\"\nd = 0.1\ntheta = \"q + 45 deg\"";

fn first(name: &str, kind: &str, keys: &str) -> String {
    format!("[[leg.arm.joint]]\nname = \"{name}\"\ntype = \"{kind}\"\n{keys}\n")
}

#[test]
fn a_universal_joint_is_two_turns() {
    let one_by_one = first("wrist_1", "revolute", &format!("{PLACED}\n{FRICTION}"))
        + &axis("wrist", "revolute", "");
    assert_eq!(made(&leg("universal", PLACED)), made(&written(&one_by_one)));
}

#[test]
fn a_spherical_joint_is_three_turns() {
    let one_by_one = first("wrist_1", "revolute", &format!("{PLACED}\n{FRICTION}"))
        + &axis("wrist_2", "revolute", FRICTION)
        + &axis("wrist", "revolute", "");
    assert_eq!(made(&leg("spherical", PLACED)), made(&written(&one_by_one)));
}

#[test]
fn a_cylindrical_joint_is_a_slide_and_a_turn() {
    let placed = "alpha = \"30 deg\"\nr = \"q + 0.1\"";
    let one_by_one = first("wrist_slide", "prismatic", &format!("{placed}\n{FRICTION}"))
        + &first("wrist", "revolute", "");
    assert_eq!(
        made(&leg("cylindrical", placed)),
        made(&written(&one_by_one))
    );
}

#[test]
fn a_planar_joint_is_two_slides_and_a_turn() {
    let placed = "alpha = \"30 deg\"\nr = 0.1";
    let one_by_one = first(
        "wrist_place",
        "fixed",
        &format!("{placed}\nparameters = []"),
    ) + &axis("wrist_x", "prismatic", FRICTION)
        + &axis("wrist_y", "prismatic", FRICTION)
        + &axis("wrist", "revolute", "parameters = [\"friction\", \"zz\"]");
    let keys = format!("{placed}\nparameters = [\"friction\", \"zz\"]");
    assert_eq!(made(&leg("planar", &keys)), made(&written(&one_by_one)));
}

#[test]
fn what_joints_of_several_axes_cannot_have() {
    let errors = listed(&leg("universal", "actuated = true\nspring = \"q\""));
    let help = "; write the axes of this joint as joints of their own, of type \"revolute\" and \"prismatic\"";
    let expected = [
        format!("8:12 `actuated` is said of a joint of one axis{help}"),
        format!("9:10 `spring` is said of a joint of one axis{help}"),
    ];
    assert_eq!(errors, expected);
    let errors = listed(&leg("sperical", ""));
    assert!(
        errors[0].contains("did you mean `spherical`?"),
        "{errors:?}"
    );
    let twice = leg("universal", "").replace("name = \"hand\"", "name = \"wrist_1\"");
    let errors = listed(&twice);
    assert!(errors[0].contains("two joints `wrist_1`"), "{errors:?}");
}
