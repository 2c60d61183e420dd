//! The DualV's compiled functions compared with motion: finite differences, power balance, least
//! squares.
//!
//! None of these tests needs the reference's dynamics: derivatives come from positions, and energy
//! from positions and velocities.

use nalgebra::{DMatrix, DVector};
use overact::forward::TOLERANCE;
use overact::math::wrap_angle;
use overact_compiled::DualV;
use overact_tests::redundant_backend;
use overact_tests::reference::energy::total_energy;
use overact_tests::reference::linear::pseudo_inverse;
use overact_tests::reference::states::frictionless;
use overact_tests::reference::{Mechanism, State, robots, trajectory};
use overact_tests::support::expected::Expected;
use overact_tests::support::sample::samples;
use overact_tests::support::{Backend, Failure, Sample, dualv};
use overact_tier::by_tier;
use rand::{RngExt, SeedableRng};
use rand_pcg::Pcg64;

/// States in the default tier and in the full one.
const STATES: [usize; 2] = [40, 200];

redundant_backend!(Generated, "generated", DualV);

fn dualv_samples(seed: u64) -> Result<(Mechanism, Expected, Vec<Sample>), Failure> {
    let mechanism = robots::dualv();
    let expected = Expected::new(dualv()?, mechanism.clone())?;
    let all = samples(
        &mechanism,
        &expected.parameters(),
        by_tier(STATES),
        seed,
        false,
    )?;
    Ok((mechanism, expected, all))
}

/// Numbers as an array.
fn array<const N: usize>(values: &[f64]) -> Result<&[f64; N], Failure> {
    Ok(overact::block::array(values)?)
}

fn vector(function: &str, sample: &Sample) -> Result<DVector<f64>, Failure> {
    Ok(Generated.call(function, sample)?.column(0).into_owned())
}

#[test]
fn joint_rates_are_derivatives_of_joint_positions() -> Result<(), Failure> {
    let (mechanism, _, all) = dualv_samples(51)?;
    let mut worst = [0.0_f64; 2];
    for sample in &all {
        // Unwound around the sample's joints, from which the path stays within half a turn.
        let near = vector("joints", sample)?;
        let joints = |state: &State| {
            let pose = array(&state.pose).and_then(|pose| Ok(DualV::joints(pose)?));
            let found = pose.unwrap_or([f64::NAN; 12]);
            DVector::from_fn(12, |at, _| near[at] + wrap_angle(found[at] - near[at]))
        };
        let (first, second) = trajectory::derivatives(&mechanism, &sample.state, joints)?;
        let velocities = vector("joint_velocities", sample)?;
        let accelerations = vector("joint_accelerations", sample)?;
        worst[0] = worst[0].max((first - &velocities).amax() / velocities.amax());
        worst[1] = worst[1].max((second - &accelerations).amax() / accelerations.amax());
    }
    println!(
        "velocities {:.1e}, accelerations {:.1e}",
        worst[0], worst[1]
    );
    // Rounding of the joints over the step and its square, 1e-15 / 3e-4 and 1e-15 / 9e-8, plus an
    // error of order six.
    assert!(worst[0] < 1e-9, "velocities {:e}", worst[0]);
    assert!(worst[1] < 1e-7, "accelerations {:e}", worst[1]);
    Ok(())
}

#[test]
fn platform_motion_is_recovered_from_actuators() -> Result<(), Failure> {
    let (mechanism, _, all) = dualv_samples(52)?;
    let mut worst = 0.0_f64;
    for sample in &all {
        let state = &sample.state;
        let actuated = mechanism.actuated();
        let exact = Sample {
            actuator_velocities: state.qd.select_rows(&actuated).as_slice().to_vec(),
            actuator_accelerations: state.qdd.select_rows(&actuated).as_slice().to_vec(),
            ..sample.clone()
        };
        for (function, expected) in [
            ("twist_from_actuators", &state.twist),
            ("acceleration_from_actuators", &state.acceleration),
        ] {
            let found = vector(function, &exact)?;
            worst = worst.max((found - expected).amax() / expected.amax());
        }
    }
    assert!(worst < 1e-11, "{worst:e}");
    Ok(())
}

/// Frictionless parameters of the model and of the reference.
fn without_friction(
    mechanism: &Mechanism,
    expected: &Expected,
    sample: &Sample,
) -> (Sample, DVector<f64>) {
    let chi = frictionless(mechanism, &sample.all_parameters);
    let columns = expected.parameters();
    let parameters = columns.iter().map(|&at| chi[at]).collect();
    let sample = Sample {
        parameters,
        ..sample.clone()
    };
    (sample, chi)
}

