//! Every function of the DualV agrees with the numeric reference, evaluated and compiled.
//!
//! The reference is exact to rounding times the condition numbers of its states, at most 60; the
//! tolerance of 1e-10 has a margin.

use overact::Function;
use overact_codegen::{Effort, Request, model_with};
use overact_compiled::partitions;
use overact_tests::redundant_backend;
use overact_tests::reference::Mechanism;
use overact_tests::reference::robots;
use overact_tests::support::agreement::unwound;
use overact_tests::support::expected::{Expected, with_joints_of_model};
use overact_tests::support::sample::samples;
use overact_tests::support::{Agreement, Backend, Evaluated, Failure, Sample, dualv};
use overact_tier::{by_tier, by_tiers};

const TOLERANCE: f64 = 1e-10;
/// States in the default, full and nightly tier.
const STATES: [usize; 3] = [6, 60, 200];

redundant_backend!(Generated, "generated", overact_compiled::DualV);
redundant_backend!(Kept123, "compiled 123", partitions::kept_123::DualV);
redundant_backend!(Kept124, "compiled 124", partitions::kept_124::DualV);
redundant_backend!(Kept134, "compiled 134", partitions::kept_134::DualV);
redundant_backend!(Kept234, "compiled 234", partitions::kept_234::DualV);

/// Whether a function depends on the partition of the actuators.
fn is_partitioned(function: Function) -> bool {
    matches!(
        function,
        Function::IdmRedActuators(_)
            | Function::IdmRedPayloadActuators
            | Function::ProjectActuators
            | Function::InverseDynamicsPreloaded
            | Function::NullSpace
    )
}

/// Compares all functions of the families; joints may differ by full turns.
fn agree(
    mechanism: &Mechanism,
    kept: &[usize],
    backend: Option<&dyn Backend>,
    partitions: bool,
    is_chosen: impl Fn(Function) -> bool + Sync,
) -> Result<(), Failure> {
    let mut robot = dualv()?.mechanism.clone();
    robot.kept_actuators = kept.to_vec();
    let request = Request {
        wanted: &|_, function, _| is_chosen(function),
        // The compiled robots test the search.
        ..Request::with_effort(by_tier([Effort::None, Effort::Quick]))
    };
    let model = model_with(robot, &request).map_err(|e| format!("{e:?}"))?;
    let evaluated = Evaluated(&model);
    let expected = Expected::new(&model, mechanism.clone())?;
    let all = samples(
        mechanism,
        &expected.parameters(),
        by_tiers(STATES),
        41,
        partitions,
    )?;
    let mut backends: Vec<&dyn Backend> = vec![&evaluated];
    backends.extend(backend);
    let mut failures = Vec::new();
    for function in model.functions.iter().filter(|f| is_chosen(f.computes)) {
        let mut found = vec![Agreement::new(); backends.len()];
        for sample in &all {
            let wanted = expected.output(function.computes, function.from, sample)?;
            for (backend, agreement) in backends.iter().zip(&mut found) {
                let mut output = backend.call(&function.name, sample)?;
                if matches!(
                    function.computes,
                    Function::Joints | Function::ActuatorPositions
                ) {
                    output.zip_apply(&wanted, |q, wanted| *q = unwound(*q, wanted));
                }
                agreement.compare(&output, &wanted);
            }
        }
        for (backend, agreement) in backends.iter().zip(&found) {
            let line = format!("{} ({}): {agreement}", function.name, backend.label());
            println!("{line}");
            if !agreement.within(TOLERANCE) {
                failures.push(line);
            }
        }
    }
    assert!(failures.is_empty(), "{}", failures.join("\n"));
    Ok(())
}

fn case_1(is_chosen: impl Fn(Function) -> bool + Sync) -> Result<(), Failure> {
    let chosen = |function| is_chosen(function) && !is_partitioned(function);
    agree(
        &robots::dualv(),
        &[0, 1, 2],
        Some(&Generated),
        false,
        chosen,
    )
}

#[test]
fn kinematics_and_jacobians_agree() -> Result<(), Failure> {
    case_1(|function| {
        matches!(
            function,
            Function::Joints
                | Function::ActuatorPositions
                | Function::InverseJacobian
                | Function::Jacobian
                | Function::ClosurePlatformJacobian
                | Function::ClosureActuatorJacobian
                | Function::LegsJacobian
                | Function::LegsPlatformJacobian
        )
    })
}

#[test]
fn joint_and_platform_rates_agree() -> Result<(), Failure> {
    case_1(|function| {
        matches!(
            function,
            Function::JointVelocities
                | Function::JointAccelerations
                | Function::TwistFromActuators
                | Function::AccelerationFromActuators
        )
    })
}

#[test]
fn case_1_regressors_agree() -> Result<(), Failure> {
    case_1(|function| {
        matches!(
            function,
            Function::IdmRedPlatform(_) | Function::IdmRedPayload
        )
    })
}

#[test]
fn inverse_and_forward_dynamics_agree() -> Result<(), Failure> {
    case_1(|function| {
        matches!(
            function,
            Function::ProjectPlatform
                | Function::InverseDynamics(_)
                | Function::MassMatrix(_)
                | Function::Bias(_)
                | Function::ForwardDynamics(_)
                | Function::ProjectTorques
        )
    })
}

#[test]
fn generated_partition_agrees() -> Result<(), Failure> {
    agree(
        &robots::dualv(),
        &[0, 1, 2],
        Some(&Generated),
        true,
        is_partitioned,
    )
}

#[test]
fn every_partition_agrees() -> Result<(), Failure> {
    let partitions: [([usize; 3], &dyn Backend); 4] = [
        ([0, 1, 2], &Kept123),
        ([0, 1, 3], &Kept124),
        ([0, 2, 3], &Kept134),
        ([1, 2, 3], &Kept234),
    ];
    for (kept, backend) in partitions {
        println!("kept {kept:?}");
        agree(&robots::dualv(), &kept, Some(backend), true, is_partitioned)?;
    }
    Ok(())
}

#[test]
fn the_reference_covers_all_functions() -> Result<(), Failure> {
    let model = dualv()?;
    let expected = Expected::new(model, robots::dualv())?;
    let all: Vec<Sample> = samples(&robots::dualv(), &expected.parameters(), 1, 41, true)?;
    for function in &model.functions {
        for backend in [&Evaluated(model) as &dyn Backend, &Generated, &Kept123] {
            backend.call(&function.name, &all[0])?;
        }
        expected.output(function.computes, function.from, &all[0])?;
    }
    Ok(())
}

#[test]
fn model_joints_equal_those_of_the_reference() -> Result<(), Failure> {
    let mechanism = robots::dualv();
    let expected = Expected::new(dualv()?, mechanism.clone())?;
    for sample in samples(
        &mechanism,
        &expected.parameters(),
        by_tiers(STATES),
        43,
        false,
    )? {
        let joints = Generated.call("joints", &sample)?;
        let state = with_joints_of_model(&mechanism, &sample.state, joints.as_slice(), TOLERANCE)?;
        let gap = (&state.q - joints.column(0)).amax();
        assert!(gap < TOLERANCE, "{gap:e}");
    }
    Ok(())
}
