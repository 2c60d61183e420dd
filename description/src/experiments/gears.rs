//! The switch for the identification of the friction of gears.

use crate::diagnostic::Code;
use crate::robot::{inventory::Inventory, model::Leg};
use crate::toml_text::reader::Item;

/// Why the friction of gears is not identified together with other corrections of the torques.
pub const GEARS_ALONE: &str = "the friction of gears is not identified together with gains of drives or the direction of gravity: all of them change the load torques";

/// Why the friction of gears is not identified for motors that turn several joints.
pub const GEARS_OF_COUPLED_MOTORS: &str = "the friction of gears is identified for drives of single joints: the torque that a gear of a coupled motor transmits is not that of a joint";

/// Reads `gear_friction`; `is_corrected` if gains or the direction of gravity are identified.
pub(crate) fn friction(item: &Item<'_, '_>, is_corrected: bool, robot: &Inventory<'_>) -> bool {
    if item.boolean() != Some(true) {
        return false;
    }
    let refuse = |why: &str, help: &str| {
        let error = item.error(Code::CONTRADICTION, why);
        item.context.report(error.help(help));
    };
    if is_corrected {
        let help = "identify gains or the direction of gravity first, write them into the description, then ask for `gear_friction`";
        refuse(GEARS_ALONE, help);
    }
    if robot.legs.iter().any(Leg::has_coupled_motors) {
        refuse(GEARS_OF_COUPLED_MOTORS, "leave out `gear_friction`");
    }
    true
}
