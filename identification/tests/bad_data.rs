//! Data that can't be right are found and named, and good data raise no alarm.
//!
//! Several faults come in variants: the default tier sees one of each, the full tier all.

mod common;
#[path = "common/dualv.rs"]
mod dualv;

use std::sync::LazyLock;

use dualv::{DualV, experiment, log, records, settings};
use overact_identification::{
    Check, CheckKind, Dataset, Error, Grade, Identification, Log, identify,
};
use overact_simulation::Record;
use overact_tier::{by_tier, is_full};

/// Two unloaded and two loaded runs.
static RECORDS: LazyLock<Vec<Record>> = LazyLock::new(|| {
    let robot = DualV::new();
    let mut experiment = experiment(&robot, 1.0, 5);
    experiment.duration_s = by_tier([1.6, 4.0]);
    records(&robot, &experiment)
});

/// Identifies from the runs, with `change` made to positions and torques of each by its number.
fn with(change: impl Fn(usize, &mut Vec<f64>, &mut Vec<f64>)) -> Result<Identification, Error> {
    let runs = RECORDS.iter().enumerate().map(|(number, record)| {
        log(record.clone(), |positions, torques| {
            change(number, positions, torques)
        })
    });
    identified(&runs.collect::<Vec<_>>())
}

fn identified(runs: &[Log]) -> Result<Identification, Error> {
    let robot = DualV::new();
    let dataset = Dataset {
        runs,
        validation: &[],
        true_values: None,
        variants: &[],
    };
    identify(&robot, &dataset, &settings(&robot).trimmed(1000.0), &|_| {})
}

/// Kinds, runs and actuators of the checks that found something, whose words all stand among the
/// warnings, too.
fn found(result: &Identification) -> Vec<(CheckKind, Option<&str>, Option<&str>)> {
    let found = failed(result);
    for check in &found {
        println!("{check:?}");
        let mut warnings = result.warnings.iter();
        assert!(warnings.any(|warning| warning.contains(&check.words)));
    }
    found
        .into_iter()
        .map(|one| (one.kind, one.run.as_deref(), one.actuator.as_deref()))
        .collect()
}

/// The checks that found something.
fn failed(result: &Identification) -> Vec<&Check> {
    let checks = result.checks.iter();
    checks.filter(|check| !check.passed).collect()
}

fn trusted(result: &Identification, subject: &str) -> bool {
    let mut verdicts = result.verdicts.iter();
    verdicts
        .find(|verdict| verdict.subject == subject)
        .expect("a verdict")
        .trusted
}

#[test]
fn good_data_raise_no_alarm() {
    let result = with(|_, _, _| {}).expect("an identification");
    assert_eq!(found(&result), []);
    assert!(trusted(&result, "case 1") && trusted(&result, "case 2"));
    if !is_full() {
        return;
    }
    // Slow and coarse: a tenth of the sampling frequency, encoders of half a milliradian.
    let coarse = with(|_, positions, torques| {
        *positions = positions
            .iter()
            .map(|q| (q / 5e-4).round() * 5e-4)
            .collect();
        *torques = torques
            .iter()
            .map(|tau| (tau / 0.5).round() * 0.5)
            .collect();
    });
    // Steps of the encoders bias least squares a little, which their own test tells.
    let coarse = coarse.expect("an identification");
    let others = found(&coarse)
        .into_iter()
        .filter(|(kind, ..)| *kind != CheckKind::RegressorErrors);
    assert_eq!(others.count(), 0);
}

#[test]
fn clipped_torques_are_named() {
    let limit = 25.0;
    let clip = |torque: &mut f64| *torque = torque.clamp(-limit, limit);
    let result = with(|run, _, torques| {
        if run == 2 {
            torques.iter_mut().skip(1).step_by(4).for_each(clip);
        }
    });
    let result = result.expect("an identification");
    // Torques that are missing make the run carry something else, too.
    let clipped = |result: &Identification| {
        let mut found = found(result);
        found.retain(|(kind, _, _)| *kind != CheckKind::PayloadLabel);
        assert_eq!(
            found,
            [(CheckKind::ClippedTorque, Some("loaded 1"), Some("leg2"))]
        );
    };
    clipped(&result);
    assert!(!trusted(&result, "case 1"));
    if !is_full() {
        return;
    }
    // The same with the noise of a measurement on top.
    let result = with(|run, _, torques| {
        if run == 2 {
            torques
                .iter_mut()
                .skip(1)
                .step_by(4)
                .enumerate()
                .for_each(|(k, torque)| {
                    *torque = torque.clamp(-limit, limit) + 0.1 * (1.7 * (k * k) as f64).sin();
                });
        }
    });
    clipped(&result.expect("an identification"));
}

