//! Helper functions of the generated code: checks of inputs, and signs.
//!
//! They correspond to those of the runtime crate (`overact::guard`, `overact::math`), operation by
//! operation. In the texts, `rob_` and `ROB_` are placeholders of the robot's prefix. Only helpers
//! that are called are written.

const IS_FINITE: &str = include_str!("text/is_finite.c");
const IS_WITHIN: &str = include_str!("text/is_within.c");
const UNIT_QUATERNION: &str = include_str!("text/unit_quaternion.c");
const SIGN: &str = include_str!("text/sign.c");
const SIGNED: &str = include_str!("text/signed.c");
const WRAP_ANGLE: &str = include_str!("text/wrap_angle.c");
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
