//! Transmissions of the runtime with the Jacobian of every robot of `robots/` whose motors are not its
//! coordinates.
//!
//! The power is equal on both sides, round trips return, and the results agree with the robot's own
//! functions of the same quantities. The derivative of the Jacobian follows from accelerations, and
//! is compared with differences.

use overact::transmission::{Transmission, curvature};
use overact::{Function, Model};
use overact_codegen::{Request, derivation::MotionInput, mechanism::Mechanism};
use overact_robot::{CompiledFile, InterpretedRobot, Robot};
use overact_tier::by_tier;
use rand_pcg::Pcg64;
use std::path::PathBuf;

type Failure = Box<dyn std::error::Error>;

/// Robots of the default tier: a skeleton, redundant motors, and a skeleton with a slide.
const SOME: [&str; 3] = ["ankle", "dualv", "tricept"];
/// States of each robot in the default tier and in the full one.
const STATES: [usize; 2] = [5, 20];
/// Half ranges of random states, rad and in units of the robot's length.
const RANGES: [f64; 2] = [0.15, 0.08];
/// Largest error of power, torques, velocities and accelerations, relative to the largest number.
const TOLERANCE: f64 = 1e-12;
/// Largest difference from the robot's pseudo-inverse, which divides by determinants, in units of
/// the squared condition number.
const GENERATED: f64 = 1e-12;
/// Largest error of a pose that is found from the positions of the motors, m or rad.
const POSE: f64 = 1e-11;
/// Step of differences, and their largest error, relative to the largest number.
const STEP: f64 = 3e-5;
const DIFFERENCES: f64 = 1e-5;

/// Descriptions of the tier, by name.
fn stems() -> Vec<(String, PathBuf)> {
    let folder = PathBuf::from(env!("CARGO_MANIFEST_DIR")).join("../robots");
    let files = std::fs::read_dir(folder).expect("the library").flatten();
    let descriptions = files.map(|entry| entry.path());
    let named = descriptions.filter(|path| path.extension().is_some_and(|e| e == "toml"));
    let named = named.map(|path| {
        let stem = path.file_stem().unwrap_or_default();
        (stem.to_string_lossy().into_owned(), path.clone())
    });
    let is_tested = |stem: &str| by_tier([SOME.contains(&stem), true]);
    let mut all: Vec<(String, PathBuf)> = named.filter(|(stem, _)| is_tested(stem)).collect();
    all.sort();
    all
}

/// Functions of the test.
fn needs(mechanism: &Mechanism, function: Function, from: MotionInput) -> bool {
    function == Function::Jacobian || InterpretedRobot::serves(mechanism, function, from)
}

#[test]
fn transmissions_of_all_robots_with_loops() -> Result<(), Failure> {
    let mut tested = 0;
    for (stem, path) in stems() {
        let request = Request {
            wanted: &needs,
            ..Robot::request()
        };
        let compiled = CompiledFile::read(&path, &request);
        let robot = Robot::new(compiled.map_err(|error| error.render(false))?);
        if robot.model().model().is_tree() {
            continue;
        }
        check(&stem, robot.model())?;
        tested += 1;
    }
    assert!(tested >= SOME.len());
    Ok(())
}

fn check(stem: &str, model: &InterpretedRobot) -> Result<(), Failure> {
    let sizes = model.info().sizes;
    macro_rules! of_size {
        ($(($n:literal, $r:literal)),*) => {
            match (sizes.actuators, sizes.dof) {
                $(($n, $r) => check_all::<$n, $r>(stem, model),)*
                other => Err(format!("{stem}: add the size {other:?}").into()),
            }
        };
    }
    of_size!(
        (1, 1),
        (2, 1),
        (3, 1),
        (2, 2),
        (3, 2),
        (4, 2),
        (3, 3),
        (4, 3),
        (5, 3),
        (4, 4),
        (5, 4),
        (6, 4),
        (5, 5),
        (6, 6),
        (7, 6),
        (8, 6)
    )
}

