//! The switch for the identification of the direction of gravity.

use crate::diagnostic::Code;
use crate::toml_text::reader::Item;
use overact_exact::Number;

/// Why gains and the direction of gravity are not identified together.
pub const GAINS_AND_GRAVITY: &str = "gains of drives and the direction of gravity are not identified together: tilt and gain have the same effect on a torque";

/// Reads `gravity_direction`, which requires nonzero gravity.
pub(crate) fn direction(item: &Item<'_, '_>, gains: bool, gravity: &[Number; 3]) -> bool {
    if item.boolean() != Some(true) {
        return false;
    }
    if gains {
        let help = "identify the gains first, put them into `torque_gain` of [data], then ask for the direction";
        item.context.report(
            item.error(Code::CONTRADICTION, GAINS_AND_GRAVITY)
                .help(help),
        );
    }
    if gravity.iter().all(|one| one.is_zero()) {
        let error = item.error(
            Code::CONTRADICTION,
            "gravity is zero in this description, so it has no direction",
        );
        let help = "set `gravity` to its magnitude and approximate direction, or leave out `gravity_direction`";
        item.context.report(error.help(help));
    }
    true
}
