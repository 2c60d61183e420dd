//! Dimensions of the factors from columns of a log to positions and torques.

use crate::diagnostic::{Code, Diagnostic};
use crate::expressions::dimension::Dimension;
use crate::robot::inventory::Inventory;
use crate::robot::model::JointKind;
use crate::toml_text::reader::{Item, Table};

/// Dimensions of signals that sensors and drives return: counts, voltages and currents first.
const SIGNALS: [Dimension; 8] = [
    Dimension::NONE,
    Dimension::VOLTAGE,
    Dimension::CURRENT,
    Dimension::ANGLE,
    Dimension::LENGTH,
    Dimension::TORQUE,
    Dimension::FORCE,
    Dimension::PRESSURE,
];

/// Number of signals without a force, which convert to a torque or force by a gain alone.
const ELECTRICAL: usize = 3;

/// Reports factors whose dimension makes no position, torque or force of any signal.
///
/// `is_of_motors` for a log of motors, whose gears may change the dimensions.
pub(crate) fn check(table: &Table<'_, '_>, robot: &Inventory<'_>, is_of_motors: bool) {
    let kinds = robot.actuator_kinds();
    for key in ["position_scale", "torque_gain"] {
        let Some(item) = table.get(key) else {
            continue;
        };
        let list = if item.value.is_array() {
            item.list().unwrap_or_default()
        } else {
            vec![item.clone(); kinds.len()]
        };
        for (item, kind) in list.iter().zip(&kinds) {
            let Some(dimension) = dimension(item, robot) else {
                continue;
            };
            let factor = Factor {
                item,
                dimension,
                slides: *kind == JointKind::Prismatic,
                is_of_motors,
            };
            let error = match key {
                "position_scale" => factor.wrong_position(),
                _ => factor.wrong_torque(),
            };
            if let Some(error) = error {
                table.context.report_once(error);
            }
        }
    }
}

/// Dimension of a factor; `None` for the name of a variable, and after an error.
fn dimension(item: &Item<'_, '_>, robot: &Inventory<'_>) -> Option<Dimension> {
    let text = item.value.as_str().unwrap_or_default().trim();
    if crate::toml_text::scope::is_word(text) {
        return None;
    }
    Some(item.evaluate(robot.scope)?.dimension)
}

/// Whether a factor makes a quantity of one of these signals.
fn makes(dimension: Dimension, quantity: Dimension, signals: &[Dimension]) -> bool {
    let mut signals = signals.iter();
    signals.any(|signal| {
        let from = signal.power(-1).and_then(|inverse| quantity.times(inverse));
        from.is_some_and(|from| dimension.fits(from))
    })
}

/// A factor of one column.
struct Factor<'i, 'c, 't> {
    item: &'i Item<'c, 't>,
    dimension: Dimension,
    /// Whether the joint is prismatic.
    slides: bool,
    is_of_motors: bool,
}

impl Factor<'_, '_, '_> {
    fn wrong_position(&self) -> Option<Diagnostic> {
        let own = self.own(Dimension::LENGTH, Dimension::ANGLE);
        let is_possible = |quantity| makes(self.dimension, quantity, &SIGNALS);
        if is_possible(own) || self.is_of_motors && is_possible(Dimension::ANGLE) {
            return None;
        }
        let help = "give the factor from the column to rad (revolute) or m (prismatic), such as \"1 deg\" or \"1 mm\"";
        Some(self.wrong("position_scale", own, self.dimension, help))
    }

    fn wrong_torque(&self) -> Option<Diagnostic> {
        let own = self.own(Dimension::FORCE, Dimension::TORQUE);
        let other = self.own(Dimension::TORQUE, Dimension::FORCE);
        let help = "give the factor from the column to N m (revolute) or N (prismatic), such as \"35 Nm/V\"";
        let electrical = &SIGNALS[..ELECTRICAL];
        let is_other =
            self.dimension != Dimension::NONE && makes(self.dimension, other, electrical);
        if is_other && !self.is_of_motors {
            return Some(self.wrong("torque_gain", own, other, help));
        }
        let mut both = [own, other].into_iter();
        let is_possible = both.any(|quantity| makes(self.dimension, quantity, &SIGNALS));
        (!is_possible).then(|| self.wrong("torque_gain", own, self.dimension, help))
    }

    fn own(&self, sliding: Dimension, rotating: Dimension) -> Dimension {
        if self.slides { sliding } else { rotating }
    }

    fn wrong(&self, key: &str, own: Dimension, made: Dimension, help: &str) -> Diagnostic {
        let joint = if self.slides { "prismatic" } else { "revolute" };
        let message = format!(
            "`{key}`: the column of a {joint} joint becomes {}, this makes {} of it",
            own.describe(),
            made.describe()
        );
        self.item.error(Code::UNIT, message).help(help)
    }
}
