//! Transmission from the actuators to the coordinates of a log: the matrix T with θ = T q.
//!
//! Here θ are the positions in the log and q those of the actuators. Torques are transformed by
//! τ = Tᵀ τ_θ. The actuators of a robot without loops are its actuated joints; a log of motors has
//! their rotors' positions. Those of a robot with loops are its motors after their gears; a log of
//! motors has their rotors' positions, one of joints has the positions of the joints that they
//! turn.

use crate::diagnostic::Code;
use crate::robot::inventory::Inventory;
use crate::robot::model::{BodyIndex, actuators};
use crate::toml_text::reader::Item;
use nalgebra::DMatrix;

/// Smallest singular value of T, relative to its largest, for motors that determine the joints.
const SINGULAR: f64 = 1e-9;

/// T of a log of motors of a robot with loops: the gear ratios, or empty if all are 1.
pub(crate) fn gears(robot: &Inventory<'_>) -> Vec<Vec<f64>> {
    let joints = actuators(robot.legs).len();
    let motors = robot.motors.iter().map(|motor| motor.ratio.value());
    let ratios: Vec<f64> = std::iter::repeat_n(1.0, joints).chain(motors).collect();
    if ratios.iter().all(|ratio| *ratio == 1.0) {
        return Vec::new();
    }
    let row = |own: usize| {
        let entry = |(at, ratio): (usize, &f64)| if at == own { *ratio } else { 0.0 };
        ratios.iter().enumerate().map(entry).collect()
    };
    (0..ratios.len()).map(row).collect()
}

/// T of a log of joints of a robot with loops: the joints that its motors turn, leg by leg.
///
/// `None` if the joints are not as many as the motors, or the motors do not determine them.
pub(crate) fn from_joints(item: &Item<'_, '_>, robot: &Inventory<'_>) -> Option<Vec<Vec<f64>>> {
    let own = actuators(robot.legs).into_iter();
    let own: Vec<Vec<(BodyIndex, f64)>> = own
        .map(|(leg, joint)| vec![(BodyIndex { leg, joint }, 1.0)])
        .collect();
    let motors = robot.motors.iter().map(|motor| {
        let terms = motor.terms.iter();
        terms
            .map(|term| (term.joint, term.factor.value()))
            .collect()
    });
    let all: Vec<Vec<(BodyIndex, f64)>> = own.into_iter().chain(motors).collect();
    let mut joints: Vec<BodyIndex> = all.iter().flatten().map(|(joint, _)| *joint).collect();
    joints.sort_unstable_by_key(|joint| (joint.leg, joint.joint));
    joints.dedup();
    let help = "use coordinates = \"motors\", the positions and torques of the motors themselves";
    if joints.len() != all.len() {
        if !item.context.is_clean() {
            return None;
        }
        let message = format!(
            "a log of joints needs as many motors as joints that they turn, but there are {} motors and {} joints",
            all.len(),
            joints.len()
        );
        item.context
            .report(item.error(Code::TRANSMISSION, message).help(help));
        return None;
    }
    let count = joints.len();
    let matrix = DMatrix::from_fn(count, count, |i, j| {
        let own = all[i].iter().filter(|(joint, _)| *joint == joints[j]);
        own.map(|(_, factor)| factor).sum()
    });
    let values = matrix.singular_values();
    let regular = values.min() > SINGULAR * values.max();
    let inverse = if regular { matrix.try_inverse() } else { None };
    let Some(inverse) = inverse else {
        let message = "the motors do not determine the joints: some turn the same combinations";
        item.context
            .report(item.error(Code::TRANSMISSION, message).help(help));
        return None;
    };
    let row = |i: usize| (0..count).map(|j| inverse[(i, j)]).collect();
    Some((0..count).map(row).collect())
}

/// The rows of T of a log of motors of a robot without loops, one per motor; `None` if the motors do not determine the actuated joints.
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
