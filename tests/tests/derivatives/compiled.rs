//! Compiled Rust in 64 and 32 bits: a tree, a redundant robot, a skeleton with chains.

use super::{Failure, Robot};
use overact_compiled::derived;
use overact_tests::compiled_backend;
use overact_tests::support::Backend;
use overact_tests::support::agreement::Agreement;
use overact_tests::support::sample::samples;
use overact_tier::by_tiers;

/// Largest difference from the reference, relative to the largest entry of a matrix.
const TOLERANCE: f64 = 1e-9;
/// Largest difference in 32 bits.
const SINGLE: f64 = 2e-3;
/// States in the default, full and nightly tier.
const STATES: [usize; 3] = [3, 10, 30];

/// Backends of a robot with a platform or a skeleton.
macro_rules! of_pose {
    ($double:ident, $robot:path) => {
        compiled_backend! {
            $double, "compiled", $robot,
            inverse_dynamics_by_displacement(pose, twist, acceleration, parameters);
            inverse_dynamics_by_twist(pose, twist, acceleration, parameters);
            forward_dynamics_by_displacement(pose, twist, torques, parameters);
            forward_dynamics_by_twist(pose, twist, torques, parameters);
        }
    };
}

of_pose!(Ankle, derived::ankle::Ankle);
of_pose!(DualV, derived::dualv::DualV);
compiled_backend! {
    Rx90, "compiled", derived::rx90::Rx90,
    inverse_dynamics_by_displacement(joints, joint_velocities, joint_accelerations, parameters);
    inverse_dynamics_by_twist(joints, joint_velocities, joint_accelerations, parameters);
    forward_dynamics_by_displacement(joints, joint_velocities, torques, parameters);
    forward_dynamics_by_twist(joints, joint_velocities, torques, parameters);
}

/// Compares the compiled functions of a robot with the reference.
fn compare(stem: &str, compiled: &dyn Backend) -> Result<(), Failure> {
    let robot = Robot::new(stem)?;
    let parameters = robot.expected.parameters();
    let all = samples(
        &robot.expected.mechanism,
        &parameters,
        by_tiers(STATES),
        47,
        false,
    )?;
    let own = robot.model.functions.iter();
    let own = own.filter(|own| own.computes.is_derivative());
    for function in own.filter(|own| !own.computes.is_of_base_parameters()) {
        let mut agreement = Agreement::new();
        for sample in &all {
            let truth = robot.expected.at(sample)?;
            let Ok(wanted) = truth.output(function.computes, function.from) else {
                continue;
            };
            agreement.compare(&compiled.call(&function.name, sample)?, &wanted);
        }
        let worst = agreement.matrix();
        assert!(
            !agreement.is_empty() && worst < TOLERANCE,
            "{}: {agreement}",
            function.name
        );
    }
    Ok(())
}

#[test]
fn compiled_derivatives_agree_for_a_skeleton_with_chains() -> Result<(), Failure> {
    compare("ankle", &Ankle)
}

#[test]
fn compiled_derivatives_agree_for_a_redundant_planar_platform() -> Result<(), Failure> {
    compare("dualv", &DualV)
}

#[test]
fn compiled_derivatives_agree_for_a_serial_robot() -> Result<(), Failure> {
    compare("rx90", &Rx90)
}

#[test]
fn single_precision_derivatives_agree_within_rounding() -> Result<(), Failure> {
    let (pose, rates, loads) = ([0.01_f64, -0.02, 0.03], [0.4, -0.6, 0.9], [1.5, -2.0, 0.7]);
    // Standard parameters, then those of the payload.
    let parameters: [f64; 68] = std::array::from_fn(|k| 1.0 + 0.1 * (k % 7) as f64);
    let short = |values: [f64; 3]| values.map(|x| x as f32);
    let long = derived::dualv::DualV::inverse_dynamics_by_displacement(
        &pose,
        &rates,
        &loads,
        &parameters,
    )?;
    let single = derived::dualv::Single::inverse_dynamics_by_displacement(
        &short(pose),
        &short(rates),
        &short(loads),
        &parameters.map(|x| x as f32),
    )?;
    let largest = long
        .iter()
        .flatten()
        .fold(0.0_f64, |most, x| most.max(x.abs()));
    for (long, single) in long.iter().flatten().zip(single.iter().flatten()) {
        assert!(
            (long - f64::from(*single)).abs() < SINGLE * largest,
            "{long} {single}"
        );
    }
    Ok(())
}
