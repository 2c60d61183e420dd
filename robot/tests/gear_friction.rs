//! Friction of gears: coefficients from logs of virtual arms and robots with loops.

use overact_identification::{DriveGearFriction, GearFriction, Identification, Log};
use overact_robot::{Identifier, Robot};
use overact_tier::{by_tier, drawn, is_full};

/// A vertical arm of two joints whose gravity torques vary at equal speeds.
const ARM: &str = r#"
name = "Arm"
gravity = [0, "-9.81 m/s^2", 0]

[leg.arm]

[[leg.arm.joint]]
name = "shoulder"
type = "revolute"
actuated = true
parameters = ["inertia", "ia", "fv", "fs", "off"]

[[leg.arm.joint]]
name = "elbow"
type = "revolute"
d = "0.4 m"
actuated = true
parameters = ["inertia", "ia", "fv", "fs", "off"]

[[place]]
name = "arm"
shape = "arm"

[experiment]
sampling = "1 kHz"
duration = "20 s"
bandwidth = "20 Hz"
encoder = 1e-5
torque_noise = [0.3, 0.1]

[experiment.parameters]
zz_shoulder = 0.9
mx_shoulder = 2.4
m_elbow = 3
mx_elbow = 0.6
zz_elbow = 0.15
ia_shoulder = 0.3
ia_elbow = 0.1
fv_shoulder = 2
fs_shoulder = 1.5
fv_elbow = 0.5
fs_elbow = 0.6

[[experiment.run]]
name = "training"
fundamental = "0.1 Hz"
terms = [
  { coordinate = "shoulder", harmonic = 1, amplitude = 0.8 },
  { coordinate = "shoulder", harmonic = 4, amplitude = 0.3, phase = 1 },
  { coordinate = "elbow", harmonic = 2, amplitude = 0.9, phase = 2 },
  { coordinate = "elbow", harmonic = 5, amplitude = 0.3 },
]
"#;

/// True friction of the gears.
const GEARS: [GearFriction; 2] = [
    GearFriction { coefficient: 0.04 },
    GearFriction { coefficient: 0.1 },
];

/// Logs of a robot's virtual experiment, with lossy gears.
///
/// `gears` has one gear for each actuator. The sign of a velocity comes from positions without
/// noise of more than their rounding, at the centre of two sampling intervals.
fn logs(robot: &Robot, gears: &[GearFriction]) -> Vec<Log> {
    let experiment = robot.experiment().expect("an experiment");
    let runs = experiment.runs(&[], &|_, _| {}).expect("runs").identified;
    let lossy = |run: &Log| {
        let n = run.actuators();
        let (positions, mut torques) = run.load().expect("numbers");
        let samples = positions.len() / n;
        for (place, torque) in torques.iter_mut().enumerate() {
            let (sample, drive) = (place / n, place % n);
            let around = [sample.saturating_sub(5), (sample + 5).min(samples - 1)];
            let [before, after] = around.map(|sample| positions[sample * n + drive]);
            *torque = gears[drive].delivered(*torque, (after - before).signum());
        }
        Log::new(
            run.name(),
            run.sampling_frequency(),
            n,
            positions,
            torques,
            run.payload(),
        )
        .expect("a run")
    };
    runs.iter().map(lossy).collect()
}

/// The arm with this seed of its noise.
fn arm(seed: u64) -> Robot {
    let text = ARM.replace("[experiment]\n", &format!("[experiment]\nseed = {seed}\n"));
    Robot::from_text("arm.toml", &text).expect("a robot")
}

fn identified(robot: &Robot, logs: &[Log]) -> Identification {
    let identifier = Identifier::new(robot).runs(logs).gear_friction(true);
    identifier.run().expect("a result")
}

/// Number of 95 % intervals that contain the true coefficients, and of all intervals.
fn covered(drives: &[DriveGearFriction], gears: &[GearFriction]) -> (usize, usize) {
    let both = drives.iter().zip(gears);
    let determined = both.filter_map(|(drive, gear)| Some((drive.coefficient?, gear.coefficient)));
    determined.fold((0, 0), |(inside, all), (found, value)| {
        let [low, high] = found.interval_95;
        (inside + usize::from(low <= value && value <= high), all + 1)
    })
}

