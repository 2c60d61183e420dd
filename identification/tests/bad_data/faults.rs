//! Faults that only the model shows: units, signs, columns, labels, drives and times.

use super::*;

#[test]
fn swapped_columns_are_detected() {
    // Positions: found by the closure.
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
    // Torques: found by the model.
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
fn two_faults_are_not_explained_by_one() {
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
fn positions_in_degrees_are_detected() {
    let result = with(|_, positions, _| positions.iter_mut().for_each(|q| *q = q.to_degrees()));
    match result {
        Ok(result) => {
            assert!(found(&result).contains(&(CheckKind::Degrees, Some("unloaded 1"), None)))
        }
        Err(error) => assert!(error.to_string().contains("look like degrees"), "{error}"),
    }
}

#[test]
fn a_drive_with_the_wrong_sign_is_detected() {
    let reverse =
        |values: &mut Vec<f64>| values.iter_mut().skip(3).step_by(4).for_each(|x| *x = -*x);
    let result = with(|_, _, torques| reverse(torques)).expect("an identification");
    assert_eq!(
        found(&result)[0],
        (CheckKind::WrongSign, None, Some("leg4"))
    );
    assert!(!trusted(&result, "platform projection"));
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
    // All drives: only the signs of the parameters show it.
    let result = with(|_, _, torques| torques.iter_mut().for_each(|tau| *tau = -*tau));
    let result = result.expect("an identification");
    let negative = (CheckKind::NegativeParameter, None, None);
    assert!(found(&result).contains(&negative));
}

#[test]
fn a_drive_with_a_tenfold_gain_is_detected() {
    let result = with(|_, _, torques| torques.iter_mut().step_by(4).for_each(|tau| *tau *= 10.0));
    let result = result.expect("an identification");
    assert_eq!(
        found(&result)[0],
        (CheckKind::WrongGain, None, Some("leg1"))
    );
    assert!(failed(&result)[0].words.contains("0.1 times"));
}

#[test]
fn mislabelled_payload_runs_are_detected() {
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
    // Even if all are labelled unloaded.
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

#[test]
fn delayed_torques_are_detected_with_their_delay() {
    // One millisecond is one sample.
    let result = with(|_, positions, torques| {
        torques.truncate(torques.len() - 4);
        positions.drain(..4);
    });
    let result = result.expect("an identification");
    let delay = check(&result, CheckKind::Delay);
    assert!(!delay.passed && delay.grade != Grade::Use, "{delay:?}");
    let output = delay.words.strip_prefix("the torques are ");
    let output = output.and_then(|text| text.split_once(" ms behind the motion"));
    let size: f64 = output.expect("a size").0.parse().expect("a number");
    assert!((size - 1.0).abs() < 0.05, "{size}");
    assert!(!trusted(&result, "platform projection"));
}

#[test]
fn a_gain_ten_percent_too_low_is_detected() {
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
fn an_encoder_offset_violates_the_closure() {
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
fn a_single_delayed_drive_is_detected() {
    let result = with(|_, _, torques| {
        let own: Vec<f64> = torques[1..].iter().step_by(4).copied().collect();
        let places = torques[1..].iter_mut().step_by(4).enumerate();
        places.for_each(|(sample, torque)| *torque = own[sample.saturating_sub(3)]);
    });
    let result = result.expect("an identification");
    let check = check(&result, CheckKind::Delay);
    println!("{}", check.words);
    assert!(!check.passed && check.words.contains("only the torque of"));
    assert_eq!(check.actuator.as_deref(), Some("leg2"));
}

#[test]
fn a_drifting_gain_is_detected() {
    let result = with(|_, _, torques| {
        let samples = torques.len() / 4;
        let own = torques.iter_mut().step_by(4).enumerate();
        own.for_each(|(sample, torque)| *torque *= 1.0 - 0.1 * sample as f64 / samples as f64);
    });
    let result = result.expect("an identification");
    let check = check(&result, CheckKind::MissingParameter);
    println!("{}", check.words);
    assert!(!check.passed && check.words.contains("a gain that drifts"));
    assert_eq!(check.actuator.as_deref(), Some("leg1"));
}

#[test]
fn exchanged_payload_labels_are_detected_by_a_negative_mass() {
    let exchanged =
        |(record, loaded): (&Record, bool)| log(record.clone(), |_, _| {}).with_payload(loaded);
    let runs: Vec<Log> = RECORDS
        .iter()
        .zip([true, true, false, false])
        .map(exchanged)
        .collect();
    let result = identified(&runs).expect("an identification");
    assert_eq!(result.grade(), Grade::DoNotUse);
    assert!(
        failed(&result).iter().any(
            |one| one.kind == CheckKind::PayloadLabel && one.words.contains("mass is negative")
        )
    );
}

#[test]
fn an_unmounted_payload_is_detected() {
    let runs = [(0, false), (1, true)];
    let runs = runs.map(|(number, loaded): (usize, bool)| {
        log(RECORDS[number].clone(), |_, _| {}).with_payload(loaded)
    });
    let result = identified(&runs).expect("an identification");
    assert!(
        failed(&result)
            .iter()
            .any(|one| one.kind == CheckKind::PayloadLabel
                && one.words.contains("differs from zero"))
    );
}
