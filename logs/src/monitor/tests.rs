//! Tests of clipped and frozen torques.

use super::{DataFault, Monitor, Suspicion};
use crate::samples::Samples;
use std::cell::RefCell;
use std::f64::consts::TAU;

/// Samples per second.
const FREQUENCY: f64 = 500.0;

/// Suspicions about a run of an actuator that swings twice in three seconds.
fn suspicions(samples: usize, torque: impl Fn(f64) -> f64) -> Vec<Suspicion> {
    let time = |sample: usize| sample as f64 / FREQUENCY;
    let swing = |sample: usize| (TAU * 2.0 / 3.0 * time(sample)).sin();
    let mut monitor = Monitor::new(1, FREQUENCY);
    monitor.take(&Samples {
        positions: (0..samples).map(swing).collect(),
        torques: (0..samples).map(|sample| torque(time(sample))).collect(),
        velocities: Vec::new(),
    });
    monitor.suspicions(&["motor"], true)
}

/// A torque of amplitude 2 and an incommensurable period, so that no two samples are equal.
fn swing(time: f64) -> f64 {
    2.0 * (3.7 * time).sin()
}

#[test]
fn clipping_limits_and_clipped_time_are_reported() {
    let found = suspicions(5000, |time| swing(time).clamp(-1.5, 1.0));
    let [one] = &found[..] else {
        panic!("one suspicion, not {found:?}");
    };
    assert_eq!(one.fault, DataFault::Clipped);
    let clipped = |sample: &usize| !(-1.5..=1.0).contains(&swing(*sample as f64 / FREQUENCY));
    let part = (0..5000).filter(clipped).count() as f64 / 5000.0;
    let output = format!("clipped at -1.5 and 1 for {:.1} % of", 100.0 * part);
    assert!(one.message.contains(&output), "{output}: {}", one.message);
}

#[test]
fn a_few_equal_peaks_of_a_long_run_are_not_clipped() {
    // Twelve of fifteen thousand samples.
    let spike = |time: f64| ((time * FREQUENCY).round() as usize).is_multiple_of(1250);
    let torque = |time: f64| if spike(time) { 3.0 } else { swing(time) };
    assert_eq!(suspicions(15_000, torque), []);
}

#[test]
fn peaks_of_a_quantised_torque_are_not_clipped() {
    let found = suspicions(5000, |time| (swing(time) / 0.05).round() * 0.05);
    assert_eq!(found, []);
}

#[test]
fn the_standstill_with_most_motion_of_others_is_reported() {
    // The second actuator reverses at 0.7 s and hardly moves then.
    let others = |time: f64| (TAU * 2.0 / 3.0 * (time - 0.7)).cos();
    let held = |time: f64| match time {
        0.6..0.8 => 0.6,
        2.1..2.4 => 2.1,
        _ => time,
    };
    let row = |sample: usize| {
        let time = sample as f64 / FREQUENCY;
        [(TAU / 3.0 * held(time)).sin(), others(time)]
    };
    let mut monitor = Monitor::new(2, FREQUENCY);
    monitor.take(&Samples {
        positions: (0..2000).flat_map(row).collect(),
        torques: (0..2000)
            .flat_map(|k| [swing(k as f64), swing(k as f64 + 0.3)])
            .collect(),
        velocities: Vec::new(),
    });
    let found = monitor.suspicions(&["first", "second"], true);
    let [stuck] = &found[..] else {
        panic!("one suspicion, not {found:?}");
    };
    assert_eq!(stuck.fault, DataFault::Stuck);
    assert_eq!(stuck.actuator.as_deref(), Some("first"));
    let output = "from t = 2.100 s on for 0.300 s, while other actuators move";
    assert!(stuck.message.contains(output), "{}", stuck.message);
}

/// Suspicions about a coupled robot whose second actuator swings and whose first has these positions.
fn suspicions_of_first(position: impl Fn(f64) -> f64) -> Vec<Suspicion> {
    let row = |sample: usize| {
        let time = sample as f64 / FREQUENCY;
        [position(time), (TAU * 2.0 / 3.0 * time).cos()]
    };
    let mut monitor = Monitor::new(2, FREQUENCY);
    monitor.take(&Samples {
        positions: (0..2000).flat_map(row).collect(),
        torques: (0..2000)
            .flat_map(|k| [swing(k as f64), swing(k as f64 + 0.3)])
            .collect(),
        velocities: Vec::new(),
    });
    monitor.suspicions(&["first", "second"], true)
}

#[test]
fn constant_and_permanently_stopped_readings_are_stuck() {
    let stops = |time: f64| -(1.0 - (time.min(2.0) / 2.0)).powi(2);
    let never = |_: f64| 0.3;
    for position in [&never as &dyn Fn(f64) -> f64, &stops] {
        let found = suspicions_of_first(position);
        let is_stuck = |one: &Suspicion| {
            one.fault == DataFault::Stuck && one.actuator.as_deref() == Some("first")
        };
        assert!(found.iter().any(is_stuck), "{found:?}");
    }
}

