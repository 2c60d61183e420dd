//! Both projections, both partitions and the payload recover the truth from synthetic data.

mod common;

use std::{cell::RefCell, collections::BTreeMap, f64::consts::PI};

use common::{Drives, PAIR};
use overact::Model;
use overact_identification::{
    ColumnSet, Dataset, Estimate, Identification, Log, ModelKind, PayloadUse, Projection, Settings,
    Stage, base_parameters, estimate_projection, identify, motion, prepare,
};

/// Values of the robot's parameters and the payload's, in column order.
const TRUTH: [f64; 10] = [0.4, 3.0, 0.8, 0.3, 0.1, 0.5, 0.2, -0.1, 5.0, 2.5];

/// Relative tolerance without noise, for rounding of decimation and least squares.
const EXACT: f64 = 1e-9;

fn settings() -> Settings {
    let mut settings = Settings::for_bandwidth(2.0, 500.0, &PAIR.info());
    settings.decimation = 5;
    settings.skip_start = 20;
    settings.skip_end = 30;
    settings
}

/// Position of the mass at a time, s; `seed` varies the trajectory.
fn trajectory(t: f64, seed: f64) -> f64 {
    (1..=4)
        .map(|k| {
            let k = f64::from(k);
            0.2 / k * (2.0 * PI * (0.3 * k + 0.07 * seed) * t + seed * k).sin()
        })
        .sum()
}

/// A run whose torques fit the filtered motion exactly, with a preload between the motors.
fn run(name: &str, seed: f64, payload: bool, asymmetry: f64) -> Log {
    let (frequency, samples) = (500.0, 4000);
    let positions: Vec<f64> = (0..samples)
        .flat_map(|k| {
            let x = trajectory(f64::from(k) / frequency, seed);
            PAIR.ratios.iter().map(move |ratio| ratio * x)
        })
        .collect();
    let idle = Log::new(
        name,
        frequency,
        2,
        positions.clone(),
        vec![0.0; positions.len()],
        payload,
    )
    .expect("a run");
    let whole = Settings {
        skip_start: 0,
        skip_end: 0,
        ..settings()
    };
    let motion = motion(&PAIR, &idle, &whole, &|_, _| {}).expect("a motion");
    let mut values = TRUTH;
    if !payload {
        values[9] = 0.0;
    }
    let torques = motion
        .twist
        .iter()
        .zip(&motion.acceleration)
        .enumerate()
        .flat_map(|(k, (v, a))| {
            let gamma = PAIR.force(&values, *v, *a) + if *v > 0.0 { asymmetry * v } else { 0.0 };
            let first = 0.3 * gamma + (k as f64 * 0.01).cos();
            [first, (first - gamma) / 2.0]
        })
        .collect();
    Log::new(name, frequency, 2, positions, torques, payload).expect("a run")
}

/// True values by name.
fn truth() -> BTreeMap<String, f64> {
    let info = PAIR.info();
    info.parameters
        .iter()
        .chain(info.payload_parameters)
        .map(|parameter| parameter.name.to_owned())
        .zip(TRUTH)
        .collect()
}

fn identified(runs: &[Log], settings: &Settings) -> Identification {
    let truth = truth();
    let validation = [run("other", 2.5, true, 0.0)];
    let dataset = Dataset {
        runs,
        validation: &validation,
        true_values: Some(&truth),
        variants: &[],
        scales: None,
    };
    identify(&PAIR, &dataset, settings, &|_| {}).unwrap_or_else(|error| panic!("{error}"))
}

/// Fails unless an estimate is the truth: m + ia1 + 4 ia2, fv1 + 4 fv2, fs1 + 2 fs2, off1 - 2 off2
/// and the payload.
fn check(estimate: &Estimate) {
    let names: Vec<&str> = estimate
        .parameters
        .iter()
        .map(|p| p.name.as_str())
        .collect();
    let expected = [
        ("m_platformR", 5.8),
        ("fv_1_leg1R", 5.0),
        ("fs_1_leg1R", 1.2),
        ("off_1_leg1R", 0.5),
        ("m_payload", 2.5),
    ];
    assert_eq!(names, expected.map(|(name, _)| name));
    for (parameter, (name, expected)) in estimate.parameters.iter().zip(expected) {
        let error = (parameter.value - expected).abs();
        assert!(error < EXACT * expected, "{name}: {error:e}");
        let known = parameter.true_value.expect("the truth is known");
        assert!((known - expected).abs() < 1e-12, "{name}: {known}");
    }
    assert!(estimate.relative_error_percent < 1e-8);
}

