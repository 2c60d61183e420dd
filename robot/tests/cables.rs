//! Cables: lengths, tensions, errors, and a measured cable robot.
//!
//! Lengths are compared with the geometry, and all derivatives with finite differences of them.

use overact::{Columns, Error, Function, Model};
use overact_identification::{Estimator, Identification, ModelKind, Stage};
use overact_robot::{Identifier, Robot};
use std::path::{Path, PathBuf};

/// Four cables hold a platform in the vertical plane.
fn planar(pulley: &str) -> String {
    let mut text = format!(
        r#"
name = "Planar"

[platform]
motion = "planar"
axis = "y"
home = {{ z = 0.05, x = -0.02, phi = 0.1 }}
redundancy = 1

[leg.cable]
type = "cable"
variables = ["ex", "ez", "px", "pz"]
base = {{ at = ["ex", 0, "ez"] }}
pulley = "{pulley}"
minimum = "5 N"
parameters = ["ia", "fv", "fs"]
end = {{ at = ["px", 0, "pz"] }}
"#
    );
    let places = [
        (0.5, 0.45, -0.06, 0.05),
        (0.55, -0.4, -0.05, -0.06),
        (-0.5, -0.45, 0.05, -0.05),
        (-0.45, 0.5, 0.06, 0.05),
    ];
    for (number, (ex, ez, px, pz)) in places.into_iter().enumerate() {
        text += &format!(
            "\n[[place]]\nname = \"c{}\"\nshape = \"cable\"\nex = {ex}\nez = {ez}\npx = {px}\npz = {pz}\n",
            number + 1
        );
    }
    text
}

/// Eight cables hold a spatial platform.
fn spatial(pulley: &str) -> String {
    let mut text = format!(
        r#"
name = "Spatial"

[platform]
motion = "spatial"
home = {{ x = 0.05, y = -0.04, z = 0.1 }}
redundancy = 2

[leg.cable]
type = "cable"
variables = ["ex", "ey", "ez", "px", "py", "pz", "up"]
base = {{ at = ["ex", "ey", "ez"], rotation = ["up", 0, 0] }}
pulley = "{pulley}"
minimum = "2 N"
parameters = ["ia", "fv", "fs"]
end = {{ at = ["px", "py", "pz"] }}
"#
    );
    for number in 0..8_u32 {
        let sign = |bit: u32| if number >> bit & 1 == 1 { 1.0 } else { -1.0 };
        let (sx, sy, sz) = (sign(0), sign(1), sign(2));
        // The upper cables cross along x and the lower ones along y: otherwise no moment about z is
        // held.
        let (px, py) = (-0.2 * sx * sz, 0.15 * sy * sz);
        text += &format!(
            "\n[[place]]\nname = \"c{}\"\nshape = \"cable\"\nex = {}\ney = {}\nez = {}\npx = {px}\npy = {py}\npz = {}\nup = \"{} deg\"\n",
            number + 1,
            1.5 * sx,
            1.2 * sy,
            1.0 * sz,
            0.1 * sz,
            if sz > 0.0 { 0 } else { 180 },
        );
    }
    text
}

fn robot(text: &str) -> Robot {
    Robot::from_text("cables.toml", text).unwrap_or_else(|error| panic!("{error}\n{text}"))
}

fn ask(robot: &Robot, function: Function, inputs: &[&[f64]], count: usize) -> Vec<f64> {
    let mut output = vec![0.0; count];
    let done = robot.model().evaluate(function, inputs, &mut output);
    done.unwrap_or_else(|error| panic!("{}: {:?}", function.name(), error));
    output
}

/// Reproducible numbers between -1 and 1.
struct Dice(u64);

impl Dice {
    fn number(&mut self) -> f64 {
        self.0 = self
            .0
            .wrapping_mul(6_364_136_223_846_793_005)
            .wrapping_add(1_442_695_040_888_963_407);
        (self.0 >> 11) as f64 / (1_u64 << 52) as f64 - 1.0
    }

    fn vector(&mut self, count: usize, size: f64) -> Vec<f64> {
        (0..count).map(|_| size * self.number()).collect()
    }
}

/// A state near home.
struct State {
    pose: Vec<f64>,
    twist: Vec<f64>,
    acceleration: Vec<f64>,
    parameters: Vec<f64>,
}

