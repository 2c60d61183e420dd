//! Every robot of `robots/` agrees with the numeric reference: motion, Jacobians, both identification
//! models, inverse dynamics.
//!
//! The tolerance is that of the reference's states: rounding times condition numbers of up to 60, and
//! for Newton's inverse kinematics its own 1e-13.

use overact_codegen::derivation::{Columns, Family, From};
use overact_codegen::mechanism::TwistCoordinate;
use overact_tests::support::conversion::reference;
use overact_tests::support::expected::Expected;
use overact_tests::support::sample::samples;
use overact_tests::support::{
    Agreement, Backend, Evaluated, Failure, description, model_of, repository,
};

const TOLERANCE: f64 = 1e-9;
const STATES: usize = 20;

/// The functions that are compared, from joint positions.
const FAMILIES: [Family; 6] = [
    Family::InverseJacobian,
    Family::JointVelocities,
    Family::JointAccelerations,
    Family::IdmRedPlatform(Columns::Standard),
    Family::IdmRedPlatform(Columns::Base),
    Family::InverseDynamics,
];

fn robots() -> Result<Vec<String>, Failure> {
    let mut stems = Vec::new();
    for entry in std::fs::read_dir(repository("robots"))? {
        let path = entry?.path();
        if path.extension().is_some_and(|e| e == "toml") {
            let stem = path.file_stem().map(|s| s.to_string_lossy().into_owned());
            stems.extend(stem);
        }
    }
    stems.sort();
    Ok(stems)
}

fn compare(stem: &str) -> Result<Vec<String>, Failure> {
    let model = model_of(&description(stem)?)?;
    let Some(platform) = &model.mechanism.platform else {
        return Ok(Vec::new());
    };
    let reach = |c: &TwistCoordinate| match c {
        TwistCoordinate::Linear(_) => 0.1 * model.mechanism.length_scale(),
        TwistCoordinate::Angular(_) => 0.2,
    };
    let workspace = platform.motion.twist().iter().map(reach).collect();
    let expected = Expected::by_position(&model, reference(&model.mechanism, workspace)?);
    let all = samples(
        &expected.mechanism,
        &expected.parameters(),
        STATES,
        7,
        false,
    )?;
    let evaluated = Evaluated(&model);
    let mut failures = Vec::new();
    let compared =
        |f: &&overact_codegen::Function| FAMILIES.contains(&f.family) && f.from != From::Actuators;
    for function in model.functions.iter().filter(compared) {
        let mut agreement = Agreement::new();
        for sample in &all {
            let wanted = expected.output(function.family, function.from, sample)?;
            agreement.compare(&evaluated.call(&function.name, sample)?, &wanted);
        }
        let line = format!("{stem}: {}: {agreement}", function.name);
        println!("{line}");
        if !agreement.within(TOLERANCE) {
            failures.push(line);
        }
    }
    Ok(failures)
}

#[test]
fn every_robot_of_the_library_agrees() -> Result<(), Failure> {
    let mut failures = Vec::new();
    for stem in robots()? {
        match compare(&stem) {
            Ok(found) => failures.extend(found),
            Err(error) => failures.push(format!("{stem}: {error}")),
        }
    }
    assert!(failures.is_empty(), "{}", failures.join("\n"));
    Ok(())
}
