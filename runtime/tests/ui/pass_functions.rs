//! Only some functions, in a crate that wants everything documented, with derives of its own.
#![deny(warnings, missing_docs)]

use overact::redundant_robot;

#[redundant_robot("descriptions/capitals.toml", functions = ["inverse_dynamics", "kinematics"], effort = "none")]
#[derive(Debug, Hash)]
pub struct Mine;

/// A model, by the functions that it is asked for.
pub mod model {
    #[overact::redundant_robot("descriptions/capitals.toml", functions = ["identification"])]
    pub struct Whole;
}

fn main() {
    let pose = Mine::HOME_POSE;
    assert!(Mine::pose_from_actuators(&Mine::actuator_positions(&pose).unwrap(), &pose).is_ok());
    let copy = Mine;
    assert_eq!((Mine::default(), format!("{copy:?}")), (copy, "Mine".to_owned()));
    let model: &dyn overact::Model = &model::Whole;
    assert_eq!(model.info().sizes.pose, pose.len());
}
