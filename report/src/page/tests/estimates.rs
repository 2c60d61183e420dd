//! Tests of estimates: regrouped sums, errors of lines, plots, reasons and calibrated parameters.

use super::{
    bare, element,
    example::{HOSTILE, identification},
    full, parsed, text,
};
use crate::{Extent, summary};
use overact_identification::{
    CalibratedParameter, Calibration, CalibrationScope, Grade, HeldParameter, Identification,
    LineError, LineNorms, ParameterKind, Stage,
};

#[test]
fn regrouped_parameters_are_shown_with_their_sum() {
    let mut identification = identification();
    let base = &mut identification.base_parameters[0];
    base.name = String::from("m_platformR");
    base.parameter = String::from("m_platform");
    base.regrouping.truncate(1);
    base.regrouping[0].parameter = String::from("ia_1");
    let text = summary(&identification, None, Extent::Whole);
    let sum = "m_platform + 0.0784 ia_1";
    assert!(text.contains(&format!("\nm_platformR = {sum}\n")), "{text}");
    let html = bare(&identification);
    let cell = format!("m_platformR<span class=\"sum\">= {sum}</span>");
    assert!(html.contains(&cell));
}

#[test]
fn friction_correlation_and_ranges_are_plotted() {
    let identification = identification();
    let html = full(&identification);
    let document = parsed(&html);
    let ids: Vec<&str> = { document.descendants() }
        .filter_map(|node| node.attribute("id"))
        .collect();
    for id in [
        "figure-first",
        "figure-friction-actuators",
        "figure-correlation-platform",
        "figure-ranges",
    ] {
        assert!(ids.contains(&id), "{id}");
    }
    let place = |id: &str| ids.iter().position(|one| *one == id);
    assert!(place("figure-first") < place("verdict"));
    assert!(place("verdict") < place("parameters") && place("parameters") < place("checks"));
    assert!(html.contains("Strongest: ") && html.contains("−0.87"));
    let dots = { document.descendants() }
        .find(|node| node.attribute("id") == Some("figure-friction-actuators"))
        .map(|figure| {
            let all = figure.descendants();
            all.filter(|node| node.tag_name().name() == "circle")
                .count()
        });
    // One residual has no velocity.
    assert_eq!(dots, Some(1));
}

#[test]
fn errors_of_each_torque_row_are_in_one_unit() {
    let identification = identification();
    let text = summary(&identification, None, Extent::Whole);
    let row = |name: &str| {
        let mut lines = text.lines();
        let line = lines.find(|line| line.starts_with(name));
        let words = line.map(|line| line.split_whitespace().map(str::to_owned));
        words.into_iter().flatten().collect::<Vec<String>>()
    };
    let line = row("x (platform)");
    assert_eq!(
        line[..6],
        ["x", "(platform)", "N", "0.0316", "2.5", "97.50"],
        "{text}"
    );
    let torque = row("leg1 (torque)");
    assert_eq!(torque[7..], ["0.1", "5", "95.00"], "{torque:?}");
    // The largest error of a line, since forces and moments have no common norm.
    let mut mixed = identification;
    let platform = mixed
        .estimates
        .iter_mut()
        .find(|one| one.stage == Stage::Recommended);
    let lines = &mut platform.expect("an estimate").lines;
    let norms = LineNorms {
        residual: 3.0,
        measured: 10.0,
        variation: 10.0,
    };
    lines.push(LineError::new("phi", "N m", &norms, 1000));
    let text = summary(&mixed, None, Extent::Whole);
    assert!(
        text.contains("at most 30.0000 % of each torque (training)"),
        "{text}"
    );
}

#[test]
fn a_reason_shared_by_two_models_is_printed_once() {
    let mut identification = identification();
    let check = &mut identification.checks[0];
    (check.passed, check.grade) = (false, Grade::DoNotUse);
    (check.models, check.stages) = (Vec::new(), Vec::new());
    check.words = String::from("the torques are late");
    let name = check.kind.name();
    identification.warnings.push(check.words.clone());
    let text = summary(&identification, None, Extent::Whole);
    assert_eq!(text.matches("the torques are late").count(), 1, "{text}");
    let again = text.lines().find(|line| line.contains("as reported above"));
    assert!(again.is_some_and(|line| line.contains(name)), "{text}");
}

#[test]
fn calibrated_parameters_are_shown_with_intervals() {
    let offset = CalibratedParameter {
        name: HOSTILE.to_owned(),
        unit: "rad",
        kind: ParameterKind::EncoderOffset,
        described: 0.0,
        change: 3.4907e-3,
        standard_deviation: 1.2e-7,
        interval_95: [3.4905e-3, 3.4909e-3],
        alternatives: vec![String::from("base_x_leg2")],
        index: 1,
    };
    let held = |name: &str, reason: Option<&str>| HeldParameter {
        name: name.to_owned(),
        unit: "m",
        kind: ParameterKind::BasePoint,
        described: 0.0,
        deviation_of_a_change: reason.is_none().then_some(2.3e-7),
        reason: reason.map(str::to_owned),
    };
    let html = full(&Identification {
        calibration: Some(Calibration {
            scope: CalibrationScope::Smallest,
            sensors: 4,
            coordinates: 3,
            samples: 2000,
            noise: Vec::new(),
            misfit_before: 492.73,
            misfit_after: 1.0,
            estimated: vec![offset],
            held: vec![
                held("base_x_leg1", None),
                held("base_z_leg1", Some("it has no effect")),
                held("base_z_leg2", Some("it has no effect")),
            ],
            converged: true,
            remarks: vec![String::from("angles do not determine the scale")],
            warnings: Vec::new(),
        }),
        ..identification()
    });
    let document = parsed(&html);
    let calibration = text(element(&document, "calibration"));
    for words in [
        "4 sensors measure 3 coordinates",
        "One value is changed.",
        "493",
        "0.0034907",
        "0.00349050 … 0.00349090",
        "0.2",
        "base_x_leg1 (2.3e−7 m)",
        "since it has no effect: base_z_leg1, base_z_leg2.",
        "explains the data equally well",
        "Angles do not determine the scale.",
    ] {
        assert!(calibration.contains(words), "{words} in {calibration}");
    }
    // Without calibration there is no section on it.
    assert!(!full(&identification()).contains("id=\"calibration\""));
}

#[test]
fn online_estimates_are_plotted_and_described() {
    let mut identification = identification();
    let html = full(&identification);
    let document = parsed(&html);
    let figure = { document.descendants() }
        .find(|node| node.attribute("id") == Some("figure-online"))
        .expect("a figure");
    let plots = figure
        .descendants()
        .filter(|node| node.tag_name().name() == "svg");
    assert_eq!(plots.count(), 2);
    let words = summary(&identification, None, Extent::Whole);
    assert!(words.contains("Changes detected at 7 s"), "{words}");
    // 1.96 · 0.5/t is below 5 % of 1.9 from t = 11 s on.
    let one_line = words.split_whitespace().collect::<Vec<_>>().join(" ");
    assert!(one_line.contains("m_platformR 11 s"), "{words}");
    identification.online.clear();
    let words = summary(&identification, None, Extent::Whole);
    assert!(!words.contains("Online estimation"), "{words}");
    assert!(!full(&identification).contains("figure-online"));
}