#[test]
fn intervals_of_gear_friction_cover_the_truth() {
    let (mut inside, mut all) = (0, 0);
    for seed in 1..=drawn([2, 10, 50]) {
        let robot = arm(seed);
        let result = identified(&robot, &logs(&robot, &GEARS));
        let own = covered(&result.gear_friction, &GEARS);
        assert_eq!(own.1, 2, "{:?}", result.gear_friction);
        (inside, all) = (inside + own.0, all + own.1);
        for (drive, gear) in result.gear_friction.iter().zip(&GEARS) {
            let found = drive.coefficient.expect("determined");
            assert!((found.value - gear.coefficient).abs() < 0.01, "{drive:?}");
            assert!(found.deviation < 0.01, "{drive:?}");
        }
    }
    println!("{inside} of {all} intervals contain the true coefficient");
    assert!(inside * 10 >= all * by_tier([5, 8]), "{inside} of {all}");
}

#[test]
fn parameters_are_right_only_if_gear_losses_are_modelled() {
    let robot = arm(1);
    let logs = logs(&robot, &GEARS);
    let lossless = identified(&robot, &logs);
    let plain = Identifier::new(&robot).runs(&logs).run().expect("a result");
    let friction = |result: &Identification| {
        let mut all = result.estimates[0].parameters.iter();
        let own = all.find(|one| one.name == "fs_elbow").expect("friction");
        own.interval_95
    };
    let [low, high] = friction(&lossless);
    assert!(low <= 0.6 && 0.6 <= high, "{low} to {high}");
    assert!(
        lossless.estimates[0].relative_error_percent < plain.estimates[0].relative_error_percent
    );
    let [low, high] = friction(&plain);
    assert!(!(low <= 0.6 && 0.6 <= high), "{low} to {high}");
}

/// Each drive of a redundant robot has its own measured torque.
#[test]
fn gear_friction_of_a_redundant_robot_is_identified() {
    if !is_full() {
        return;
    }
    let path = concat!(env!("CARGO_MANIFEST_DIR"), "/../robots/dualv.toml");
    let robot = Robot::from_toml(path).expect("a robot");
    let none = GearFriction::default();
    let gears = [GEARS[0], none, GEARS[1], none];
    let result = identified(&robot, &logs(&robot, &gears));
    let (inside, all) = covered(&result.gear_friction, &gears);
    println!("{:?}", result.gear_friction);
    assert!(all == 4 && inside + 1 >= all, "{:?}", result.gear_friction);
}

/// With a load of constant size, its friction is Coulomb friction.
#[test]
fn friction_of_a_constant_load_is_not_separable() {
    let text = r#"
name = "Lift"
gravity = [0, 0, "-9.81 m/s^2"]

[leg.arm]

[[leg.arm.joint]]
name = "lift"
type = "prismatic"
actuated = true
parameters = ["m", "fv", "fs"]

[[place]]
name = "arm"
shape = "arm"

[experiment]
sampling = "500 Hz"
duration = "20 s"
bandwidth = "20 Hz"
encoder = 1e-6
torque_noise = 2.0

[experiment.parameters]
m_lift = 20
fv_lift = 30
fs_lift = 10

[[experiment.run]]
name = "training"
fundamental = "0.1 Hz"
terms = [{ coordinate = "lift", harmonic = 1, amplitude = "50 mm" }]
"#;
    let robot = Robot::from_text("lift.toml", text).expect("a robot");
    let logs = logs(&robot, &GEARS[..1]);
    let result = identified(&robot, &logs);
    let [drive] = &result.gear_friction[..] else {
        panic!("one drive");
    };
    assert!(drive.coefficient.is_none(), "{drive:?}");
    assert!(
        result
            .warnings
            .iter()
            .any(|one| one.contains("is not determined")),
        "{:?}",
        result.warnings
    );
}

#[test]
fn gears_and_gains_are_not_identified_together() {
    let robot = arm(1);
    let logs = logs(&robot, &GEARS);
    let identifier = Identifier::new(&robot).runs(&logs).gear_friction(true);
    let error = identifier
        .gravity_direction(true)
        .run()
        .expect_err("a problem");
    assert!(error.to_string().contains("friction of gears"), "{error}");
    let text = format!("{ARM}\n[identification]\ngravity_direction = true\ngear_friction = true\n");
    let errors = Robot::from_text("arm.toml", &text).expect_err("a problem");
    assert!(errors.to_string().contains("friction of gears"), "{errors}");
}
