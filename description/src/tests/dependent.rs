//! Errors of the key `dependent`.

use super::{good, listed};

/// A skeleton of two joints with lines of their own, and a rod from the ground with lines of its pin.
fn robot(first: &str, second: &str, pin: &str) -> String {
    format!(
        r#"name = "Arm"
[[leg.arm.joint]]
name = "a"
type = "revolute"
actuated = true
{first}
[[leg.arm.joint]]
name = "b"
type = "revolute"
d = 0.3
{second}
[[leg.rod.joint]]
name = "pin"
type = "revolute"
{pin}
[[leg.rod.joint]]
name = "tip"
type = "fixed"
d = 0.3
[leg.rod.end]
type = "point"
body = "b"
at = [0.1, 0, 0]
[[place]]
name = "arm"
shape = "arm"
[[place]]
name = "rod"
shape = "rod"
"#
    )
}

const KEY: &str = "dependent = true";

#[test]
fn dependent_joints_are_no_coordinates() {
    let description = good(&robot("", KEY, ""));
    let own = crate::independent_joints(&description.legs);
    let names: Vec<&str> = own.iter().map(|(name, _)| name.as_str()).collect();
    assert_eq!(names, ["a"]);
    assert!(description.legs[0].joints[1].dependent.is_some());
    let description = good(&robot("", "dependent = false", ""));
    assert!(description.legs[0].joints[1].dependent.is_none());
}

#[test]
fn joints_of_chains_cannot_be_dependent() {
    let expected = "15:13 the joints of a chain always follow from the bodies that it connects; \
                    leave `dependent` out: it is for joints of the skeleton and of branches only";
    assert_eq!(listed(&robot("", KEY, KEY)), [expected]);
}

#[test]
fn some_joint_is_independent() {
    let expected = "6:13 all joints of the skeleton are dependent; leave `dependent` out at as many \
                    joints as the robot has degrees of freedom, for instance at those with motors";
    assert_eq!(listed(&robot(KEY, KEY, "")), [expected]);
}

#[test]
fn coupled_and_fixed_joints_cannot_be_dependent() {
    let coupled = format!("theta = \"-q_a\"\n{KEY}");
    let expected = "12:13 a coupled joint follows from other joints already; leave `dependent` out, \
                    or write it at the joints whose variables the expression contains";
    assert_eq!(listed(&robot("", &coupled, "")), [expected]);
    let fixed =
        robot("", KEY, "").replace("type = \"revolute\"\nd = 0.3", "type = \"fixed\"\nd = 0.3");
    let expected = "11:13 a fixed joint has no position; leave `dependent` out, or use \
                    type = \"revolute\" or \"prismatic\"";
    assert_eq!(listed(&fixed), [expected]);
}

#[test]
fn joints_of_several_axes_cannot_be_dependent() {
    let several = robot("", KEY, "").replace(
        "type = \"revolute\"\nd = 0.3",
        "type = \"universal\"\nd = 0.3",
    );
    let expected = "11:13 `dependent` is for joints of one axis only; write the axes of this joint as \
                    separate joints, of type \"revolute\" and \"prismatic\"";
    assert_eq!(listed(&several), [expected]);
}

#[test]
fn robots_without_chains_have_no_dependent_joints() {
    let tree = robot("", KEY, "");
    let rod = tree.find("[[leg.rod.joint]]").unwrap_or_default();
    let text = format!(
        "{}[[place]]\nname = \"arm\"\nshape = \"arm\"\n",
        &tree[..rod]
    );
    let expected = "11:13 no chain determines this joint: the robot has no loops; leave `dependent` \
                    out, or add a chain, a leg with an `end` on a body";
    assert_eq!(listed(&text), [expected]);
    let text = robot("", "", KEY).replace(
        "name = \"Arm\"\n",
        "name = \"Arm\"\n[platform]\nmotion = \"planar\"\n",
    );
    let found = listed(&text);
    let expected = "the joints of a robot with a platform all follow from its pose; leave `dependent` \
                    out; `independent` of [platform] names the independent coordinates of a platform \
                    with parasitic motion";
    assert!(
        found.iter().any(|error| error.ends_with(expected)),
        "{found:?}"
    );
}

#[test]
fn the_key_is_a_boolean() {
    let found = listed(&robot("", "dependent = \"yes\"", ""));
    let expected = "11:13 `dependent`: expected true or false, found a string";
    assert_eq!(found, [expected]);
}
