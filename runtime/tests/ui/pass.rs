//! A robot in a user's crate, with a name chosen by the user.

use overact::{Model, redundant_robot};

/// Two motors on one mass.
#[redundant_robot("descriptions/capitals.toml")]
#[derive(Debug, Clone, Copy)]
pub struct Mine;

fn main() -> Result<(), overact::Error> {
    let home = Mine::HOME_POSE;
    assert_eq!(Mine::actuator_positions(&home)?, Mine::HOME_JOINTS);
    assert_eq!(Mine.info().name, "Result");
    assert_eq!(Mine::ACTUATOR_NAMES, ["LeftLeg", "R"]);
    let regressor = Mine::idm_red_platform(&home, &[0.1], &[0.3])?;
    assert_eq!(regressor.len(), Mine::DOF);
    Ok(())
}
