//! Helper functions of the generated code: checks of inputs, and signs.
//!
//! They correspond to those of the runtime crate (`overact::guard`, `overact::math`), operation by
//! operation. In the texts, `rob_` and `ROB_` are placeholders of the robot's prefix. Only helpers
//! that are called are written.

use super::naming::Naming;
use super::tables::number;
use crate::model::RobotModel;

const IS_FINITE: &str = include_str!("text/is_finite.c");
const IS_WITHIN: &str = include_str!("text/is_within.c");
const UNIT_QUATERNION: &str = include_str!("text/unit_quaternion.c");
const SIGN: &str = include_str!("text/sign.c");
const SIGNED: &str = include_str!("text/signed.c");
const WRAP_ANGLE: &str = include_str!("text/wrap_angle.c");
/// Distribution of forces on cables with one internal torque, with several, and without any.
const TENSIONS: [&str; 3] = [
    concat!(
        include_str!("text/tension/tension_line.c"),
        "\n",
        include_str!("text/tension/tensions.c")
    ),
    concat!(
        include_str!("text/tension/tension.c"),
        "\n",
        include_str!("text/tension/tensions.c")
    ),
    include_str!("text/tension/tension_square.c"),
];

/// The distribution of forces on cables, with the table of the least torques; empty for functions
/// without it.
#[must_use]
pub fn tensions(model: &RobotModel, naming: &Naming) -> String {
    let mut functions = model.functions.iter();
    let Some(program) = functions.find_map(|function| {
        let program = &function.program;
        (!program.least_torques.is_empty()).then_some(program)
    }) else {
        return String::new();
    };
    let least = program.least_torques.iter().map(|&least| {
        if least.is_finite() {
            number(least)
        } else {
            "-HUGE_VAL".to_owned()
        }
    });
    let least = least.collect::<Vec<_>>().join(", ");
    let redundancy = program.entries.len() / program.least_torques.len() - 1;
    let text = match redundancy {
        0 => TENSIONS[2],
        1 => TENSIONS[0],
        _ => TENSIONS[1],
    };
    let table = naming.apply("static const double rob_least_tensions[ROB_ACTUATORS]");
    let comment =
        "/* Least torques of the actuators: minimum tensions of cables, no bound of others. */\n";
    format!(
        "{comment}{table} = {{ {least} }};\n\n{}\n",
        naming.apply(text)
    )
}

/// All helpers, each after those that it calls, with the start of a call.
const ALL: [(&str, &str); 6] = [
    ("is_finite(", IS_FINITE),
    ("is_within(", IS_WITHIN),
    ("unit_quaternion(", UNIT_QUATERNION),
    ("sign(", SIGN),
    ("signed(", SIGNED),
    ("wrap_angle(", WRAP_ANGLE),
];

/// The helpers that a code with this prefix calls.
#[must_use]
pub fn needed(prefix: &str, code: &str) -> Vec<&'static str> {
    let is_called = |name: &str| code.contains(&format!("{prefix}_{name}"));
    let is_needed = |name: &str| {
        let by_another = name == "sign(" && is_called("signed(");
        is_called(name) || by_another
    };
    let needed = ALL.iter().filter(|(name, _)| is_needed(name));
    needed.map(|(_, text)| *text).collect()
}
