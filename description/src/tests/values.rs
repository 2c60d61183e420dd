//! Values of expressions and joints in good descriptions.

use super::{good, listed, single};
use crate::*;
use overact_exact::{Angle, Number, Ratio};

/// Constant part of θ for a joint at `q + expression`.
fn angle(constants: &str, expression: &str) -> Angle {
    let root = format!("[constants]\n{constants}\n");
    let robot = good(&single(&root, &format!("gamma = \"{expression}\"")));
    robot.legs[0].joints[0].gamma.value
}

fn length(expression: &str) -> Number {
    let robot = good(&single("", &format!("d = {expression}")));
    robot.legs[0].joints[0].d.value
}

fn degrees(text: &str) -> Angle {
    Angle::degrees(Ratio::decimal(text).unwrap()).unwrap()
}

fn ratio(n: i128, d: i128) -> Number {
    Number::ratio(Ratio::new(n, d).unwrap())
}

#[test]
fn angles_are_exact() {
    assert_eq!(angle("", "15.52 deg"), degrees("15.52"));
    assert_eq!(angle("", "pi/2"), degrees("90"));
    assert_eq!(angle("", "-pi * 2 / 3 + 30 deg"), degrees("-90"));
    assert_eq!(
        angle("", "1e-3 rad"),
        Angle::radians(Ratio::new(1, 1000).unwrap())
    );
    assert_eq!(angle("", "atan2(-1, 1)"), degrees("-45"));
    assert_eq!(angle("", "atan2(sqrt(3) * 1 m, 1 m)"), degrees("60"));
    assert_eq!(
        angle("a = \"40 deg\"\nb = \"90 deg - a\"", "2*b - a/4"),
        degrees("90")
    );
    let odd = angle("", "atan2(1, 3)").value();
    assert!((odd - 1.0_f64.atan2(3.0)).abs() < 1e-15);
}

#[test]
fn lengths_are_exact() {
    assert_eq!(length("0.41"), ratio(41, 100));
    assert_eq!(length("\"0.41 m\""), ratio(41, 100));
    assert_eq!(length("\"3 mm + 1 cm\""), ratio(13, 1000));
    assert_eq!(length("\"2 * 0.5 m * sin(30 deg)\""), ratio(1, 2));
    assert_eq!(length("\"sqrt(9 m^2) / 2\""), ratio(3, 2));
    assert_eq!(length("\"6 m / 2 m * 1 m\""), ratio(3, 1));
    assert_eq!(length("\"1 m/s * 2 s\""), ratio(2, 1));
    assert_eq!(length("\"-(2 m)^-1 * 4 m^2 + 2 m\""), Number::ZERO);
    assert_eq!(length("\"1_000 mm\""), Number::ONE);
    assert_eq!(length("\"1 N m / (0.5 kg m/s^2)\""), ratio(2, 1));
    assert_eq!(length("\"-2^2 + 5\""), Number::ONE);
    assert!((length("\"sqrt(2) * 1 m\"") * length("\"sqrt(2) * 1 m\"") - ratio(2, 1)).is_zero());
}

#[test]
fn coupled_joints_are_resolved() {
    let text = r#"
name = "Parallelogram"
[[leg.arm.joint]]
name = "root"
type = "revolute"
actuated = true
[[leg.arm.joint]]
type = "revolute"
theta = "-q_root / 2 + 90 deg"
[[leg.arm.joint]]
type = "revolute"
antecedent = "root"
theta = "q2 - q4"
[[leg.arm.joint]]
type = "revolute"
[[leg.arm.joint]]
type = "prismatic"
r = "0.02 m/rad * q4 + 0.3 m"
theta = "10 deg"
[[place]]
name = "arm"
shape = "arm"
home = { root = "20 deg", 4 = 1 }
"#;
    let robot = good(text);
    let joints = &robot.legs[0].joints;
    let half = Ratio::new(-1, 2).unwrap();
    assert_eq!(joints[1].variable, [(0, half)]);
    assert_eq!(joints[1].theta.value, degrees("90"));
    assert_eq!(joints[2].variable, [(0, half), (3, Ratio::integer(-1))]);
    assert_eq!(joints[2].antecedent, Some(0));
    assert_eq!(joints[4].variable, [(3, Ratio::new(1, 50).unwrap())]);
    assert_eq!(joints[4].r.value, ratio(3, 10));
    let independent: Vec<_> = joints
        .iter()
        .enumerate()
        .map(|(i, j)| j.is_independent(i))
        .collect();
    assert_eq!(independent, [true, false, false, true, false]);
    assert!((joints[0].home.value() - 20_f64.to_radians()).abs() < 1e-15);
    assert_eq!(joints[3].home, Number::ONE);
}

#[test]
fn omitted_keys_have_defaults() {
    let robot = good(&single("", ""));
    assert_eq!(
        robot.gravity,
        [Number::ZERO, Number::ZERO, ratio(-981, 100)]
    );
    let joint = &robot.legs[0].joints[0];
    assert_eq!((joint.name.value.as_str(), joint.antecedent), ("1", None));
    assert_eq!(joint.variable, [(0, Ratio::ONE)]);
    assert_eq!(joint.parameters.len(), 14);
    let base = &robot.legs[0].base;
    assert_eq!(
        (base.at, base.rotation),
        ([Number::ZERO; 3], [Angle::ZERO; 3])
    );
    assert!(robot.experiment.is_none() && robot.data.is_none());
}

