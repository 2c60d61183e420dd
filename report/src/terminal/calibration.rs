//! Calibrated encoder offsets and lengths as text.

use std::fmt::Write;

use overact_identification::{Calibration, HeldParameter, significant};

use crate::layout::{WIDTH, paragraph, table};

/// Digits of a standard deviation.
const DIGITS: usize = 2;

/// Changes, unchanged parameters, and those that the data do not determine.
pub(crate) fn calibration(calibration: &Calibration) -> String {
    let mut text = format!(
        "\nCalibration from the closure of the loops ({} sensors, {} of the platform's coordinates)\n",
        calibration.sensors, calibration.coordinates
    );
    if calibration.samples > 0 {
        let _ = writeln!(
            text,
            "{} samples; the closure residual is {} times the sensors' noise as described, {} as calibrated",
            calibration.samples,
            significant(calibration.misfit_before, 3),
            significant(calibration.misfit_after, 3)
        );
    }
    text.push_str(&changes(calibration));
    text.push_str(&held(&calibration.held));
    for remark in &calibration.remarks {
        paragraph(&mut text, "- ", remark);
    }
    text
}

/// Table of the changes.
fn changes(calibration: &Calibration) -> String {
    if calibration.estimated.is_empty() {
        return String::from("no value is changed\n");
    }
    let rows = calibration.estimated.iter().map(|one| {
        let [low, high] = one.interval_95;
        vec![
            one.name.clone(),
            significant(one.described, 6),
            format!("{:+.4e}", one.change),
            format!("{:.1e}", one.standard_deviation),
            format!("{low:+.4e} … {high:+.4e}"),
            one.unit.to_owned(),
        ]
    });
    let header = [
        "parameter",
        "described",
        "change",
        "deviation",
        "95 % interval",
        "unit",
    ];
    table(&header, rows.collect())
}

/// Unchanged parameters: their detection limits, and those that the data do not determine.
fn held(held: &[HeldParameter]) -> String {
    let mut text = String::new();
    let known = held.iter().filter_map(|one| {
        let deviation = one.deviation_of_a_change?;
        let deviation = significant(deviation, DIGITS);
        Some(format!("{} ({deviation} {})", one.name, one.unit))
    });
    let known: Vec<String> = known.collect();
    if !known.is_empty() {
        text.push_str("unchanged (in brackets the standard deviation of a change):\n");
        text.push_str(&wrapped(&known));
    }
    let mut reasons: Vec<(&str, Vec<&str>)> = Vec::new();
    for one in held {
        let Some(reason) = one.reason.as_deref() else {
            continue;
        };
        match reasons.iter_mut().find(|(known, _)| *known == reason) {
            Some((_, names)) => names.push(&one.name),
            None => reasons.push((reason, vec![&one.name])),
        }
    }
    for (reason, names) in reasons {
        paragraph(&mut text, "", &format!("not determined, since {reason}:"));
        text.push_str(&wrapped(&names));
    }
    text
}

/// Comma-separated words in indented lines.
fn wrapped(words: &[impl AsRef<str>]) -> String {
    let mut text = String::new();
    let mut width = WIDTH;
    for (index, word) in words.iter().map(AsRef::as_ref).enumerate() {
        let comma = if index + 1 < words.len() { "," } else { "" };
        let length = word.chars().count() + comma.len() + 1;
        if width + length > WIDTH {
            let newline = if text.is_empty() { "" } else { "\n" };
            let _ = write!(text, "{newline} ");
            width = 1;
        }
        let _ = write!(text, " {word}{comma}");
        width += length;
    }
    text.push('\n');
    text
}

#[cfg(test)]
mod tests {
    use super::calibration;
    use overact_identification::{
        CalibratedParameter, Calibration, CalibrationScope, HeldParameter, ParameterKind,
    };

    fn held(name: &str, deviation: Option<f64>, reason: Option<&str>) -> HeldParameter {
        HeldParameter {
            name: name.to_owned(),
            unit: "m",
            kind: ParameterKind::BasePoint,
            described: 0.0,
            deviation_of_a_change: deviation,
            reason: reason.map(str::to_owned),
        }
    }

    #[test]
    fn changed_and_held_parameters_are_printed() {
        let offset = CalibratedParameter {
            name: "offset_leg2".to_owned(),
            unit: "rad",
            kind: ParameterKind::EncoderOffset,
            described: 0.0,
            change: 3.4907e-3,
            standard_deviation: 1.2e-7,
            interval_95: [3.4905e-3, 3.4909e-3],
            alternatives: Vec::new(),
            index: 1,
        };
        let reason = Some("it has no effect on the sensors");
        let text = calibration(&Calibration {
            scope: CalibrationScope::Smallest,
            sensors: 4,
            coordinates: 3,
            samples: 2000,
            noise: Vec::new(),
            misfit_before: 492.73,
            misfit_after: 1.0,
            estimated: vec![offset],
            held: vec![
                held("base_x_leg1", Some(2.3e-7), None),
                held("base_z_leg1", None, reason),
                held("base_z_leg2", None, reason),
            ],
            converged: true,
            remarks: vec!["angles do not determine the scale".to_owned()],
            warnings: Vec::new(),
        });
        for line in [
            "2000 samples; the closure residual is 493 times the sensors' noise as described, 1 as calibrated",
            "  base_x_leg1 (2.3e-7 m)",
            "not determined, since it has no effect on the sensors:",
            "  base_z_leg1, base_z_leg2",
            "- angles do not determine the scale",
        ] {
            assert!(text.lines().any(|own| own == line), "{line}\nin\n{text}");
        }
        assert!(
            text.contains("offset_leg2") && text.contains("+3.4907e-3"),
            "{text}"
        );
    }
}
