//! Compiled Rust in 64 and 32 bits against the numeric reference, for robots of several kinds.

use super::{Failure, is_tested};
use overact_codegen::{Effort, Request, Source};
use overact_compiled::framed;
use overact_tests::compiled_backend;
use overact_tests::support::conversion::reference;
use overact_tests::support::expected::Expected;
use overact_tests::support::library::workspace;
use overact_tests::support::sample::samples;
use overact_tests::support::{Backend, Comparison, Evaluated, description, model_with};
use overact_tier::by_tiers;

/// Tolerances in 64 and 32 bits.
const TOLERANCES: [f64; 2] = [1e-9, 2e-4];
/// States of each robot in the default, full and nightly tier.
const STATES: [usize; 3] = [10, 40, 200];

/// Backends of a robot with a platform or a skeleton.
macro_rules! of_pose {
    ($double:ident, $robot:path) => {
        compiled_backend! {
            $double, "compiled", $robot,
            tool_pose(pose);
            tool_jacobian(pose);
            tool_velocity(pose, twist);
            tool_acceleration_bias(pose, twist);
            tool_torques(pose, wrench);
            link_pose(pose);
            link_jacobian(pose);
            link_velocity(pose, twist);
            link_acceleration_bias(pose, twist);
            link_torques(pose, wrench);
            total_mass(parameters);
            centre_of_mass(pose, parameters);
            centre_of_mass_jacobian(pose, parameters);
            kinetic_energy(pose, twist, parameters);
            potential_energy(pose, parameters);
        }
    };
}

of_pose!(Ankle, framed::ankle::Ankle);
of_pose!(Delta, framed::delta::Delta);
of_pose!(DualV, framed::dualv::DualV);
of_pose!(Hexapod, framed::hexapod::Hexapod);
compiled_backend! {
    Rx90, "compiled", framed::rx90::Rx90,
    tool_pose(joints);
    tool_jacobian(joints);
    tool_velocity(joints, joint_velocities);
    tool_acceleration_bias(joints, joint_velocities);
    tool_torques(joints, wrench);
    link_pose(joints);
    link_jacobian(joints);
    link_velocity(joints, joint_velocities);
    link_acceleration_bias(joints, joint_velocities);
    link_torques(joints, wrench);
    total_mass(parameters);
    centre_of_mass(joints, parameters);
    centre_of_mass_jacobian(joints, parameters);
    kinetic_energy(joints, joint_velocities, parameters);
    potential_energy(joints, parameters);
}

/// Compares the compiled functions of a robot and their programs with the reference.
fn compare(stem: &str, frames: &str, compiled: &dyn Backend) -> Result<(), Failure> {
    let Source { name, text } = description(stem)?;
    let source = Source::new(name, format!("{text}\n{frames}"));
    let request = Request {
        wanted: &|_, function, _| is_tested(function),
        ..Request::with_effort(Effort::Quick)
    };
    let model = model_with(&source, &request)?;
    let mechanism = reference(&model.mechanism, workspace(&model));
    let expected = Expected::by_position(&model, mechanism);
    let parameters = expected.parameters();
    let all = samples(
        &expected.mechanism,
        &parameters,
        by_tiers(STATES),
        41,
        false,
    )?;
    let truths = all.iter().map(|sample| expected.at(sample));
    let truths = truths.collect::<Result<Vec<_>, Failure>>()?;
    let mut comparison = Comparison::new(TOLERANCES[0]);
    for function in &model.functions {
        comparison.function(function, compiled, &all, &truths)?;
        comparison.function(function, &Evaluated(&model), &all, &truths)?;
    }
    assert_eq!(comparison.lines.len(), 30, "{:?}", comparison.lines);
    assert!(
        comparison.failures.is_empty(),
        "{stem}: {:?}",
        comparison.failures
    );
    Ok(())
}

#[test]
fn compiled_frames_agree_for_a_skeleton_with_chains() -> Result<(), Failure> {
    compare("ankle", framed::ankle::FRAMES, &Ankle)
}

#[test]
fn compiled_frames_agree_for_a_translational_platform() -> Result<(), Failure> {
    compare("delta", framed::delta::FRAMES, &Delta)
}

#[test]
fn compiled_frames_agree_for_a_redundant_planar_platform() -> Result<(), Failure> {
    compare("dualv", framed::dualv::FRAMES, &DualV)
}

#[test]
fn compiled_frames_agree_for_a_spatial_platform() -> Result<(), Failure> {
    compare("hexapod", framed::hexapod::FRAMES, &Hexapod)
}

#[test]
fn compiled_frames_agree_for_a_serial_robot() -> Result<(), Failure> {
    compare("rx90", framed::rx90::FRAMES, &Rx90)
}

/// Functions of the pose alone in 32 bits; other inputs are converted in the same way.
#[test]
fn single_precision_frames_agree_within_rounding() -> Result<(), Failure> {
    let joints = [0.3_f64, -0.7, 1.1, 0.4, -0.9, 0.2];
    let short = joints.map(|q| q as f32);
    let (long, short) = (
        framed::rx90::Rx90::tool_jacobian(&joints)?,
        framed::rx90::Single::tool_jacobian(&short)?,
    );
    for (long, short) in long.iter().flatten().zip(short.iter().flatten()) {
        assert!(
            (long - f64::from(*short)).abs() < TOLERANCES[1],
            "{long} {short}"
        );
    }
    let pose = [0.01_f64, -0.02, 0.03];
    let short = pose.map(|x| x as f32);
    let (long, short) = (
        framed::dualv::DualV::tool_pose(&pose)?,
        framed::dualv::Single::tool_pose(&short)?,
    );
    for (long, short) in long.iter().zip(short) {
        assert!(
            (long - f64::from(short)).abs() < TOLERANCES[1],
            "{long} {short}"
        );
    }
    Ok(())
}