/// Largest errors, each relative to its tolerance.
#[derive(Default, Debug)]
struct Worst {
    power: f64,
    torques: f64,
    velocities: f64,
    accelerations: f64,
    generated: f64,
    poses: f64,
    curvature: f64,
}

/// Largest difference relative to the largest magnitude.
fn relative(a: &[f64], b: &[f64]) -> f64 {
    let scale = b
        .iter()
        .fold(f64::MIN_POSITIVE, |most, x| most.max(x.abs()));
    let all = a.iter().zip(b).map(|(x, y)| (x - y).abs() / scale);
    all.fold(0.0, f64::max)
}

/// Numbers in [-1, 1].
fn draw<const K: usize>(random: &mut Pcg64) -> [f64; K] {
    use rand_distr::{Distribution, StandardUniform};
    std::array::from_fn(|_| {
        let number: f64 = StandardUniform.sample(random);
        2.0 * number - 1.0
    })
}

fn check_all<const N: usize, const R: usize>(
    stem: &str,
    model: &InterpretedRobot,
) -> Result<(), Failure> {
    let mut worst = Worst::default();
    let mut random = Pcg64::new(23, 0);
    let [turn, slide] = RANGES;
    let length = slide * model.model().mechanism.length_scale();
    let is_turn = |name: &str| name.starts_with('r') || name == "phi";
    let names = model.info().coordinates;
    let has_platform = model.model().mechanism.platform.is_some();
    let (mut done, mut drawn) = (0, 0);
    while done < by_tier(STATES) {
        drawn += 1;
        assert!(drawn < 1000, "{stem}: too few states within reach");
        let numbers: [f64; R] = draw(&mut random);
        let step: [f64; R] = std::array::from_fn(|i| {
            let range = if has_platform && !is_turn(names[i]) {
                length
            } else {
                turn.min(length.max(slide))
            };
            numbers[i] * range
        });
        let mut pose = model.info().home_pose.to_vec();
        model.displace(&mut pose, &step);
        let own = State::<N, R> {
            model,
            start: model.info().home_pose,
            pose,
            twist: draw(&mut random),
            acceleration: draw(&mut random),
            torques: draw(&mut random),
        };
        // A state that a leg does not reach.
        if own.jacobian(&own.pose).is_err() {
            continue;
        }
        own.check(&mut worst)?;
        if done == 0 {
            worst.curvature = own.curvature_error()?;
        }
        done += 1;
    }
    println!("{stem}: {worst:?}");
    let exact = [
        worst.power,
        worst.torques,
        worst.velocities,
        worst.accelerations,
    ];
    assert!(exact.iter().all(|w| *w < TOLERANCE), "{stem}: {worst:?}");
    assert!(worst.generated < GENERATED, "{stem}: {worst:?}");
    assert!(worst.poses < POSE, "{stem}: {worst:?}");
    assert!(worst.curvature < DIFFERENCES, "{stem}: {worst:?}");
    Ok(())
}

/// A robot at a state.
struct State<'a, const N: usize, const R: usize> {
    model: &'a InterpretedRobot,
    start: &'a [f64],
    pose: Vec<f64>,
    twist: [f64; R],
    acceleration: [f64; R],
    torques: [f64; N],
}