#[test]
fn power_balance_holds() -> Result<(), Failure> {
    let (mechanism, expected, all) = dualv_samples(53)?;
    let mut worst = 0.0_f64;
    for sample in &all {
        let (sample, chi) = without_friction(&mechanism, &expected, sample);
        let energy =
            |state: &State| DVector::from_element(1, total_energy(&mechanism, state, &chi));
        let change = trajectory::derivatives(&mechanism, &sample.state, energy)?.0[0];
        let torques = vector("inverse_dynamics", &sample)?;
        let rates = Generated.call("inverse_jacobian", &sample)? * &sample.state.twist;
        let powers = torques.component_mul(&rates.column(0));
        let scale = powers.abs().sum().max(change.abs());
        worst = worst.max((powers.sum() - change).abs() / scale);
    }
    println!("power {worst:.1e}");
    assert!(worst < 1e-8, "{worst:e}");
    Ok(())
}

#[test]
fn mass_matrix_and_bias_sum_to_the_inverse_dynamics() -> Result<(), Failure> {
    let (_, _, all) = dualv_samples(54)?;
    let mut worst = [0.0_f64; 3];
    for sample in &all {
        let mass = Generated.call("mass_matrix", sample)?;
        let inputs = &mass * &sample.state.acceleration + vector("bias", sample)?;
        let torques =
            DMatrix::from_column_slice(4, 1, vector("inverse_dynamics", sample)?.as_slice());
        let jacobian = Generated.call("inverse_jacobian", sample)?;
        let projected = jacobian.transpose() * &torques;
        let regressor = Generated.call("idm_red_platform", sample)?;
        let payload = Generated.call("idm_red_payload", sample)?;
        let (own, load) = sample.parameters.split_at(regressor.ncols());
        let linear = regressor * DVector::from_column_slice(own)
            + payload * DVector::from_column_slice(load);
        let relative = |a: f64| a / inputs.amax();
        worst[0] = worst[0].max(relative((projected.column(0) - &inputs).amax()));
        worst[1] = worst[1].max(relative((linear - &inputs).amax()));
        worst[2] = worst[2].max((&mass - mass.transpose()).amax() / mass.amax());
        assert!(mass.symmetric_eigenvalues().min() > 0.0, "{mass}");
    }
    assert!(worst.iter().all(|w| *w < 1e-11), "{worst:?}");
    Ok(())
}

#[test]
fn forward_kinematics_returns_to_the_pose() -> Result<(), Failure> {
    let (_, _, all) = dualv_samples(55)?;
    let mut worst = 0.0_f64;
    for sample in &all {
        let exact = DualV::actuator_positions(array(&sample.state.pose)?)?;
        // Full turns of an encoder must not matter.
        for turn in [0.0, std::f64::consts::TAU] {
            let found =
                DualV::pose_from_actuators(&exact.map(|q| q + turn), array(&sample.start)?)?;
            for (found, expected) in found.iter().zip(&sample.state.pose) {
                worst = worst.max((found - expected).abs());
            }
        }
    }
    assert!(worst < 1e-12, "{worst:e}");
    Ok(())
}

#[test]
fn noisy_actuators_give_the_least_squares_pose() -> Result<(), Failure> {
    let (_, _, all) = dualv_samples(56)?;
    let mut generator = Pcg64::seed_from_u64(57);
    let mut worst = 0.0_f64;
    for sample in &all {
        let noisy = DualV::actuator_positions(array(&sample.state.pose)?)?
            .map(|q| q + 1e-3 * generator.random_range(-1.0..1.0));
        let pose = DualV::pose_from_actuators(&noisy, array(&sample.start)?)?;
        let (q, jacobian) = (
            DualV::actuator_positions(&pose)?,
            DualV::inverse_jacobian(&pose)?,
        );
        let residual = DVector::from_fn(4, |at, _| wrap_angle(noisy[at] - q[at]));
        let jacobian = DMatrix::from_fn(4, 3, |row, column| jacobian[row][column]);
        assert!(
            residual.amax() > 0.0,
            "four noisy angles fit no pose exactly"
        );
        // The gradient Jᵀ r vanishes where the next Gauss-Newton step J^+ r does. The iteration
        // ends with a step below its tolerance, and steps shrink fast.
        let step = pseudo_inverse(&jacobian) * &residual;
        worst = worst.max(step.amax());
    }
    println!("remaining step {worst:.1e}");
    assert!(worst < TOLERANCE, "{worst:e}");
    Ok(())
}

#[test]
fn null_space_torques_do_not_move_the_robot() -> Result<(), Failure> {
    let (_, _, all) = dualv_samples(58)?;
    let mut worst = [0.0_f64; 3];
    for sample in &all {
        let jacobian = Generated.call("inverse_jacobian", sample)?;
        let basis = Generated.call("null_space", sample)?;
        let torques = DVector::from_column_slice(&sample.torques);
        let kept = &torques - &basis * (basis.transpose() * &torques);
        let gram = basis.transpose() * &basis - DMatrix::identity(1, 1);
        worst[0] = worst[0].max((jacobian.transpose() * &basis).amax() / jacobian.amax());
        worst[1] = worst[1].max(gram.amax());
        let projected = vector("project_torques", sample)?;
        worst[2] = worst[2].max((projected - kept).amax() / torques.amax());
    }
    assert!(worst.iter().all(|w| *w < 1e-12), "{worst:?}");
    Ok(())
}