#[test]
fn a_drive_at_rest_while_reversing_is_not_stuck() {
    // It approaches the point of reversal gently, rests for 0.2 s, and leaves it gently.
    let pause = |time: f64| match time {
        ..1.8 => -(1.8 - time).powi(2),
        1.8..2.0 => 0.0,
        _ => -(time - 2.0).powi(2),
    };
    assert_eq!(suspicions_of_first(pause), []);
}

#[test]
fn a_torque_frozen_during_motion_is_reported() {
    let frozen = |time: f64| {
        if (2.0..3.0).contains(&time) {
            swing(2.0)
        } else {
            swing(time)
        }
    };
    let quantised = |time: f64| (frozen(time) / 0.02).round() * 0.02;
    for torque in [&frozen as &dyn Fn(f64) -> f64, &quantised] {
        let found = suspicions(5000, torque);
        let [one] = &found[..] else {
            panic!("one suspicion, not {found:?}");
        };
        assert_eq!(one.fault, DataFault::FrozenTorque);
        let output = " from t = 1.99";
        assert!(
            one.message.contains(output) || one.message.contains(" from t = 2.00"),
            "{}",
            one.message
        );
    }
    let constant = suspicions(5000, |_| 1.5);
    let [one] = &constant[..] else {
        panic!("one suspicion, not {constant:?}");
    };
    assert_eq!(one.fault, DataFault::FrozenTorque);
    assert!(
        one.message.contains("stays at 1.5 throughout"),
        "{}",
        one.message
    );
}

#[test]
fn torques_held_between_samples_are_not_frozen() {
    // A log at 500 Hz of a torque that changes every 50 ms, or by large quanta.
    let held = |time: f64| swing((time * 20.0).floor() / 20.0);
    assert_eq!(suspicions(5000, held), []);
    let coarse = |time: f64| (swing(time) / 0.3).round() * 0.3;
    let found = suspicions(5000, coarse);
    assert!(
        found.iter().all(|one| one.fault != DataFault::FrozenTorque),
        "{found:?}"
    );
}

/// Suspicions about a run of two actuators whose row `repeats` is that before it.
fn with_repeated_rows(repeats: fn(usize) -> bool) -> Vec<Suspicion> {
    let mut samples = Samples::default();
    for sample in 0..3000 {
        let sample = if repeats(sample) { sample - 1 } else { sample };
        let time = sample as f64 / FREQUENCY;
        let positions = [(2.0 * time).sin(), (3.0 * time).cos()];
        samples.positions.extend(positions);
        samples.torques.extend([swing(time), swing(time + 0.1)]);
    }
    let mut monitor = Monitor::new(2, FREQUENCY);
    monitor.take(&samples);
    monitor.suspicions(&["left", "right"], true)
}

#[test]
fn repeated_rows_are_counted_and_resampling_is_suggested() {
    let found = with_repeated_rows(|sample| sample % 100 == 50);
    let lost = found.iter().find(|one| one.fault == DataFault::Dropped);
    let message = &lost.expect("a suspicion").message;
    let expected = "30 samples repeat all numbers of the one before";
    assert!(message.contains(expected), "{message}");
    assert!(message.contains("`resample = \"500 Hz\"`"), "{message}");
    assert_eq!(with_repeated_rows(|_| false), []);
}

/// White noise with the variance 1/12, the same on every machine.
fn noise(seed: u64) -> impl FnMut() -> f64 {
    let mut state = seed;
    move || {
        state = state
            .wrapping_mul(6_364_136_223_846_793_005)
            .wrapping_add(1_442_695_040_888_963_407);
        (state >> 11) as f64 / (1_u64 << 53) as f64 - 0.5
    }
}

#[test]
fn torques_that_are_noise_around_zero_are_reported() {
    for (samples, seed) in [(500, 1), (5000, 2), (50_000, 3)] {
        let draw = RefCell::new(noise(seed));
        let found = suspicions(samples, |_| draw.borrow_mut()());
        let [one] = &found[..] else {
            panic!("one suspicion, not {found:?}");
        };
        assert_eq!(one.fault, DataFault::Zero);
        assert!(one.message.contains("noise around zero"), "{}", one.message);
    }
}

#[test]
fn torques_with_more_noise_than_signal_are_not_zero() {
    // Amplitudes of 0.3 and 0.15, and an offset, under noise with a deviation of 0.29.
    let signals: [fn(f64) -> f64; 3] = [
        |time| 0.3 * (3.7 * time).sin(),
        |time| 0.15 * (3.7 * time).sin(),
        |_| 0.1,
    ];
    for (signal, samples) in signals.into_iter().zip([5000, 50_000, 50_000]) {
        let draw = RefCell::new(noise(4));
        let found = suspicions(samples, |time| signal(time) + draw.borrow_mut()());
        assert_eq!(found, []);
    }
}