fn states(robot: &Robot, count: usize) -> Vec<State> {
    let info = robot.model().info();
    let mut dice = Dice(7);
    let state = |_| {
        let mut pose = info.home_pose.to_vec();
        let step = dice.vector(info.sizes.dof, 0.1);
        robot.model().displace(&mut pose, &step);
        let parameter = |one: &overact::Parameter| match one.symbol.name() {
            "m" => 4.0,
            "ia" => 0.2,
            "xx" | "yy" | "zz" => 0.3 + 0.02 * (dice.number() + 1.0),
            _ => 0.05 * (dice.number() + 1.0),
        };
        let parameters = info.parameters.iter().map(parameter).collect();
        State {
            pose,
            twist: dice.vector(info.sizes.dof, 0.5),
            acceleration: dice.vector(info.sizes.dof, 1.0),
            parameters,
        }
    };
    (0..count).map(state).collect()
}

const FIRST_DIFFERENCE: [f64; 3] = [0.75, -0.15, 1.0 / 60.0];
const SECOND_DIFFERENCE: [f64; 4] = [-49.0 / 18.0, 1.5, -0.15, 1.0 / 90.0];

/// Lengths at the pose displaced by a step.
fn lengths(robot: &Robot, pose: &[f64], step: &[f64]) -> Vec<f64> {
    let mut pose = pose.to_vec();
    robot.model().displace(&mut pose, step);
    let n = robot.model().info().sizes.actuators;
    ask(robot, Function::ActuatorPositions, &[&pose], n)
}

fn assert_close(name: &str, found: &[f64], expected: &[f64], tolerance: f64) {
    let scale = expected.iter().fold(1.0_f64, |most, x| most.max(x.abs()));
    for (found, expected) in found.iter().zip(expected) {
        let error = (found - expected).abs() / scale;
        assert!(error < tolerance, "{name}: {found} instead of {expected}");
    }
}

/// All derivatives of the lengths, and forces by virtual work.
fn compare(text: &str, least: f64) {
    let robot = robot(text);
    let sizes = robot.model().info().sizes;
    let (n, r) = (sizes.actuators, sizes.dof);
    let mut dice = Dice(3);
    for state in states(&robot, 5) {
        let jacobian = ask(&robot, Function::InverseJacobian, &[&state.pose], n * r);
        let mut expected = vec![0.0; n * r];
        for column in 0..r {
            for (k, weight) in FIRST_DIFFERENCE.iter().enumerate() {
                let size = 1e-3 * (k + 1) as f64;
                let along = |size: f64| {
                    let mut step = vec![0.0; r];
                    step[column] = size;
                    lengths(&robot, &state.pose, &step)
                };
                for (row, (a, b)) in along(size).iter().zip(along(-size)).enumerate() {
                    expected[row * r + column] += weight * (a - b) / 1e-3;
                }
            }
        }
        assert_close("inverse_jacobian", &jacobian, &expected, 1e-9);
        let path = |t: f64| -> Vec<f64> {
            let both = state.twist.iter().zip(&state.acceleration);
            both.map(|(v, a)| v * t + 0.5 * a * t * t).collect()
        };
        let time = 5e-3;
        let mut second: Vec<f64> = lengths(&robot, &state.pose, &path(0.0))
            .iter()
            .map(|length| SECOND_DIFFERENCE[0] * length)
            .collect();
        for (k, weight) in SECOND_DIFFERENCE.iter().enumerate().skip(1) {
            let t = k as f64 * time;
            let both = [t, -t].map(|t| lengths(&robot, &state.pose, &path(t)));
            for (row, sum) in second.iter_mut().enumerate() {
                *sum += weight * (both[0][row] + both[1][row]);
            }
        }
        second.iter_mut().for_each(|sum| *sum /= time * time);
        let inputs: [&[f64]; 3] = [&state.pose, &state.twist, &state.acceleration];
        let accelerations = ask(&robot, Function::JointAccelerations, &inputs, n);
        assert_close("joint_accelerations", &accelerations, &second, 1e-8);
        // A tension pulls: its power is the negative of that of its length.
        let tensions: Vec<f64> = (0..n).map(|_| 10.0 + dice.number()).collect();
        let inputs = ask(
            &robot,
            Function::ProjectPlatform,
            &[&state.pose, &tensions],
            r,
        );
        let work = |column: usize| -> f64 {
            let rows = tensions.iter().enumerate();
            rows.map(|(row, tension)| -tension * expected[row * r + column])
                .sum()
        };
        let expected: Vec<f64> = (0..r).map(work).collect();
        assert_close("project_platform", &inputs, &expected, 1e-9);
        tensions_of(&robot, &state, least);
    }
}

