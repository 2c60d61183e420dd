//! Periodic runs with periodic errors and with random errors.

use super::{Log, PeriodicMotion, periodic_motions, periods};
use rand::{RngExt, SeedableRng};
use rand_pcg::Pcg64;

/// A run of two actuators at 1 kHz with a period in samples.
///
/// It has random errors of size `fresh` at each sample, and of size `repeated` at each phase.
fn run(period: f64, samples: usize, fresh: f64, repeated: f64) -> Log {
    let mut generator = Pcg64::seed_from_u64(4);
    let size = period.round() as usize;
    let again: Vec<f64> = (0..2 * size)
        .map(|_| repeated * generator.random_range(-1.0..1.0))
        .collect();
    let mut positions = Vec::new();
    for sample in 0..samples {
        let angle = std::f64::consts::TAU * sample as f64 / period;
        for (i, phase) in [0.0, 1.0].into_iter().enumerate() {
            let motion = (angle + phase).sin() + 0.3 * (3.0 * angle - phase).cos();
            let noise = fresh * generator.random_range(-1.0..1.0);
            positions.push(motion + noise + again[sample % size * 2 + i]);
        }
    }
    let torques = vec![0.0; positions.len()];
    Log::new("run", 1000.0, 2, positions, torques, false).expect("a run")
}

#[test]
fn the_period_and_the_error_correlation_are_estimated() {
    for [fresh, repeated, expected] in [[1e-4, 0.0, 0.0], [0.0, 1e-4, 1.0], [1e-4, 1e-4, 0.5]] {
        let log = run(1250.0, 8000, fresh, repeated);
        let found = periods(&log, None).expect("periodic");
        assert_eq!((found.samples, found.count), (1250, 6));
        let correlation = found.correlation.expect("noise");
        assert!((correlation - expected).abs() < 0.05, "{correlation}");
        assert!(found.difference < 1e-7);
        assert_eq!(periods(&log, Some(1.25)).expect("periodic"), found);
    }
}

#[test]
fn fractional_periods_are_combined_to_whole_samples() {
    let log = run(833.0 + 1.0 / 3.0, 10_000, 1e-5, 0.0);
    for period in [None, Some((2500.0 / 3.0) * 1e-3)] {
        let found = periods(&log, period).expect("periodic");
        assert_eq!((found.samples, found.count), (2500, 4));
    }
}

#[test]
fn the_instrument_is_the_mean_of_the_other_periods() {
    let log = run(500.0, 1700, 1e-3, 0.0);
    let (own, torques) = log.load().expect("in memory");
    let others = log.others(periods(&log, None).expect("periodic"));
    let (mean, same) = others.load().expect("in memory");
    assert_eq!((mean.len(), same), (own.len(), torques));
    // Phase 100 occurs four times, phase 300 three times.
    for (sample, at) in [(600, &[100, 1100, 1600][..]), (300, &[800, 1300])] {
        let expected = at.iter().map(|k| own[2 * k + 1]).sum::<f64>() / at.len() as f64;
        assert!((mean[2 * sample + 1] - expected).abs() < 1e-14);
    }
}

#[test]
fn invalid_periods_are_rejected() {
    let message = |period: f64, given: Option<f64>| {
        let log = run(period, 3000, 1e-4, 0.0);
        let error = periods(&log, given).expect_err("no period");
        error.to_string()
    };
    assert!(message(2000.0, None).contains("no period"));
    assert!(message(2000.0, Some(2.0)).contains("fewer than two periods"));
    assert!(message(1000.0, Some(0.9)).contains("does not repeat after 0.9"));
    assert!(message(1000.0, Some(f64::NAN)).contains("not possible"));
    assert!(message(1000.0, Some(0.98765)).contains("whole number of samples"));
}

#[test]
fn a_period_that_exceeds_the_memory_limit_is_rejected() {
    let samples = super::LARGEST_PERIOD / 2 + 1000;
    let numbers = vec![0.0; 2 * 2 * samples];
    let log = Log::new("run", 1000.0, 2, numbers.clone(), numbers, false).expect("a run");
    let error = periods(&log, Some(samples as f64 * 1e-3)).expect_err("too long");
    assert!(error.to_string().contains("too many"), "{error}");
}

#[test]
fn repeated_motions_are_found_within_and_between_runs() {
    let periodic = run(500.0, 1700, 1e-4, 0.0);
    let other = run(400.0, 1700, 1e-4, 0.0);
    // Less than two periods each.
    let once = run(1500.0, 1700, 1e-4, 0.0);
    let found = periodic_motions(
        &[
            periodic.clone(),
            other,
            once.clone(),
            periodic,
            once.clone(),
        ],
        None,
    );
    let output = |samples, motion| Some(PeriodicMotion { samples, motion });
    let expected = [
        output(500, 0),
        output(400, 1),
        output(1700, 2),
        output(500, 0),
        output(1700, 2),
    ];
    assert_eq!(found, expected);
    assert_eq!(periodic_motions(&[once], None), [None]);
}

#[test]
fn runs_of_one_motion_with_different_payloads_are_not_combined() {
    let empty = run(1500.0, 1700, 1e-4, 0.0);
    let (positions, torques) = empty.load().expect("in memory");
    let loaded = Log::new("loaded", 1000.0, 2, positions, torques, true).expect("a run");
    assert_eq!(periodic_motions(&[empty, loaded], None), [None, None]);
}
