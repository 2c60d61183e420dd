//! Errors in expressions, types and joints.

use super::{listed, rendered, single};

/// The only error of a robot whose joint has these keys; the keys start at line 6.
fn joint(keys: &str) -> String {
    let all = listed(&single("", keys));
    assert_eq!(all.len(), 1, "{keys}: {all:#?}");
    all.concat()
}

/// The errors of a robot whose root has these keys; they start at line 2.
fn root(keys: &str) -> Vec<String> {
    listed(&single(keys, ""))
}

#[test]
fn several_errors_are_shown_at_once() {
    let text = single(
        "[constants]\nwidth = \"0.4 m\"",
        "gamma = \"3 * widht\"\nalhpa = 1\nd = \"15 deg\"",
    );
    let expected = "\
error[OA106]: unknown name `widht`
 --> my.toml:7:14
  |
7 | gamma = \"3 * widht\"
  |              ^^^^^
  |
  = help: did you mean `width`?

error[OA102]: unknown key `alhpa`
 --> my.toml:8:1
  |
8 | alhpa = 1
  | ^^^^^ not a key of a joint
  |
  = help: did you mean `alpha`?

error[OA105]: `d`: expected a length (m), found an angle (15 deg)
 --> my.toml:9:5
  |
9 | d = \"15 deg\"
  |     ^^^^^^^^ this is an angle";
    assert_eq!(rendered(&text), expected);
}

#[test]
fn malformed_expressions_are_rejected() {
    let cases = [
        (
            "d = \"\"",
            "6:5 expected an expression, found an empty string",
        ),
        (
            "d = \"1 m + 2 deg\"",
            "6:6 a length and an angle cannot be added",
        ),
        ("d = \"2 * (1 m\"", "6:10 this parenthesis is not closed"),
        ("d = \"1 m)\"", "6:9 this `)` has no opening parenthesis"),
        (
            "d = \"1 + \"",
            "6:8 the expression ends where a value is expected",
        ),
        ("d = \"* 2\"", "6:6 expected a value, found `*`"),
        (
            "d = \"1 m 2\"",
            "6:10 expected an operator or the end, found `2`",
        ),
        (
            "d = \"2 mmm\"",
            "6:8 expected an operator or the end, found `mmm`; did you mean `mm`?",
        ),
        ("d = \"1 m/(3 - 3)\"", "6:10 division by zero"),
        ("d = \"sqrt(-1)\"", "6:6 square root of a negative number"),
        ("d = \"sqrt(2 m)\"", "6:6 a length (m) has no square root"),
        (
            "d = \"sin(1 m)\"",
            "6:6 `sin` takes an angle (rad), found a length (1 m)",
        ),
        (
            "d = \"tan(90 deg)\"",
            "6:6 the tangent of a right angle is infinite",
        ),
        (
            "d = \"sine(1)\"",
            "6:6 unknown function `sine`; did you mean `sin`?",
        ),
        (
            "d = \"atan2(1)\"",
            "6:6 `atan2` takes 2 argument(s), found 1",
        ),
        ("d = \"1e400 m\"", "6:6 this is not a number in range"),
        ("d = \"1e200 * 1e200\"", "6:6 the value is too large"),
        (
            "d = 1e31",
            "6:5 the value is too large; in SI units numbers go from 1e-50 to 1e30",
        ),
        (
            "d = \"-1e-51 m\"",
            "6:5 the value is too small; in SI units numbers go from 1e-50 to 1e30",
        ),
        ("d = inf", "6:5 this number is out of range"),
        (
            "d = \"2^0.5\"",
            "6:6 the exponent must be an integer between -64 and 64",
        ),
        (
            "gamma = \"90°\"",
            "6:12 unexpected character `°` in an expression; write degrees as `deg`",
        ),
        // The location inside a string with escapes is unknown.
        (
            "d = \"\\u0031 +\"",
            "6:5 the expression ends where a value is expected",
        ),
    ];
    for (keys, expected) in cases {
        let found = joint(keys);
        assert!(found.starts_with(expected), "{found}");
    }
    let deep = format!("d = \"{}1{}\"", "(".repeat(100), ")".repeat(100));
    assert!(joint(&deep).contains("nested too deeply"));
}

