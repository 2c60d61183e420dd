//! Faults that the numbers of the logs show without a model.

use super::*;

#[test]
fn faultless_data_raise_no_alarm() {
    let result = with(|_, _, _| {}).expect("an identification");
    assert_eq!(found(&result), []);
    assert!(trusted(&result, "platform projection") && trusted(&result, "actuator projection"));
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
    // Coarse encoders bias least squares a little, which has its own test, and cause peaks.
    let coarse = coarse.expect("an identification");
    let others = found(&coarse)
        .into_iter()
        .filter(|(kind, ..)| !matches!(kind, CheckKind::RegressorErrors | CheckKind::Outliers));
    assert_eq!(others.count(), 0);
}

#[test]
fn clipped_torques_are_detected() {
    let limit = 25.0;
    let clip = |torque: &mut f64| *torque = torque.clamp(-limit, limit);
    let result = with(|run, _, torques| {
        if run == 2 {
            torques.iter_mut().skip(1).step_by(4).for_each(clip);
        }
    });
    let result = result.expect("an identification");
    // Clipped torques also resemble another payload and cause outliers.
    let clipped = |result: &Identification| {
        let mut found = found(result);
        found.retain(|(kind, _, _)| !matches!(kind, CheckKind::PayloadLabel | CheckKind::Outliers));
        assert_eq!(
            found,
            [(CheckKind::ClippedTorque, Some("loaded 1"), Some("leg2"))]
        );
    };
    clipped(&result);
    assert!(!trusted(&result, "platform projection"));
    if !is_full() {
        return;
    }
    // The same with measurement noise.
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
fn stuck_encoders_are_detected() {
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
    // From start to end, which violates the closure.
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
fn dropped_and_repeated_samples_are_detected() {
    for &repeated in by_tier([&[false][..], &[false, true]]) {
        let result = with(|run, positions, torques| {
            if run == 0 {
                for rows in [positions, torques] {
                    // Twenty samples are missing, or ten repeat the previous one.
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
fn a_run_at_standstill_is_detected() {
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
fn missing_and_duplicate_torque_columns_are_detected() {
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

#[test]
fn a_few_influential_outliers_are_detected() {
    let result = with(|number, _, torques| {
        if number != 1 {
            return;
        }
        let samples = torques.len() / 4;
        let lost = samples / 2..samples / 2 + samples / 25;
        lost.for_each(|sample| torques[4 * sample] = 0.0);
    });
    let result = result.expect("an identification");
    let check = check(&result, CheckKind::Outliers);
    println!("{}", check.words);
    assert!(!check.passed);
    assert_eq!(check.run.as_deref(), Some(RECORDS[1].name.as_str()));
}

#[test]
fn a_run_with_too_short_a_motion_is_unusable() {
    let short = |record: &Record| {
        log(record.clone(), |positions, torques| {
            let samples = positions.len() / 4;
            positions.truncate(4 * (samples / 8));
            torques.truncate(4 * (samples / 8));
        })
    };
    let runs: Vec<Log> = RECORDS.iter().take(1).map(short).collect();
    let result = identified(&runs).expect("an identification");
    let check = check(&result, CheckKind::ShortMotion);
    println!("{}", check.words);
    assert!(!check.passed && check.grade == Grade::DoNotUse);
}

#[test]
fn overlapping_parts_of_one_log_are_detected() {
    let run = |number: usize| log(RECORDS[number].clone(), |_, _| {});
    let cut = run(1).beginning(run(1).samples() / 2).expect("a cut");
    let runs = [run(0), run(1), cut, run(2), run(3)];
    let result = identified(&runs).expect("an identification");
    let repeated = check(&result, CheckKind::RepeatedSamples);
    assert_eq!(result.grade(), Grade::DoNotUse);
    assert!(!repeated.passed && repeated.words.contains("they count twice"));
    assert!((repeated.statistic - 100.0).abs() < 1.0, "{repeated:?}");
}
