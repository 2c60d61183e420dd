//! Drive gains as text.

use overact_identification::{DriveGain, significant};

use crate::layout::table;

/// Table of the gains; empty if none were identified.
pub(crate) fn gains(gains: &[DriveGain]) -> String {
    if gains.is_empty() {
        return String::new();
    }
    let rows = gains.iter().map(|one| {
        vec![
            one.actuator.clone(),
            significant(one.factor, 5),
            significant(one.deviation, 2),
            String::from(if one.is_wrong() { "differs" } else { "" }),
        ]
    });
    let header = ["drive", "gain / described", "deviation", ""];
    format!(
        "\nGains of the drives (all torques below are multiplied by them)\n{}",
        table(&header, rows.collect())
    )
}

#[cfg(test)]
mod tests {
    use super::gains;
    use overact_identification::DriveGain;

    #[test]
    fn wrong_gains_are_marked() {
        let gain = |actuator: &str, factor| DriveGain {
            actuator: actuator.to_owned(),
            factor,
            deviation: 0.00312,
            total_least_squares: None,
        };
        let text = gains(&[gain("leg1", 1.2034), gain("leg2", 1.001)]);
        let line = |name: &str| text.lines().find(|line| line.contains(name)).unwrap_or("");
        assert!(
            line("leg1").contains("1.2034") && line("leg1").contains("0.0031"),
            "{text}"
        );
        assert!(line("leg1").contains("differs"), "{text}");
        assert!(
            line("leg2").contains("1.001") && !line("leg2").contains("not"),
            "{text}"
        );
        assert_eq!(gains(&[]), "");
    }
}
