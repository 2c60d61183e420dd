//! Ends of a run, and standstill.

mod common;

use std::f64::consts::TAU;

use common::EMPS;
use overact::Model;
use overact_identification::{Dataset, Error, Identification, Log, Settings, identify};

/// m + ia, fv, fs, off of the drive.
const TRUTH: [f64; 4] = [90.0, 200.0, 20.0, -3.0];
const FREQUENCY: f64 = 1000.0;

/// A run with positions and forces as functions of time.
fn run(seconds: f64, of: impl Fn(f64) -> (f64, f64)) -> Log {
    let samples = (seconds * FREQUENCY) as usize;
    let (positions, torques) = (0..samples).map(|k| of(k as f64 / FREQUENCY)).unzip();
    Log::new("run", FREQUENCY, 1, positions, torques, false).expect("a run")
}

fn identified(log: &Log, settings: &Settings) -> Result<Identification, Error> {
    let dataset = Dataset {
        runs: std::slice::from_ref(log),
        validation: &[],
        true_values: None,
        variants: &[],
        scales: None,
    };
    identify(&EMPS, &dataset, settings, &|_| {})
}

/// Largest relative error of the base estimates.
fn error(log: &Log, settings: &Settings) -> f64 {
    let result = identified(log, settings).expect("an estimate");
    let found = result.estimates[0].parameters.iter().zip(TRUTH);
    let errors = found.map(|(found, truth)| ((found.value - truth) / truth).abs());
    errors.fold(0.0, f64::max)
}

fn settings() -> Settings {
    Settings {
        filter_cutoff_hz: 40.0,
        decimation: 10,
        ..Settings::for_sampling_frequency(FREQUENCY, &EMPS.info())
    }
}

fn force(v: f64, a: f64) -> f64 {
    let [m, fv, fs, off] = TRUTH;
    m * a + fv * v + fs * overact::math::sign(v) + off
}

#[test]
fn filter_transients_are_trimmed_by_default() {
    // Both ends have large accelerations, which the filter does not continue.
    let log = run(4.0, |t| {
        let (w, u) = (TAU * 0.6, TAU * 1.7);
        let x = 0.1 * (w * t + 1.0).cos() + 0.03 * (u * t).cos();
        let v = -0.1 * w * (w * t + 1.0).sin() - 0.03 * u * (u * t).sin();
        let a = -0.1 * w * w * (w * t + 1.0).cos() - 0.03 * u * u * (u * t).cos();
        (x, force(v, a))
    });
    let whole = settings();
    let trimmed = settings().trimmed(FREQUENCY);
    assert_eq!((whole.skip_start, whole.skip_end), (0, 0));
    assert_eq!(trimmed.skip_start, trimmed.skip_end);
    // Some periods of the cutoff frequency.
    assert!(
        (50..300).contains(&trimmed.skip_start),
        "{}",
        trimmed.skip_start
    );
    let (whole, trimmed) = (error(&log, &whole), error(&log, &trimmed));
    println!("largest relative error: whole {whole:.1e}, trimmed {trimmed:.1e}");
    assert!(trimmed < 2e-3 && whole > 10.0 * trimmed);
}

#[test]
fn a_velocity_dead_band_protects_coulomb_friction_at_standstill() {
    // Strokes with rests in between, in which the axis creeps by a micrometre without force.
    let log = run(12.0, |t| {
        let (stroke, at) = ((t / 2.0).floor(), t.rem_euclid(2.0));
        let way = if stroke % 2.0 == 0.0 { 0.1 } else { -0.1 };
        let start = if stroke % 2.0 == 0.0 { 0.0 } else { 0.1 };
        if at < 1.0 {
            let w = TAU;
            let x = start + way * (at - (w * at).sin() / w);
            let (v, a) = (way * (1.0 - (w * at).cos()), way * w * (w * at).sin());
            (x, force(v, a))
        } else {
            let creep = 1e-6 * (TAU * 2.0 * at).sin() * overact::math::sign(way);
            (start + way + creep, TRUTH[3])
        }
    });
    let fs = |band: f64| {
        let settings = Settings {
            velocity_dead_band: band,
            ..settings().trimmed(FREQUENCY)
        };
        identified(&log, &settings).expect("an estimate").estimates[0].parameters[2].value
    };
    let (without, with) = (fs(0.0), fs(1e-4));
    println!("Coulomb friction: without a dead band {without:.2}, with {with:.2}");
    assert!((with / TRUTH[2] - 1.0).abs() < 0.05, "{with}");
    assert!(without < 0.8 * TRUTH[2], "{without}");
}

#[test]
fn invalid_dead_bands_are_rejected() {
    for band in [-1.0, f64::NAN, f64::INFINITY] {
        let settings = Settings {
            velocity_dead_band: band,
            ..settings()
        };
        let log = run(1.0, |t| (t, 0.0));
        let text = identified(&log, &settings)
            .expect_err("an error")
            .to_string();
        assert!(text.contains("the velocity dead band is"), "{text}");
    }
}
