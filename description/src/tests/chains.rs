//! Errors of chains: unknown bodies, chains that connect nothing, misplaced skeletons.

use super::{good, listed};
use crate::BodyIndex;

/// An arm of two joints and a rod between two of its bodies; `base` and `end` are the lines of its tables.
fn robot(base: &str, end: &str) -> String {
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
d = 0.3
actuated = true
[leg.rod]
base = {{ {base} }}
[[leg.rod.joint]]
type = "revolute"
[[leg.rod.joint]]
type = "revolute"
d = 0.2
[leg.rod.end]
{end}
type = "point"
[[place]]
name = "arm"
shape = "arm"
[[place]]
name = "rod"
shape = "rod"
"#
    )
}

#[test]
fn chains_are_attached_to_their_bodies() {
    let description = good(&robot("body = \"upper\"", "body = \"fore\""));
    let chain = &description.legs[1];
    let body = |leg, joint| Some(BodyIndex { leg, joint });
    assert_eq!((chain.base_body, chain.end_body), (body(0, 0), body(0, 1)));
    let description = good(&robot("at = [0, 0, 0]", "body = \"fore\""));
    assert_eq!(description.legs[1].base_body, None);
    let description = good(&robot("body = \"ground\"", "body = \"upper\""));
    let chain = &description.legs[1];
    assert_eq!((chain.base_body, chain.end_body), (None, body(0, 0)));
}

#[test]
fn unknown_skeleton_bodies_are_rejected() {
    let errors = listed(&robot("body = \"uper\"", "body = \"fore\""));
    let expected = "13:17 the skeleton `arm` has no body `uper`; did you mean `upper`?";
    assert_eq!(errors, [expected]);
    let errors = listed(&robot("", "body = \"hand\""));
    let expected = "20:8 the skeleton `arm` has no body `hand`; bodies have the names of their joints: \
                    upper, fore, ground";
    assert_eq!(errors, [expected]);
}

/// The arm with a second rod, placed after the first, between two bodies.
fn two_rods(base: &str, end: &str) -> String {
    let one = robot("", "body = \"fore\"");
    let other = robot(base, end);
    let (_, other) = other.split_once("[leg.rod]").expect("a rod");
    let (shape, _) = other.split_once("[[place]]").expect("a place");
    let shape = shape
        .replace("[leg.rod", "[leg.second")
        .replace("[[leg.rod", "[[leg.second");
    format!("{one}[leg.second]{shape}[[place]]\nname = \"second\"\nshape = \"second\"\n")
}

#[test]
fn chains_on_chains_need_earlier_placement() {
    let description = good(&two_rods("body = \"rod.1\"", "body = \"rod.2\""));
    let chain = &description.legs[2];
    let body = |leg, joint| Some(BodyIndex { leg, joint });
    assert_eq!((chain.base_body, chain.end_body), (body(1, 0), body(1, 1)));
    let errors = listed(&two_rods("body = \"rod.3\"", "body = \"fore\""));
    let expected = "the chain `rod` has no body `3`; bodies have the names of their joints: 1, 2";
    assert!(errors[0].ends_with(expected), "{errors:?}");
    let errors = listed(&two_rods("body = \"rode.1\"", "body = \"fore\""));
    let expected =
        "no chain or branch `rode` is placed before the chain `second`; did you mean `rod`?";
    assert!(errors[0].ends_with(expected), "{errors:?}");
    let errors = listed(&two_rods("body = \"second.1\"", "body = \"fore\""));
    let expected = "the chain `second` can't start or end on its own body; legs are solved in the order of their places, so a body that carries a chain or a branch must be in the skeleton, or in a chain or branch that is placed before";
    assert!(errors[0].ends_with(expected), "{errors:?}");
    // Of two chains that refer to each other, one is not placed yet.
    let both = two_rods("body = \"rod.1\"", "body = \"fore\"");
    let turned = both.replacen(
        "[leg.rod.end]\nbody = \"fore\"",
        "[leg.rod.end]\nbody = \"second.1\"",
        1,
    );
    let errors = listed(&turned);
    let expected =
        "the chain `second` is not placed before the chain `rod`, which needs a body of it";
    assert!(errors[0].contains(expected), "{errors:?}");
}

/// The arm with its rod and a hand on a body.
fn with_hand(base: &str) -> String {
    let hand = format!(
        "[leg.hand]\nbase = {{ {base} }}\n[[leg.hand.joint]]\nname = \"grip\"\ntype = \"revolute\"\nactuated = true\n"
    );
    let text = robot("", "body = \"fore\"").replacen("[[place]]", &format!("{hand}[[place]]"), 1);
    text + "[[place]]\nname = \"hand\"\nshape = \"hand\"\n"
}