#[test]
fn platform_motions_and_leg_ends_are_read() {
    let robot = good(
        r#"
name = "one_axis"
[platform]
motion = "fixed axis"
axis = { at = [0, "1 cm", 0], direction = "x" }
home = { x = 0.5 }
[[leg.a.joint]]
type = "prismatic"
actuated = true
[leg.a.end]
type = "point"
at = [0, 0.1, 0]
[[place]]
name = "a"
shape = "a"
"#,
    );
    assert_eq!(robot.type_name(), "OneAxis");
    let platform = robot.platform.unwrap();
    assert_eq!(platform.motion.value, Motion::FixedAxis { axis: 0 });
    assert_eq!(platform.axis_at[1], ratio(1, 100));
    assert_eq!(platform.home.at[0], ratio(1, 2));
    assert_eq!(platform.parameters, StandardParameter::INERTIA);
    assert_eq!(
        robot.legs[0].end.as_ref().unwrap().value,
        End::Point {
            at: [Number::ZERO, ratio(1, 10), Number::ZERO],
            along: [true; 3]
        }
    );
    assert_eq!(Motion::Rotation { axis: 0 }.coordinates(), ["phi"]);
    assert_eq!(Motion::Planar { axis: 1 }.coordinates(), ["z", "x", "phi"]);
    assert_eq!(Motion::Spatial.coordinates().len(), 6);
}

#[test]
fn fixed_axis_platforms_translate_or_rotate() {
    let on_axis = |axis: &str| {
        format!(
            "name = \"one_axis\"\n[platform]\nmotion = \"fixed axis\"\naxis = {axis}\n\
             [[leg.a.joint]]\ntype = \"revolute\"\nactuated = true\n[leg.a.end]\n\
             [[place]]\nname = \"a\"\nshape = \"a\""
        )
    };
    let motion = |axis: &str| good(&on_axis(axis)).platform.unwrap().motion.value;
    assert_eq!(motion("\"y\""), Motion::FixedAxis { axis: 1 });
    assert_eq!(
        motion("{ direction = \"y\", motion = \"translation\" }"),
        Motion::FixedAxis { axis: 1 }
    );
    assert_eq!(
        motion("{ direction = \"y\", motion = \"rotation\" }"),
        Motion::Rotation { axis: 1 }
    );
    let errors = listed(&on_axis("{ direction = \"y\", motion = \"screw\" }"));
    let expected = "4:36 `motion`: expected \"translation\" or \"rotation\", found \"screw\"";
    assert_eq!(errors, [expected]);
}

#[test]
fn numbers_that_suggest_another_unit_are_warned_about() {
    let warnings = |joint: &str| -> Vec<String> {
        let warnings = good(&single("", joint)).warnings.into_iter();
        warnings.map(|warning| warning.value).collect()
    };
    for fine in [
        "alpha = \"-90 deg\"\nr = \"0.32 m\"",
        "alpha = 1.5707\ntheta = \"q + 0.3\"",
        "theta = \"q - 7 rad\"\nd = 49.9",
    ] {
        assert_eq!(warnings(fine), Vec::<String>::new(), "{fine}");
    }
    let found = warnings("alpha = -90\nr = 320\ntheta = \"q + 90\"");
    assert_eq!(
        found,
        [
            "`alpha`: a number without a unit is in rad, and -90 rad are more than a turn: -90 deg?",
            "`r` is 320 m long, and a number without a unit is in m: 320 mm?",
            "`theta`: a number without a unit is in rad, and 90 rad are more than a turn: 90 deg?",
        ]
    );
}

#[test]
fn bare_home_angles_above_a_turn_are_warned_about() {
    let warnings = |home: &str| {
        let warnings = good(&format!("{}home = {{ 1 = {home} }}\n", single("", "")))
            .warnings
            .into_iter();
        warnings.map(|warning| warning.value).collect::<Vec<_>>()
    };
    for fine in ["1.5", "\"127 deg\"", "\"7 rad\""] {
        assert_eq!(warnings(fine), Vec::<String>::new(), "{fine}");
    }
    for bare in ["127", "\"127\""] {
        let found = warnings(bare);
        assert_eq!(found.len(), 1, "{bare}: {found:?}");
        assert!(found[0].contains("127 deg?"), "{found:?}");
    }
}

#[test]
fn a_capitalised_payload_name_is_warned_about() {
    let with = |name: &str| {
        let joint = format!("\n[[leg.arm.joint]]\ntype = \"fixed\"\nname = \"{name}\"");
        good(&single("", &joint)).warnings
    };
    assert_eq!(with("payload"), []);
    assert_eq!(with("tool"), []);
    let found = with("Payload");
    assert!(
        found[0].value.contains("did you mean `payload`"),
        "{found:?}"
    );
}

#[test]
fn malformed_column_expressions_are_warned_about_at_their_line() {
    let data = "[data]\ntime = \"t\"\npositions = [\"q\"]\ntorques = [\n  \"i *\"\n]\n";
    let text = single(data, "");
    let found = good(&text).warnings;
    assert_eq!(found.len(), 1);
    assert_eq!(&text[found[0].span.clone()], "\"i *\"");
    assert!(
        found[0].value.contains("something is missing at its end"),
        "{found:?}"
    );
}
