//! The switch for the identification of Stribeck velocities.

use crate::diagnostic::Code;
use crate::robot::{
    inventory::Inventory,
    model::{Leg, Motor},
};
use crate::toml_text::reader::Item;

/// Why Stribeck velocities are not identified together with corrections of the torques.
pub const STRIBECK_ALONE: &str = "Stribeck velocities are not identified together with gains of drives, the friction of gears or the direction of gravity";

/// Why no Stribeck velocity is identified.
pub const NO_STRIBECK: &str =
    "no joint or motor has Stribeck friction, whose velocity is to be identified";

/// Whether a joint or motor has Stribeck friction.
pub(crate) fn is_present(legs: &[Leg], motors: &[Motor]) -> bool {
    let mut joints = legs.iter().flat_map(|leg| &leg.joints);
    let mut motors = motors.iter();
    joints.any(|joint| joint.stribeck.is_some()) || motors.any(|motor| motor.stribeck.is_some())
}

/// Reads `stribeck_velocity`; `is_corrected` if another correction is identified.
pub(crate) fn velocity(item: &Item<'_, '_>, is_corrected: bool, robot: &Inventory<'_>) -> bool {
    if item.boolean() != Some(true) {
        return false;
    }
    let refuse = |why: &str, help: &str| {
        let error = item.error(Code::CONTRADICTION, why);
        item.context.report(error.help(help));
    };
    if is_corrected {
        let help = "identify the other quantities first, write them into the description, then ask for `stribeck_velocity`";
        refuse(STRIBECK_ALONE, help);
    }
    if !is_present(robot.legs, robot.motors) {
        let help = "give a joint the key `stribeck`, from whose velocity the search starts";
        refuse(NO_STRIBECK, help);
    }
    true
}
