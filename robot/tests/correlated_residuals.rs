//! Correlated residuals: crosstalk is reported, the errors of coarse encoders are not.

use overact_identification::{Check, CheckKind, Identification, Log};
use overact_robot::{Identifier, Robot};

/// Two coupled joints without friction, whose encoders are coarse for the torque noise.
const ARM: &str = r#"
name = "Arm"
gravity = [0, "-9.81 m/s^2", 0]

[[leg.arm.joint]]
name = "shoulder"
type = "revolute"
actuated = true
parameters = ["inertia", "ia"]

[[leg.arm.joint]]
name = "elbow"
type = "revolute"
d = "0.4 m"
actuated = true
parameters = ["zz", "mx", "my", "m", "ia"]

[[place]]
name = "arm"
shape = "arm"

[identification]
filter_cutoff = "40 Hz"
decimation = 8

[experiment]
sampling = "1 kHz"
duration = "10 s"
bandwidth = "20 Hz"
encoder = 1e-4
torque_noise = [0.05, 0.02]

[experiment.parameters]
zz_shoulder = 0.9
mx_shoulder = 2.4
ia_shoulder = 0.3
m_elbow = 3
mx_elbow = 0.6
zz_elbow = 0.15
ia_elbow = 0.1

[[experiment.run]]
name = "training"
fundamental = "0.2 Hz"
terms = [
  { coordinate = "shoulder", harmonic = 1, amplitude = 0.8 },
  { coordinate = "shoulder", harmonic = 4, amplitude = 0.3, phase = 1 },
  { coordinate = "elbow", harmonic = 2, amplitude = 0.9, phase = 2 },
  { coordinate = "elbow", harmonic = 5, amplitude = 0.3 },
]
"#;

/// Identification from the virtual run, with white noise of this amplitude, N m,
/// in both torques.
fn identified(amplitude: f64) -> Identification {
    let robot = Robot::from_text("arm.toml", ARM).expect("a robot");
    let experiment = robot.experiment().expect("an experiment");
    let runs = experiment.runs(&[], &|_, _| {}).expect("runs");
    let run = runs.identified.first().expect("a run");
    let (positions, mut torques) = run.load().expect("numbers");
    let mut random = 1_u64;
    for pair in torques.chunks_exact_mut(2) {
        random = random
            .wrapping_mul(6_364_136_223_846_793_005)
            .wrapping_add(1);
        let error = amplitude * ((random >> 11) as f64 / (1_u64 << 52) as f64 - 1.0);
        pair[0] += error;
        pair[1] += error;
    }
    let (name, frequency) = (run.name(), run.sampling_frequency());
    let log = Log::new(name, frequency, 2, positions, torques, run.payload()).expect("a log");
    Identifier::new(&robot)
        .runs(&[log])
        .run()
        .expect("a result")
}

/// The check of residual correlation.
fn correlation(result: &Identification) -> &Check {
    let mut checks = result.checks.iter();
    let found = checks.find(|check| check.kind == CheckKind::ResidualCorrelation);
    found.expect("the check")
}

#[test]
fn errors_of_coarse_encoders_are_no_missing_effect() {
    let result = identified(0.0);
    let check = correlation(&result);
    assert!(check.passed, "{}", check.located());
    assert!(
        check.located().contains("as by position errors"),
        "{}",
        check.located()
    );
}

#[test]
fn an_effect_on_two_drives_is_reported() {
    let result = identified(1.0);
    let check = correlation(&result);
    assert!(!check.passed, "{}", check.located());
}