impl<const N: usize, const R: usize> State<'_, N, R> {
    fn array<const K: usize>(numbers: &[f64]) -> [f64; K] {
        std::array::from_fn(|at| numbers[at])
    }

    /// A function's output, row by row.
    fn call(&self, function: Function, inputs: &[&[f64]]) -> Result<Vec<f64>, Failure> {
        let (rows, columns) = function.shape(&self.model.info().sizes);
        let mut output = vec![f64::NAN; rows * columns];
        self.model.evaluate(function, inputs, &mut output)?;
        Ok(output)
    }

    fn jacobian(&self, pose: &[f64]) -> Result<[[f64; R]; N], Failure> {
        let flat = self.call(Function::InverseJacobian, &[pose])?;
        Ok(std::array::from_fn(|a| Self::array(&flat[a * R..])))
    }

    /// Accelerations of the motors.
    fn accelerations(&self, twist: &[f64], acceleration: &[f64]) -> Result<[f64; N], Failure> {
        let inputs = [&self.pose, twist, acceleration];
        let joints = self.call(Function::JointAccelerations, &inputs)?;
        Ok(std::array::from_fn(|a| self.model.of_actuator(a, &joints)))
    }

    fn check(&self, worst: &mut Worst) -> Result<(), Failure> {
        let (pose, rates, torques) = (&self.pose[..], self.twist, self.torques);
        let own = Transmission::new(&self.jacobian(pose)?)?;
        let most = |worst: &mut f64, error: f64| *worst = worst.max(error);

        let (speeds, joints) = (own.motor_velocities(&rates)?, own.joint_torques(&torques)?);
        let powers: Vec<f64> = torques.iter().zip(&speeds).map(|(t, w)| t * w).collect();
        let scale: f64 = powers.iter().map(|power| power.abs()).sum();
        let power: f64 = joints.iter().zip(&rates).map(|(t, w)| t * w).sum();
        most(
            &mut worst.power,
            (powers.iter().sum::<f64>() - power).abs() / scale,
        );

        if self.model.pulls().is_empty() {
            let projected = self.call(Function::ProjectPlatform, &[pose, &torques])?;
            most(&mut worst.torques, relative(&joints, &projected));
        }
        let again = own.joint_torques(&own.motor_torques(&joints)?)?;
        most(&mut worst.torques, relative(&again, &joints));
        most(
            &mut worst.velocities,
            relative(&own.joint_velocities(&speeds)?, &rates),
        );

        let acceleration = self.acceleration;
        let bias = self.accelerations(&rates, &[0.0; R])?;
        let motors = own.motor_accelerations(&acceleration, &bias)?;
        let expected = self.accelerations(&rates, &acceleration)?;
        most(&mut worst.accelerations, relative(&motors, &expected));
        let back = own.joint_accelerations(&motors, &bias)?;
        most(&mut worst.accelerations, relative(&back, &acceleration));

        let inverse = own.inverse().as_flattened();
        let condition = own.condition() * own.condition();
        let generated = self.call(Function::Jacobian, &[pose])?;
        most(
            &mut worst.generated,
            relative(inverse, &generated) / condition,
        );
        let found = self.call(Function::TwistFromActuators, &[pose, &speeds])?;
        most(&mut worst.generated, relative(&found, &rates) / condition);

        let positions = self.call(Function::ActuatorPositions, &[pose])?;
        let mut found = self.start.to_vec();
        self.model.pose_from_actuators(&positions, &mut found)?;
        let pairs = found.iter().zip(pose).map(|(a, b)| (a - b).abs());
        most(&mut worst.poses, pairs.fold(0.0, f64::max));
        Ok(())
    }

    /// Error of the curvature, from the symmetric part of differences of the Jacobian.
    fn curvature_error(&self) -> Result<f64, Failure> {
        let found = curvature(|twist: &[f64; R]| self.accelerations(twist, &[0.0; R]))?;
        let mut slopes = [[[0.0; R]; R]; N];
        for i in 0..R {
            let moved = |by: f64| {
                let mut pose = self.pose.clone();
                let mut step = [0.0; R];
                step[i] = by;
                self.model.displace(&mut pose, &step);
                self.jacobian(&pose)
            };
            let (after, before) = (moved(STEP)?, moved(-STEP)?);
            for a in 0..N {
                for j in 0..R {
                    let slope = (after[a][j] - before[a][j]) / (2.0 * STEP);
                    slopes[a][i][j] += 0.5 * slope;
                    slopes[a][j][i] += 0.5 * slope;
                }
            }
        }
        let flat = |all: &[[[f64; R]; R]; N]| all.as_flattened().as_flattened().to_vec();
        // Slides along coordinates have no curvature.
        let (found, slopes) = (flat(&found), flat(&slopes));
        let size = found
            .iter()
            .chain(&slopes)
            .fold(1.0_f64, |most, x| most.max(x.abs()));
        let all = found.iter().zip(&slopes).map(|(a, b)| (a - b).abs() / size);
        Ok(all.fold(0.0, f64::max))
    }
}
