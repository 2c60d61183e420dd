//! Transmissions of the runtime with the generated Jacobian of every robot whose motors are not its
//! coordinates.
//!
//! The power is equal on both sides, round trips return, and the results agree with the generated
//! functions of the same quantities. The derivative of the Jacobian follows from accelerations, and
//! is compared with differences.

use overact::transmission::{Transmission, curvature};
use overact::{Function, Model};
use overact_tests::support::library::described;
use overact_tests::support::sample::samples;
use overact_tests::support::{Failure, Sample, Served};
use overact_tier::by_tier;

/// States of each robot in the default tier and in the full one.
const STATES: [usize; 2] = [4, 100];
/// Largest error of power, torques, velocities and accelerations, relative to the largest number.
const TOLERANCE: f64 = 1e-12;
/// Largest difference from the generated pseudo-inverse, which divides by determinants, in units of
/// the squared condition number.
const GENERATED: f64 = 1e-12;
/// Largest error of a pose that is found from the positions of the motors, m or rad.
const POSE: f64 = 1e-11;
/// Step of differences, and their largest error, relative to the largest number.
const STEP: f64 = 1e-4;
const DIFFERENCES: f64 = 1e-5;

overact_tests::library!(check);

fn check(stem: &str, compiled: &dyn Model) -> Result<(), Failure> {
    let (model, expected) = described(stem)?;
    if model.mechanism.is_tree() {
        return Ok(());
    }
    let count = by_tier(STATES);
    let all = samples(
        &expected.mechanism,
        &expected.parameters(),
        count,
        23,
        false,
    )?;
    let sizes = compiled.info().sizes;
    macro_rules! of_size {
        ($(($n:literal, $r:literal)),*) => {
            match (sizes.actuators, sizes.dof) {
                $(($n, $r) => check_all::<$n, $r>(stem, compiled, &all),)*
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

fn check_all<const N: usize, const R: usize>(
    stem: &str,
    model: &dyn Model,
    all: &[Sample],
) -> Result<(), Failure> {
    let mut worst = Worst::default();
    for (at, sample) in all.iter().enumerate() {
        let own = Robot::<N, R> { model, sample };
        own.check(&mut worst)?;
        if at == 0 {
            worst.curvature = own.curvature_error()?;
        }
    }
    println!("{stem}: {worst:.1e?}");
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

/// A robot at a sample.
struct Robot<'a, const N: usize, const R: usize> {
    model: &'a dyn Model,
    sample: &'a Sample,
}

impl<const N: usize, const R: usize> Robot<'_, N, R> {
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
        let inputs = [&self.sample.state.pose, twist, acceleration];
        let joints = self.call(Function::JointAccelerations, &inputs)?;
        Ok(std::array::from_fn(|a| self.model.of_actuator(a, &joints)))
    }

    fn check(&self, worst: &mut Worst) -> Result<(), Failure> {
        let state = &self.sample.state;
        let (pose, twist) = (&state.pose[..], state.twist.as_slice());
        let own = Transmission::new(&self.jacobian(pose)?)?;
        let rates: [f64; R] = Self::array(twist);
        let torques: [f64; N] = Self::array(&self.sample.torques);
        let most = |worst: &mut f64, error: f64| *worst = worst.max(error);

        let (speeds, joints) = (own.motor_velocities(&rates)?, own.joint_torques(&torques)?);
        let powers: Vec<f64> = torques.iter().zip(&speeds).map(|(t, w)| t * w).collect();
        let scale: f64 = powers.iter().map(|power| power.abs()).sum();
        let power: f64 = joints.iter().zip(&rates).map(|(t, w)| t * w).sum();
        most(
            &mut worst.power,
            (powers.iter().sum::<f64>() - power).abs() / scale,
        );

        let served = Served(self.model);
        let projected = served.evaluate(Function::ProjectPlatform, self.sample)?;
        if self.model.pulls().is_empty() {
            most(&mut worst.torques, relative(&joints, projected.as_slice()));
        }
        let again = own.joint_torques(&own.motor_torques(&joints)?)?;
        most(&mut worst.torques, relative(&again, &joints));
        most(
            &mut worst.velocities,
            relative(&own.joint_velocities(&speeds)?, &rates),
        );

        let acceleration: [f64; R] = Self::array(state.acceleration.as_slice());
        let bias = self.accelerations(twist, &[0.0; R])?;
        let motors = own.motor_accelerations(&acceleration, &bias)?;
        let expected = self.accelerations(twist, &acceleration)?;
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
        let mut found = self.sample.start.clone();
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
                let mut pose = self.sample.state.pose.clone();
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
