//! Legend of the names in a generated file: a table with symbols and equations of Briot, Krut,
//! Gautier 2015.
//!
//! Each kind of name is a pattern: `#` matches one or more of the robot's joints, `@` an axis (x,
//! y, z), `%` a twist coordinate (vx, wz), `$` a number. Only kinds that occur are listed, each by
//! its first name.

use super::labels::Labels;
use std::collections::BTreeSet;

/// A kind of name.
struct NamePattern {
    pattern: &'static str,
    symbol: &'static str,
    meaning: &'static str,
}

const fn kind(pattern: &'static str, symbol: &'static str, meaning: &'static str) -> NamePattern {
    NamePattern {
        pattern,
        symbol,
        meaning,
    }
}

/// All kinds of names that the derivation assigns.
const KINDS: &[NamePattern] = &[
    kind(
        "%",
        "v",
        "platform velocity from the actuators' by least squares, eq. (21)",
    ),
    kind(
        "d%",
        "v̇",
        "platform acceleration from the actuators' by least squares, eq. (24)",
    ),
    kind("c_phi", "cos φ", "cosine of the platform angle"),
    kind("s_phi", "sin φ", "sine of the platform angle"),
    kind(
        "c#",
        "cos q",
        "cosine of a joint angle; `c12`: of q₁ + q₂; `c1o`: of an angle plus its constant offset",
    ),
    kind(
        "s#",
        "sin q",
        "sine of a joint angle, named like the cosine",
    ),
    kind("q#", "q", "joint position, m or rad, eq. (7)"),
    kind(
        "p_@",
        "p",
        "vector from the platform's origin to the leg's end, base axes, m",
    ),
    kind(
        "d_@",
        "D",
        "vector from the leg's first joint to its end, in the leg's plane, m",
    ),
    kind("rho_squared", "ρ²", "D · D, m²"),
    kind("h_squared", "h²", "l₁²/ρ² - a², the square of h"),
    kind(
        "h",
        "h",
        "the elbow is at a D ± h D⊥, the solution of eq. (7)",
    ),
    kind(
        "signed_h",
        "±h",
        "h with the sign of the leg's working mode",
    ),
    kind(
        "l1_@",
        "l₁ e₁",
        "vector along the proximal link, in the leg's plane, m",
    ),
    kind(
        "l2_@",
        "l₂ e₂",
        "vector along the distal link, in the leg's plane, m",
    ),
    kind(
        "w#_squared",
        "w²",
        "radicand of the closure equation of a joint; negative if out of reach",
    ),
    kind("w#", "w", "its square root"),
    kind(
        "signed_w#",
        "±w",
        "w with the sign of the leg's working mode",
    ),
    kind(
        "middle#",
        "-(q' + q'')/2",
        "negative mean of the two possible positions of a slide",
    ),
    kind(
        "det",
        "det J_k",
        "determinant or pivot of the leg's Jacobian J_k, eq. (13), up to a constant factor",
    ),
    kind(
        "k",
        "k",
        "common factor of the leg's wrenches, up to sign: a constant divided by the determinant",
    ),
    kind("k#", "k_i", "common factor of one of the leg's wrenches"),
    kind(
        "f#_@",
        "f_i",
        "force of the wrench at the leg's end that is reciprocal to all rates except u_i, base axes: a row of J_k⁻¹, eq. (9)",
    ),
    kind("n#_@", "n_i", "moment of this wrench about the leg's end"),
    kind(
        "fk#_@",
        "f_i/k",
        "this force without the factor k, in the leg's axes",
    ),
    kind(
        "nk#_@",
        "n_i/k",
        "this moment without the factor k, in the leg's axes",
    ),
    kind(
        "rate_#",
        "u_i",
        "rate of joint i; along parallel axes the absolute rate, q̇_1 + … + q̇_i, eq. (9)",
    ),
    kind("rate_#_squared", "u_i²", "square of a joint rate"),
    kind("rate_dot_#", "u̇_i", "derivative of this rate, eq. (10)"),
    kind(
        "bias_rate_dot_#",
        "u̇_i at v̇ = 0",
        "this derivative for zero platform acceleration, eq. (10)",
    ),
    kind(
        "g#_%",
        "∂u_i/∂v",
        "row of the reduced Jacobian J_k⁻¹ J_tk, eq. (9)",
    ),
    kind(
        "gq#_%",
        "∂q̇_i/∂v",
        "the same for the rate of joint i; for an actuated joint a row of J_p^inv, eq. (20)",
    ),
    kind("qd_#", "q̇_i", "joint rate, rad/s or m/s, eq. (9)"),
    kind("qdd_#", "q̈_i", "joint acceleration, eq. (10)"),
    kind(
        "bias_qdd_#",
        "q̈_i at v̇ = 0",
        "joint acceleration for zero platform acceleration",
    ),
    kind("v_end_@", "Ṗ", "velocity of the leg's end, m/s"),
    kind("a_end_@", "P̈", "acceleration of the leg's end, m/s²"),
    kind(
        "v_arm_@",
        "ω × p",
        "velocity of the leg's end relative to the platform's origin",
    ),
    kind(
        "a_arm_@",
        "ω̇ × p + ω × (ω × p)",
        "acceleration of the leg's end relative to the platform's origin",
    ),
    kind(
        "bias_a_end_@",
        "P̈ at v̇ = 0",
        "acceleration of the leg's end for zero platform acceleration",
    ),
    kind(
        "bias_a_arm_@",
        "ω × (ω × p)",
        "centripetal acceleration of the leg's end",
    ),
    kind(
        "a_on_f#",
        "(f_i/k) · (P̈ - b)",
        "acceleration of the leg's end along a wrench, minus the bias terms b that do not depend on the pose",
    ),
    kind(
        "bias_a_on_f#",
        "(f_i/k) · (P̈ - b) at v̇ = 0",
        "the same for zero platform acceleration",
    ),
    kind("w_@", "Rᵀ ω", "platform angular velocity in its own axes"),
    kind(
        "wd_@",
        "Rᵀ ω̇",
        "platform angular acceleration in its own axes",
    ),
    kind(
        "a_@",
        "Rᵀ a",
        "acceleration of the platform's origin in its own axes",
    ),
    kind("w#_@", "ω_j", "angular velocity of body j in its own axes"),
    kind(
        "wd#_@",
        "ω̇_j",
        "angular acceleration of body j in its own axes",
    ),
    kind(
        "a#_@",
        "a_j - g",
        "acceleration of the origin of body j minus gravity, in its own axes",
    ),
    kind(
        "u#_@@",
        "U_j",
        "S(ω̇_j) + S(ω_j) S(ω_j), where S(a) b = a × b",
    ),
    kind(
        "v#_by_#_@",
        "∂V_j/∂u_i",
        "partial velocity of the origin of body j",
    ),
    kind(
        "w#_by_#_@",
        "∂Ω_j/∂u_i",
        "partial angular velocity of body j",
    ),
    kind(
        "force#_@",
        "f",
        "inertial force of a body, in its own axes (platform: base axes)",
    ),
    kind(
        "moment#_@",
        "m",
        "inertial moment of a body about its origin",
    ),
    kind(
        "tau_#",
        "τ_j",
        "torque of friction, offset and rotor inertia of a joint, eq. (5)",
    ),
    kind(
        "force_on_u#",
        "s_i",
        "generalised force of a leg on u_i; Γ¹ = Σ (∂u_i/∂v)ᵀ s_i, eq. (30)",
    ),
    kind(
        "force_on_%",
        "Dᵀ τ_p",
        "generalised force of the platform bodies, eq. (17)",
    ),
    kind(
        "bias_wd_@",
        "Rᵀ ω̇ at v̇ = 0",
        "platform angular acceleration for v̇ = 0, in its own axes",
    ),
    kind(
        "bias_a_@",
        "Rᵀ a at v̇ = 0",
        "acceleration of the platform's origin for v̇ = 0, in its own axes",
    ),
    kind(
        "bias_wd#_@",
        "ω̇_j at v̇ = 0",
        "angular acceleration of body j for zero independent accelerations",
    ),
    kind(
        "bias_a#_@",
        "a_j - g at v̇ = 0",
        "acceleration of the origin of body j for zero independent accelerations",
    ),
    kind(
        "bias_u#_@@",
        "U_j at v̇ = 0",
        "S(ω̇_j) + S(ω_j) S(ω_j) for zero independent accelerations",
    ),
    kind("s_$_$", "S", "(J_p^inv)ᵀ J_p^inv, eq. (22)"),
    kind(
        "schur_$_$",
        "S'",
        "Schur complement of S after eliminating the previous columns",
    ),
    kind("pivot_$", "d_k", "pivot of S = L diag(d) Lᵀ"),
    kind("inv_pivot_$", "1/d_k", "reciprocal pivot"),
    kind("l_$_$", "L", "entry of L"),
    kind(
        "missed_$",
        "q - q(x)",
        "measured minus computed position of an actuator, in a step of forward kinematics",
    ),
    kind(
        "c_actuator_$",
        "cos q",
        "cosine of the measured position of an actuator",
    ),
    kind(
        "s_actuator_$",
        "sin q",
        "sine of the measured position of an actuator",
    ),
    kind(
        "share_$_$",
        "J_a^-T j",
        "torque of a kept actuator that balances a unit torque of a projected one, eq. (50)",
    ),
    kind(
        "norm_$",
        "√(1 + c · Q c)",
        "norm of the internal torque with a unit torque at a projected actuator",
    ),
    kind("inv_norm_$", "1/√(1 + c · Q c)", "reciprocal of this norm"),
    kind(
        "det_ja",
        "det J_a",
        "determinant of the kept actuators' rows of J_p^inv, up to a constant factor",
    ),
    kind("%_by_a$", "J_a⁻¹", "∂v/∂q̇ of a kept actuator, eq. (36)"),
    kind(
        "g#_a$",
        "∂u_i/∂q̇_a",
        "reduced Jacobian for a kept actuator's velocity, eq. (36)",
    ),
];

