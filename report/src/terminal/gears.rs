//! Friction of gears as text.

use overact_identification::{DriveGearFriction, GearCoefficient, significant};

use crate::layout::table;

/// Table of the coefficients; empty if none were identified.
pub(crate) fn gears(drives: &[DriveGearFriction]) -> String {
    if drives.is_empty() {
        return String::new();
    }
    let row = |drive: &str, motion: &str, coefficient: Option<GearCoefficient>| {
        let number = |of: fn(GearCoefficient) -> f64, digits| {
            coefficient.map_or_else(|| String::from("-"), |own| significant(of(own), digits))
        };
        vec![
            drive.to_owned(),
            motion.to_owned(),
            number(|own| own.value, 3),
            number(|own| own.deviation, 2),
            number(|own| own.interval_95[0], 3),
            number(|own| own.interval_95[1], 3),
        ]
    };
    let rows = drives.iter().flat_map(|one| {
        [
            row(&one.actuator, "driving", one.driving),
            row(&one.actuator, "back-driving", one.back_driving),
        ]
    });
    let header = [
        "gear of",
        "motion",
        "coefficient",
        "deviation",
        "95 % from",
        "to",
    ];
    format!(
        "\nFriction of the gears, as a part of the transmitted torque (all torques below are those that the gears transmit)\n{}",
        table(&header, rows.collect())
    )
}

#[cfg(test)]
mod tests {
    use super::gears;
    use overact_identification::{DriveGearFriction, GearCoefficient};

    #[test]
    fn a_coefficient_that_is_not_determined_has_no_numbers() {
        let drive = DriveGearFriction {
            actuator: String::from("shoulder"),
            driving: Some(GearCoefficient {
                value: 0.0412,
                deviation: 0.00213,
                interval_95: [0.037, 0.0454],
            }),
            back_driving: None,
        };
        let text = gears(&[drive]);
        let mut lines = text.lines().filter(|line| line.contains("driving"));
        assert!(
            lines.next().is_some_and(|line| line.contains("0.0412")),
            "{text}"
        );
        let last = lines.next().unwrap_or("");
        assert!(last.contains('-') && !last.contains('0'), "{text}");
        assert_eq!(gears(&[]), "");
    }
}