#[test]
fn wrong_types_and_dimensions_are_rejected() {
    let cases = [
        (
            "d = true",
            "6:5 `d`: expected a number or an expression, found a boolean",
        ),
        (
            "gamma = \"2 m\"",
            "6:9 `gamma`: expected an angle (rad), found a length (2 m)",
        ),
        (
            "d = \"2 kg m/s\"",
            "6:5 `d`: expected a length (m), found a quantity in m kg s^-1 (2 m kg s^-1)",
        ),
        (
            "d = \"1 m/s\"",
            "6:5 `d`: expected a length (m), found a speed (1 m/s)",
        ),
        (
            "actuated = \"yes\"",
            "6:12 `actuated`: expected true or false, found a string",
        ),
    ];
    for (keys, expected) in cases {
        // The helper's own `actuated` conflicts with the last case.
        let text = single("", keys);
        let text = if keys.starts_with("actuated") {
            text.replacen("actuated = true\n", "\n", 1)
        } else {
            text
        };
        assert_eq!(listed(&text).first().map(String::as_str), Some(expected));
    }
    assert_eq!(
        root("gravity = [1, 2]"),
        ["2:11 `gravity`: expected a list of 3 values, found 2"]
    );
    assert_eq!(
        root("summary = 1"),
        ["2:11 `summary`: expected a string, found an integer"]
    );
}

#[test]
fn invalid_joint_positions_are_rejected() {
    let cases = [
        (
            "theta = \"2*q\"",
            "6:9 the position of a joint with its own variable is `q` plus a constant",
        ),
        (
            "theta = \"0.5\"",
            "6:9 the position of this joint is a constant; add the joint variable `q`",
        ),
        (
            "theta = \"sin(q)\"",
            "6:10 the argument of a function cannot hold a joint variable",
        ),
        (
            "theta = \"q * pi\"",
            "6:10 the factor of a joint variable must be a fraction",
        ),
        (
            "theta = \"1 / q\"",
            "6:14 a divisor cannot hold a joint variable",
        ),
        (
            "r = \"q\"",
            "6:5 `r` is constant and cannot hold a joint variable",
        ),
        (
            "theta = \"q2\"",
            "6:10 unknown name `q2`; did you mean `q1`?",
        ),
    ];
    for (keys, expected) in cases {
        let found = joint(keys);
        assert!(found.starts_with(expected), "{found}");
    }
    let slide = single("", "theta = \"q\"").replace("revolute", "prismatic");
    let found = listed(&slide).concat();
    assert!(
        found.starts_with("6:9 `theta` is constant and cannot hold a joint variable"),
        "{found}"
    );
}

#[test]
fn invalid_joint_couplings_are_rejected() {
    assert_eq!(
        joint("name = \"a b\"").split(';').next(),
        Some("6:8 `a b` cannot be the name of a joint")
    );
    assert_eq!(
        joint("antecedent = \"hip\""),
        "6:14 there is no joint `hip` in this leg; known: 1, base"
    );
    let text = |first: &str, second: &str| {
        format!(
            "name = \"A\"\n[[leg.a.joint]]\ntype = \"revolute\"\nactuated = true\n[[leg.a.joint]]\n\
             type = \"revolute\"\n{first}\n[[leg.a.joint]]\ntype = \"revolute\"\n{second}\n\
             [[place]]\nname = \"a\"\nshape = \"a\"\n"
        )
    };
    let cycle = listed(&text("antecedent = \"3\"", "antecedent = \"2\""));
    assert_eq!(
        cycle,
        ["7:14 the antecedents form a cycle; every chain of antecedents must lead to \"base\""]
    );
    let late = listed(&text("antecedent = \"3\"", "antecedent = \"1\""));
    assert_eq!(
        late,
        ["7:14 the antecedent comes after the joint; write the joints from the base on"]
    );
    let follow = listed(&text("theta = \"q3\"", "theta = \"-q2\""));
    let message = "the joints are coupled in a cycle; an independent joint has `q` instead of the others' variables";
    assert_eq!(
        follow,
        [format!("7:9 {message}"), format!("10:9 {message}")]
    );
    let twice = listed(&text("name = \"3\"", ""));
    assert_eq!(twice.len(), 1);
    assert!(
        twice[0].starts_with("8:1 there are two joints `3` in this leg"),
        "{}",
        twice[0]
    );
    let driven = listed(&text("theta = \"-q1\"\nactuated = true", ""));
    assert!(
        driven
            .concat()
            .starts_with("7:9 a coupled joint cannot be actuated")
    );
}

#[test]
fn unknown_body_parameters_are_rejected() {
    let found = joint("parameters = [\"mass\", \"zz\"]");
    assert!(
        found.starts_with("6:15 unknown parameter `mass`; known: xx, xy"),
        "{found}"
    );
    let fixed = single("", "")
        .replace("revolute", "fixed")
        .replace("actuated = true", "parameters = [\"fv\"]");
    assert!(
        listed(&fixed)[0].starts_with("5:15 a fixed joint has no parameter `fv`"),
        "{:?}",
        listed(&fixed)
    );
}
