//! Equations that are left out while a joint stands still.

mod common;

use common::{EMPS, PAIR};
use overact::Model;
use overact_identification::{Dataset, Identification, Log, Settings, identify};
use std::f64::consts::PI;

const FREQUENCY: f64 = 1000.0;
const SAMPLES: usize = 20_000;

/// Velocity below which the drive of these tests sticks, m/s.
const STICKS: f64 = 0.05;

/// A drive of 95 kg with friction that needs 40 N more while it sticks.
fn log() -> Log {
    let omega = PI;
    let (positions, torques) = (0..SAMPLES)
        .map(|k| {
            let t = k as f64 / FREQUENCY;
            let velocity =
                0.1 * omega * (omega * t).cos() + 0.05 * 2.3 * omega * (2.3 * omega * t).cos();
            let acceleration = -0.1 * omega.powi(2) * (omega * t).sin()
                - 0.05 * (2.3 * omega).powi(2) * (2.3 * omega * t).sin();
            let position = 0.1 * (omega * t).sin() + 0.05 * (2.3 * omega * t).sin();
            let sticks = if velocity.abs() < STICKS { 40.0 } else { 0.0 };
            let force = 95.0 * acceleration + 200.0 * velocity + 20.0 * velocity.signum() + sticks;
            (position, force)
        })
        .unzip();
    Log::new("sticking", FREQUENCY, 1, positions, torques, false).expect("a log")
}

fn settings(limit: Vec<f64>) -> Settings {
    Settings {
        standstill_velocity: limit,
        ..Settings::for_bandwidth(10.0, FREQUENCY, &EMPS.info()).trimmed(FREQUENCY)
    }
}

fn identified(limit: Vec<f64>) -> Identification {
    let log = log();
    let dataset = Dataset {
        runs: std::slice::from_ref(&log),
        validation: &[],
        true_values: None,
        variants: &[],
    };
    identify(&EMPS, &dataset, &settings(limit), &|_| {}).expect("an identification")
}

#[test]
fn equations_at_standstill_are_left_out_and_counted() {
    let (all, moving) = (identified(Vec::new()), identified(vec![0.08]));
    assert!(all.runs[0].standstill_equations.is_empty());
    let left_out = moving.runs[0].standstill_equations[0];
    assert_eq!(
        moving.estimates[0].equations + left_out,
        all.estimates[0].equations
    );
    // The part of the time in which this motion is slower than the limit.
    let part = left_out as f64 / all.estimates[0].equations as f64;
    assert!((0.1..0.25).contains(&part), "{part}");
    let offset = |result: &Identification| {
        let mut parameters = result.estimates[0].parameters.iter();
        let own = parameters
            .find(|own| own.name == "off_1")
            .expect("an offset");
        own.value.abs()
    };
    assert!(offset(&all) > 2.0, "{}", offset(&all));
    assert!(offset(&moving) < 0.5, "{}", offset(&moving));
    let errors = [&all, &moving].map(|result| result.estimates[0].relative_error_percent);
    assert!(errors[1] < 0.3 * errors[0], "{errors:?}");
    // Zero leaves nothing out.
    let none = identified(vec![0.0]);
    assert_eq!(none.runs[0].standstill_equations, [0]);
    let pairs = none.estimates[0]
        .parameters
        .iter()
        .zip(&all.estimates[0].parameters);
    for (own, other) in pairs {
        assert!(
            (own.value / other.value - 1.0).abs() < 1e-9,
            "{own:?} {other:?}"
        );
    }
}

#[test]
fn limits_that_make_no_sense_are_refused() {
    let refused = |model: &dyn Model, limit: Vec<f64>| {
        let settings = Settings {
            kept_actuators: vec![0],
            ..settings(limit)
        };
        settings
            .check(&model.info())
            .expect_err("an error")
            .to_string()
    };
    assert_eq!(
        refused(&EMPS, vec![0.1, 0.1]),
        "there are 2 velocities of standstill for 1 actuator\n  help: give `standstill_velocity` one for each actuator, or none"
    );
    assert_eq!(refused(&EMPS, vec![-1.0]), "a velocity of standstill is -1");
    assert!(refused(&PAIR, vec![0.1; 2]).contains("of a redundant robot"));
}
