//! Direction-dependent, Stribeck, load-dependent and quadratic friction, and known torques, from description to
//! identification.

use overact_identification::{Estimator, Identification, Stage};
use overact_robot::{Identifier, Robot};

/// An arm in the vertical plane; each joint has another kind of friction, and the last one is
/// coupled to the others.
const ARM: &str = r#"
name = "FrictionArm"

[[leg.arm.joint]]
type = "revolute"
alpha = "90 deg"
actuated = true
parameters = ["zz", "friction by direction"]
known = "1.5 N m * sin(q) + 0.4 N m"

[[leg.arm.joint]]
type = "revolute"
d = "0.3 m"
actuated = true
parameters = ["zz", "mx", "my", "fv", "fs", "off", "fq"]
stribeck = "0.4 rad/s"
friction_load = "12 N m * cos(q + 30 deg)"

[[leg.arm.joint]]
type = "revolute"
d = "0.2 m"
theta = "-q1 - q2"
parameters = ["m", "friction by direction"]

[[place]]
name = "arm"
shape = "arm"

[identification]
filter_cutoff = "60 Hz"
decimation = 10
essential = false

[experiment]
sampling = "2 kHz"
duration = "10 s"
bandwidth = "20 Hz"
encoder = "1e-6 rad"
torque_noise = "0.02 N m"
seed = 3

[experiment.parameters]
zz_1 = 0.4
fv_pos_1 = 0.8
fs_pos_1 = 1.2
fv_neg_1 = 0.5
fs_neg_1 = 0.7
zz_2 = 0.1
mx_2 = 0.3
my_2 = 0.05
fv_2 = 0.4
fs_2 = 0.6
off_2 = 0.1
fst_2 = 0.5
fl_2 = 0.05
fq_2 = 0.15
m_3 = 1.0
fv_pos_3 = 0.2
fs_pos_3 = 0.3
fv_neg_3 = 0.1
fs_neg_3 = 0.2

[[experiment.run]]
name = "slow"
fundamental = "0.1 Hz"
terms = [
    { coordinate = "1", harmonic = 1, amplitude = "70 deg" },
    { coordinate = "1", harmonic = 3, amplitude = "20 deg", phase = "40 deg" },
    { coordinate = "2", harmonic = 2, amplitude = "50 deg", phase = "70 deg" },
    { coordinate = "2", harmonic = 5, amplitude = "10 deg", phase = "10 deg" },
]

[[experiment.run]]
name = "fast"
fundamental = "0.25 Hz"
terms = [
    { coordinate = "1", harmonic = 1, amplitude = "60 deg", phase = "20 deg" },
    { coordinate = "1", harmonic = 4, amplitude = "15 deg", phase = "80 deg" },
    { coordinate = "2", harmonic = 1, amplitude = "50 deg", phase = "110 deg" },
    { coordinate = "2", harmonic = 3, amplitude = "30 deg", phase = "50 deg" },
]
"#;

fn identified(text: &str) -> Identification {
    let robot = Robot::from_text("arm.toml", text).unwrap_or_else(|error| panic!("{error}"));
    let experiment = robot.experiment().expect("an experiment");
    let runs = experiment.runs(&[], &|_, _| {}).expect("runs");
    let found = Identifier::new(&robot).data(&runs).run();
    found.unwrap_or_else(|error| panic!("{error}"))
}

/// Names of the base parameters, and the largest error of an estimate in standard deviations and
/// percent.
fn errors(result: &Identification) -> (Vec<String>, f64, f64) {
    let estimate = result.estimates.iter();
    let estimate = estimate.filter(|one| one.estimator == Estimator::LeastSquares);
    let estimate = { estimate }
        .find(|one| one.stage == Stage::Base)
        .expect("an estimate");
    let (mut deviations, mut percent) = (0.0_f64, 0.0_f64);
    let mut names = Vec::new();
    for own in &estimate.parameters {
        let truth = own.true_value.expect("a true value");
        println!(
            "{:12} {:9.5} ± {:.5}, true {truth:9.5}",
            own.name, own.value, own.correlated_standard_deviation
        );
        deviations = deviations.max((own.value - truth).abs() / own.correlated_standard_deviation);
        percent = percent.max(100.0 * (own.value / truth - 1.0).abs());
        names.push(own.name.clone());
    }
    (names, deviations, percent)
}

#[test]
fn friction_of_every_kind_is_identified_under_default_settings() {
    let result = identified(ARM);
    let (names, deviations, percent) = errors(&result);
    for name in ["fv_neg_1", "fst_2", "fl_2", "fq_2", "fv_pos_3"] {
        assert!(names.iter().any(|one| one == name), "{names:?}");
    }
    // The constant part of the coupled joint's friction, the difference of its coefficients, is
    // regrouped.
    assert!(names.iter().any(|one| one == "fs_pos_3R"), "{names:?}");
    assert!(!names.iter().any(|one| one == "fs_neg_3"), "{names:?}");
    assert!(deviations < 4.5, "{deviations:.1} deviations");
    assert!(percent < 5.0, "{percent:.1} %");
}

/// A motor that drives both joints and one that drives the first: joint-side estimates are reported
/// on the motor side.
#[test]
fn motor_parameters_are_reported_on_the_motor_side() {
    let motors = "[[leg.arm.motor]]\nname = \"first\"\nturns = \"q1\"\nratio = -20\n\
                  [[leg.arm.motor]]\nname = \"both\"\nturns = \"q1 + 2*q2\"\nratio = 50\n\
                  parameters = [\"ia\", \"friction by direction\", \"fq\"]\nstribeck = \"1 rad/s\"\n\n[[place]]";
    let values = "[experiment.parameters]\nia_both = 0.2\nfv_pos_both = 0.3\nfs_pos_both = 0.8\n\
                  fv_neg_both = 0.5\nfs_neg_both = 0.6\nfst_both = 0.4\nfq_both = 0.05\n";
    let text = ARM.replacen("[[place]]", motors, 1);
    let text = text.replacen("[experiment.parameters]\n", values, 1);
    // Two joints determine friction of three rates only.
    let text = text.replace("[\"m\", \"friction by direction\"]", "\"m\"");
    let own = |line: &&str| !(line.starts_with('f') && line.contains("_3 = "));
    let text: Vec<&str> = text.lines().filter(own).collect();
    let text = text.join("\n");
    let result = identified(&text);
    let (_, deviations, _) = errors(&result);
    assert!(deviations < 4.5, "{deviations:.1} deviations");
    let parameters = &result.estimates[0].parameters;
    let behind = |name: &str| {
        let mut all = parameters.iter();
        all.find(|one| one.name == name).expect(name).value
    };
    let output = |name: &str| {
        let mut all = result.motors.iter();
        let one = all.find(|one| one.name == name).expect(name);
        (one.motor.as_str(), one.value, one.unit.as_str())
    };
    let at = |name: &str, motor, divisor: f64, unit| {
        assert_eq!(output(name), (motor, behind(name) / divisor, unit));
    };
    at("fv_neg_1", "first", 400.0, "N m s/rad");
    at("fv_pos_both", "both", 2500.0, "N m s/rad");
    at("fst_both", "both", 50.0, "N m");
    at("fq_both", "both", 125_000.0, "N m s^2/rad^2");
    let of_joint = result.motors.iter().any(|one| one.name.ends_with("_2"));
    assert!(!of_joint, "no motor turns the second joint alone");
}
