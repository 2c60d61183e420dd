//! Skeletons with dependent joints agree with the numeric reference in all functions.
//!
//! The reference cuts every loop, keeps all joints of the tree free and closes the cuts by Lagrange
//! multipliers.

use overact::Function;
use overact_codegen::derivation::MotionInput;
use overact_codegen::interpreter::{Failed, Rows};
use overact_codegen::{Choice, Effort, Request, RobotModel, Source};
use overact_tests::support::all_functions::{against_reference, of_functions};
use overact_tests::support::dependent::{branch, equipped, rigid, slider, spatial, stephenson};
use overact_tests::support::{Failure, model_with};
use overact_tier::by_tiers;

const TOLERANCE: f64 = 1e-9;
/// Tolerance of functions of base parameters of the robot in space, whose regroupings are computed
/// numerically.
const OF_BASE: f64 = 1e-6;
/// Tolerance of derivatives, which the reference computes by differences.
const OF_DERIVATIVES: f64 = 1e-7;
/// States of each robot in the default, full and nightly tier.
const STATES: [usize; 3] = [3, 20, 60];

/// Compares all functions of a description with the reference.
fn compare(text: String, of_base: f64) -> Result<(), Failure> {
    let source = Source::new("dependent.toml", text);
    let failures = against_reference(source, by_tiers(STATES), [of_base, TOLERANCE])?;
    assert!(failures.is_empty(), "{}", failures.join("\n"));
    Ok(())
}

#[test]
fn stephensons_six_bar_agrees() -> Result<(), Failure> {
    compare(stephenson(""), TOLERANCE)
}

#[test]
fn a_redundant_motor_on_a_rod_agrees() -> Result<(), Failure> {
    compare(stephenson("actuated = true"), TOLERANCE)
}

#[test]
fn a_dependent_slide_agrees() -> Result<(), Failure> {
    compare(slider(), TOLERANCE)
}

#[test]
fn a_rigid_end_that_blocks_agrees() -> Result<(), Failure> {
    compare(rigid(), TOLERANCE)
}

#[test]
fn a_dependent_branch_on_a_chain_agrees() -> Result<(), Failure> {
    compare(branch(), TOLERANCE)
}

#[test]
fn a_link_on_three_rods_in_space_agrees() -> Result<(), Failure> {
    compare(spatial(), OF_BASE)
}

#[test]
fn springs_payload_frames_and_motors_agree() -> Result<(), Failure> {
    compare(equipped(), TOLERANCE)
}

/// Derivatives of the dynamics agree with differences of the reference.
#[test]
fn derivatives_agree() -> Result<(), Failure> {
    let names = [
        "inverse_dynamics_by_displacement",
        "inverse_dynamics_by_twist",
        "forward_dynamics_by_displacement",
        "forward_dynamics_by_twist",
        "mass_matrix",
        "joints",
    ];
    let choice = Choice::new(names).map_err(|unknown| format!("{unknown:?}"))?;
    let robots = [
        ("stephenson", stephenson("")),
        ("slider", slider()),
        ("rigid", rigid()),
        ("branch", branch()),
        ("spatial", spatial()),
    ];
    let mut all = Vec::new();
    for (name, text) in robots {
        let source = Source::new("dependent.toml", text);
        let tolerances = [OF_DERIVATIVES; 2];
        match of_functions(source, by_tiers(STATES), tolerances, Some(&choice)) {
            Ok(failures) => all.extend(failures.into_iter().map(|line| format!("{name}: {line}"))),
            Err(error) => all.push(format!("{name}: {error}")),
        }
    }
    assert!(all.is_empty(), "{}", all.join("\n"));
    Ok(())
}

/// Whole-robot model of a description with all functions.
fn model(text: String) -> Result<RobotModel, Failure> {
    let source = Source::new("dependent.toml", text);
    model_with(&source, &Request::with_effort(Effort::None))
}

/// Value of a function of the pose, by interpretation.
fn of_pose(model: &RobotModel, function: Function, pose: &[f64]) -> Result<Vec<f64>, Failed> {
    let compiled = model.function(function, MotionInput::Pose);
    let program = &compiled.expect("a function of the robot").program;
    let shape: usize = program.output.shape.iter().product();
    let mut output = vec![0.0; shape];
    let given = [Rows {
        values: pose,
        shared: false,
    }];
    program.evaluate(1, &given, &mut output).map(|()| output)
}

