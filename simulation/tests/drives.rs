//! Effect of each non-ideal drive option on the log of a run.

mod support;

use std::f64::consts::TAU;

use nalgebra::Complex;
use overact_simulation::{Drives, Error, Experiment, Record, Run, Term, Trajectory, simulate};
use support::{Robot, mechanisms::TwoMotors};

/// Two motors that move one mass of 2 kg, 30 mm at 2 Hz, without friction.
const MASS: f64 = 2.0;
const AMPLITUDE: f64 = 0.03;
const RATE: f64 = TAU * 2.0;

fn experiment() -> Experiment {
    let term = Term {
        coordinate: "x".into(),
        harmonic: 1,
        amplitude: AMPLITUDE,
        phase_rad: 0.0,
    };
    Experiment {
        duration_s: 2.0,
        parameters: vec![0.3, 0.0, 0.0, 0.7, 0.0, 0.0, 1.0, 0.0],
        runs: vec![Run {
            name: "sine".into(),
            payload: false,
            duration_s: None,
            trajectory: Trajectory::Periodic {
                fundamental_hz: 2.0,
                terms: vec![term],
            },
        }],
        ..Experiment::default()
    }
}

fn record(change: impl FnOnce(&mut Experiment)) -> Record {
    let mut experiment = experiment();
    change(&mut experiment);
    let mut records = simulate(&Robot::new(TwoMotors), &experiment, &|_, _| ())
        .unwrap_or_else(|error| panic!("{error}"));
    records.remove(0)
}

/// Second half of the run: sample, torques, and the force of the motion.
fn settled(record: &Record) -> impl Iterator<Item = (usize, [f64; 2], f64)> {
    (record.time.len() / 2..record.time.len()).map(|k| {
        let force = -MASS * AMPLITUDE * RATE * RATE * (RATE * record.time[k]).sin();
        (k, [record.torques[2 * k], record.torques[2 * k + 1]], force)
    })
}

const FORCE: f64 = MASS * AMPLITUDE * RATE * RATE;

#[test]
fn logged_torques_exclude_the_gain_error() {
    let ideal = record(|_| ());
    assert!(settled(&ideal).all(|(_, [a, b], force)| (a + b - force).abs() < 2e-3 * FORCE));
    let record = record(|experiment| experiment.drives.gain = vec![1.25, 0.8]);
    for (_, [a, b], force) in settled(&record) {
        assert!((1.25 * a + 0.8 * b - force).abs() < 2e-3 * FORCE);
    }
    let miss = settled(&record).map(|(_, [a, b], force)| (a + b - force).abs());
    assert!(miss.fold(0.0, f64::max) > 0.01 * FORCE);
}

#[test]
fn the_controller_compensates_the_cogging() {
    let (amplitude, periods) = (0.4, 50.0);
    let record = record(|experiment| {
        experiment.drives.cogging = vec![amplitude, 0.0];
        experiment.drives.cogging_periods = vec![periods; 2];
    });
    // The torque missing from the log is the cogging: τ = m a - A sin(2πN q).
    let (mut product, mut square) = (0.0, 0.0);
    for (k, [a, b], force) in settled(&record) {
        // Only slow cogging, which the controller can follow.
        let speed = AMPLITUDE * RATE * (RATE * record.time[k]).cos().abs();
        let tooth = (TAU * periods * record.positions[2 * k]).sin();
        if speed * periods < 8.0 {
            product += (a + b - force) * tooth;
            square += tooth * tooth;
        }
    }
    let found = product / square;
    assert!((found / amplitude + 1.0).abs() < 0.15, "{found}");
}

#[test]
fn motor_encoders_measure_the_spring_deflection() {
    let stiffness = 1e5;
    let record = record(|experiment| {
        // The spring acts on the controller without delay, which would destabilise a fast one.
        experiment.bandwidth_hz = 10.0;
        experiment.derivative_cutoff_hz = 20.0;
        experiment.drives.flexible_stiffness = vec![stiffness, 0.0];
    });
    // The other encoder is at the joint. The logged torque is half a sample older.
    for (k, [torque, _], _) in settled(&record) {
        let spring = record.positions[2 * k] - record.positions[2 * k + 1];
        assert!((spring - torque / stiffness).abs() < 0.05 * FORCE / stiffness);
    }
}

