//! The table `[controller]`: control loops of the drives during measured runs.

use crate::diagnostic::Code;
use crate::experiments::per_actuator::per_actuator;
use crate::expressions::dimension::Dimension;
use crate::robot::inventory::Inventory;
use crate::toml_text::reader::Item;

/// Position and velocity loops, u = k_v (k_p (q_d - q) - q̇); lists have one value per actuator.
#[derive(Debug, Clone, PartialEq)]
pub struct Controller {
    /// Columns of the desired positions in a log, in units of the measured ones.
    pub reference: Vec<String>,
    /// k_p, 1/s.
    pub position_gain: Vec<f64>,
    /// k_v, units of u per m/s or rad/s.
    pub velocity_gain: Vec<f64>,
    /// N or N m per unit of u.
    pub drive_gain: Vec<f64>,
    /// Largest |u|.
    pub limit: Option<Vec<f64>>,
}

/// Reads the table.
pub(crate) fn read(item: &Item<'_, '_>, robot: &Inventory<'_>) -> Option<Controller> {
    let table = item.table("the table `[controller]`")?;
    let kinds = robot.actuator_kinds();
    let count = robot.actuator_count();
    let list = |item: &Item<'_, '_>, dimension| per_actuator(item, &kinds, dimension, robot.scope);
    // The unit of the drive's signal is arbitrary.
    let position_gain = table
        .require("position_gain", "position_gain = 100, in 1/s")
        .and_then(|item| list(&item, |_| Dimension::FREQUENCY));
    let velocity_gain = table
        .require("velocity_gain", "velocity_gain = 10")
        .and_then(|item| list(&item, |_| Dimension::NONE));
    let drive_gain = table.get("drive_gain").map_or_else(
        || Some(vec![1.0; count]),
        |item| list(&item, |_| Dimension::NONE),
    );
    let limit = table
        .get("limit")
        .map(|item| list(&item, |_| Dimension::NONE));
    let reference = table
        .require("reference", "give one column for each actuator")
        .and_then(|item| {
            let names = item.strings()?;
            if names.len() != count {
                let message = format!(
                    "`reference`: expected {count} columns, one for each actuator, found {}",
                    names.len()
                );
                item.context.report(item.error(Code::WRONG_COUNT, message));
                return None;
            }
            Some(names.into_iter().map(|name| name.value).collect())
        });
    table.finish();
    Some(Controller {
        reference: reference?,
        position_gain: position_gain?,
        velocity_gain: velocity_gain?,
        drive_gain: drive_gain?,
        limit: match limit {
            Some(limit) => Some(limit?),
            None => None,
        },
    })
}
