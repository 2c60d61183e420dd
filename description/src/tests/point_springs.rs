//! Springs between two points: bodies, forces, units of their coefficients, and errors.

use super::{good, listed, single};
use crate::{BodyIndex, PointSpring, SpringBody};

/// A robot of one joint with a spring of these keys after its name.
fn arm(keys: &str) -> String {
    format!(
        "{}[[spring]]\nname = \"gas\"\n{keys}\n",
        single("", "d = \"0.2 m\"")
    )
}

/// Ends of a spring from the ground to the only body.
const ENDS: &str = "from = { body = \"ground\", at = [0, \"5 cm\", 0] }\nto = { body = \"1\" }";

fn spring(keys: &str) -> PointSpring {
    let robot = good(&arm(&format!("{ENDS}\n{keys}")));
    robot.springs[0].clone()
}

#[test]
fn spring_forces_have_their_values_and_units() {
    let (length, rate) = (0.5, -0.2);
    let cases = [
        ("l - 0.3 m", 0.2, "N/m"),
        ("dl", rate, "N s/m"),
        ("l * dl", length * rate, "m^-1 kg s^-1"),
        ("1", 1.0, "N"),
        ("sqrt(l^2 - (0.3 m)^2)", 0.4, "N/m"),
        ("1/l", 2.0, "N m"),
    ];
    for (text, value, unit) in cases {
        let force = spring(&format!("force = \"{text}\"")).force;
        let force = force.expect("a force");
        let found = force.formula.value_at(length, rate);
        assert!((found - value).abs() < 1e-14, "{text}: {found}");
        assert_eq!(force.unit, unit, "{text}");
    }
    let known = spring("known = \"50 N + 3 N s/m * dl - 2 N/cm * (l - 0.3 m)\"");
    assert!(known.force.is_none());
    let known = known.known.expect("a known force");
    assert!((known.value_at(length, rate) - 9.4).abs() < 1e-12);
    assert!(known.has_rate());
}

#[test]
fn spring_ends_are_attached_to_bodies() {
    let own = spring("known = \"5 N\"");
    assert_eq!(own.from.body, SpringBody::Ground);
    assert!((own.from.at[1].value() - 0.05).abs() < 1e-15);
    let body = BodyIndex { leg: 0, joint: 0 };
    assert_eq!(own.to.body, SpringBody::Joint(body));
    let platform = "name = \"Slide\"\n[platform]\nmotion = \"fixed axis\"\naxis = \"z\"\n\
                    [[leg.slide.joint]]\ntype = \"prismatic\"\nactuated = true\n\
                    [leg.slide.end]\n[[place]]\nname = \"slide\"\nshape = \"slide\"\n\
                    [[spring]]\nname = \"gas\"\nfrom = { body = \"slide.1\" }\n\
                    to = { body = \"platform\", at = [1, 0, 0] }\nforce = \"l\"\n";
    let robot = good(platform);
    assert_eq!(robot.springs[0].to.body, SpringBody::Platform);
}

#[test]
fn invalid_springs_between_points_are_rejected() {
    let of = |keys: &str| {
        let all = listed(&arm(keys));
        assert_eq!(all.len(), 1, "{keys}: {all:#?}");
        all.concat()
    };
    let with = |keys: &str| of(&format!("{ENDS}\n{keys}"));
    let cases = [
        (
            with(""),
            "11:1 the spring has neither a `force` nor a `known` force; for instance force = \"l - 0.3 m\", with an unknown coefficient, or known = \"2 N/mm * (l - 0.3 m)\"",
        ),
        (
            with("force = \"stretch - 0.3 m\""),
            "15:10 unknown name `stretch`; known here: l, dl",
        ),
        (
            with("force = \"l - \""),
            "15:12 the expression ends where a value is expected",
        ),
        (
            with("force = \"l + dl\""),
            "15:10 a length and a speed cannot be added",
        ),
        (
            with("force = \"sin(l/(1 m))\""),
            "15:9 sines of a length are not supported; write the force with powers, roots and quotients of `l` and `dl`",
        ),
        (
            with("known = \"2 * l\""),
            "15:9 expected a force (N), found a length; give its factors their units, for instance \"2 N/m * l\"",
        ),
        (
            of("from = { body = \"ground\" }\nto = { body = \"elbow\" }\nforce = \"l\""),
            "14:15 the robot has no body `elbow`; bodies are ground, 1, arm.1",
        ),
        (
            of("from = { body = \"1\" }\nto = { body = \"arm.1\" }\nforce = \"l\""),
            "11:1 both ends of the spring are on the same body; a spring connects two bodies; name another one in `from` or `to`",
        ),
        (
            of("from = { at = [0, 0, 0] }\nto = { body = \"1\" }\nforce = \"l\""),
            "13:8 the end of a spring has no `body`; for instance body = \"ground\"",
        ),
        (
            of("to = { body = \"1\" }\nforce = \"l\""),
            "11:1 the spring has no `from`; for instance from = { body = \"ground\", at = [0, 0, \"0.2 m\"] }",
        ),
    ];
    for (found, expected) in cases {
        assert_eq!(found, expected);
    }
}

#[test]
fn spring_names_are_identifiers_and_unique() {
    let twice = arm(&format!(
        "{ENDS}\nforce = \"l\"\n[[spring]]\nname = \"gas\"\n{ENDS}\nknown = \"1 N\""
    ));
    let expected =
        "17:8 there are two springs `gas`; parameters are named after springs: rename one of them";
    assert_eq!(listed(&twice), [expected]);
    let bad = arm(&format!("{ENDS}\nforce = \"l\"")).replace("\"gas\"", "\"gas spring\"");
    let expected = "12:8 `gas spring` cannot be the name of a spring; its parameter is named after it: use letters, digits and underscores";
    assert_eq!(listed(&bad), [expected]);
    let joint = single("", "spring = \"q\"");
    let same = format!("{joint}[[spring]]\nname = \"1\"\n{ENDS}\nforce = \"l\"\n");
    let expected = "12:8 another parameter is also called `k_1`; the coefficient of a joint's spring has this name: rename this spring";
    assert_eq!(listed(&same), [expected]);
}