/// Inverse dynamics: the forces of the model, the minimum `least` (N) of all tensions, and the least
/// norm.
fn tensions_of(robot: &Robot, state: &State, least: f64) {
    let sizes = robot.model().info().sizes;
    let (n, r) = (sizes.actuators, sizes.dof);
    let inputs: [&[f64]; 4] = [
        &state.pose,
        &state.twist,
        &state.acceleration,
        &state.parameters,
    ];
    let function = Function::InverseDynamics(Columns::Standard);
    let tensions = ask(robot, function, &inputs, n);
    let columns = sizes.parameters;
    let function = Function::IdmRedPlatform(Columns::Standard);
    let regressor = ask(robot, function, &inputs[..3], r * columns);
    let wanted: Vec<f64> = (0..r)
        .map(|row| {
            let own = &regressor[row * columns..(row + 1) * columns];
            own.iter().zip(&state.parameters).map(|(w, x)| w * x).sum()
        })
        .collect();
    let found = ask(
        robot,
        Function::ProjectPlatform,
        &[&state.pose, &tensions],
        r,
    );
    assert_close("tensions", &found, &wanted, 1e-9);
    assert!(tensions.iter().all(|t| *t >= least), "{tensions:?}");
    // At the optimum, t - t_min is the positive part of a combination of the rows of the Jacobian.
    let jacobian = ask(robot, Function::InverseJacobian, &[&state.pose], n * r);
    let taut: Vec<usize> = (0..n).filter(|&i| tensions[i] > least + 1e-9).collect();
    let matrix = nalgebra::DMatrix::from_fn(taut.len(), r, |i, c| -jacobian[taut[i] * r + c]);
    let right = nalgebra::DVector::from_fn(taut.len(), |i, _| tensions[taut[i]] - least);
    let multipliers = matrix
        .clone()
        .svd(true, true)
        .solve(&right, 1e-12)
        .expect("a solution");
    let scale = right.amax();
    assert!(
        (&matrix * &multipliers - &right).amax() < 1e-7 * scale,
        "not of least norm"
    );
    for i in (0..n).filter(|i| !taut.contains(i)) {
        let own: f64 = (0..r).map(|c| -jacobian[i * r + c] * multipliers[c]).sum();
        assert!(own < 1e-7 * scale, "cable {i} should pull more");
    }
}

#[test]
fn eyelets_of_a_planar_robot_agree_with_finite_differences() {
    compare(&planar("0 m"), 5.0);
}

#[test]
fn pulleys_of_a_planar_robot_agree_with_finite_differences() {
    compare(&planar("25 mm"), 5.0);
}

#[test]
fn eyelets_of_a_spatial_robot_agree_with_finite_differences() {
    compare(&spatial("0 m"), 2.0);
}

#[test]
fn pulleys_of_a_spatial_robot_agree_with_finite_differences() {
    compare(&spatial("40 mm"), 2.0);
}

/// The length over a pulley by bisection of the angle at which the cable leaves the rim.
fn wrapped(radius: f64, across: f64, up: f64) -> f64 {
    let outside = |angle: f64| {
        let (x, y) = (
            across - radius * (1.0 - angle.cos()),
            up - radius * angle.sin(),
        );
        -angle.cos() * x + angle.sin() * y
    };
    let (mut low, mut high) = (1e-9, std::f64::consts::PI);
    for _ in 0..100 {
        let middle = 0.5 * (low + high);
        if outside(middle) < 0.0 {
            low = middle;
        } else {
            high = middle;
        }
    }
    let (x, y) = (across - radius * (1.0 - low.cos()), up - radius * low.sin());
    radius * low + x.hypot(y)
}

#[test]
fn robots_with_cables_agree_with_finite_differences() {
    for (name, least) in [("cable_planar", 10.0), ("cable_spatial", 20.0)] {
        let folder = Path::new(env!("CARGO_MANIFEST_DIR")).join("../robots");
        let file = folder.join(format!("{name}.toml"));
        let text = std::fs::read_to_string(file).expect("a description");
        compare(&text, least);
    }
}

