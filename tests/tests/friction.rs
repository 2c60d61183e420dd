//! Robots with direction-dependent friction, Stribeck friction, springs and known torques agree with the
//! numeric reference.
//!
//! They are compiled and evaluated.

use overact::{Columns, Function, Model, StandardParameter};
use overact_codegen::derivation::BodyParameter;
use overact_codegen::{Effort, Request, RobotModel, Source};
use overact_compiled::friction::{
    ARM, BAR, FrictionArm, FrictionBar, MOTOR, MotorBar, SCREW, SPRING, ScrewArm, SpringBar,
};
use overact_tests::support::conversion::reference;
use overact_tests::support::expected::Expected;
use overact_tests::support::library::workspace;
use overact_tests::support::sample::samples;
use overact_tests::support::{Comparison, Evaluated, Failure, Served, model_with};
use overact_tier::{by_tier, by_tiers};

const TOLERANCE: f64 = 1e-9;
/// States in the default, full and nightly tier.
const STATES: [usize; 3] = [20, 60, 200];

fn described(text: &str) -> Result<(RobotModel, Expected), Failure> {
    let source = Source::new("friction.toml", text);
    let request = Request::with_effort(by_tier([Effort::None, Effort::Quick]));
    let model = model_with(&source, &request)?;
    let mechanism = reference(&model.mechanism, workspace(&model));
    let expected = Expected::by_position(&model, mechanism);
    Ok((model, expected))
}

/// Compares all functions, and reports the worst differences.
fn compare(text: &str, compiled: &dyn Model) -> Result<(), Failure> {
    let (model, expected) = described(text)?;
    let parameters = expected.parameters();
    let all = samples(&expected.mechanism, &parameters, by_tiers(STATES), 5, false)?;
    let truths = all.iter().map(|sample| expected.at(sample));
    let truths = truths.collect::<Result<Vec<_>, Failure>>()?;
    let mut comparison = Comparison::new(TOLERANCE);
    let evaluated = Evaluated(&model);
    for function in &model.functions {
        if function.computes != Function::ClosureError {
            comparison.function(function, &evaluated, &all, &truths)?;
        }
    }
    let served = Served(compiled);
    for function in Function::ALL {
        let own = model.served(function);
        if let Some(function) = own.filter(|f| f.computes != Function::ClosureError) {
            comparison.function(function, &served, &all, &truths)?;
        }
    }
    println!("{}", comparison.lines.join("\n"));
    assert!(
        comparison.failures.is_empty(),
        "{}",
        comparison.failures.join("\n")
    );
    Ok(())
}

#[test]
fn friction_agrees_for_a_coupled_joint_and_motor() -> Result<(), Failure> {
    compare(ARM, &FrictionArm)
}

#[test]
fn friction_agrees_for_passive_joints() -> Result<(), Failure> {
    compare(BAR, &FrictionBar)
}

#[test]
fn springs_and_known_torques_agree_for_a_five_bar() -> Result<(), Failure> {
    compare(SPRING, &SpringBar)
}

/// More motors than degrees of freedom, each of which turns joints of one leg or two.
#[test]
fn friction_agrees_for_coupled_motors() -> Result<(), Failure> {
    compare(MOTOR, &MotorBar)?;
    // Actuators from the positions of the joints, as an excitation or a calibration asks for them.
    let joints = [0.3, -0.7, 1.1, 0.4];
    let positions = [0.7, -0.4, 0.3 - 1.5 * 0.7];
    for (actuator, wanted) in positions.into_iter().enumerate() {
        let found = MotorBar.of_actuator(actuator, &joints);
        assert!((found - wanted).abs() < 1e-15, "{actuator}: {found}");
    }
    Ok(())
}

#[test]
fn friction_agrees_for_helical_joints() -> Result<(), Failure> {
    compare(SCREW, &ScrewArm)
}

/// Friction at rest is the mean of both directions, like an offset, and no division fails.
#[test]
fn friction_at_rest_is_finite() -> Result<(), Failure> {
    let (model, _) = described(ARM)?;
    let mut columns = vec![0.0; 3 * model.selection.standard.len()];
    let (joints, still) = ([0.1, 0.2, 0.3], [0.0; 3]);
    let function = Function::IdmRedPlatform(Columns::Standard);
    FrictionArm.evaluate(function, &[&joints, &still, &still], &mut columns)?;
    let of = |symbol: StandardParameter| {
        let parameter = BodyParameter::Leg {
            leg: 0,
            joint: 0,
            symbol,
        };
        let all = &model.selection.standard;
        let at = all.iter().position(|one| *one == parameter);
        at.map(|at| columns[at])
    };
    assert_eq!(of(StandardParameter::FsPos), Some(0.5));
    assert_eq!(of(StandardParameter::FsNeg), Some(-0.5));
    assert_eq!(of(StandardParameter::Fst), Some(0.0));
    assert_eq!(of(StandardParameter::FvPos), Some(0.0));
    Ok(())
}

/// A motor of one joint with direction-dependent friction like the joint's: duplicates are
/// regrouped.
#[test]
fn duplicate_friction_of_joint_and_motor_is_regrouped() -> Result<(), Failure> {
    let text = "name = \"Twice\"\n[[leg.arm.joint]]\ntype = \"revolute\"\nactuated = true\n\
                parameters = [\"zz\", \"fv\", \"fs\", \"off\"]\n\
                [[leg.arm.motor]]\nturns = \"q1\"\nparameters = [\"friction by direction\"]\n\
                [[place]]\nname = \"arm\"\nshape = \"arm\"\n";
    let (model, _) = described(text)?;
    let kept = model.base.iter().map(|base| model.base_name(base));
    let kept: Vec<String> = kept.collect();
    // 1, sign, velocity and speed, and the acceleration.
    assert_eq!(kept.len(), 5, "{kept:?}");
    let regrouped: usize = model.base.iter().map(|base| base.regrouped.len()).sum();
    assert!(regrouped >= 3, "{kept:?}");
    Ok(())
}
