//! Imports of random mechanisms in three formats agree with a numeric reference.
//!
//! A mechanism is written as MJCF, as URDF with its loops in `<gazebo>`, and as SDFormat. The
//! reference computes the mechanism itself, without its description: it cuts the loops and projects
//! the torques of the tree on the motions of the description's coordinates.
//!
//! `OVERACT_RANDOM_SEED=17` repeats one mechanism and prints its MJCF.

mod dynamics;
mod formats;
mod mechanism;

use dynamics::{Motion, Tree};
use formats::FORMATS;
use mechanism::{Draw, RandomMechanism};
use overact::{Columns, Function, Input, Model};
use overact_codegen::derivation::MotionInput;
use overact_codegen::mechanism::Mechanism;
use overact_codegen::{Effort, Request, Source};
use overact_interchange::Options;
use overact_robot::InterpretedRobot;
use overact_tests::support::{Failure, model_with};
use overact_tier::drawn;
use std::collections::BTreeMap;
use std::path::Path;

const INVERSE_DYNAMICS: Function = Function::InverseDynamics(Columns::Standard);
/// Largest difference of torques, relative to the largest torque.
const TOLERANCE: f64 = 1e-8;
const STATES: u64 = 3;
/// Numbers of trees and of closed mechanisms in the default, full and nightly tier.
const TREES: [u64; 3] = [1, 10, 40];
const CLOSED: [u64; 3] = [1, 10, 40];
/// Largest displacements from home, rad or m; the first at which all states exist is used.
const SIZES: [f64; 4] = [0.08, 0.02, 0.005, 0.001];

/// An imported mechanism with its inverse dynamics.
struct ImportedRobot {
    robot: InterpretedRobot,
    /// Values of the columns of inverse dynamics.
    parameters: Vec<f64>,
    /// Bodies whose joints are the coordinates.
    coordinates: Vec<usize>,
    /// Bodies whose joints have motors, in the order of torques.
    motors: Vec<usize>,
}

impl ImportedRobot {
    /// Imports a file and derives its inverse dynamics.
    fn new(file: &Path, own: &RandomMechanism) -> Result<Self, Failure> {
        let driven = own.driven.iter().map(|body| format!("j{body}"));
        let options = Options {
            actuated: Some(driven.collect()),
            ..Options::default()
        };
        let text = overact_robot::import(file, &options)
            .map_err(|error| format!("{error}"))?
            .text;
        // Legs without closed form need the functions that find their joints.
        let wanted = |mechanism: &Mechanism, function: Function, from: MotionInput| {
            function == INVERSE_DYNAMICS && InterpretedRobot::serves(mechanism, function, from)
                || InterpretedRobot::finds_pose(mechanism, function, from)
        };
        let request = Request {
            wanted: &wanted,
            ..Request::with_effort(Effort::None)
        };
        let given = parameters(&text);
        let model = model_with(&Source::new("imported.toml", text), &request)?;
        let columns = model.columns_of(Function::IdmRedPlatform(Columns::Standard));
        let value = |name: String| given.get(&name).copied().unwrap_or(0.0);
        let parameters = { columns.iter() }
            .map(|&parameter| value(model.parameter_name(parameter)))
            .collect();
        let joints = model.mechanism.joints();
        let body = |at: usize| -> Result<usize, Failure> {
            let name = &model.mechanism.joint(joints[at]).name;
            let number = name.strip_prefix('j').and_then(|own| own.parse().ok());
            number.ok_or_else(|| format!("`{name}` is no joint of the file").into())
        };
        let bodies = |joints: Vec<usize>| -> Result<Vec<usize>, Failure> {
            joints.into_iter().map(body).collect()
        };
        Ok(Self {
            coordinates: bodies(model.mechanism.coordinate_joints())?,
            motors: bodies(model.mechanism.actuated())?,
            robot: InterpretedRobot::new(model),
            parameters,
        })
    }