/// `pose_error_jacobian` is the derivative of `pose_error`, and `pose_jacobian` its null space.
#[test]
fn pose_errors_vanish_along_the_allowed_motion() -> Result<(), Failure> {
    for text in [stephenson(""), slider(), rigid(), branch(), spatial()] {
        let model = model(text)?;
        let home = &model.mechanism.home.pose;
        let (pose, dof) = (home.len(), model.mechanism.dof());
        let ask = |function, pose: &[f64]| {
            of_pose(&model, function, pose).map_err(|failed| format!("{failed:?}"))
        };
        let errors = ask(Function::PoseError, home)?;
        assert!(errors.iter().all(|error| error.abs() < 1e-12), "{errors:?}");
        let rows = ask(Function::PoseErrorJacobian, home)?;
        let allowed = ask(Function::PoseJacobian, home)?;
        const STEP: f64 = 1e-5;
        for (at, row) in rows.chunks(pose).enumerate() {
            for joint in 0..pose {
                let moved = |step: f64| -> Result<f64, Failure> {
                    let mut moved = home.clone();
                    moved[joint] += step;
                    Ok(ask(Function::PoseError, &moved)?[at])
                };
                let change = (moved(STEP)? - moved(-STEP)?) / (2.0 * STEP);
                let (size, missed) = (row[joint].abs(), (change - row[joint]).abs());
                assert!(
                    missed < 1e-8 * (1.0 + size),
                    "{change} against {}",
                    row[joint]
                );
            }
            for column in 0..dof {
                let along: f64 = (0..pose).map(|k| row[k] * allowed[k * dof + column]).sum();
                assert!(along.abs() < 1e-12, "{along}");
            }
        }
    }
    Ok(())
}

/// Functions of the pose refuse one that the chains do not allow, and name the chain.
#[test]
fn poses_that_chains_do_not_allow_are_refused() -> Result<(), Failure> {
    let model = model(stephenson(""))?;
    let mut pose = model.mechanism.home.pose.clone();
    assert!(of_pose(&model, Function::Joints, &pose).is_ok());
    pose[2] += 0.01;
    let failed = of_pose(&model, Function::Joints, &pose).expect_err("a pose off the closure");
    let program = &model.function(Function::Joints, MotionInput::Pose);
    let guard = &program.expect("a function of the robot").program.guards[failed.guard];
    let condition = format!("{:?}", guard.condition);
    let names_a_rod = condition.contains("inner") || condition.contains("outer");
    assert!(condition.contains("Closed") && names_a_rod, "{condition}");
    Ok(())
}

/// The given positions of independent joints stay; rounded positions of the others are corrected.
#[test]
fn rounded_homes_close() -> Result<(), Failure> {
    let home = model(stephenson(""))?.mechanism.home;
    assert_eq!(home.pose[0], 75.0_f64.to_radians());
    let given = [-57.0_f64, -29.0].map(f64::to_radians);
    let moved = home.pose[1..]
        .iter()
        .zip(given)
        .map(|(pose, given)| (pose - given).abs());
    let moved: Vec<f64> = moved.collect();
    assert!(
        moved.iter().all(|moved| (1e-5..0.1).contains(moved)),
        "{moved:?}"
    );
    Ok(())
}

/// The diagnosis of a wrong description.
fn diagnosis(text: String) -> String {
    match model(text) {
        Ok(_) => "no error".to_owned(),
        Err(error) => error.to_string(),
    }
}

#[test]
fn wrong_numbers_of_dependent_joints_are_explained() {
    let text = stephenson("").replacen("dependent = true", "actuated = true", 1);
    let wanted = [
        "1 joint is dependent, but the chains determine 2 of the 3 joints",
        "write `dependent = true` at ",
    ];
    let found = diagnosis(text);
    assert!(wanted.iter().all(|words| found.contains(words)), "{found}");
    let tip = "[[leg.outer.joint]]\nname = \"tip\"";
    let knee = "[[leg.outer.joint]]\nname = \"knee\"\ntype = \"revolute\"\nd = 0.06\n";
    let text = stephenson("").replace(tip, &format!("{knee}{tip}"));
    let found = diagnosis(text);
    let wanted = "2 joints are dependent, but the chains determine 1 of the 3 joints";
    assert!(found.contains(wanted), "{found}");
}

#[test]
fn joints_that_the_chains_do_not_determine_are_explained() {
    // The slide of a crank whose rod is perpendicular to it.
    let text = slider()
        .replace("at = [0.3, 0, 0.1]", "at = [0.25, 0, -0.2]")
        .replace("crank = \"40 deg\", slide = 0.2", "crank = 0, slide = 0.2")
        .replace("pin = \"100 deg\"", "pin = \"180 deg\"")
        .replace("at = [0.02, 0, 0.03]", "at = [0, 0, 0]")
        .replace("d = \"0.3 m\"", "d = \"0.2 m\"");
    let found = diagnosis(text);
    let wanted = "the chains do not determine the dependent joints at home";
    assert!(found.contains(wanted), "{found}");
}

/// A chain with too few joints names the key.
#[test]
fn blocking_chains_without_dependent_joints_name_the_key() {
    let text = stephenson("").replace("dependent = true", "actuated = true");
    let found = diagnosis(text);
    assert!(
        found.contains("mark these with `dependent = true`"),
        "{found}"
    );
}
