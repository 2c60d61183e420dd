//! Motor tables: of the leg of a robot without loops, and of robots with loops.

use super::{Leg, Motor, names::Names};
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
    motors(model, &mut names, &|joint| {
        let own = leg.joints.iter().find(|own| own.of == Some(joint));
        own.map(|own| format!("q_{}", own.name))
    })
}

/// Motors of a robot with loops, whose joints may be in several legs.
pub(super) fn of_robot(model: &Model, legs: &[Leg]) -> Vec<Motor> {
    let mut names = Names::default();
    for leg in legs {
        names.unique(&leg.name);
    }
    motors(model, &mut names, &|joint| {
        let mut all = legs
            .iter()
            .flat_map(|leg| leg.joints.iter().map(move |own| (leg, own)));
        let (leg, own) = all.find(|(_, own)| own.of == Some(joint))?;
        Some(format!("{}.q_{}", leg.name, own.name))
    })
}

/// Name of a joint's variable; `None` for a joint that the description does not have.
type Variable<'v> = &'v dyn Fn(usize) -> Option<String>;

fn motors(model: &Model, names: &mut Names, variable: Variable<'_>) -> Vec<Motor> {
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
            turns: combination(model, &own.turns, variable),
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
fn combination(model: &Model, turns: &[(usize, f64)], variable: Variable<'_>) -> String {
    let is_angle = |joint: usize| model.joints[joint].kind == JointType::Revolute;
    let has_angles = turns.iter().any(|(joint, _)| is_angle(*joint));
    let mut text = String::new();
    for &(joint, factor) in turns {
        let Some(name) = variable(joint) else {
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
        text.push_str(&name);
    }
    text
}
