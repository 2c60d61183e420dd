//! A robot in a user's crate, under a name of the user's choice.

use overact::{Model, redundant_robot};

/// A five-bar.
#[redundant_robot("descriptions/five_bar.toml")]
#[derive(Debug, Clone, Copy)]
pub struct Mine;

fn main() -> Result<(), overact::Error> {
    let q = Mine::actuator_positions(&Mine::HOME_POSE)?;
    let pose = Mine::pose_from_actuators(&q, &[0.01, 0.31])?;
    for (found, home) in pose.iter().zip(Mine::HOME_POSE) {
        assert!((found - home).abs() < 1e-12);
    }
    assert_eq!(Mine.info().name, "FiveBar");
    assert_eq!(Mine::ACTUATOR_NAMES, ["left", "right"]);
    let regressor = Mine::idm_red_platform(&pose, &[0.1, 0.2], &[0.3, 0.4])?;
    assert_eq!(regressor.len(), Mine::DOF);
    Ok(())
}