#[test]
fn the_wrapped_arc_is_part_of_the_length() {
    let robot = robot(&planar("25 mm"));
    let pose = [0.1, 0.02, 0.0];
    let lengths = ask(&robot, Function::ActuatorPositions, &[&pose], 4);
    let (x, z) = (pose[1] - 0.06, pose[0] + 0.05);
    let expected = wrapped(0.025, (x - 0.5_f64).abs(), z - 0.45);
    assert!(
        (lengths[0] - expected).abs() < 1e-12,
        "{} {expected}",
        lengths[0]
    );
}

#[test]
fn a_point_inside_the_pulley_and_an_infeasible_motion_are_errors() {
    let ask = |robot: &Robot, function, inputs: &[&[f64]], count: usize| {
        let mut output = vec![0.0; count];
        let done = robot.model().evaluate(function, inputs, &mut output);
        done.map_err(|error| error.error)
    };
    // The platform point of the first cable is 5 mm from the pulley's centre, which is 25 mm left of
    // its exit.
    let pose = [0.4, 0.53, 0.0];
    let pulleys = robot(&planar("25 mm"));
    let found = ask(&pulleys, Function::ActuatorPositions, &[&pose], 4);
    assert_eq!(found, Err(Error::OutOfReach { leg: "c1" }));
    // Right of the frame, all cables pull to the left.
    let eyelets = robot(&planar("0 m"));
    let info = eyelets.model().info();
    let parameters: Vec<f64> = (info.parameters.iter())
        .map(|one| if one.symbol.name() == "m" { 4.0 } else { 0.0 })
        .collect();
    let inputs: [&[f64]; 4] = [&[0.0, 3.0, 0.0], &[0.0; 3], &[0.0; 3], &parameters];
    let function = Function::InverseDynamics(Columns::Standard);
    assert_eq!(ask(&eyelets, function, &inputs, 4), Err(Error::Tensions));
}

#[test]
fn impossible_cables_are_rejected() {
    let refused = |text: String, words: &str| {
        let error = Robot::from_text("cables.toml", &text).err();
        let text = error.map(|error| error.to_string()).unwrap_or_default();
        assert!(text.contains(words), "no `{words}` in\n{text}");
    };
    let planar = planar("25 mm");
    refused(
        planar.replace("pulley = \"25 mm\"", "pulley = \"2 m\""),
        "cannot wrap its pulley",
    );
    refused(
        planar.replace("pulley = \"25 mm\"", "pulley = \"-1 mm\""),
        "must be positive",
    );
    refused(
        planar.replace("minimum = \"5 N\"", "minimum = \"5 m\""),
        "force",
    );
    refused(
        planar.replace("\"ia\", \"fv\"", "\"zz\", \"fv\""),
        "a cable has no parameter `zz`",
    );
    refused(
        planar.replace(
            "at = [\"px\", 0, \"pz\"]",
            "at = [\"px\", 0, \"pz\"], type = \"rigid\"",
        ),
        "type",
    );
    refused(planar.replace("pulley =", "pully ="), "pulley");
    refused(
        planar.replace("type = \"cable\"\n", "type = \"cable\"\njoint = []\n"),
        "a cable has no `joint`",
    );
    let home = planar.replace(
        "name = \"c1\"\n",
        "name = \"c1\"\nhome = { length = 0.5 }\n",
    );
    refused(home, "a cable has no `home`");
    let frame = planar.clone() + "\n[frame.hook]\nbody = \"c1.length\"\n";
    refused(frame, "the robot has no body `c1.length`");
    // The platform point is the exit point.
    let same = planar.replace(
        "ex = 0.5\nez = 0.45\npx = -0.06\npz = 0.05",
        "ex = -0.02\nez = 0.05\npx = 0\npz = 0",
    );
    refused(same, "has no length at the home configuration");
}

/// The measured cable robot, if it is on this machine.
fn measured() -> Option<PathBuf> {
    let shared = std::env::var("OVERACT_SHARED").map_or_else(
        |_| Path::new(env!("CARGO_MANIFEST_DIR")).join("../../shared"),
        PathBuf::from,
    );
    let log = shared.join("data/ocdpr/prova1_buona.csv");
    if !log.exists() {
        println!("skipped: {} is missing", log.display());
        return None;
    }
    Some(log)
}