/// Lines of documentation that explain the names in a robot's functions.
#[must_use]
pub fn lines(labels: &Labels, names: &BTreeSet<String>) -> Vec<String> {
    let parsed: Vec<(String, String)> = names
        .iter()
        .map(|name| {
            let positive = name.strip_prefix("minus_").unwrap_or(name);
            (labels.parsed(positive).what, positive.to_owned())
        })
        .collect();
    let mut rows = Vec::new();
    for kind in KINDS {
        let found = parsed
            .iter()
            .find(|(what, _)| fits(kind.pattern, what, labels.joints()));
        if let Some((_, name)) = found {
            rows.push(format!(
                " | `{name}` | {} | {} |",
                kind.symbol, kind.meaning
            ));
        }
    }
    if rows.is_empty() {
        return Vec::new();
    }
    let head = [
        " # Names",
        "",
        " | name | symbol | meaning |",
        " |---|---|---|",
    ];
    let tail = [
        "",
        " Compound names: `minus_a` -a; `a_b` product; `a_plus_b`, `a_minus_b` sums; `a_per_b` quotient; `inv_a` 1/a;",
        " `a_squared` a². `zz_1_leg1_on_vx` is the entry of IDM_red in the column of `zz_1_leg1` and the row of `vx`.",
        " `t1_leg1` is an unnamed intermediate value. Names of the platform have no leg, or `platform`.",
        " Parameters have the names in `PARAMETERS` and `BASE_PARAMETERS`; those of any leg end in `_leg`.",
    ];
    let head = head.iter().map(ToString::to_string);
    head.chain(rows)
        .chain(tail.iter().map(ToString::to_string))
        .collect()
}

