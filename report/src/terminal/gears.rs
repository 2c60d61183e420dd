//! Friction of gears as text.

use overact_identification::{DriveGearFriction, GearCoefficient, significant};

use crate::layout::table;

/// Table of the coefficients; empty if none were identified.
pub(crate) fn gears(drives: &[DriveGearFriction]) -> String {
    if drives.is_empty() {
        return String::new();
    }
    let row = |drive: &DriveGearFriction| {
        let number = |of: fn(GearCoefficient) -> f64, digits| {
            let own = drive.coefficient;
            own.map_or_else(|| String::from("-"), |own| significant(of(own), digits))
        };
        vec![
            drive.actuator.clone(),
            number(|own| own.value, 3),
            number(|own| own.deviation, 2),
            number(|own| own.interval_95[0], 3),
            number(|own| own.interval_95[1], 3),
        ]
    };
    let header = ["gear of", "coefficient", "deviation", "95 % from", "to"];
    format!(
        "\nFriction of the gears, as a part of the transmitted torque (all torques below are those that the gears transmit)\n{}",
        table(&header, drives.iter().map(row).collect())
    )
}

#[cfg(test)]
mod tests {
    use super::gears;
    use overact_identification::{DriveGearFriction, GearCoefficient};

    #[test]
    fn undetermined_coefficients_are_printed_as_dashes() {
        let drive = |actuator: &str, coefficient| DriveGearFriction {
            actuator: actuator.to_owned(),
            coefficient,
        };
        let known = GearCoefficient {
            value: 0.0412,
            deviation: 0.00213,
            interval_95: [0.037, 0.0454],
        };
        let text = gears(&[drive("shoulder", Some(known)), drive("elbow", None)]);
        let line = |name: &str| text.lines().find(|line| line.contains(name)).unwrap_or("");
        assert!(line("shoulder").contains("0.0412"), "{text}");
        assert!(
            line("elbow").contains('-') && !line("elbow").contains('0'),
            "{text}"
        );
        assert_eq!(gears(&[]), "");
    }
}
