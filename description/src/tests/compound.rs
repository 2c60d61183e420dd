//! Joints of several axes equal sequences of joints with one axis.

use super::{good, listed};
use crate::{Joint, JointKind};
use overact_core::StandardParameter;
use overact_exact::{Angle, Number};

/// A leg with one joint of a type, with additional keys, between a turn and a slide.
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

/// A leg with explicit axes.
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

/// Data of a joint without its location.
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

/// Another axis in the x direction of the previous one.
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
fn a_universal_joint_is_two_revolute_joints() {
    let one_by_one = first("wrist_1", "revolute", &format!("{PLACED}\n{FRICTION}"))
        + &axis("wrist", "revolute", "");
    assert_eq!(made(&leg("universal", PLACED)), made(&written(&one_by_one)));
}

#[test]
fn a_spherical_joint_is_three_revolute_joints() {
    let one_by_one = first("wrist_1", "revolute", &format!("{PLACED}\n{FRICTION}"))
        + &axis("wrist_2", "revolute", FRICTION)
        + &axis("wrist", "revolute", "");
    assert_eq!(made(&leg("spherical", PLACED)), made(&written(&one_by_one)));
}

#[test]
fn a_cylindrical_joint_is_a_prismatic_and_a_revolute_joint() {
    let placed = "alpha = \"30 deg\"\nr = \"q + 0.1\"";
    let one_by_one = first("wrist_slide", "prismatic", &format!("{placed}\n{FRICTION}"))
        + &first("wrist", "revolute", "");
    assert_eq!(
        made(&leg("cylindrical", placed)),
        made(&written(&one_by_one))
    );
}

#[test]
fn a_planar_joint_is_two_prismatic_and_a_revolute_joint() {
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

/// Name, kind, variable and motor of an axis.
type Axis = (String, JointKind, Vec<(usize, f64)>, bool);

/// Joint 1 of the leg, a slide, and the next one: their variables, and whether they are driven.
fn screw(keys: &str) -> Vec<Axis> {
    let of_joint = |joint: &Joint| {
        let variable = joint
            .variable
            .iter()
            .map(|(of, factor)| (*of, factor.value()));
        let name = joint.name.value.clone();
        (name, joint.kind.value, variable.collect(), joint.actuated)
    };
    let legs = good(&leg("helical", keys)).legs;
    legs[0].joints[1..3].iter().map(of_joint).collect()
}

#[test]
fn a_helical_joint_is_a_revolute_and_a_coupled_prismatic_joint() {
    let placed = "alpha = \"30 deg\"\nd = 0.1\ntheta = \"q + 45 deg\"\nr = 0.2\npitch = \"5 mm\"";
    let slide = "alpha = \"30 deg\"\nd = 0.1\nr = \"0.001 m/rad * q_wrist + 0.2\"\nparameters = []";
    let one_by_one = first("wrist_slide", "prismatic", slide)
        + &first("wrist", "revolute", "theta = \"q + 45 deg\"");
    assert_eq!(made(&leg("helical", placed)), made(&written(&one_by_one)));
    let lead = 0.005 / std::f64::consts::TAU;
    let expected = |lead: f64, is_driven: bool| {
        vec![
            (
                "wrist_slide".to_owned(),
                JointKind::Prismatic,
                vec![(2, lead)],
                false,
            ),
            (
                "wrist".to_owned(),
                JointKind::Revolute,
                vec![(2, 1.0)],
                is_driven,
            ),
        ]
    };
    assert_eq!(screw("pitch = \"5 mm\""), expected(lead, false));
    assert_eq!(
        screw("pitch = 0.005\nactuated = true"),
        expected(lead, true)
    );
    assert_eq!(screw("pitch = \"-0.8 mm/rad\""), expected(-0.0008, false));
    // It has one variable, and all properties of a joint with one axis.
    let torques =
        "actuated = true\nspring = \"q\"\nstribeck = \"0.1 rad/s\"\nknown = \"1 N m * cos(q)\"";
    let legs = good(&leg("helical", &format!("pitch = \"5 mm\"\n{torques}"))).legs;
    let turn = &legs[0].joints[2];
    assert!(turn.spring.is_some() && turn.stribeck.is_some() && turn.known.is_some());
}

#[test]
fn invalid_pitches_are_rejected() {
    let one = |keys: &str| listed(&leg("helical", keys)).join("\n");
    assert!(
        one("").contains("pitch = \"5 mm\" for each turn about z"),
        "{}",
        one("")
    );
    assert!(
        one("pitch = 0").contains("8:9 a pitch must not be zero"),
        "{}",
        one("pitch = 0")
    );
    for variable in ["q", "2 * q", "q + 0.1"] {
        let message = one(&format!("pitch = \"{variable}\""));
        assert!(
            message.contains("8:9 a pitch is constant and cannot hold a joint variable"),
            "{message}"
        );
    }
    let unit = one("pitch = \"5 kg\"");
    assert!(
        unit.contains("8:9 `pitch`: expected a length (m), found a mass"),
        "{unit}"
    );
    let other = listed(&leg("universal", "pitch = \"5 mm\"")).join("\n");
    assert!(
        other.contains("8:9 `pitch` is for helical joints only"),
        "{other}"
    );
}

#[test]
fn joint_variables_in_constant_keys_are_rejected_with_the_axes() {
    let place = "gamma, b, alpha, d, theta and r are constants that place them";
    for (word, keys, expected) in [
        ("planar", "r = \"q\"", format!("a planar joint has the axes `wrist_x` (slide), `wrist_y` (slide), `wrist` (turn): {place}")),
        ("planar", "theta = \"q_wrist + 90 deg\"", "a planar joint has the axes".to_owned()),
        ("spherical", "r = \"q + 0.1 m\"", "a spherical joint has the axes `wrist_1` (turn), `wrist_2` (turn), `wrist` (turn): `theta` may hold `q`, the variable of the first".to_owned()),
        ("universal", "d = \"q\"", "a universal joint has the axes `wrist_1` (turn), `wrist` (turn)".to_owned()),
        ("cylindrical", "theta = \"q + 1 rad\"", "a cylindrical joint has the axes `wrist_slide` (slide), `wrist` (turn): `r` may hold `q`".to_owned()),
        ("helical", "pitch = 0.01\nr = \"q\"", "the variable of a helical joint is the angle `q` in theta".to_owned()),
        ("revolute", "r = \"q\"", "the variable of a revolute joint is the angle `q` in theta".to_owned()),
        ("prismatic", "theta = \"q\"", "the variable of a prismatic joint is the length `q` in r".to_owned()),
        ("fixed", "theta = \"q + 10 deg\"", "a fixed joint has no variable: use type = \"revolute\"".to_owned()),
    ] {
        let errors = listed(&leg(word, keys)).join("\n");
        let is_reported = errors.contains("is constant and cannot hold a joint variable") && errors.contains(&expected);
        assert!(is_reported, "{word} {keys}: {errors}");
    }
}

#[test]
fn keys_of_single_axes_are_rejected_for_compound_joints() {
    let errors = listed(&leg("universal", "actuated = true\nspring = \"q\""));
    let help =
        "; write the axes of this joint as separate joints, of type \"revolute\" and \"prismatic\"";
    let expected = [
        format!("8:12 `actuated` is for joints of one axis only{help}"),
        format!("9:10 `spring` is for joints of one axis only{help}"),
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