#[test]
fn stuck_encoders_are_named() {
    // For half a second.
    let result = with(|run, positions, _| {
        if run == 1 {
            let held = positions[4 * 1000 + 2];
            positions[4 * 1000..4 * 1500]
                .iter_mut()
                .skip(2)
                .step_by(4)
                .for_each(|q| *q = held);
        }
    });
    match result {
        Ok(result) => assert!(found(&result).contains(&(
            CheckKind::StuckEncoder,
            Some("unloaded 2"),
            Some("leg3")
        ))),
        Err(error) => assert!(error.to_string().contains("stuck"), "{error}"),
    }
    if !is_full() {
        return;
    }
    // From start to end, which the loops do not allow.
    let result = with(|run, positions, _| {
        if run == 1 {
            let held = positions[2];
            positions
                .iter_mut()
                .skip(2)
                .step_by(4)
                .for_each(|q| *q = held);
        }
    });
    match result {
        Ok(result) => assert!(found(&result).contains(&(
            CheckKind::StuckEncoder,
            Some("unloaded 2"),
            Some("leg3")
        ))),
        Err(error) => assert!(error.to_string().contains("stuck"), "{error}"),
    }
}

#[test]
fn dropped_and_repeated_samples_are_named() {
    for &repeated in by_tier([&[false][..], &[false, true]]) {
        let result = with(|run, positions, torques| {
            if run == 0 {
                for rows in [positions, torques] {
                    // Twenty samples are gone; or ten are what the one before was.
                    if repeated {
                        let held: Vec<f64> = rows[4 * 1500..4 * 1501].to_vec();
                        rows[4 * 1500..4 * 1510]
                            .chunks_exact_mut(4)
                            .for_each(|row| row.copy_from_slice(&held));
                    } else {
                        rows.drain(4 * 1500..4 * 1520);
                    }
                }
            }
        });
        let result = result.expect("an identification");
        assert_eq!(
            found(&result)[0],
            (CheckKind::DroppedSamples, Some("unloaded 1"), None),
            "{repeated}"
        );
        assert!(failed(&result)[0].words.contains("t = 1.5"));
    }
}

#[test]
fn a_run_at_standstill_is_named() {
    let result = with(|run, positions, torques| {
        if run == 1 {
            let held = positions[..4].to_vec();
            for (k, row) in positions.chunks_exact_mut(4).enumerate() {
                for (i, (q, held)) in row.iter_mut().zip(&held).enumerate() {
                    // The last digit flickers.
                    let noise = (7.3 * (k * (i + 1)) as f64).sin();
                    *q = held + if noise > 0.5 { 1e-5 } else { 0.0 };
                }
            }
            torques.fill(0.01);
        }
    });
    let result = result.expect("an identification");
    assert_eq!(
        found(&result)[0],
        (CheckKind::Standstill, Some("unloaded 2"), None)
    );
}

#[test]
fn swapped_columns_are_named() {
    // Positions: the loops tell.
    let swapped =
        with(|_, positions, _| positions.chunks_exact_mut(4).for_each(|row| row.swap(0, 2)));
    match swapped {
        Ok(result) => assert!(found(&result).contains(&(
            CheckKind::SwappedColumns,
            Some("unloaded 1"),
            Some("leg1")
        ))),
        Err(error) => assert!(
            error
                .to_string()
                .contains("the positions of `leg1` and `leg3` look swapped"),
            "{error}"
        ),
    }
    if !is_full() {
        return;
    }
    // Torques: the model tells.
    let swapped = with(|_, _, torques| torques.chunks_exact_mut(4).for_each(|row| row.swap(1, 2)));
    let result = swapped.expect("an identification");
    assert_eq!(
        found(&result)[0],
        (CheckKind::SwappedColumns, None, Some("leg2"))
    );
    assert!(
        failed(&result)[0]
            .words
            .contains("the torques of `leg2` and `leg3`")
    );
}

#[test]
fn two_mistakes_are_not_explained_by_one() {
    let both = |positions: &mut Vec<f64>| {
        for row in positions.chunks_exact_mut(4) {
            row.swap(0, 2);
            row[3] = -row[3];
        }
    };
    match with(|_, positions, _| both(positions)) {
        Ok(result) => {
            let found = found(&result);
            let explained = [CheckKind::SwappedColumns, CheckKind::WrongSign];
            assert!(!found.is_empty());
            assert!(
                !found.iter().any(|(kind, ..)| explained.contains(kind)),
                "{found:?}"
            );
        }
        Err(error) => assert!(!error.to_string().contains(" look"), "{error}"),
    }
}

#[test]
fn degrees_are_named() {
    let result = with(|_, positions, _| positions.iter_mut().for_each(|q| *q = q.to_degrees()));
    match result {
        Ok(result) => {
            assert!(found(&result).contains(&(CheckKind::Degrees, Some("unloaded 1"), None)))
        }
        Err(error) => assert!(error.to_string().contains("look like degrees"), "{error}"),
    }
}

