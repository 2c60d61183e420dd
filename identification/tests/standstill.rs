//! Exclusion of equations while a joint is at standstill.

mod common;

use common::{EMPS, PAIR};
use overact::Model;
use overact_identification::{CheckKind, Dataset, Identification, Log, Settings, identify};
use std::f64::consts::PI;

const FREQUENCY: f64 = 1000.0;
const SAMPLES: usize = 20_000;

/// Velocity below which the drive of these tests sticks, m/s.
const STICTION_VELOCITY: f64 = 0.05;

/// A drive of 95 kg with 40 N of additional friction while it sticks.
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
            let sticks = if velocity.abs() < STICTION_VELOCITY {
                40.0
            } else {
                0.0
            };
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
        scales: None,
    };
    identify(&EMPS, &dataset, &settings(limit), &|_| {}).expect("an identification")
}

#[test]
fn equations_at_standstill_are_skipped_and_counted() {
    let (all, moving) = (identified(Vec::new()), identified(vec![0.08]));
    assert!(all.runs[0].standstill_equations.is_empty());
    let left_out = moving.runs[0].standstill_equations[0];
    assert_eq!(
        moving.estimates[0].equations + left_out,
        all.estimates[0].equations
    );
    // Fraction of the time in which this motion is slower than the limit.
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
    // Zero excludes nothing.
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
fn standstill_limits_that_skip_most_equations_are_reported() {
    let most = identified(vec![0.5]);
    let left_out = most.runs[0].standstill_equations[0];
    let all = left_out + most.estimates[0].equations;
    assert!(2 * left_out > all, "{left_out} of {all}");
    let expected = format!("{left_out} of {all} equations are skipped at standstill");
    let output = |text: &String| text.starts_with(&expected) && text.contains("`position_scale`");
    assert!(most.warnings.iter().any(output), "{:?}", most.warnings);
    let few = identified(vec![0.08]);
    assert!(!few.warnings.iter().any(|text| text.contains("skipped at")));
    let log = log();
    let refused = |settings: Settings| {
        let dataset = Dataset {
            runs: std::slice::from_ref(&log),
            validation: &[],
            true_values: None,
            variants: &[],
            scales: None,
        };
        let result = identify(&EMPS, &dataset, &settings, &|_| {});
        result.expect_err("too little").to_string()
    };
    let text = refused(settings(vec![100.0]));
    assert!(
        text.starts_with("the data determine no parameter: `standstill_velocity` skips"),
        "{text}"
    );
    let text = refused(Settings {
        decimation: 5000,
        ..settings(Vec::new())
    });
    assert!(
        text.contains("`decimation` keeps one equation per 5000 samples"),
        "{text}"
    );
}

/// Words of a check for friction of 20 N times `friction` of the speed.
fn check_words_for(friction: impl Fn(f64) -> f64) -> String {
    let mut log = log();
    let (positions, _) = log.load().expect("numbers");
    let rate = |k: usize| FREQUENCY * (positions[k + 1] - positions[k - 1]) / 2.0;
    let bend =
        |k: usize| FREQUENCY.powi(2) * (positions[k + 1] - 2.0 * positions[k] + positions[k - 1]);
    let mut state = 1_u64;
    let torques = (0..positions.len()).map(|k| {
        let k = k.clamp(1, positions.len() - 2);
        state = state
            .wrapping_mul(6_364_136_223_846_793_005)
            .wrapping_add(1);
        let noise = (state >> 33) as f64 / f64::from(1_u32 << 31) - 0.5;
        let part = 20.0 * friction(rate(k).abs()) * rate(k).signum();
        95.0 * bend(k) + 200.0 * rate(k) + part + 2.0 * noise
    });
    let torques: Vec<f64> = torques.collect();
    log = Log::new("rubbing", FREQUENCY, 1, positions, torques, false).expect("a log");
    let dataset = Dataset {
        runs: std::slice::from_ref(&log),
        validation: &[],
        true_values: None,
        variants: &[],
        scales: None,
    };
    let settings = settings(vec![0.004]);
    let result = identify(&EMPS, &dataset, &settings, &|_| {}).expect("an identification");
    let mut checks = result.checks.iter().filter(|check| !check.passed);
    let words = checks.find(|check| check.kind == CheckKind::MissingParameter);
    words.map(|check| check.located()).unwrap_or_default()
}

#[test]
fn rising_and_falling_friction_near_standstill_is_detected() {
    let rises = check_words_for(|speed| 1.0 + (-speed / 0.07).exp());
    assert!(
        rises.starts_with("the friction in the torque of joint 1 rises towards standstill by "),
        "{rises}"
    );
    assert!(
        rises.contains(" N beyond the model, over about ") && rises.contains("`stribeck`"),
        "{rises}"
    );
    let falls = check_words_for(|speed| 1.0 - (-speed / 0.07).exp());
    assert!(
        falls.starts_with("the friction in the torque of joint 1 falls towards standstill by "),
        "{falls}"
    );
    assert!(falls.contains("That is not Stribeck's friction"), "{falls}");
    assert!(
        falls.contains("Equations below `standstill_velocity`, 0.004 m/s, are skipped"),
        "{falls}"
    );
}

#[test]
fn invalid_standstill_limits_are_rejected() {
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