/// Whether a name matches a pattern; `joints` are the names of the joints.
fn fits(pattern: &str, name: &str, joints: &[String]) -> bool {
    let mut letters = pattern.chars();
    let Some(first) = letters.next() else {
        return name.is_empty();
    };
    let rest = letters.as_str();
    let is_axis = |c: char| matches!(c, 'x' | 'y' | 'z');
    match first {
        '#' => joints.iter().any(|joint| {
            // `force2`, `force_elbow`.
            let is_number = joint.starts_with(|c: char| c.is_ascii_digit());
            let separator = if is_number { "" } else { "_" };
            let word = name.strip_prefix(separator).unwrap_or(name);
            let behind = word.strip_prefix(joint.as_str());
            behind.is_some_and(|left| {
                let offset = left.strip_prefix('o');
                let ends =
                    fits(rest, left, joints) || offset.is_some_and(|l| fits(rest, l, joints));
                ends || fits(pattern, left, joints)
            })
        }),
        '$' => {
            let digits = name.bytes().take_while(u8::is_ascii_digit).count();
            (1..=digits).any(|count| fits(rest, &name[count..], joints))
        }
        '@' => name
            .strip_prefix(is_axis)
            .is_some_and(|left| fits(rest, left, joints)),
        '%' => {
            let left = name
                .strip_prefix(['v', 'w'])
                .and_then(|left| left.strip_prefix(is_axis));
            left.is_some_and(|left| fits(rest, left, joints))
        }
        letter => name
            .strip_prefix(letter)
            .is_some_and(|left| fits(rest, left, joints)),
    }
}

#[cfg(test)]
mod tests {
    use super::{KINDS, fits};

    fn first(name: &str) -> Option<&'static str> {
        let joints = ["1", "2", "elbow"].map(str::to_owned);
        let kind = KINDS.iter().find(|k| fits(k.pattern, name, &joints));
        kind.map(|k| k.pattern)
    }

    #[test]
    fn names_match_their_pattern_in_the_legend() {
        assert_eq!(first("c_phi"), Some("c_phi"));
        assert_eq!(first("c12"), Some("c#"));
        assert_eq!(first("c12o"), Some("c#"));
        assert_eq!(first("s_elbow"), Some("s#"));
        assert_eq!(first("g1_vx"), Some("g#_%"));
        assert_eq!(first("g1_a2"), Some("g#_a$"));
        assert_eq!(first("wz"), Some("%"));
        assert_eq!(first("force2_x"), Some("force#_@"));
        assert_eq!(first("rate_dot_2"), Some("rate_dot_#"));
        assert_eq!(first("u2_xy"), Some("u#_@@"));
        assert_eq!(first("g1_vx_rate_dot_1"), None);
        assert_eq!(first("t12"), None);
    }

    #[test]
    fn no_legend_pattern_shadows_another() {
        for kind in KINDS {
            let name = kind.pattern.replace(['#', '$'], "1").replace('@', "x");
            let name = name.replace('%', "vx");
            assert_eq!(first(&name), Some(kind.pattern), "{name}");
        }
    }
}
