//! Motor tables of serial robots.

use super::{Joint, Leg, Motor, names::Names};
use crate::{
    geometry::digits::fine,
    model::{JointType, Model},
};

/// Motors of a leg: expressions of its joint variables.
pub(super) fn of_leg(model: &Model, leg: &Leg) -> Vec<Motor> {
    let mut names = Names::default();
    for joint in &leg.joints {
        names.unique(&joint.name);
    }
    let mut motors = Vec::new();
    for (at, own) in model.motors.iter().enumerate() {
        let name = if own.name.is_empty() {
            format!("m{}", at + 1)
        } else {
            own.name.clone()
        };
        let given = [
            ("ia", own.armature),
            ("fv", own.damping),
            ("fs", own.friction),
        ];
        motors.push(Motor {
            name: names.unique(&name),
            turns: combination(model, leg, &own.turns),
            ratio: own.ratio,
            values: given
                .into_iter()
                .filter(|(_, value)| *value != 0.0)
                .collect(),
        });
    }
    motors
}

/// Expression of a combination of joints.
fn combination(model: &Model, leg: &Leg, turns: &[(usize, f64)]) -> String {
    let is_angle = |joint: usize| model.joints[joint].kind == JointType::Revolute;
    let has_angles = turns.iter().any(|(joint, _)| is_angle(*joint));
    let mut text = String::new();
    for &(joint, factor) in turns {
        let is_own = |own: &&Joint| own.of == Some(joint);
        let Some(own) = leg.joints.iter().find(is_own) else {
            continue;
        };
        match (text.is_empty(), factor < 0.0) {
            (true, false) => {}
            (true, true) => text.push('-'),
            (false, false) => text.push_str(" + "),
            (false, true) => text.push_str(" - "),
        }
        let unit = if has_angles && !is_angle(joint) {
            " rad/m"
        } else {
            ""
        };
        let size = factor.abs();
        if size != 1.0 || !unit.is_empty() {
            text.push_str(&format!("{}{unit} * ", fine(size, size)));
        }
        text.push_str(&format!("q_{}", own.name));
    }
    text
}