#[test]
fn the_flexible_mode_acts_between_torque_and_motion() {
    let (mode, damping) = (40.0, 0.2);
    let record = record(|experiment| {
        experiment.bandwidth_hz = 5.0;
        experiment.runs[0].trajectory = Trajectory::Periodic {
            fundamental_hz: 8.0,
            terms: vec![Term {
                coordinate: "x".into(),
                harmonic: 1,
                amplitude: 0.005,
                phase_rad: 0.0,
            }],
        };
        experiment.drives.flexible_hz = vec![mode; 2];
        experiment.drives.flexible_damping = damping;
    });
    let rate = TAU * 8.0;
    // Amplitudes at 8 Hz over whole periods.
    let amplitude = |of: fn(&[f64]) -> f64, values: &[f64]| {
        let mut sum = Complex::new(0.0, 0.0);
        for (k, ..) in settled(&record) {
            let turn = Complex::from_polar(1.0, -rate * record.time[k]);
            sum += turn * of(&values[2 * k..2 * k + 2]);
        }
        sum
    };
    let torque = amplitude(|two| two[0] + two[1], &record.torques);
    let force = amplitude(|two| two[0], &record.positions) * (-MASS * rate * rate);
    // The logged torque is (1 - u² + 2jζu) times the torque on the mass.
    let u = 8.0 / mode;
    let expected = Complex::new(1.0 - u * u, 2.0 * damping * u);
    let found = torque / force;
    assert!((found - expected).norm() < 0.01, "{found} {expected}");
}

#[test]
fn encoder_and_drive_delays_degrade_tracking() {
    // Slow enough for a delay of a millisecond to be harmless.
    let record = |change: fn(&mut Experiment)| {
        record(|experiment| {
            experiment.bandwidth_hz = 20.0;
            experiment.derivative_cutoff_hz = 100.0;
            change(experiment);
        })
    };
    let plain = record(|_| ()).tracking_error[0];
    let late = record(|experiment| experiment.encoder_delay_s = 1e-3);
    let delayed = record(|experiment| experiment.drives.delay_s = 1e-3);
    let slow = record(|experiment| experiment.drives.current_bandwidth_hz = vec![150.0; 2]);
    for record in [&late, &delayed, &slow] {
        let error = record.tracking_error[0];
        assert!(error > 2.0 * plain, "{error:e} {plain:e}");
    }
    // The log has the current that moved the mass, but delayed positions.
    assert!(settled(&slow).all(|(_, [a, b], force)| (a + b - force).abs() < 0.05 * FORCE));
    let phase = |record: &Record| {
        let (mut position, mut torque) = (Complex::new(0.0, 0.0), Complex::new(0.0, 0.0));
        for (k, [a, b], _) in settled(record) {
            let turn = Complex::from_polar(1.0, -RATE * record.time[k]);
            position += turn * record.positions[2 * k];
            torque += turn * -(a + b);
        }
        (position / torque).arg()
    };
    assert!(phase(&delayed).abs() < 1e-4 && phase(&slow).abs() < 1e-4);
    assert!((phase(&late) + RATE * 1e-3).abs() < 1e-4);
}

#[test]
fn torques_saturate_at_their_limit() {
    let limit = 0.4 * FORCE;
    let record = record(|experiment| experiment.torque_limit = Some(vec![limit; 2]));
    let largest = record.torques.iter().fold(0.0_f64, |m, t| m.max(t.abs()));
    assert!((largest - limit).abs() < 1e-12 && record.tracking_error[0] > 1e-3);
}

#[test]
fn all_invalid_drive_settings_are_reported_together() {
    let mut bad = experiment();
    bad.encoder_delay_s = -1.0;
    bad.drives = Drives {
        gain: vec![0.0, 1.0],
        delay_s: f64::NAN,
        current_bandwidth_hz: vec![100.0],
        cogging: vec![-0.1, 0.0],
        cogging_periods: vec![0.0, 1.0],
        flexible_hz: vec![f64::INFINITY, 0.0],
        flexible_damping: 1.0,
        flexible_stiffness: vec![1.0; 3],
    };
    let Err(Error::Experiment(problems)) = simulate(&Robot::new(TwoMotors), &bad, &|_, _| ())
    else {
        panic!("the drives are bad");
    };
    let fields: Vec<&str> = problems.iter().map(|p| p.field.as_str()).collect();
    assert_eq!(
        fields,
        [
            "drives.gain[0]",
            "drives.current_bandwidth_hz",
            "drives.cogging[0]",
            "drives.cogging_periods[0]",
            "drives.flexible_hz[0]",
            "drives.flexible_stiffness",
            "drives.delay_s",
            "encoder_delay_s",
            "drives.flexible_damping",
        ]
    );
}
