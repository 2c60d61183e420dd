//! Encoder offsets and lengths from the closure of redundant loops.

mod coverage;
mod runs;

use overact_identification::{Calibration, CalibrationScope, Identification, Stage};
use overact_robot::{Identifier, Robot};
use overact_tier::{by_tier, is_full};
use runs::{Encoder, Reading, faulty, robot, run, text};

fn calibrated(robot: &Robot, log: overact_identification::Log) -> Calibration {
    let found = robot.calibrate(&[log], CalibrationScope::Smallest);
    found.expect("a calibration")
}

/// Checks the names of the changes, and their errors in standard deviations.
fn check(found: &Calibration, truth: &[(&str, f64)]) {
    let names: Vec<&str> = found
        .estimated
        .iter()
        .map(|one| one.name.as_str())
        .collect();
    let wanted: Vec<&str> = truth.iter().map(|(name, _)| *name).collect();
    assert_eq!(names, wanted, "{found:?}");
    for (one, (name, change)) in found.estimated.iter().zip(truth) {
        let miss = (one.change - change) / one.standard_deviation;
        assert!(
            miss.abs() < 3.0,
            "{name}: {} is off by {miss} σ",
            one.change
        );
        assert!(one.standard_deviation < 0.01 * change.abs(), "{one:?}");
    }
    assert!((0.9..1.1).contains(&found.misfit_after), "{found:?}");
}

#[test]
fn an_encoder_offset_and_a_long_link_of_a_dualv_are_calibrated() {
    let described = robot(&text("dualv.toml"));
    let long = faulty(&described, &[("d_2_leg2", 2.8e-3)]);
    let offset = 0.2_f64.to_radians();
    let reading = Reading {
        offsets: vec![0.0, 0.0, offset],
        ..Reading::default()
    };
    let log = run(&long, &reading);
    let found = calibrated(&described, log.clone());
    check(&found, &[("offset_leg3", offset), ("d_2_leg2", 2.8e-3)]);
    assert!(found.misfit_before > 100.0);
    // Lengths out of the plane have no effect; a common factor of all lengths is not observable.
    let out_of_plane = found.held.iter().find(|one| one.name == "base_z_leg1");
    let reason = out_of_plane.and_then(|one| one.reason.as_deref());
    assert_eq!(reason, Some("it has no effect on the sensors"));
    assert!(
        found
            .remarks
            .iter()
            .any(|remark| remark.contains("the scale"))
    );
    // The calibrated description keeps the author's text and needs no further calibration.
    let right = described.calibrated(&found).expect("a description");
    let own = &right.source().text;
    assert!(own.contains("d = \"l_ab + d_2_change\"\n"), "{own}");
    assert!(own.contains("# Table 1. Legs 1, 2 and 3, 4 meet the platform at the same points."));
    let offsets = right.mapping().position_offset;
    assert_eq!(offsets[..2], [0.0, 0.0]);
    check(&calibrated(&right, log.without_offsets(&offsets)), &[]);
}

#[test]
fn a_correct_description_is_not_changed() {
    let described = robot(&text("dualv.toml"));
    let found = calibrated(&described, run(&described, &Reading::default()));
    check(&found, &[]);
    assert_eq!(found.held.len(), 40);
    let unchanged = described.calibrated_text(&found).expect("a text");
    assert_eq!(unchanged, described.source().text);
}

#[test]
fn without_redundancy_nothing_is_calibrated() {
    let described = robot(&text("five_bar.toml"));
    let found = calibrated(&described, run(&described, &Reading::default()));
    assert!(found.estimated.is_empty() && !found.is_change());
    assert!(found.held.iter().all(|one| one.reason.is_some()));
    assert!(
        found.remarks[0].starts_with("nothing can be calibrated"),
        "{found:?}"
    );
}

