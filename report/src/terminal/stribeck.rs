//! Stribeck velocities as text.

use overact_identification::{StribeckVelocity, VelocityEstimate, significant};

use crate::layout::table;

/// Table of the velocities; empty if none were identified.
pub(crate) fn stribeck(joints: &[StribeckVelocity]) -> String {
    if joints.is_empty() {
        return String::new();
    }
    let row = |joint: &StribeckVelocity| {
        let number = |of: fn(VelocityEstimate) -> f64| {
            let own = joint.estimate;
            own.map_or_else(|| String::from("-"), |own| significant(of(own), 3))
        };
        vec![
            joint.parameter.clone(),
            significant(joint.described, 3),
            number(|own| own.value),
            number(|own| own.interval_95[0]),
            number(|own| own.interval_95[1]),
            joint.unit.to_owned(),
        ]
    };
    let header = [
        "friction",
        "described",
        "velocity",
        "95 % from",
        "to",
        "unit",
    ];
    format!(
        "\nStribeck velocities, `stribeck` of joints and motors (the parameters below are those for these velocities)\n{}",
        table(&header, joints.iter().map(row).collect())
    )
}

#[cfg(test)]
mod tests {
    use super::stribeck;
    use overact_identification::{StribeckVelocity, VelocityEstimate};

    #[test]
    fn undetermined_velocities_are_printed_as_dashes() {
        let joint = |parameter: &str, estimate| StribeckVelocity {
            parameter: parameter.to_owned(),
            unit: "rad/s",
            described: 0.05,
            estimate,
        };
        let known = VelocityEstimate {
            value: 0.0412,
            interval_95: [0.037, 0.0454],
        };
        let text = stribeck(&[joint("fst_1", Some(known)), joint("fst_2", None)]);
        let line = |name: &str| text.lines().find(|line| line.contains(name)).unwrap_or("");
        assert!(line("fst_1").contains("0.0412"), "{text}");
        assert_eq!(line("fst_2").matches('-').count(), 3, "{text}");
        assert_eq!(stribeck(&[]), "");
    }
}
