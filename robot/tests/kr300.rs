//! A measured heavy arm with a counterbalance: bodies from CAD are held, friction is identified.

use nalgebra::{Matrix3, Vector3};
use overact_identification::{Estimate, Estimator, Grade, Identification, Stage};
use overact_robot::{Identifier, Robot};
use std::fmt::Write as _;
use std::path::{Path, PathBuf};

/// A body: mass, kg, centre of mass, m, and inertia about it, xx yy zz xy xz yz in kg m².
struct Body {
    mass: f64,
    centre: [f64; 3],
    inertia: [f64; 6],
}

const BODIES: [Body; 5] = [
    Body {
        mass: 395.4,
        centre: [-0.003, 0.004, 0.174],
        inertia: [16.73, 32.81, 29.80, -4.404, -1.704, -0.129],
    },
    Body {
        mass: 339.12,
        centre: [0.441, -0.001, 0.023],
        inertia: [7.508, 88.89, 88.67, 0.430, -4.397, 0.173],
    },
    Body {
        mass: 105.21,
        centre: [0.023, -0.076, 0.018],
        inertia: [10.78, 1.943, 10.19, -0.102, -0.119, 0.606],
    },
    Body {
        mass: 35.80,
        centre: [0.0, -0.001, 0.236],
        inertia: [0.4250, 0.4285, 0.2180, 0.0, 0.0, 0.0114],
    },
    Body {
        mass: 31.46,
        centre: [0.0, -0.009, 0.080],
        inertia: [0.2838, 0.2583, 0.2296, 0.0, 0.0, 0.0195],
    },
];

/// The last body with a load at 0.1 m before the flange, without inertia about its centre.
fn last_body(load: f64) -> Body {
    let mass = 17.78 + load;
    Body {
        mass,
        centre: [0.0, 0.0, -(0.1 * load - 0.05 * 17.78) / mass],
        inertia: [0.0; 6],
    }
}

/// Gears, and inertias of the rotors on the motor's side.
const GEARS: [f64; 6] = [
    1798.0 / 7.0,
    1872.0 / 7.0,
    757.0 / 3.0,
    221.0,
    5032.0 / 21.0,
    206_793.0 / 1340.0,
];
const ROTORS: [f64; 6] = [0.00923, 0.0118, 0.0118, 0.00173, 0.00173, 0.00173];

/// The cylinder with gas behind it, as a spring between two points whose force is known.
const COUNTERBALANCE: &str = r#"
[[spring]]
name = "counterbalance"
from = { body = "1", at = [0.35, 0.189, 0.8] }
to = { body = "2", at = ["-0.2 m * cos(5 deg)", "-0.2 m * sin(5 deg)", 0] }
known = "1.01 * 296.8 * 328 * 0.159 * 1.6690e-3 N / (0.00096 - 1.6690e-3 * (l - 0.6 m) / 1 m)"
"#;

/// The arm without counterbalance, and with all parameters free.
fn arm() -> String {
    let joints = [
        ("180 deg", 0.0, -0.675, "q"),
        ("90 deg", 0.35, -0.189, "q - 90 deg"),
        ("0 deg", 1.15, 0.189, "q + 180 deg"),
        ("-90 deg", 0.041, -1.0, "q"),
        ("90 deg", 0.0, 0.0, "q"),
        ("-90 deg", 0.0, -0.24, "q"),
    ];
    let mut text = String::from("name = \"Kr300\"\n");
    for (alpha, d, r, theta) in joints {
        let _ = write!(
            text,
            "\n[[leg.arm.joint]]\ntype = \"revolute\"\nalpha = \"{alpha}\"\nd = {d}\nr = {r}\ntheta = \"{theta}\"\nactuated = true\n"
        );
    }
    let gears: Vec<String> = GEARS.iter().map(|gear| format!("{gear:?}")).collect();
    text + &format!(
        r#"
[[place]]
name = "arm"
shape = "arm"

[data]
time = "$1"
positions = ["$2", "$3", "$4", "$5", "$6", "$7"]
torques = ["$17", "$18", "$19", "$20", "$21", "$22"]
position_scale = "1 deg"
torque_gain = [{}]

[identification]
filter_cutoff = "5 Hz"
filter_equations = true
decimation = 10
"#,
        gears.join(", ")
    )
}

