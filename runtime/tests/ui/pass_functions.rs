//! Only some functions, in a crate that requires documentation, with derives of its own.
#![deny(warnings, missing_docs)]

use overact::redundant_robot;

#[redundant_robot("descriptions/capitals.toml", functions = ["inverse_dynamics", "kinematics"], effort = "none")]
#[derive(Debug, Hash)]
pub struct Mine;

/// All functions of a model.
pub mod model {
    #[overact::redundant_robot("descriptions/capitals.toml", functions = ["identification"])]
    pub struct Whole;
}

/// The facade, re-exported by another crate.
pub mod vendor {
    pub use ::overact as robots;
}

/// Functions of joints and base parameters only, without a crate called `overact`.
#[redundant_robot(
    "descriptions/five_bar.toml",
    functions = ["idm_red_platform", "inverse_dynamics"],
    from = ["joints", "pose"],
    columns = "base",
    crate = "crate::vendor::robots",
    effort = "none",
)]
pub struct Few;

/// Whether the functions exist, with errors from the other path.
pub fn few() -> Result<(), vendor::robots::Error> {
    let (pose, joints) = (Few::HOME_POSE, Few::HOME_JOINTS);
    let (rest, base) = ([0.0; Few::DOF], [1.0; Few::BASE_PARAMETERS.len()]);
    let from_pose = Few::idm_red_platform_base(&pose, &rest, &rest)?;
    let from_joints = Few::idm_red_platform_base_from_joints(&pose, &joints, &rest, &rest)?;
    assert_eq!(from_pose.len(), from_joints.len());
    Few::inverse_dynamics_base(&pose, &rest, &rest, &base)?;
    Ok(())
}

fn main() {
    few().unwrap();
    let pose = Mine::HOME_POSE;
    assert!(Mine::pose_from_actuators(&Mine::actuator_positions(&pose).unwrap(), &pose).is_ok());
    let copy = Mine;
    assert_eq!((Mine::default(), format!("{copy:?}")), (copy, "Mine".to_owned()));
    let model: &dyn overact::Model = &model::Whole;
    assert_eq!(model.info().sizes.pose, pose.len());
}