#[test]
fn both_projections_recover_the_parameters_and_the_payload() {
    let runs = [
        run("unloaded", 1.0, false, 0.0),
        run("loaded", 2.0, true, 0.0),
    ];
    for kept in [0, 1] {
        let result = identified(
            &runs,
            &Settings {
                kept_actuators: vec![kept],
                ..settings()
            },
        );
        println!("{:#?}", result.estimates);
        let models: Vec<(ModelKind, Stage)> = result
            .estimates
            .iter()
            .map(|estimate| (estimate.model, estimate.stage))
            .collect();
        assert_eq!(
            models,
            [
                (ModelKind::Platform, Stage::Base),
                (ModelKind::Platform, Stage::Recommended),
                (ModelKind::Platform, Stage::Essential),
                (ModelKind::Actuators, Stage::Base),
                (ModelKind::Actuators, Stage::Recommended),
                (ModelKind::Actuators, Stage::Essential)
            ]
        );
        assert_eq!(result.estimates[3].kept_actuators, [["leg1", "leg2"][kept]]);
        for estimate in &result.estimates {
            check(estimate);
        }
        let partition = result.estimates[3].partition.as_ref().expect("kept");
        assert!((partition.largest - 1.0).abs() < 1e-12);
        for cross in &result.cross_validation {
            assert!(cross.relative_error_percent < 1e-7);
            // The preload is not predicted: the torques show it.
            assert!(cross.torques[0].relative_error_percent > 1.0);
            assert!(cross.projected_torques[0].relative_error_percent < 1e-7);
        }
        assert_eq!(result.warnings, [""; 0]);
    }
}

#[test]
fn times_are_relative_to_the_start_of_the_log() {
    let log = run("run", 1.0, false, 0.0);
    let moved = motion(&PAIR, &log, &settings(), &|_, _| {}).expect("a motion");
    assert_eq!(moved.time(0), 20.0 / 500.0);
    let last = moved.samples - 1;
    assert_eq!(moved.time(last), (4000 - 30 - 1) as f64 / 500.0);
    // The number of samples makes plots show every second one.
    let settings = Settings {
        decimation: 2,
        ..settings()
    };
    let runs = [log];
    let dataset = Dataset {
        runs: &runs,
        validation: &runs,
        true_values: None,
        variants: &[],
        scales: None,
    };
    let figures = identify(&PAIR, &dataset, &settings, &|_| {})
        .expect("an identification")
        .figures;
    for shown in &figures.runs {
        assert!(shown.time.len() > 900 && shown.time[0] >= 20.0 / 500.0);
        for (t, x) in shown.time.iter().zip(&shown.pose[0]) {
            assert!((x - trajectory(*t, 1.0)).abs() < 1e-4, "{x} at {t}");
        }
        for prediction in &figures.predictions {
            for line in &prediction.lines {
                assert_eq!(line.time, shown.time);
            }
        }
    }
}

#[test]
fn regroupings_are_exact() {
    let columns = ColumnSet::new(&PAIR, true, false, 1).expect("columns");
    let base = base_parameters(&PAIR, &columns, PayloadUse::Separate, 1).expect("base");
    assert_eq!(base.columns, [8, 1, 2, 3, 9]);
    let expected: [&[(usize, f64)]; 5] = [
        &[(0, 1.0), (4, 4.0)],
        &[(5, 4.0)],
        &[(6, 2.0)],
        &[(7, -2.0)],
        &[],
    ];
    for (found, expected) in base.regroupings.iter().zip(expected) {
        assert_eq!(found.len(), expected.len());
        for (found, expected) in found.iter().zip(expected) {
            assert_eq!(found.0, expected.0);
            assert!((found.1 - expected.1).abs() < 1e-13, "{found:?}");
        }
    }
    // Another seed, another sample, the same parameters.
    let other = base_parameters(&PAIR, &columns, PayloadUse::Separate, 99).expect("base");
    assert_eq!(other.names, base.names);
    // A robot a thousand times smaller: the spread of the poses is halved until it fits.
    let small = Drives {
        reach: 1e-3,
        ..PAIR
    };
    let tiny = base_parameters(&small, &columns, PayloadUse::Separate, 1).expect("base");
    assert_eq!(tiny.names, base.names);
}