/// Table of the prior that holds all bodies and rotors.
fn held(load: f64) -> String {
    let last = last_body(load);
    let mut text = String::from("\n[prior]\nheld = [\"1\", \"2\", \"3\", \"4\", \"5\", \"6\"");
    for joint in 1..=6 {
        let _ = write!(text, ", \"ia_{joint}\"");
    }
    text += "]\n\n[prior.values]\n";
    for (joint, body) in (1..).zip(BODIES.iter().chain([&last])) {
        let [xx, yy, zz, xy, xz, yz] = body.inertia;
        let centre = Vector3::from(body.centre);
        let about = Matrix3::new(xx, xy, xz, xy, yy, yz, xz, yz, zz)
            + (Matrix3::identity() * centre.norm_squared() - centre * centre.transpose())
                * body.mass;
        let first = centre * body.mass;
        let values = [
            ("xx", about[(0, 0)]),
            ("xy", about[(0, 1)]),
            ("xz", about[(0, 2)]),
            ("yy", about[(1, 1)]),
            ("yz", about[(1, 2)]),
            ("zz", about[(2, 2)]),
            ("mx", first.x),
            ("my", first.y),
            ("mz", first.z),
            ("m", body.mass),
            ("ia", ROTORS[joint - 1] * GEARS[joint - 1].powi(2)),
        ];
        for (symbol, value) in values {
            let _ = writeln!(text, "{symbol}_{joint} = {:?}", value + 0.0);
        }
    }
    text
}

/// The measured run, if it is on this machine.
fn measured() -> Option<PathBuf> {
    let shared = std::env::var("OVERACT_SHARED").map_or_else(
        |_| Path::new(env!("CARGO_MANIFEST_DIR")).join("../../shared"),
        PathBuf::from,
    );
    let log = shared.join("data/kr300/run_A.csv");
    if !log.exists() {
        println!("skipped: {} is missing", log.display());
        return None;
    }
    Some(log)
}

fn identified(text: &str, log: &Path) -> Identification {
    let robot = Robot::from_text("kr300.toml", text).unwrap_or_else(|error| panic!("{error}"));
    let range = PathBuf::from(format!("{}[0.5:9.5]", log.display()));
    let logs = robot.read_logs(&[(&range, false)], &|_| {});
    let logs = logs.unwrap_or_else(|error| panic!("{error}"));
    let found = Identifier::new(&robot).runs(&logs).run();
    found.unwrap_or_else(|error| panic!("{error}"))
}

fn base(found: &Identification) -> &Estimate {
    let is_base =
        |one: &&Estimate| one.estimator == Estimator::LeastSquares && one.stage == Stage::Base;
    found.estimates.iter().find(is_base).expect("an estimate")
}

/// Relative residual of joint 2, percent of the measured torque.
fn residual_of_joint_2(text: &str, log: &Path) -> f64 {
    let found = identified(text, log);
    let lines = base(&found).lines.iter();
    let all: Vec<f64> = lines.map(|line| line.relative_error_percent).collect();
    println!("{all:.1?} {:?}", found.grade());
    all[1]
}

#[test]
fn the_counterbalance_as_a_spring_explains_the_second_joint() {
    let Some(log) = measured() else { return };
    // Loads with which the whole arm fits best, without and with the counterbalance.
    let without = residual_of_joint_2(&(arm() + &held(70.0)), &log);
    let with = residual_of_joint_2(&(arm() + COUNTERBALANCE + &held(160.0)), &log);
    println!("joint 2: {without:.1} % without, {with:.1} % with the counterbalance");
    assert!(without > 30.0, "{without}");
    assert!(with <= 18.0, "{with}");
}

#[test]
fn a_free_fit_of_ten_seconds_is_unusable() {
    let Some(log) = measured() else { return };
    let found = identified(&(arm() + COUNTERBALANCE), &log);
    let lines = base(&found).lines.iter();
    let all: Vec<f64> = lines.map(|line| line.relative_error_percent).collect();
    println!("{all:.1?}");
    assert_eq!(found.grade(), Grade::DoNotUse);
}
