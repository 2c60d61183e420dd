//! Reproduces the published identification of the EMPS benchmark to every printed digit.

mod common;

use common::EMPS;
use overact_identification::{
    Dataset, Gain, Identification, Log, Mapping, ModelKind, Normalisation, Settings, Stage, Time,
    identify,
};
use overact_logs::read;

/// Reads one of the benchmark's files.
fn log(file: &str) -> Option<Log> {
    let path = common::shared(&format!("data/emps/{file}"))?;
    let mapping = Mapping {
        time: Time::Column(String::from("t")),
        positions: vec![String::from("qm")],
        torques: vec![String::from("vir")],
        velocities: Vec::new(),
        position_scale: vec![1.0],
        position_offset: Vec::new(),
        torque_gain: vec![Gain::Variable(String::from("gtau"))],
        resample: None,
        transmission: Vec::new(),
        rotating: Vec::new(),
    };
    Some(read(&path, &mapping, false).unwrap_or_else(|error| panic!("{error}")))
}

/// Settings of the published procedure.
fn settings() -> Settings {
    use overact::Model;
    let mut settings = Settings::for_bandwidth(10.0, 1000.0, &EMPS.info());
    // The usual rules give the authors' filters for a bandwidth of 10 Hz.
    assert_eq!(
        (settings.filter_order, settings.filter_cutoff_hz),
        (4, 100.0)
    );
    assert_eq!(settings.decimation, 10);
    settings.difference_order = 2;
    settings.skip_start = 49;
    settings.normalisation = Normalisation::SampleVariance;
    settings
}

/// Identifies the benchmark's run and cross-validates on its pulses.
fn identified(settings: &Settings) -> Option<Identification> {
    let runs = [log("DATA_EMPS.mat")?];
    let validation = [log("DATA_EMPS_PULSES.mat")?];
    let dataset = Dataset {
        runs: &runs,
        validation: &validation,
        true_values: None,
        variants: &[],
        scales: None,
    };
    Some(identify(&EMPS, &dataset, settings, &|_| {}).unwrap_or_else(|error| panic!("{error}")))
}

/// Fails unless `value`, printed with four decimals, is `expected`.
fn printed(value: f64, expected: &str) {
    assert_eq!(format!("{value:.4}"), expected);
}

#[test]
fn symmetric_friction_gives_the_published_table() {
    for weighted in [false, true] {
        let Some(result) = identified(&Settings {
            weighted,
            ..settings()
        }) else {
            return;
        };
        println!("{:#?} {:#?}", result.checks, result.errors_in_regressor);
        let base = &result.estimates[0];
        assert_eq!((base.model, base.stage), (ModelKind::Joints, Stage::Base));
        let expected = [
            ("m_1R", "95.1089", "0.1141"),
            ("fv_1", "203.5034", "0.5631"),
            ("fs_1", "20.3935", "0.4964"),
            ("off_1", "-3.1648", "1.4021"),
        ];
        assert_eq!(base.parameters.len(), expected.len());
        for (parameter, (name, value, deviation)) in base.parameters.iter().zip(expected) {
            assert_eq!(parameter.name, name);
            printed(parameter.value, value);
            printed(parameter.relative_standard_deviation_percent, deviation);
        }
        printed(base.relative_error_percent, "4.0834");
        printed(base.condition_number, "25.9883");
        printed(base.residual_norm, "108.7569");
        if !weighted {
            printed(base.residual_deviation, "2.1843");
        }
        let pulses = &result.cross_validation[0];
        printed(pulses.residual_norm, "169.4876");
        printed(pulses.relative_error_percent, "5.9824");
        // One motor: the torque is the line.
        assert!((pulses.torques[0].residual_norm - pulses.residual_norm).abs() < 1e-9);
        // The period is found in the run, and encoder errors are harmless.
        let output = &result.errors_in_regressor[0];
        assert_eq!(output.runs[0].period_s, 6.24);
        assert!(output.parameters.iter().all(|parameter| !parameter.spoiled));
        // Friction depends on the direction, as the asymmetric model shows.
        let known = |warning: &String| {
            warning.contains("cancelled") || warning.contains("friction that differs by direction")
        };
        assert!(result.warnings.iter().all(known), "{:?}", result.warnings);
    }
}

#[test]
fn the_unbiased_deviation_divides_by_the_degrees_of_freedom() {
    let unbiased = Settings {
        weighted: false,
        normalisation: Normalisation::Unbiased,
        ..settings()
    };
    let Some(result) = identified(&unbiased) else {
        return;
    };
    printed(result.estimates[0].residual_deviation, "2.1857");
}

#[test]
fn asymmetric_friction_gives_the_published_table() {
    let asymmetric = Settings {
        weighted: false,
        asymmetric_friction: true,
        ..settings()
    };
    let Some(result) = identified(&asymmetric) else {
        return;
    };
    println!("{:#?}", result.estimates);
    let base = &result.estimates[0];
    let value = |name: &str| {
        base.parameters
            .iter()
            .find(|parameter| parameter.name == name)
            .expect("a name")
            .value
    };
    assert_eq!(base.parameters.len(), 5);
    printed(value("m_1R"), "95.1540");
    printed(value("fv_pos_1"), "166.7061");
    printed(value("fs_pos_1"), "20.1440");
    printed(value("fv_neg_1"), "240.4236");
    printed(value("fs_neg_1"), "20.6277");
    printed(base.relative_error_percent, "3.1117");
}