    /// Largest difference of torques from those of the mechanism, relative to the largest torque.
    fn difference(&self, own: &RandomMechanism, seed: u64, size: f64) -> Result<f64, Failure> {
        let mut draw = Draw::new(seed);
        let mut worst = 0.0_f64;
        for _ in 0..STATES {
            let mut drawn = |largest: f64| -> Vec<f64> {
                let count = self.coordinates.len();
                (0..count).map(|_| draw.range(-largest, largest)).collect()
            };
            let mut positions = drawn(size);
            let (rates, accelerations) = (drawn(1.0), drawn(3.0));
            for (position, home) in positions
                .iter_mut()
                .zip(&self.robot.model().mechanism.home.pose)
            {
                *position += home;
            }
            let input = |input: &Input| match input {
                Input::Pose => positions.as_slice(),
                Input::Twist => rates.as_slice(),
                Input::Acceleration => accelerations.as_slice(),
                _ => self.parameters.as_slice(),
            };
            let inputs: Vec<&[f64]> = INVERSE_DYNAMICS.inputs().iter().map(input).collect();
            let mut torques = vec![0.0; self.motors.len()];
            self.robot
                .evaluate(INVERSE_DYNAMICS, &inputs, &mut torques)?;
            let motors: Vec<(usize, f64)> = { self.motors.iter().copied() }.zip(torques).collect();
            let motion = Motion {
                positions: &positions,
                rates: &rates,
                accelerations: &accelerations,
            };
            let found = Tree::new(own).residual(&self.coordinates, motion, &motors);
            let found = found.ok_or("the reference does not close")?;
            worst = worst.max(found.difference.amax() / found.whole.amax());
        }
        Ok(worst)
    }
}

/// Values of `[experiment.parameters]` by name.
fn parameters(text: &str) -> BTreeMap<String, f64> {
    let (_, values) = text
        .split_once("[experiment.parameters]")
        .unwrap_or_default();
    let lines = values
        .lines()
        .skip(1)
        .take_while(|line| !line.starts_with('['));
    let pair = |line: &str| {
        let (name, value) = line.split_once(" = ")?;
        Some((name.to_owned(), value.parse().ok()?))
    };
    lines.filter_map(pair).collect()
}

/// Largest difference of the imports of a mechanism in all formats.
fn compare(own: &RandomMechanism, seed: u64, folder: &Path) -> Result<f64, Failure> {
    let mut worst = 0.0_f64;
    for (suffix, write) in FORMATS {
        let file = folder.join(format!("{seed}.{suffix}"));
        std::fs::write(&file, write(own))?;
        let found = ImportedRobot::new(&file, own).and_then(|robot| {
            let mut last = Err("no size".into());
            for size in SIZES {
                last = robot.difference(own, seed, size);
                if last.is_ok() {
                    break;
                }
            }
            last
        });
        match found {
            Ok(found) if found < TOLERANCE => worst = worst.max(found),
            Ok(found) => return Err(format!("{suffix}: torques differ by {found:.1e}").into()),
            Err(error) => return Err(format!("{suffix}: {error}").into()),
        }
    }
    Ok(worst)
}

/// Compares mechanisms of several seeds.
fn agree(what: &str, make: fn(u64) -> RandomMechanism, count: u64) -> Result<(), Failure> {
    let own = std::env::var("OVERACT_RANDOM_SEED");
    let own: Option<u64> = own.ok().and_then(|seed| seed.parse().ok());
    let seeds = own.map_or(0..count, |seed| seed..seed + 1);
    let folder = std::env::temp_dir().join(format!("overact_random_{what}_{}", std::process::id()));
    std::fs::create_dir_all(&folder)?;
    let (mut worst, mut errors) = (0.0_f64, Vec::new());
    for seed in seeds {
        let mechanism = make(seed);
        if own.is_some() {
            println!("{}", FORMATS[0].1(&mechanism));
        }
        match compare(&mechanism, seed, &folder) {
            Ok(found) => worst = worst.max(found),
            Err(error) => errors.push(format!("seed {seed}: {error}")),
        }
    }
    std::fs::remove_dir_all(&folder)?;
    println!("{count} {what}: torques differ by {worst:.1e}");
    assert!(errors.is_empty(), "{}", errors.join("\n"));
    Ok(())
}

#[test]
fn imports_of_random_trees_agree_with_the_reference() -> Result<(), Failure> {
    agree("trees", RandomMechanism::tree, drawn(TREES))
}

#[test]
fn imports_of_random_closed_mechanisms_agree_with_the_reference() -> Result<(), Failure> {
    agree("closed", RandomMechanism::closed, drawn(CLOSED))
}