#[test]
fn loaded_runs_alone_regroup_the_payload() {
    let runs = [
        run("loaded", 1.0, true, 0.0),
        run("loaded again", 2.0, true, 0.0),
    ];
    let result = identified(&runs, &settings());
    let mass = &result.estimates[0].parameters[0];
    assert_eq!(mass.name, "m_platformR");
    assert!((mass.value - 8.3).abs() < EXACT * 8.3);
    assert!((mass.true_value.expect("known") - 8.3).abs() < 1e-12);
    assert!(result.warnings[0].contains("not identifiable without unloaded runs"));
}

#[test]
fn directional_friction_follows_the_direction_of_each_joint() {
    // Motor 2 turns backwards: its negative direction is the positive one of motor 1.
    let runs = [run("unloaded", 1.0, false, 0.7)];
    let result = identified(
        &runs,
        &Settings {
            asymmetric_friction: true,
            ..settings()
        },
    );
    let positive = &result.base_parameters[1];
    assert_eq!(positive.name, "fv_pos_1_leg1R");
    assert_eq!(positive.regrouping.len(), 1);
    assert_eq!(positive.regrouping[0].parameter, "fv_neg_1_leg2");
    // If the mass moves backwards, motor 2 moves forwards: fv_pos_2 + fv_neg_1/4, and with the
    // offsets fs_pos_2 + fs_neg_1/2.
    let expected = [5.8, 5.7, 1.25, 1.7, 0.35];
    for (parameter, expected) in result.estimates[0].parameters.iter().zip(expected) {
        let error = (parameter.value - expected).abs();
        assert!(
            error < EXACT * expected,
            "{} {}",
            parameter.name,
            parameter.value
        );
    }
    // The two Coulomb coefficients contain the true offset.
    let coulomb = &result.estimates[0].parameters[3];
    assert_eq!(coulomb.name, "fs_pos_1_leg1R");
    assert!((coulomb.true_value.expect("known") - 1.7).abs() < 1e-12);
    assert!(
        result
            .warnings
            .iter()
            .any(|w| w.contains("other: the validation run carries"))
    );
}

#[test]
fn partitions_share_one_preparation() {
    let runs = [run("unloaded", 1.0, false, 0.0)];
    let steps = RefCell::new(Vec::new());
    let projections = [0, 1].map(|kept| Projection::Actuators(vec![kept]));
    let prepared = prepare(&PAIR, &runs, &projections, &settings(), &|step| {
        steps.borrow_mut().push(format!("{step:?}"));
    })
    .expect("prepared");
    for projection in 0..2 {
        let outcome =
            estimate_projection(&prepared, projection, &settings(), None).expect("an estimate");
        assert!((outcome.base.parameters[0].value - 5.8).abs() < EXACT * 5.8);
        assert!(outcome.base.parameters[0].true_value.is_none());
    }
    let steps = steps.into_inner();
    assert!(steps.iter().any(|step| step.contains("done: 4000")));
    assert!(steps.iter().any(|step| step == "Base"));
}

#[test]
fn the_json_result_has_its_documented_keys() {
    let runs = [run("unloaded", 1.0, false, 0.0)];
    let document = serde_json::to_value(identified(&runs, &settings())).expect("JSON");
    for key in ["robot", "runs", "estimates", "cross_validation", "warnings"] {
        assert!(document.get(key).is_some(), "{key}");
    }
    let estimate = &document["estimates"][0];
    for key in [
        "model",
        "kept_actuators",
        "stage",
        "parameters",
        "relative_error_percent",
        "condition_number",
        "equations",
    ] {
        assert!(estimate.get(key).is_some(), "{key}");
    }
    assert_eq!(estimate["stage"], "base");
    for key in [
        "name",
        "value",
        "standard_deviation",
        "relative_standard_deviation_percent",
        "true_value",
    ] {
        assert!(estimate["parameters"][0].get(key).is_some(), "{key}");
    }
    assert_eq!(document["settings"]["normalisation"], "unbiased");
}
