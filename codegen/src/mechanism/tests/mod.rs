//! Invalid robots: the error names the cause and a remedy.

mod chains;
mod homes;
mod mobility;

use super::check;
use overact_description::diagnostic::Source;
use overact_description::parse;

const PLANAR: &str = include_str!("../../../../robots/planar_3rrr.toml");
const SLIDERS: &str = include_str!("../../../../robots/planar_3prr.toml");
const DELTA: &str = include_str!("../../../../robots/delta.toml");
const HEXAPOD: &str = include_str!("../../../../robots/hexapod.toml");

/// The description up to its settings, with replacements that all have to apply.
fn changed(text: &str, changes: &[(&str, &str)]) -> String {
    let text = text.split("\n[identification]").next().unwrap_or_default();
    changes.iter().fold(text.to_owned(), |text, (from, to)| {
        assert!(text.contains(from), "{from}");
        text.replace(from, to)
    })
}

/// The errors of a description; none of the legs' shapes may be reported twice.
fn diagnosis(text: &str) -> String {
    let source = Source::new("my.toml", text);
    let description = match parse(&source) {
        Ok(description) => description,
        Err(errors) => return errors.render_plain(&source),
    };
    match check(&description) {
        Ok(_) => "a robot".to_owned(),
        Err(errors) => errors.render_plain(&source),
    }
}

/// Asserts that the only kind of error is at `place` and contains all of `expected`.
fn assert_diagnosis(text: &str, place: &str, expected: &[&str]) {
    let diagnosis = diagnosis(text);
    assert!(
        diagnosis.contains(&format!("--> my.toml:{place}\n")),
        "{place} in\n{diagnosis}"
    );
    assert!(diagnosis.contains("= help: "), "no way out of\n{diagnosis}");
    for words in expected {
        assert!(diagnosis.contains(words), "{words}\nin\n{diagnosis}");
    }
}

/// The planar robot whose last joints are `joint`, with homes of `joints` joints.
fn wrist(joint: &str, joints: usize) -> String {
    let old = "type = \"revolute\"\nd = \"l_2\"\nparameters = [\"fs\"]";
    let text = changed(PLANAR, &[(old, joint)]);
    if joints > 2 {
        return text;
    }
    let homes = [
        ", 3 = \"-322 deg\"",
        ", 3 = \"-442 deg\"",
        ", 3 = \"-562 deg\"",
    ];
    homes.iter().fold(text, |text, home| text.replace(home, ""))
}

#[test]
fn coincident_joint_axes_are_rejected() {
    assert_diagnosis(
        &changed(PLANAR, &[("l_2 = \"0.20 m\"", "l_2 = \"0 m\"")]),
        "39:5",
        &[
            "joints `2` and `3` of leg `arm` always turn about the same axis",
            "has no length: give the second a `d`",
        ],
    );
    assert_diagnosis(
        &changed(DELTA, &[("rod = \"0.56 m\"", "rod = \"0 m\"")]),
        "45:1",
        &[
            "joints `cross` and `rod` of leg `arm` never move the leg's end",
            "a rod of zero length?",
        ],
    );
    assert_diagnosis(
        &changed(DELTA, &[("arm = \"0.24 m\"", "arm = \"0 m\"")]),
        "42:5",
        &["joints `arm` and `cross` of leg `arm` always turn about the same axis"],
    );
    let slider = [(
        "type = \"revolute\"\nalpha = \"90 deg\"",
        "type = \"prismatic\"",
    )];
    assert_diagnosis(
        &changed(SLIDERS, &slider).replace("229.7 deg", "0.1 m"),
        "33:1",
        &[
            "joints `1` and `2` of leg `slider` always slide in the same direction",
            "leave one of the joints out",
        ],
    );
}

