//! Layout and names of the standard parameters χ.
//!
//! A leg body has 22 parameters: those of (2) and (5), the coefficient of its joint's spring, and
//! friction by direction, at standstill, by load and by the square of the rate: [xx xy xz yy yz zz mx my mz m ia fv fs off k
//! fv_pos fs_pos fv_neg fs_neg fst fl fq]. Platform and payload have the first ten. Inertial
//! parameters are about the origin of the body's frame, in its axes. Columns are ordered by leg,
//! joint and parameter; coefficients of elements between two points and parameters of motors come
//! last.

use super::mechanism::Mechanism;

/// Symbols of a leg body's parameters, in column order.
pub const SYMBOLS: [&str; 22] = [
    "xx", "xy", "xz", "yy", "yz", "zz", "mx", "my", "mz", "m", "ia", "fv", "fs", "off", "k",
    "fv_pos", "fs_pos", "fv_neg", "fs_neg", "fst", "fl", "fq",
];
/// Number of parameters of a leg body.
pub const BODY: usize = 22;
/// Place of quadratic friction among the parameters of a leg body or motor.
pub const QUADRATIC: usize = 21;
/// Number of inertial parameters, those of the platform and of the payload.
pub const INERTIAL: usize = 10;
/// Place of the coefficient of a joint's spring among the parameters of its body.
pub const STIFFNESS: usize = 14;

/// Total number of standard parameters; a serial robot has no platform and no payload.
#[must_use]
pub fn count(mechanism: &Mechanism) -> usize {
    motor_start(mechanism) + BODY * mechanism.motors.len()
}

/// Column of the first parameter of the first motor, which has the layout of a leg body.
#[must_use]
pub fn motor_start(mechanism: &Mechanism) -> usize {
    element_start(mechanism) + mechanism.elements.len()
}

/// Column of the coefficient of the first element between two points.
#[must_use]
pub fn element_start(mechanism: &Mechanism) -> usize {
    platform_start(mechanism)
        + if !mechanism.motion.has_platform() {
            0
        } else {
            2 * INERTIAL
        }
}

/// Column of the first parameter of a leg, both counted from 0.
#[must_use]
pub fn leg_start(mechanism: &Mechanism, leg: usize) -> usize {
    BODY * mechanism.legs[..leg]
        .iter()
        .map(|leg| leg.joints.len())
        .sum::<usize>()
}

/// Column of the first parameter of the platform; the payload's follow.
#[must_use]
pub fn platform_start(mechanism: &Mechanism) -> usize {
    leg_start(mechanism, mechanism.legs.len())
}

/// Names in column order: `zz_2_leg3`, counted from 1, then `m_platform` and `m_payload`.
#[must_use]
pub fn names(mechanism: &Mechanism) -> Vec<String> {
    let mut names = Vec::new();
    for (k, leg) in mechanism.legs.iter().enumerate() {
        for j in 0..leg.joints.len() {
            names.extend(
                SYMBOLS
                    .iter()
                    .map(|s| format!("{s}_{}_leg{}", j + 1, k + 1)),
            );
        }
    }
    if mechanism.motion.has_platform() {
        for body in ["platform", "payload"] {
            names.extend(SYMBOLS[..INERTIAL].iter().map(|s| format!("{s}_{body}")));
        }
    }
    names.extend((1..=mechanism.elements.len()).map(|index| format!("k_element{index}")));
    for index in 1..=mechanism.motors.len() {
        names.extend(SYMBOLS.iter().map(|s| format!("{s}_motor{index}")));
    }
    names
}