/// The measured robot with parameters of its drives.
fn ocdpr(parameters: &str) -> String {
    let mut text = format!(
        r#"
name = "Ocdpr"

[platform]
motion = "planar"
axis = "y"
home = {{ z = "-0.06 m", x = "-0.06 m" }}
redundancy = 1
parameters = ["yy", "mx", "mz", "m"]

[leg.cable]
type = "cable"
variables = ["ex", "ez", "px", "pz"]
base = {{ at = ["ex", 0, "ez"] }}
minimum = "5 N"
parameters = {parameters}
end = {{ at = ["px", 0, "pz"] }}

[data]
time = "$1"
positions = ["$2", "$3", "$4", "$5"]
torques = ["$6", "$7", "$8", "$9"]
resample = "100 Hz"
"#
    );
    let places = [
        (0.4375, 0.35, -0.04, 0.05),
        (0.4375, -0.35, -0.04, -0.05),
        (-0.4375, -0.35, 0.04, -0.05),
        (-0.4375, 0.35, 0.04, 0.05),
    ];
    for (number, (ex, ez, px, pz)) in places.into_iter().enumerate() {
        text += &format!(
            "\n[[place]]\nname = \"c{}\"\nshape = \"cable\"\nex = {ex}\nez = {ez}\npx = {px}\npz = {pz}\n",
            number + 1
        );
    }
    text
}

fn identified(text: &str, log: &Path) -> Identification {
    let robot = robot(text);
    let range = PathBuf::from(format!("{}[11:60]", log.display()));
    let logs = robot.read_logs(&[(&range, false)], &|_| {});
    let logs = logs.unwrap_or_else(|error| panic!("{error}"));
    let found = Identifier::new(&robot).runs(&logs).run();
    found.unwrap_or_else(|error| panic!("{error}"))
}

/// The sentences of all checks that failed.
fn failed(found: &Identification) -> String {
    let checks = found.checks.iter().filter(|check| !check.passed);
    let words: Vec<String> = checks.map(|check| check.words.clone()).collect();
    words.join("\n")
}

#[test]
fn the_interval_covers_the_mass_of_a_measured_cable_robot() {
    let Some(log) = measured() else { return };
    let found = identified(&ocdpr("[\"fs\"]"), &log);
    println!("{}", failed(&found));
    for model in [ModelKind::Platform, ModelKind::Actuators] {
        let mut estimates = found.estimates.iter();
        let estimate = estimates
            .find(|one| {
                one.estimator == Estimator::LeastSquares
                    && one.stage == Stage::Recommended
                    && one.model == model
            })
            .expect("an estimate");
        let mass = estimate
            .parameters
            .iter()
            .find(|one| one.name.starts_with("m_platform"));
        let mass = mass.expect("a mass");
        println!("{model:?}: {} {:?}", mass.value, mass.interval_95);
        let [low, high] = mass.interval_95;
        assert!(low < 2.425 && 2.425 < high, "{model:?}: {low} to {high}");
    }
    let words = failed(&found);
    assert!(
        words.contains("`yy_platform` is not identifiable"),
        "{words}"
    );
    assert!(!words.contains("stuck"), "{words}");
    let grades: Vec<_> = found.verdicts.iter().map(|one| one.grade).collect();
    println!("{grades:?}");
}

#[test]
fn unmodelled_friction_is_detected() {
    let Some(log) = measured() else { return };
    let words = failed(&identified(&ocdpr("[]"), &log));
    println!("{words}");
    assert!(words.contains("friction"), "{words}");
}

#[test]
fn a_slack_cable_is_detected() {
    let Some(log) = measured() else { return };
    let text = ocdpr("[\"fs\"]").replace("\"$7\"", "\"$7 - 20\"");
    let words = failed(&identified(&text, &log));
    assert!(
        words.contains("the tension of the cable `c2` falls to"),
        "{words}"
    );
}

#[test]
fn data_of_a_drifting_load_cell_are_unusable() {
    let Some(log) = measured() else { return };
    let text = ocdpr("[\"fs\"]").replace("\"$7\"", "\"$7 + 1.0 * ($1 - 11)\"");
    let found = identified(&text, &log);
    println!("{}", failed(&found));
    assert_eq!(found.grade(), overact_identification::Grade::DoNotUse);
}
