//! Springs of joints: formulas, units of their coefficients, and errors.

use super::{good, listed, single};
use crate::{Formula, Spring};

/// The spring of a robot's revolute joint.
fn spring(text: &str) -> Spring {
    let robot = good(&single("", &format!("spring = \"{text}\"")));
    let spring = robot.legs[0].joints[0].spring.clone();
    spring.expect("a spring")
}

#[test]
fn spring_formulas_have_their_values_and_units() {
    let at = 0.3_f64;
    let cases = [
        ("q", at, "N m/rad"),
        ("2*(q - 0.1 rad)", 0.4, "N m/rad"),
        ("q^3", at.powi(3), "m^2 kg s^-2 rad^-3"),
        ("sin(q)", at.sin(), "N m"),
        ("tan(2*q)", 0.6_f64.tan(), "N m"),
        ("0.02 m * 0.1 m * cos(q)", 0.002 * at.cos(), "N/m"),
        ("sqrt(2) * q", 2.0_f64.sqrt() * at, "N m/rad"),
        ("1/(2 - cos(q))", 1.0 / (2.0 - at.cos()), "N m"),
        (
            "0.1 m * sqrt((0.2 m)^2 - (0.1 m)^2 * cos(q)) - 0.01 m^2",
            0.1 * (0.04 - 0.01 * at.cos()).sqrt() - 0.01,
            "N/m",
        ),
        ("-(1 + sin(q))^-2", -(1.0 + at.sin()).powi(-2), "N m"),
    ];
    for (text, value, unit) in cases {
        let spring = spring(text);
        let found = spring.formula.value(at);
        assert!((found - value).abs() < 1e-14, "{text}: {found}");
        assert_eq!(spring.unit, unit, "{text}");
    }
    // Linear formulas stay linear and exact.
    assert!(matches!(spring("2*q - 1").formula, Formula::Linear { .. }));
}

#[test]
fn invalid_joint_springs_are_rejected() {
    let joint = |keys: &str| {
        let all = listed(&single("", keys));
        assert_eq!(all.len(), 1, "{keys}: {all:#?}");
        all.concat()
    };
    let cases = [
        (
            "spring = 3",
            "6:10 a torque that does not depend on the position is not a spring; write it with the joint variable, for instance spring = \"q - 20 deg\"; a constant torque is the parameter `off`",
        ),
        (
            "spring = true",
            "6:10 `spring`: expected a number or an expression, found a boolean",
        ),
        (
            "spring = \"q1\"",
            "6:11 unknown name `q1`; did you mean `q`?",
        ),
        (
            "spring = \"q + 0.1 m\"",
            "6:11 an angle and a length cannot be added",
        ),
        (
            "spring = \"1 m * sin(q) + q\"",
            "6:11 a length and an angle cannot be added",
        ),
        (
            "spring = \"cos(q^2)\"",
            "6:11 `cos` takes an angle that is linear in the joint variable; for instance cos(q - 20 deg)",
        ),
        (
            "spring = \"sqrt(q)\"",
            "6:11 an angle (rad) has no square root",
        ),
        (
            "spring = \"2^q\"",
            "6:11 an exponent cannot hold a joint variable; powers have integer exponents, for instance q^2",
        ),
        (
            "spring = \"q^100\"",
            "6:11 the exponent must be an integer between -64 and 64; write sqrt(x) for a root",
        ),
        (
            "spring = \"atan2(q, 1)\"",
            "6:11 the argument of `atan2` cannot hold a joint variable",
        ),
        (
            "spring = \"((sin(q)^20)^60)^60\"",
            "6:12 the formula has more than 1000 operations; write powers and sums in a shorter form",
        ),
        ("spring = \"q / 0\"", "6:15 division by zero"),
    ];
    for (keys, expected) in cases {
        assert_eq!(joint(keys), expected, "{keys}");
    }
}

#[test]
fn springs_of_fixed_joints_are_rejected() {
    let fixed = "name = \"Arm\"\n[[leg.arm.joint]]\ntype = \"revolute\"\nactuated = true\n\
                 [[leg.arm.joint]]\ntype = \"fixed\"\nspring = \"q\"\n\
                 [[place]]\nname = \"arm\"\nshape = \"arm\"\n";
    assert!(listed(fixed)[0].starts_with("7:10 a fixed joint has no spring"));
}

#[test]
fn closed_loop_joints_have_springs_known_torques_and_loads() {
    let platform = "name = \"Slide\"\n[platform]\nmotion = \"fixed axis\"\naxis = \"z\"\n\
                    [[leg.slide.joint]]\ntype = \"prismatic\"\nactuated = true\n\
                    spring = \"q - 1 cm\"\nknown = \"3 N\"\nfriction_load = \"2 N/m * q\"\n\
                    [leg.slide.end]\n[[place]]\nname = \"slide\"\nshape = \"slide\"\n";
    let robot = good(platform);
    let joint = &robot.legs[0].joints[0];
    let spring = joint.spring.as_ref().expect("a spring");
    assert_eq!(spring.unit, "N/m");
    assert!((spring.formula.value(0.03) - 0.02).abs() < 1e-15);
    assert_eq!(
        joint.known.as_ref().map(|known| known.value(0.03)),
        Some(3.0)
    );
    assert!(joint.load.is_some());
}