#[test]
fn legs_with_too_many_joints_are_rejected() {
    let fourth =
        "type = \"revolute\"\nd = \"l_2\"\n\n[[leg.arm.joint]]\ntype = \"revolute\"\nd = \"0.1 m\"";
    assert_diagnosis(
        &wrist(fourth, 4),
        "41:1",
        &[
            "leg `arm` can move while the platform stands still",
            "4 joints move an end that has only 3 motions",
            "leave out a joint",
        ],
    );
    let branch = "type = \"revolute\"\nd = \"l_2\"\nantecedent = \"1\"";
    assert_diagnosis(
        &wrist(branch, 3),
        "31:1",
        &[
            "joint `2` of leg `arm` is on a branch that does not lead to the leg's end",
            "theta = \"-q2\"",
        ],
    );
    let point = [
        ("type = \"rigid\"", "type = \"point\""),
        ("rotation = [0, 0, 0]", ""),
    ];
    assert_diagnosis(
        &changed(PLANAR, &point),
        "39:5",
        &[
            "joint `3` of leg `arm` never moves the leg's end",
            "an end of type \"point\" rotates freely",
        ],
    );
}

#[test]
fn legs_with_too_few_joints_are_rejected() {
    let wanted = "leg `arm` has too few joints to follow the platform's motion";
    assert_diagnosis(
        &wrist("type = \"fixed\"\nd = \"l_2\"\nparameters = []", 2),
        "37:1",
        &[
            wanted,
            "its joints allow its end 2 of the 3 motions",
            "add a passive joint",
        ],
    );
    // A parallelogram keeps the platform's orientation.
    assert_diagnosis(
        &wrist("type = \"revolute\"\nd = \"l_2\"\ntheta = \"-q1-q2\"", 2),
        "37:1",
        &[wanted, "2 of the 3"],
    );
    let spatial = [
        ("motion = \"planar\"", "motion = \"spatial\""),
        (", phi = \"0 deg\"", ""),
        ("d = \"l_1\"", "d = \"l_1\"\nactuated = true"),
    ];
    assert_diagnosis(&changed(PLANAR, &spatial), "38:1", &[wanted, "3 of the 6"]);
    // As many joints as the platform has motions, but in other directions.
    let tilted = [
        ("motion = \"planar\"", "motion = \"translation\""),
        (", phi = \"0 deg\"", ""),
    ];
    assert_diagnosis(
        &changed(PLANAR, &tilted),
        "47:1",
        &[
            "leg `leg1` cannot follow the platform's motion",
            "it blocks motion along z",
        ],
    );
}

#[test]
fn unreachable_platform_points_are_rejected() {
    assert_diagnosis(
        &changed(PLANAR, &[("radius = \"0.35 m\"", "radius = \"0.80 m\"")]),
        "47:1",
        &[
            "leg `leg1` never reaches its place on the platform at the home pose",
            "at least 0.300 m away",
        ],
    );
    assert_diagnosis(
        &changed(
            PLANAR,
            &[("d = \"l_2\"", "d = \"l_2\"\nalpha = \"10 deg\"")],
        ),
        "48:1",
        &[
            "leg `leg1` cannot take the platform's orientation at the home pose",
            "check `alpha`",
        ],
    );
    // Stretched away from the platform, where no step reduces the gap; yet a solution exists.
    let away = [(
        "1 = \"129 deg\", 2 = \"103 deg\", 3 = \"-322 deg\"",
        "1 = \"0 deg\", 2 = \"0 deg\", 3 = \"-90 deg\"",
    )];
    assert_diagnosis(
        &changed(PLANAR, &away),
        "47:1",
        &[
            "leg `leg1` does not close from its rough home",
            "it closes elsewhere",
            "give home = { 1 = \"",
        ],
    );
}

#[test]
fn the_proposed_home_closes_the_robot() {
    let away = [(
        "1 = \"129 deg\", 2 = \"103 deg\", 3 = \"-322 deg\"",
        "1 = \"0 deg\", 2 = \"0 deg\", 3 = \"-90 deg\"",
    )];
    let text = changed(PLANAR, &away);
    let message = diagnosis(&text);
    let proposed = message
        .split("give home = ")
        .nth(1)
        .and_then(|rest| rest.split(", or another").next());
    let given = "{ 1 = \"0 deg\", 2 = \"0 deg\", 3 = \"-90 deg\" }";
    let better = text.replace(given, proposed.expect("a proposal"));
    assert_ne!(better, text);
    assert_eq!(diagnosis(&better), "a robot");
}