#[test]
fn branches_on_chains_are_attached_to_their_bodies() {
    let description = good(&with_hand("body = \"rod.2\""));
    assert_eq!(
        description.legs[2].base_body,
        Some(BodyIndex { leg: 1, joint: 1 })
    );
    let own = crate::independent_joints(&description.legs).into_iter();
    let names: Vec<String> = own.map(|(name, _)| name).collect();
    assert_eq!(names, ["upper", "fore", "hand.grip"]);
    // A tree that is not on a body is no branch.
    let errors = listed(&with_hand("at = [0, 0, 0]"));
    assert!(
        errors[0].contains("one leg without an end, and others only on bodies of chains"),
        "{errors:?}"
    );
    let errors = listed(&with_hand("body = \"rod.3\""));
    assert!(
        errors[0].contains("the chain `rod` has no body `3`"),
        "{errors:?}"
    );
}

#[test]
fn misplaced_branches_are_rejected() {
    let text = with_hand("body = \"rod.2\"");
    let hand = "[[place]]\nname = \"hand\"\nshape = \"hand\"\n";
    let first = text
        .replace(hand, "")
        .replacen("[[place]]", &format!("{hand}[[place]]"), 1);
    let errors = listed(&first);
    assert_eq!(errors.len(), 1, "{errors:?}");
    assert!(
        errors[0].contains("the skeleton `arm` is not placed first"),
        "{errors:?}"
    );
    let errors = listed(&with_hand("body = \"hand.grip\""));
    assert!(
        errors[0].contains("the branch `hand` can't start or end on its own body"),
        "{errors:?}"
    );
    // Without the arm the bodies of the others are missing.
    let (head, rest) = text.split_once("[leg.arm]").expect("an arm");
    let (_, legs) = rest.split_once("[leg.rod]").expect("a rod");
    let alone = format!("{head}[leg.rod]{legs}")
        .replace("[[place]]\nname = \"arm\"\nshape = \"arm\"\n", "")
        .replace("body = \"fore\"", "body = \"rod.1\"");
    let errors = listed(&alone);
    assert!(
        errors[0].contains("no leg is the skeleton: `hand` is a branch"),
        "{errors:?}"
    );
}

/// With several legs, parameter names contain the leg, so a fixed joint is not recognised as payload.
#[test]
fn payloads_of_skeletons_need_their_own_table() {
    let fixed = "[[leg.arm.joint]]\nname = \"payload\"\ntype = \"fixed\"\n[leg.rod]";
    let text = robot("", "body = \"fore\"")
        .replacen("[leg.rod]", fixed, 1)
        .replacen("[leg.arm]", "payloads = [\"box\"]\n[leg.arm]", 1);
    let errors = listed(&text);
    assert!(
        errors[0].contains("payloads have names, but the robot has no payload")
            && errors[0].contains("describe it in a table [payload.NAME]"),
        "{errors:?}"
    );
    let own = "[payload.box]\nbody = \"fore\"\n[leg.arm]";
    let text = robot("", "body = \"fore\"").replacen("[leg.arm]", own, 1);
    let robot = super::good(&text);
    assert_eq!(robot.payload_bodies.len(), 1);
    assert_eq!(robot.payloads[0].value, "box");
}

#[test]
fn chains_without_two_bodies_are_rejected() {
    let errors = listed(&robot("body = \"fore\"", "body = \"fore\""));
    let expected = "20:8 the chain `rod` starts from and ends on the same body; name another body in `base.body` or `end.body`: a chain connects two";
    assert_eq!(errors, [expected]);
    let errors = listed(&robot("body = \"fore\"", "body = \"ground\""));
    let expected = "20:8 the chain `rod` ends on the ground; reverse it: its base on the ground, its end on the body";
    assert_eq!(errors, [expected]);
    let errors = listed(&robot("", ""));
    let expected = "19:1 the chain `rod` has no body to end on; body = \"NAME\" of a joint of \
                    the skeleton `arm`: upper, fore";
    assert_eq!(errors, [expected]);
}

#[test]
fn misplaced_skeletons_are_rejected() {
    let text = robot("", "body = \"fore\"");
    let (places, rod) = text
        .split_once("[[place]]\nname = \"rod\"")
        .expect("two places");
    let (before, arm) = places.split_once("[[place]]").expect("a place");
    let turned = format!("{before}[[place]]\nname = \"rod\"{rod}[[place]]{arm}");
    let errors = listed(&turned);
    let expected = "26:8 the skeleton `arm` is not placed first; its joints are the robot's coordinates: put \
                    its [[place]] before those of chains and branches";
    assert_eq!(errors, [expected]);
    // A robot with a platform has no skeleton.
    let errors = listed(&text.replace("[leg.arm]", "[platform]\nmotion = \"planar\"\n[leg.arm]"));
    assert!(
        errors[1].contains("there is no skeleton with a body `fore`"),
        "{errors:?}"
    );
    assert!(
        errors[0].contains("the leg `arm` has no end on the platform"),
        "{errors:?}"
    );
    // A single leg is no chain.
    let (alone, _) = text
        .split_once("[[place]]\nname = \"rod\"")
        .expect("two places");
    let (head, tail) = alone.split_once("[leg.rod]").expect("a chain");
    let (_, arm) = tail.split_once("[[place]]").expect("a place");
    let text = format!("{head}[leg.arm.base]\nbody = \"upper\"\n[[place]]{arm}");
    let errors = listed(&text);
    assert!(
        errors[0].contains("there is no skeleton with a body `upper`"),
        "{errors:?}"
    );
}
