//! Derivatives of friction, springs and known torques, and of robots whose joints are iterated.

use super::agreement::compare;
use super::{Failure, Robot};
use overact::Function;
use overact_codegen::Source;
use overact_codegen::derivation::JointsBy;
use overact_tests::support::elements::{with_point_springs, with_springs};
use overact_tests::support::{description, repository};
use overact_tier::by_tier;

/// Robots that get springs on all joints and between bodies, in the default tier and in the full
/// one.
const ROBOTS: [&[&str]; 2] = [
    &["dualv"],
    &[
        "dualv",
        "excavator",
        "palletiser",
        "spatial_3prs",
        "spherical_3rrr",
        "rx90",
    ],
];

/// A description elsewhere in the repository.
fn described(path: &str) -> Result<Robot, Failure> {
    let text = std::fs::read_to_string(repository(path))?;
    Robot::of(path, &Source::new(path, text))
}

#[test]
fn all_kinds_of_friction_are_differentiated() -> Result<(), Failure> {
    for stem in ["friction_arm", "friction_bar"] {
        let robot = described(&format!("tests/compiled/friction/{stem}.toml"))?;
        compare(&robot, |_| true).map_err(|error| format!("{stem}: {error}"))?;
    }
    Ok(())
}

#[test]
fn springs_and_screws_are_differentiated() -> Result<(), Failure> {
    for stem in ["spring_bar", "screw_arm"] {
        let robot = described(&format!("tests/compiled/friction/{stem}.toml"))?;
        compare(&robot, |_| true).map_err(|error| format!("{stem}: {error}"))?;
    }
    Ok(())
}

/// Whether a function is a derivative of the torques. Large springs leave the reference's
/// accelerations too few digits for differences.
const fn is_of_torques(function: Function) -> bool {
    matches!(
        function,
        Function::InverseDynamicsByDisplacement(_) | Function::InverseDynamicsByTwist(_)
    )
}

#[test]
fn springs_on_all_joints_are_differentiated() -> Result<(), Failure> {
    for (seed, stem) in by_tier(ROBOTS).iter().enumerate() {
        let text = with_springs(&description(stem)?.text, seed as u64);
        let text = with_point_springs(&text, seed as u64, true)?;
        let robot = Robot::of(stem, &Source::new(*stem, text))?;
        compare(&robot, is_of_torques).map_err(|error| format!("{stem}: {error}"))?;
    }
    Ok(())
}

#[test]
fn joints_by_newtons_method_are_differentiated() -> Result<(), Failure> {
    let names = by_tier([&["newton_point"][..], &["newton_point", "newton_spatial"]]);
    for name in names {
        let robot = described(&format!("cli/tests/c/{name}.toml"))?;
        assert_eq!(robot.model.selection.joints, JointsBy::Newton);
        compare(&robot, |_| true).map_err(|error| format!("{name}: {error}"))?;
    }
    Ok(())
}
