//! Finite differences along a path through random states.
//!
//! The derivative of a frame's position and orientation is J v, that of its velocity J v̇ + J̇ v.
//! The derivative of the centre of mass is its Jacobian times v, that of both energies the power of
//! inertia and gravity, which the reference computes by its own dynamics in another test.

use super::{Failure, Robot, all_robots, each};
use nalgebra::{DVector, Quaternion, Vector3};
use overact::{FrameFunction, FrameQuantity, Function};
use overact_codegen::CompiledFunction;
use overact_tests::reference::trajectory::derivatives;
use overact_tests::reference::{Mechanism, State};
use overact_tests::support::Sample;
use overact_tests::support::backend::evaluate;
use overact_tests::support::sample::samples;
use overact_tier::by_tiers;

const TOLERANCE: f64 = 1e-7;
/// States of each robot in the default, full and nightly tier.
const STATES: [usize; 3] = [3, 8, 40];

all_robots!(differ);

/// Value of a function in a state.
fn value(function: &CompiledFunction, state: &State, sample: &Sample) -> DVector<f64> {
    let input = |name: &str| match name {
        "pose" => Some(state.pose.as_slice()),
        "joints" => Some(state.q.as_slice()),
        "twist" | "joint_velocities" => Some(state.twist.as_slice()),
        name => sample.input(name).ok(),
    };
    let found = evaluate(&function.program, &input);
    DVector::from_vec(found.unwrap_or_else(|_| vec![f64::NAN; function.program.entries.len()]))
}

/// A product of a matrix function, row-major, and a vector.
fn product(matrix: &DVector<f64>, vector: &DVector<f64>) -> DVector<f64> {
    let width = vector.len();
    let row = |row: usize| {
        (0..width)
            .map(|c| matrix[row * width + c] * vector[c])
            .sum()
    };
    DVector::from_iterator(matrix.len() / width, (0..matrix.len() / width).map(row))
}

/// Velocity and angular velocity from a pose and its derivative.
fn rates(pose: &DVector<f64>, change: &DVector<f64>) -> DVector<f64> {
    let of = |at: &DVector<f64>| Quaternion::new(at[3], at[4], at[5], at[6]);
    let omega: Vector3<f64> = (of(change) * of(pose).conjugate()).imag() * 2.0;
    DVector::from_column_slice(&[change[0], change[1], change[2], omega.x, omega.y, omega.z])
}

fn differ(robot: &Robot) -> Result<(), Failure> {
    let parameters = robot.expected.parameters();
    let mechanism = &robot.expected.mechanism;
    for sample in samples(mechanism, &parameters, by_tiers(STATES), 29, false)? {
        for frame in 0..robot.model.mechanism.frames.len() {
            of_frame(robot, mechanism, frame, &sample)?;
        }
        let plain = |function| robot.model.plain(function);
        let both = plain(Function::CentreOfMass).zip(plain(Function::CentreOfMassJacobian));
        if let Some((centre, jacobian)) = both {
            let change = derivatives(mechanism, &sample.state, |at| value(centre, at, &sample))?.0;
            let wanted = product(
                &value(jacobian, &sample.state, &sample),
                &sample.state.twist,
            );
            near("centre_of_mass", &change, &wanted)?;
        }
    }
    Ok(())
}

fn of_frame(
    robot: &Robot,
    mechanism: &Mechanism,
    frame: usize,
    sample: &Sample,
) -> Result<(), Failure> {
    let name = &robot.model.mechanism.frames[frame].name;
    let function = |quantity| {
        let function = Function::Frame(FrameFunction { frame, quantity });
        let found = robot.model.plain(function);
        found.ok_or_else(|| format!("no {quantity:?} of {name}"))
    };
    let state = &sample.state;
    let here = |function: &CompiledFunction| value(function, state, sample);
    let change = |function: &CompiledFunction| {
        derivatives(mechanism, state, |at| value(function, at, sample)).map(|both| both.0)
    };
    let pose = function(FrameQuantity::Pose)?;
    let length = here(pose).rows(3, 4).norm();
    if (length - 1.0).abs() > 1e-12 {
        return Err(format!("{name}: a quaternion of length {length}").into());
    }
    let velocity = function(FrameQuantity::Velocity)?;
    near(name, &rates(&here(pose), &change(pose)?), &here(velocity))?;
    let jacobian = here(function(FrameQuantity::Jacobian)?);
    near(name, &product(&jacobian, &state.twist), &here(velocity))?;
    let bias = here(function(FrameQuantity::AccelerationBias)?);
    let wanted = product(&jacobian, &state.acceleration) + bias;
    near(name, &change(velocity)?, &wanted)
}

fn near(name: &str, found: &DVector<f64>, wanted: &DVector<f64>) -> Result<(), Failure> {
    let difference = (found - wanted).amax() / (1.0 + wanted.amax());
    if difference < TOLERANCE {
        return Ok(());
    }
    Err(format!("`{name}` differs by {difference:.1e}: {found} against {wanted}").into())
}
