//! Motor-side parameters as text.

use overact_identification::{MotorParameter, significant};

use crate::layout::table;

/// Table of the parameters; empty if no motors are described.
pub(crate) fn motors(motors: &[MotorParameter]) -> String {
    if motors.is_empty() {
        return String::new();
    }
    let rows = motors.iter().map(|one| {
        vec![
            one.motor.clone(),
            significant(one.ratio, 6),
            one.name.clone(),
            significant(one.value, 5),
            significant(one.deviation, 2),
            one.unit.clone(),
        ]
    });
    let header = [
        "motor",
        "ratio",
        "parameter",
        "motor side",
        "deviation",
        "unit",
    ];
    format!(
        "\nParameters of the drives, motor side\n{}",
        table(&header, rows.collect())
    )
}

#[cfg(test)]
mod tests {
    use super::motors;
    use overact_identification::MotorParameter;

    #[test]
    fn each_motor_parameter_has_a_line() {
        assert_eq!(motors(&[]), "");
        let one = |name: &str, value| MotorParameter {
            motor: String::from("m6"),
            name: name.to_owned(),
            ratio: 32.0,
            value,
            deviation: 1e-6,
            unit: String::from("N m"),
        };
        let text = motors(&[one("fs_m6", 0.0625), one("fv_m6", 1.5e-4)]);
        assert_eq!(text.lines().filter(|line| line.contains("m6")).count(), 2);
        assert!(text.contains("0.0625"), "{text}");
    }
}
