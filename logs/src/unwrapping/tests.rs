use super::{Rotation, Unwrapper};
use std::f64::consts::TAU;

/// A column with these possible periods.
fn rotation(periods: &[f64]) -> Rotation {
    Rotation {
        column: 0,
        name: String::from("q"),
        periods: periods.to_vec(),
        period: None,
    }
}

/// White noise of unit range.
fn noise() -> impl FnMut() -> f64 {
    let mut state = 1_u64;
    move || {
        state = state
            .wrapping_mul(6_364_136_223_846_793_005)
            .wrapping_add(1);
        (state >> 11) as f64 / (1_u64 << 53) as f64 - 0.5
    }
}

/// Wraps an angle to a turn that starts at `low`.
fn wrapped(angle: f64, low: f64, turn: f64) -> f64 {
    (angle - low).rem_euclid(turn) + low
}

/// The period found for a signal, and its problem.
fn found(signal: &[f64], periods: &[f64]) -> Option<(f64, Option<String>)> {
    let mut watch = Unwrapper::new(vec![rotation(periods)]);
    signal.iter().for_each(|value| watch.take(&mut [*value]));
    let wrap = watch.wraps().pop()?;
    let problem = wrap.problem("run").map(|problem| problem.message);
    Some((wrap.period, problem))
}

/// Largest error of an unwrapped signal, up to a multiple of its period.
fn error(signal: &[f64], turn: f64, wanted: impl Fn(usize) -> f64) -> f64 {
    let mut own = rotation(&[turn]);
    own.period = Some(turn);
    let mut unwrapper = Unwrapper::new(vec![own]);
    let mut first = None;
    let errors = signal.iter().enumerate().map(|(sample, value)| {
        let mut row = [*value];
        unwrapper.take(&mut row);
        let offset = row[0] - wanted(sample);
        (offset - *first.get_or_insert(offset)).abs()
    });
    errors.fold(0.0, f64::max)
}

/// Ten turns in 2000 samples, with an added oscillation, in turns.
fn turns(sample: usize) -> f64 {
    let time = sample as f64 / 2000.0;
    10.0 * time + 0.3 * (40.0 * time).sin()
}

#[test]
fn wrapped_angles_are_detected_and_unwrapped_in_any_unit() {
    for (turn, low) in [
        (TAU, -0.5 * TAU),
        (TAU, 0.0),
        (360.0, -180.0),
        (1.0, 0.0),
        (4096.0, 0.0),
    ] {
        let angle = |sample| turn * turns(sample);
        let signal: Vec<f64> = (0..2000)
            .map(|sample| wrapped(angle(sample), low, turn))
            .collect();
        let found = found(&signal, &[turn, 50.0 * turn]);
        assert_eq!(found, Some((turn, None)), "{turn} from {low}");
        let error = error(&signal, turn, angle);
        assert!(error < 1e-9 * turn, "{turn} from {low}: {error}");
    }
}

#[test]
fn angles_oscillating_around_the_wrap_are_unwrapped() {
    let mut noise = noise();
    let oscillating: Vec<f64> = (0..2000)
        .map(|sample| 0.02 * (0.01 * sample as f64).sin() + 0.01 * noise() + 0.5 * TAU)
        .collect();
    let signal: Vec<f64> = oscillating
        .iter()
        .map(|angle| wrapped(*angle, -0.5 * TAU, TAU))
        .collect();
    assert_eq!(found(&signal, &[TAU]), Some((TAU, None)));
    let error = error(&signal, TAU, |sample| oscillating[sample]);
    assert!(error < 1e-9, "{error}");
}

#[test]
fn overflowing_counters_are_distinguished_by_their_period() {
    let counts = |turn: f64| -> Vec<f64> {
        let count = |sample| wrapped((turn * turns(sample)).round(), 0.0, turn);
        (0..2000).map(count).collect()
    };
    let periods = [2048.0, 4000.0, 4096.0, 8192.0];
    for turn in [4000.0, 4096.0] {
        assert_eq!(found(&counts(turn), &periods), Some((turn, None)), "{turn}");
    }
}

#[test]
fn lost_samples_and_counted_turns_are_not_unwrapped() {
    // Lost samples: a jump in a motion of less than a turn.
    let arc = |sample: usize| 2.9 * (0.01 * sample as f64).sin();
    let lost: Vec<f64> = (0..100).chain(420..2000).map(arc).collect();
    assert_eq!(found(&lost, &[TAU]), None);
    let counted: Vec<f64> = (0..2000).map(|sample| TAU * turns(sample)).collect();
    assert_eq!(found(&counted, &[TAU]), None);
    // A period that differs from the jump.
    let signal: Vec<f64> = counted
        .iter()
        .map(|angle| wrapped(*angle, 0.0, TAU))
        .collect();
    assert_eq!(found(&signal, &[1.5 * TAU, 6.6]), None);
}

#[test]
fn half_turns_between_samples_are_reported_as_ambiguous() {
    let slow = |sample: usize| TAU * 1e-4 * (sample as f64).powi(2);
    let signal = |samples: usize| -> Vec<f64> {
        (0..samples)
            .map(|sample| wrapped(slow(sample), 0.0, TAU))
            .collect()
    };
    assert_eq!(found(&signal(1500), &[TAU]), Some((TAU, None)));
    let (_, problem) = found(&signal(2600), &[TAU]).expect("a wrap");
    let problem = problem.expect("a problem");
    assert!(
        problem.starts_with("sample 2001: `q` was logged within one turn"),
        "{problem}"
    );
}
