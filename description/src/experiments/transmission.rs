//! Transmission from joints to motors: the matrix T with θ = T q.
//!
//! Here θ are the rotors' positions and q those of the actuated joints. Torques are transformed by
//! τ = Tᵀ τ_θ.

use crate::diagnostic::Code;
use crate::robot::inventory::Inventory;
use crate::robot::model::actuators;
use crate::toml_text::reader::Item;
use nalgebra::DMatrix;

/// Smallest singular value of T, relative to its largest, for motors that determine the joints.
const SINGULAR: f64 = 1e-9;

/// The rows of T, one per motor; `None` if the motors do not determine the actuated joints.
pub(crate) fn matrix(item: &Item<'_, '_>, robot: &Inventory<'_>) -> Option<Vec<Vec<f64>>> {
    let actuated = actuators(robot.legs);
    let legs = robot.legs.iter().enumerate();
    let motors = legs.flat_map(|(leg, of)| of.joints.iter().map(move |joint| (leg, joint)));
    let rows: Vec<Vec<f64>> = motors
        .filter_map(|(leg, joint)| {
            let ratio = joint.motor?.value();
            let factor = |&(of, index): &(usize, usize)| {
                let own = joint
                    .variable
                    .iter()
                    .find(|(j, _)| (leg, *j) == (of, index));
                own.map_or(0.0, |(_, factor)| ratio * factor.value())
            };
            Some(actuated.iter().map(factor).collect())
        })
        .collect();
    let help = "describe each motor as [[leg.NAME.motor]] with turns = \"q1\" and its gear's ratio";
    if rows.len() != actuated.len() {
        // After another error the intended motors and joints are unknown.
        if !item.context.is_clean() {
            return None;
        }
        let message = format!(
            "a log of motors needs as many motors as actuated joints, {}, but the description has {}",
            actuated.len(),
            rows.len()
        );
        item.context
            .report(item.error(Code::TRANSMISSION, message).help(help));
        return None;
    }
    let count = rows.len();
    let matrix = DMatrix::from_fn(count, count, |i, j| rows[i][j]);
    let values = matrix.singular_values();
    if values.min() <= SINGULAR * values.max() {
        let message = "the motors do not determine the joints: some turn the same combinations";
        let help = "each motor turns something that the others do not";
        item.context
            .report(item.error(Code::TRANSMISSION, message).help(help));
        return None;
    }
    Some(rows)
}