/// Single faults of planar, translational, spherical and spatial robots.
#[test]
fn single_faults_of_other_robots_are_located() {
    let cases: &[(&str, &str, f64)] = by_tier([
        &[("planar_4prr.toml", "offset_leg2", 2e-4)],
        &[
            ("planar_4prr.toml", "offset_leg2", 2e-4),
            ("planar_4prr.toml", "d_3_leg3", 4e-3),
            ("planar_4prr.toml", "end_x_leg1", 2e-3),
            ("delta_4.toml", "offset_leg3", 3.5e-3),
            ("delta_4.toml", "d_arm_leg2", 2e-3),
            ("delta_4.toml", "base_z_leg4", 2e-3),
            ("spherical_4rrr.toml", "offset_leg4", 3.5e-3),
            ("octopod.toml", "offset_leg5", 5e-4),
            ("octopod.toml", "base_x_leg7", 2e-3),
        ],
    ]);
    for (name, parameter, change) in cases {
        let described = robot(&text(name));
        let mut reading = Reading {
            size: [0.05, 0.15],
            encoder: Encoder::Resolution(1e-6),
            ..Reading::default()
        };
        let offset = parameter.strip_prefix("offset_leg");
        let real = match offset.and_then(|leg| leg.parse::<usize>().ok()) {
            Some(leg) => {
                reading.offsets = vec![0.0; leg];
                reading.offsets[leg - 1] = *change;
                robot(&text(name))
            }
            None => faulty(&described, &[(*parameter, *change)]),
        };
        let found = calibrated(&described, run(&real, &reading));
        let one = match found.estimated.as_slice() {
            [one] => one,
            other => panic!("{name}, {parameter}: {other:?}"),
        };
        // If the data cannot isolate the fault, it is among the indistinguishable parameters.
        if one.name == *parameter {
            let miss = (one.change - change) / one.standard_deviation;
            assert!(miss.abs() < 4.0, "{name}, {parameter}: off by {miss} σ");
        } else {
            let others = &one.alternatives;
            assert!(
                others.iter().any(|own| own == parameter),
                "{name}, {parameter}: {one:?}"
            );
        }
    }
}

/// Essential parameters of case 1: name, relative error in percent, and whether the interval
/// covers.
fn errors(result: &Identification) -> Vec<(String, f64, bool)> {
    let estimate = result
        .estimates
        .iter()
        .find(|one| one.stage == Stage::Essential);
    let parameters = estimate.expect("an estimate").parameters.iter();
    let error = |one: &overact_identification::ParameterEstimate| {
        let [low, high] = one.interval_95;
        let truth = one.true_value.expect("a virtual robot");
        let covered = (low..=high).contains(&truth);
        (one.name.clone(), 100.0 * (one.value / truth - 1.0), covered)
    };
    parameters.map(error).collect()
}

/// The nine essential parameters of the DualV with an encoder offset and a long link.
///
/// They are wrong with the description and right with its calibration.
#[test]
fn calibration_restores_the_parameters_of_a_dualv() {
    if !is_full() {
        return;
    }
    let described = robot(&text("dualv.toml"));
    for (link, offset) in [(0.0, 0.2_f64), (0.0, 1.0), (2.8e-3, 0.0), (2.8e-3, 1.0)] {
        let real = faulty(&described, &[("d_2_leg2", link)]);
        let mut experiment = real.experiment().expect("an experiment");
        for run in &mut experiment.plan_mut().runs {
            run.duration_s = Some(4.0);
        }
        let mut data = experiment.runs(&real.held_out(), &|_, _| {}).expect("runs");
        let shift = [0.0, 0.0, -offset.to_radians(), 0.0];
        for log in data.identified.iter_mut().chain(&mut data.validation) {
            *log = log.clone().without_offsets(&shift);
        }
        let identifier = Identifier::new(&described).data(&data);
        let result = identifier.calibrate(CalibrationScope::Smallest).run();
        let result = result.expect("a result");
        let calibration = result.calibration.as_ref().expect("a calibration");
        let mut truth = vec![("offset_leg3", offset.to_radians()), ("d_2_leg2", link)];
        truth.retain(|(_, change)| *change != 0.0);
        check(calibration, &truth);
        let errors = errors(&result);
        println!("{link} m, {offset} deg: {errors:?}");
        assert_eq!(errors.len(), 9, "{errors:?}");
        for (name, error, _) in &errors {
            assert!(error.abs() < 2.0, "{name}: {error} %");
        }
        // One of nine 95 % intervals may miss; without faults the same one misses in this
        // experiment.
        let covered = errors.iter().filter(|(.., covered)| *covered).count();
        assert!(covered >= 8, "{errors:?}");
    }
}

#[test]
fn encoder_offsets_of_robots_without_a_platform_are_calibrated() {
    let described = robot(&text("four_bar.toml"));
    let offset = 2e-3;
    let runs = described.experiment().expect("runs").runs(&[], &|_, _| {});
    let run = runs.expect("virtual runs").identified.remove(0);
    for scope in [
        CalibrationScope::Smallest,
        CalibrationScope::Offsets,
        CalibrationScope::All,
    ] {
        let shifted = run.clone().without_offsets(&[0.0, -offset]);
        let found = described
            .calibrate(&[shifted], scope)
            .expect("a calibration");
        let names: Vec<&str> = found
            .estimated
            .iter()
            .map(|one| one.name.as_str())
            .collect();
        assert!(names.contains(&"offset_output"), "{names:?}");
        assert!(
            names.iter().all(|name| name.starts_with("offset_")),
            "{names:?}"
        );
        let is_reported =
            |remark: &String| remark.contains("calibration of lengths requires a platform");
        assert!(found.remarks.iter().any(is_reported), "{:?}", found.remarks);
        if scope == CalibrationScope::Smallest {
            check(&found, &[("offset_output", offset)]);
        }
    }
}