/// The planar robot whose last leg has no motor and a shape of its own.
fn one_passive_leg() -> String {
    let text = changed(PLANAR, &[]);
    let places = text.find("[[place]]").expect("placements");
    let leg = text.find("[leg.arm]").expect("a leg");
    let last = text.rfind("shape = \"arm\"").expect("a last placement");
    let passive = text[leg..places]
        .replace("leg.arm", "leg.passive")
        .replace("actuated = true\n", "");
    let rest = text[last..].replacen("\"arm\"", "\"passive\"", 1);
    format!("{}{passive}{}{rest}", &text[..places], &text[places..last])
}

#[test]
fn actuators_that_do_not_hold_the_platform_are_rejected() {
    let locked = "with all motors locked the platform can still";
    assert_diagnosis(
        &changed(
            PLANAR,
            &[(
                "type = \"revolute\"\nactuated = true",
                "type = \"revolute\"",
            )],
        ),
        "18:10",
        &[
            "the platform has 3 degrees of freedom, but the robot has 0 actuators",
            "without an actuator: leg1, leg2, leg3",
            "actuated = true",
        ],
    );
    assert_diagnosis(
        &one_passive_leg(),
        "18:10",
        &[
            "the platform has 3 degrees of freedom, but the robot has 2 actuators",
            "without an actuator: leg3",
        ],
    );
    // Two legs at the same place.
    let collinear = [(
        "base = \"12 deg\"\ntop = \"45 deg\"",
        "base = \"-12 deg\"\ntop = \"-45 deg\"",
    )];
    assert_diagnosis(
        &changed(HEXAPOD, &collinear),
        "17:10",
        &[
            "the actuators never determine the platform's motion",
            locked,
            "at once",
            "`leg1` and `leg2` have the same effect",
        ],
    );
    // All legs at one point of the platform.
    assert_diagnosis(
        &changed(HEXAPOD, &[("r_p = \"0.20 m\"", "r_p = \"0 m\"")]),
        "17:10",
        &[
            "never determine",
            &format!("{locked} turn about x, y and z"),
            "attach the legs at other points",
        ],
    );
    // Rotated until the distal links point at the platform's centre: singular at home only.
    let turned = [
        ("phi = \"0 deg\"", "phi = \"atan2(sqrt(255), 23)\""),
        (
            "1 = \"129 deg\", 2 = \"103 deg\"",
            "1 = \"121 deg\", 2 = \"94 deg\"",
        ),
        ("-322 deg", "-270 deg"),
        ("-442 deg", "-390 deg"),
        ("-562 deg", "-510 deg"),
    ];
    assert_diagnosis(
        &changed(PLANAR, &turned),
        "18:10",
        &[
            "the actuators do not determine the platform's motion at the home configuration",
            &format!("{locked} turn about z"),
            "home is a singular pose",
        ],
    );
}

#[test]
fn cyclically_coupled_joints_are_rejected() {
    let cycle = [
        ("d = \"l_1\"", "d = \"l_1\"\ntheta = \"-q3\""),
        ("d = \"l_2\"", "d = \"l_2\"\ntheta = \"q2\""),
    ];
    assert_diagnosis(
        &changed(PLANAR, &cycle),
        "34:9",
        &["the joints are coupled in a cycle", "has `q` instead"],
    );
}

#[test]
fn actuator_counts_that_contradict_the_redundancy_are_rejected() {
    let with_redundancy = |wanted: u8, twice: bool| {
        let motion = format!("motion = \"planar\"\nredundancy = {wanted}");
        let second = if twice {
            "d = \"l_1\"\nactuated = true"
        } else {
            "d = \"l_1\""
        };
        changed(
            PLANAR,
            &[("motion = \"planar\"", &motion), ("d = \"l_1\"", second)],
        )
    };
    assert_diagnosis(
        &with_redundancy(0, true),
        "19:14",
        &[
            "a redundancy of 0 means 3 actuators for 3 coordinates, but the robot has 6",
            "the actuators are leg1_1, leg1_2, leg2_1, leg2_2, leg3_1, leg3_2",
            "take `actuated = true` from a joint, or write redundancy = 3",
        ],
    );
    assert_diagnosis(
        &with_redundancy(1, false),
        "19:14",
        &[
            "a redundancy of 1 means 4 actuators for 3 coordinates, but the robot has 3",
            "mark more joints",
        ],
    );
    assert_eq!(self::diagnosis(&with_redundancy(3, true)), "a robot");
    assert_eq!(self::diagnosis(&with_redundancy(0, false)), "a robot");
}