#[test]
fn a_drive_of_the_wrong_sign_is_named() {
    let reverse =
        |values: &mut Vec<f64>| values.iter_mut().skip(3).step_by(4).for_each(|x| *x = -*x);
    let result = with(|_, _, torques| reverse(torques)).expect("an identification");
    assert_eq!(
        found(&result)[0],
        (CheckKind::WrongSign, None, Some("leg4"))
    );
    assert!(!trusted(&result, "case 1"));
    if !is_full() {
        return;
    }
    match with(|_, positions, _| reverse(positions)) {
        Ok(result) => assert!(found(&result).contains(&(
            CheckKind::WrongSign,
            Some("unloaded 1"),
            Some("leg4")
        ))),
        Err(error) => assert!(
            error
                .to_string()
                .contains("the position of `leg4` looks reversed"),
            "{error}"
        ),
    }
    // All drives: nothing but the signs of the parameters tells.
    let result = with(|_, _, torques| torques.iter_mut().for_each(|tau| *tau = -*tau));
    let result = result.expect("an identification");
    let negative = (CheckKind::NegativeParameter, None, None);
    assert!(found(&result).contains(&negative));
}

#[test]
fn a_drive_of_a_wrong_gain_is_named() {
    let result = with(|_, _, torques| torques.iter_mut().step_by(4).for_each(|tau| *tau *= 10.0));
    let result = result.expect("an identification");
    assert_eq!(
        found(&result)[0],
        (CheckKind::WrongGain, None, Some("leg1"))
    );
    assert!(failed(&result)[0].words.contains("0.1 times"));
}

#[test]
fn a_payload_run_that_is_labelled_unloaded_is_named() {
    let all = [(3, "loaded 2", false), (0, "unloaded 1", true)];
    for &(number, run, label) in by_tier([&all[..1], &all]) {
        let mut runs: Vec<Log> = RECORDS
            .iter()
            .map(|record| log(record.clone(), |_, _| {}))
            .collect();
        runs[number] = runs[number].clone().with_payload(label);
        let result = identified(&runs).expect("an identification");
        assert_eq!(
            found(&result)[0],
            (CheckKind::PayloadLabel, Some(run), None)
        );
        let is = if label {
            "without the payload"
        } else {
            "with the payload"
        };
        assert!(
            failed(&result)[0]
                .words
                .contains(&format!("looks like one {is}"))
        );
    }
    if !is_full() {
        return;
    }
    // Even if all are said to be unloaded.
    let runs: Vec<Log> = RECORDS[..3]
        .iter()
        .map(|record| log(record.clone(), |_, _| {}).with_payload(false))
        .collect();
    let result = identified(&runs).expect("an identification");
    assert_eq!(
        found(&result)[0],
        (CheckKind::PayloadLabel, Some("loaded 1"), None)
    );
}

/// The first check of a kind.
fn check(result: &Identification, kind: CheckKind) -> &Check {
    let mut checks = result.checks.iter();
    checks.find(|one| one.kind == kind).expect("the check")
}

#[test]
fn late_torques_are_named_with_their_delay() {
    // One millisecond is one sample.
    let result = with(|_, positions, torques| {
        torques.truncate(torques.len() - 4);
        positions.drain(..4);
    });
    let result = result.expect("an identification");
    let delay = check(&result, CheckKind::Delay);
    assert!(!delay.passed && delay.grade != Grade::Use, "{delay:?}");
    let told = delay.words.strip_prefix("the torques come ");
    let told = told.and_then(|text| text.split_once(" ms behind the motion"));
    let size: f64 = told.expect("a size").0.parse().expect("a number");
    assert!((size - 1.0).abs() < 0.05, "{size}");
    assert!(!trusted(&result, "case 1"));
}

#[test]
fn a_gain_ten_percent_low_is_named() {
    let result = with(|_, _, torques| torques.chunks_exact_mut(4).for_each(|row| row[2] *= 0.9));
    let result = result.expect("an identification");
    let mut gains = result.checks.iter();
    let gain = gains.find(|one| one.kind == CheckKind::WrongGain && !one.passed);
    let gain = gain.expect("a wrong gain");
    assert_eq!(gain.actuator.as_deref(), Some("leg3"));
    assert!(gain.words.contains("too small"), "{}", gain.words);
    assert_ne!(result.grade(), Grade::Use);
}

#[test]
fn an_encoder_that_is_off_misses_the_closure() {
    let off = 0.2_f64.to_radians();
    let result = with(|_, positions, _| {
        positions.chunks_exact_mut(4).for_each(|row| row[0] += off);
    });
    let result = result.expect("an identification");
    let closure = check(&result, CheckKind::Closure);
    assert_eq!(closure.grade, Grade::DoNotUse, "{closure:?}");
    assert!(closure.statistic > 10.0 * closure.threshold);
    assert_eq!(result.grade(), Grade::DoNotUse);
}

#[test]
fn torques_that_were_not_recorded_are_named() {
    let zero = with(|_, _, torques| torques.fill(0.0)).expect("an identification");
    assert_eq!(zero.grade(), Grade::DoNotUse);
    assert_eq!(found(&zero)[0].0, CheckKind::ZeroTorque);
    if !is_full() {
        return;
    }
    let twice = with(|_, _, torques| torques.chunks_exact_mut(4).for_each(|row| row[1] = row[0]));
    let twice = twice.expect("an identification");
    assert_eq!(twice.grade(), Grade::DoNotUse);
    assert_eq!(found(&twice)[0].0, CheckKind::DuplicateColumns);
}
