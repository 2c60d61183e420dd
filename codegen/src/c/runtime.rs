//! What functions call that is no function of the robot: checks at their boundary and signs. The Rust functions
//! have them from the runtime crate (`overact::guard`, `overact::math`), of which these are the counterparts,
//! operation by operation.
//!
//! In the texts `rob_` and `ROB_` stand for the robot's prefix. Each is written where it is called.

const IS_FINITE: &str = include_str!("text/is_finite.c");
const IS_WITHIN: &str = include_str!("text/is_within.c");
const UNIT_QUATERNION: &str = include_str!("text/unit_quaternion.c");
const SIGN: &str = include_str!("text/sign.c");
const SIGNED: &str = include_str!("text/signed.c");
const WRAP_ANGLE: &str = include_str!("text/wrap_angle.c");
/// All, each behind those that it calls, with the name that it is called by.
const ALL: [(&str, &str); 6] = [
    ("is_finite(", IS_FINITE),
    ("is_within(", IS_WITHIN),
    ("unit_quaternion(", UNIT_QUATERNION),
    ("sign(", SIGN),
    ("signed(", SIGNED),
    ("wrap_angle(", WRAP_ANGLE),
];

/// Those that a code calls, whose names begin with a prefix.
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
