//! Evaluation of programs over blocks of samples, and errors of samples without a value.

use overact::{ActuatorGroup, Columns, Function};
use overact_codegen::CompiledFunction;
use overact_codegen::derivation::MotionInput;
use overact_codegen::internals::{random_states, sample};
use overact_codegen::interpreter::{BLOCK, Rows};
use overact_codegen::lowering::Condition;
use overact_compiled::DualV;
use overact_tests::reference::robots;
use overact_tests::support::backend::evaluate;
use overact_tests::support::expected::Expected;
use overact_tests::support::sample::samples;
use overact_tests::support::{Failure, Sample, dualv};

/// Three blocks and a part of one.
const STATES: usize = 3 * BLOCK + 8;

fn dualv_samples() -> Result<Vec<Sample>, Failure> {
    let expected = Expected::new(dualv()?, robots::dualv())?;
    samples(&robots::dualv(), &expected.parameters(), STATES, 81, true)
}

/// Evaluates all samples at once, with the parameters of the first.
fn at_once(function: &CompiledFunction, all: &[Sample]) -> Result<Vec<f64>, Failure> {
    let program = &function.program;
    let gather = |name: &str| -> Result<(Vec<f64>, bool), Failure> {
        if name == "parameters" {
            return Ok((all[0].parameters.clone(), true));
        }
        let mut values = Vec::new();
        for sample in all {
            values.extend(sample.argument(function.computes, name)?);
        }
        Ok((values, false))
    };
    let values = program.inputs.iter().map(|a| gather(&a.name));
    let values = values.collect::<Result<Vec<_>, _>>()?;
    let inputs: Vec<Rows<'_>> = values
        .iter()
        .map(|(values, shared)| Rows {
            values,
            shared: *shared,
        })
        .collect();
    let mut output = vec![f64::NAN; all.len() * program.output.len()];
    program
        .evaluate(all.len(), &inputs, &mut output)
        .map_err(|failed| format!("`{}`: {failed:?}", program.output.name))?;
    Ok(output)
}

#[test]
fn blocks_and_single_samples_give_equal_results() -> Result<(), Failure> {
    let model = dualv()?;
    let all = dualv_samples()?;
    for function in &model.functions {
        let together = at_once(function, &all)?;
        let parts = together.chunks(function.program.output.len());
        let mut worst = 0.0_f64;
        for (part, sample) in parts.zip(&all) {
            let single = evaluate(&function.program, &|name| match name {
                "parameters" => Some(&all[0].parameters),
                _ => sample.argument(function.computes, name).ok(),
            })?;
            let scale = single.iter().fold(0.0_f64, |m, x| m.max(x.abs()));
            for (a, b) in part.iter().zip(&single) {
                worst = worst.max((a - b).abs() / scale.max(f64::MIN_POSITIVE));
            }
        }
        // Sines and cosines of blocks are within two units in the last place of the library's.
        assert!(worst < 1e-12, "{}: {worst:e}", function.name);
    }
    Ok(())
}

#[test]
fn the_first_sample_out_of_reach_is_reported() -> Result<(), Failure> {
    let mut all = dualv_samples()?;
    for far in [BLOCK + 3, 2 * BLOCK] {
        all[far].state.pose[0] = 3.0;
    }
    let function = Function::IdmRedPlatform(Columns::Standard);
    let function = dualv()?
        .function(function, MotionInput::Pose)
        .ok_or("no function")?;
    let program = &function.program;
    let mut poses = Vec::new();
    let mut rates = Vec::new();
    for sample in &all {
        poses.extend(&sample.state.pose);
        rates.extend(sample.state.twist.iter());
    }
    let row = |values| Rows {
        values,
        shared: false,
    };
    let inputs = [row(&poses), row(&rates), row(&rates)];
    let mut output = vec![0.0; STATES * program.output.len()];
    let failed = program.evaluate(STATES, &inputs, &mut output);
    let failed = failed.err().ok_or("three metres are out of reach")?;
    assert_eq!(failed.sample, BLOCK + 3);
    let condition = &program.guards[failed.guard].condition;
    assert!(
        matches!(condition, Condition::Reach { .. }),
        "{condition:?}"
    );
    Ok(())
}

#[test]
fn samples_after_an_unreachable_state_are_ignored() -> Result<(), Failure> {
    let model = dualv()?;
    let function = Function::IdmRedPlatform(Columns::Standard);
    let function = model
        .function(function, MotionInput::Pose)
        .ok_or("no function")?;
    let [rows, columns] = function.program.output.shape[..] else {
        return Err("the regressor is a matrix".into());
    };
    let mut states = random_states(&model.mechanism, STATES, 82);
    let regular = sample(&function.program, &states, rows, columns);
    states[BLOCK + 3].pose[0] = 3.0;
    let found = sample(&function.program, &states, rows, columns);
    let valid = BLOCK * rows;
    assert_eq!(found.rows(0, valid), regular.rows(0, valid));
    assert!(found.rows_range(valid..).iter().all(|x| *x == 0.0));
    assert!(regular.rows_range(valid..).iter().any(|x| *x != 0.0));
    Ok(())
}

#[test]
fn compiled_functions_return_specific_errors() {
    use overact::Error;
    let still = [0.0; 3];
    let out_of_reach = DualV::joints(&[3.0, 0.0, 0.0]);
    assert!(
        matches!(out_of_reach, Err(Error::OutOfReach { .. })),
        "{out_of_reach:?}"
    );
    for pose in [
        [f64::NAN, 0.0, 0.0],
        [0.0, f64::INFINITY, 0.0],
        [0.0, 0.0, f64::NAN],
    ] {
        let found = DualV::idm_red_platform(&pose, &still, &still);
        assert!(found.is_err(), "{pose:?} gives {found:?}");
    }
    let far = DualV::pose_from_actuators(&[0.0, f64::NAN, 0.0, 0.0], &DualV::HOME_POSE);
    assert!(
        matches!(far, Err(Error::NotFinite { input: "actuators" })),
        "{far:?}"
    );
    // A stretched leg: joint 2 at zero.
    let mut joints = DualV::HOME_JOINTS;
    joints[1] = 0.0;
    let stretched = DualV::inverse_jacobian_from_joints(&DualV::HOME_POSE, &joints);
    assert!(
        matches!(stretched, Err(Error::SingularLeg { leg: "leg1", .. })),
        "{stretched:?}"
    );
}

#[test]
fn singular_partitions_fail_only_in_the_actuator_projection() {
    use overact::Error;
    // The robot is regular here, but the first three actuators alone are not; six digits give the
    // singularity to nine.
    let (mut low, mut high) = (-0.105_793, -0.105_791);
    let still = [0.0; 3];
    let kept = |phi: f64| -> f64 {
        let rows = DualV::inverse_jacobian(&[-0.10, 0.16, phi]).unwrap_or_default();
        nalgebra::Matrix3::from_fn(|r, c| rows[r][c]).determinant()
    };
    assert!(kept(low) * kept(high) < 0.0, "the singularity is bracketed");
    while high - low > 1e-16 {
        let middle = 0.5 * (low + high);
        if middle <= low || middle >= high {
            break;
        }
        if kept(low) * kept(middle) <= 0.0 {
            high = middle;
        } else {
            low = middle;
        }
    }
    let pose = [-0.10, 0.16, low];
    let found = DualV::idm_red_actuators(&pose, &still, &still);
    let expected = ActuatorGroup::Kept;
    assert!(
        matches!(found, Err(Error::SingularPlatform { actuators, .. }) if actuators == expected),
        "{found:?}"
    );
    assert!(DualV::idm_red_platform(&pose, &still, &still).is_ok());
}
