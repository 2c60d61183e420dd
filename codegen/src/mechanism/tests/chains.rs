//! Errors of chains that do not fit their skeleton.

use super::{assert_diagnosis, diagnosis};

/// An arm of two joints in a plane and a linkage from the ground to its second body; `joints` are the linkage's.
fn arm(joints: &str, at: &str) -> String {
    format!(
        r#"name = "Arm"
[leg.arm]
[[leg.arm.joint]]
name = "upper"
type = "revolute"
actuated = true
[[leg.arm.joint]]
name = "fore"
type = "revolute"
d = 0.4
[leg.linkage]
base = {{ at = [0.1, 0.1, 0] }}
{joints}
[leg.linkage.end]
type = "point"
body = "fore"
at = {at}
[[place]]
name = "arm"
shape = "arm"
home = {{ upper = 1.2, fore = -1.0 }}
[[place]]
name = "linkage"
shape = "linkage"
home = {{ 1 = 2.5, 2 = -1.5 }}
"#
    )
}

const TURN: &str = "[[leg.linkage.joint]]\ntype = \"revolute\"\nd = 0.3\n";
const DRIVEN: &str = "[[leg.linkage.joint]]\ntype = \"revolute\"\nactuated = true\n";
const TIP: &str = "[[leg.linkage.joint]]\ntype = \"fixed\"\nd = 0.4\n";

#[test]
fn a_chain_with_too_few_joints_is_rejected() {
    let text = arm(&format!("{DRIVEN}{TIP}"), "[-0.1, 0, 0]").replace(", 2 = -1.5", "");
    assert_diagnosis(
        &text,
        "16:1",
        &["chain `linkage` has too few joints to follow its second body's motion"],
    );
}

/// If an end shares one direction only, any two joints seem to rotate about one axis.
#[test]
fn a_chain_end_without_enough_shared_directions_is_rejected() {
    let text = arm(
        &format!("{DRIVEN}{TURN}{TIP}"),
        "[-0.1, 0, 0]\nalong = [\"x\"]",
    );
    assert_diagnosis(
        &text,
        "19:1",
        &[
            "chain `linkage` can move while its second body stands still",
            "2 joints move an end that shares only one motion with it",
            "`along` with more directions",
        ],
    );
}

#[test]
fn an_unreachable_chain_end_is_rejected() {
    let text = arm(&format!("{DRIVEN}{TURN}{TIP}"), "[3, 0, 0]");
    assert_diagnosis(
        &text,
        "31:1",
        &["chain `linkage` never reaches its place on its second body"],
    );
}

#[test]
fn a_skeleton_with_too_few_motors_is_rejected() {
    let text = arm(&format!("{DRIVEN}{TURN}{TIP}"), "[-0.1, 0, 0]");
    let text = text.replacen("actuated = true\n", "", 1);
    assert_diagnosis(
        &text,
        "1:8",
        &["the skeleton has 2 degrees of freedom, but the robot has 1 actuator"],
    );
}

#[test]
fn an_arm_with_a_linkage_is_accepted() {
    let text = arm(&format!("{DRIVEN}{TURN}{TIP}"), "[-0.1, 0, 0]");
    assert_eq!(diagnosis(&text), "a robot");
}
