//! Transmissions: the joints and combinations of joints that motors drive.

use super::Tree;
use crate::{
    account::Use,
    files::Files,
    model::{Model, Motor},
    xml::{Element, numbers},
};

/// Types of transmissions that drive one joint each, without the package name.
const SINGLE: [&str; 3] = [
    "SimpleTransmission",
    "SimpleGazeboTransmission",
    "simple_transmission",
];

/// Marks the joints that transmissions drive, and reads motors that turn two of them.
pub(super) fn read(files: &Files, root: &Element, tree: &Tree, model: &mut Model) {
    let nested = root.all("ros2_control");
    let nested = nested.flat_map(|control| control.all("transmission"));
    for transmission in root.all("transmission").chain(nested) {
        let joints: Vec<&Element> = transmission.all("joint").collect();
        let actuators = transmission.all("actuator").count();
        if let Some(coupling) = kind(transmission).and_then(Coupling::named) {
            drive_two(files, transmission, coupling, tree, model);
            continue;
        }
        if joints.len() > 1 || actuators > 1 || !is_single(transmission) {
            reject(files, transmission);
            continue;
        }
        for joint in joints {
            if let Some(joint_index) = moving(files, joint, tree, model) {
                drive(files, transmission, joint, joint_index, model);
            }
        }
    }
}

/// The type of a transmission, without its package.
fn kind(transmission: &Element) -> Option<&str> {
    let text = |tag: &str| {
        let (text, _) = &transmission.child(tag)?.text;
        Some(text.as_str())
    };
    let found = text("type")
        .or_else(|| text("plugin"))
        .or_else(|| transmission.get("type"))?;
    found.rsplit(['/', ':']).next()
}

fn is_single(transmission: &Element) -> bool {
    let kind = kind(transmission).filter(|kind| !kind.is_empty());
    kind.is_none_or(|kind| SINGLE.contains(&kind) || kind.ends_with("JointTransmission"))
}

fn reject(files: &Files, transmission: &Element) {
    let kind = kind(transmission).unwrap_or("several joints");
    let message = format!("a transmission of type `{kind}` couples joints, which is not supported");
    let help = "remove it and name the driven joints, `--actuated JOINT,JOINT`; without loops the motors can be \
                described in the TOML, [[leg.NAME.motor]] with `turns`";
    files.report(&transmission.place, message, help);
}

/// Moving joint that a transmission names; `None` after an error, and for a fixed joint.
fn moving(files: &Files, joint: &Element, tree: &Tree, model: &Model) -> Option<usize> {
    let name = joint.required(files, "name")?;
    let found = model.joint_named(name);
    if found.is_some() {
        return found;
    }
    if tree.by_joint.contains_key(name) {
        let reason = "the joint is fixed";
        files.record(Use::Ignored, &joint.place, "joint", None, reason);
        return None;
    }
    let help = files.joint_help(name, tree.by_joint.keys().map(String::as_str));
    files.report(&joint.place, format!("there is no joint `{name}`"), help);
    None
}

fn drive(
    files: &Files,
    transmission: &Element,
    element: &Element,
    joint: usize,
    model: &mut Model,
) {
    let actuator = transmission.child("actuator");
    let places = [Some(transmission), Some(element), actuator];
    let given = places
        .into_iter()
        .flatten()
        .find_map(|own| reduction(files, own));
    let value = |tag: &str| {
        let own = actuator?.child(tag)?;
        Some(own.number(files, "value", 0.0))
    };
    model.says_motors = true;
    let own = &mut model.joints[joint];
    own.actuated = true;
    // Drake: the inertia of the rotor before its gear.
    let gear = value("gear_ratio").unwrap_or(1.0);
    own.armature += gear * gear * value("rotor_inertia").unwrap_or(0.0);
    model.motors.push(Motor {
        name: actuator
            .and_then(|own| own.get("name"))
            .unwrap_or("")
            .to_owned(),
        turns: vec![(joint, 1.0)],
        ratio: given.unwrap_or(1.0),
        ..Motor::new(transmission.place.clone())
    });
}

/// Value of `<mechanicalReduction>`; `None` without it and after an error.
fn reduction(files: &Files, of: &Element) -> Option<f64> {
    let tags = ["mechanicalReduction", "mechanical_reduction"];
    let own = tags.iter().find_map(|tag| of.child(tag))?;
    let (text, place) = &own.text;
    match numbers(text).as_deref() {
        Some([value]) if *value != 0.0 => Some(*value),
        _ => {
            let message = format!("<{}> must be a number other than 0", own.name);
            files.report(place, message, "write the ratio of the gear");
            None
        }
    }
}

/// Transmissions of ROS that couple two motors and two joints.
#[derive(Debug, Clone, Copy)]
enum Coupling {
    Differential,
    FourBarLinkage,
}

impl Coupling {
    fn named(kind: &str) -> Option<Self> {
        match kind {
            "DifferentialTransmission" => Some(Self::Differential),
            "FourBarLinkageTransmission" => Some(Self::FourBarLinkage),
            _ => None,
        }
    }

    /// Factors of both joints for each motor, without the motor's own gear.
    ///
    /// Equations of ROS's `transmission_interface`, `jointToActuatorPosition`.
    fn factors(self, gears: [f64; 2]) -> [[f64; 2]; 2] {
        let [first, second] = gears;
        match self {
            Self::Differential => [[first, second], [first, -second]],
            Self::FourBarLinkage => [[first, 0.0], [1.0, second]],
        }
    }
}

/// Reads the two motors of a coupling; the first joint and motor have the roles `…1`.
fn drive_two(
    files: &Files,
    transmission: &Element,
    coupling: Coupling,
    tree: &Tree,
    model: &mut Model,
) {
    let pair = |tag: &'static str| {
        let all: Vec<&Element> = transmission.all(tag).collect();
        let found = in_roles(tag, &all);
        if found.is_none() {
            let message = format!("the transmission needs two elements <{tag}>");
            let help = format!("give them the roles `{tag}1` and `{tag}2`");
            files.report(&transmission.place, message, help);
        }
        found
    };
    let (Some(joints), Some(actuators)) = (pair("joint"), pair("actuator")) else {
        return;
    };
    let found = joints.map(|joint| moving(files, joint, tree, model));
    let [Some(first), Some(second)] = found else {
        if files.is_clean() {
            let message = "a transmission couples a fixed joint";
            files.report(&transmission.place, message, "name two joints that move");
        }
        return;
    };
    if first == second {
        let message = format!(
            "a transmission couples `{}` to itself",
            model.joints[first].name
        );
        files.report(&transmission.place, message, "name two different joints");
        return;
    }
    let gear = |of: &Element| reduction(files, of).unwrap_or(1.0);
    let factors = coupling.factors(joints.map(gear));
    model.says_motors = true;
    for (actuator, [a, b]) in actuators.into_iter().zip(factors) {
        let turns = [(first, a), (second, b)].into_iter();
        let value = |tag: &str| {
            actuator
                .child(tag)
                .map(|own| own.number(files, "value", 0.0))
        };
        let gear_ratio = value("gear_ratio").unwrap_or(1.0);
        model.motors.push(Motor {
            name: actuator.get("name").unwrap_or("").to_owned(),
            turns: turns.filter(|(_, factor)| *factor != 0.0).collect(),
            ratio: gear(actuator),
            armature: gear_ratio * gear_ratio * value("rotor_inertia").unwrap_or(0.0),
            ..Motor::new(transmission.place.clone())
        });
    }
}

/// Two elements in the order of their roles, or of the file without roles.
fn in_roles<'e>(tag: &str, all: &[&'e Element]) -> Option<[&'e Element; 2]> {
    let [first, second] = *all else { return None };
    let role = |of: &'e Element| {
        let text = of.child("role").map(|role| role.text.0.as_str());
        text.or_else(|| of.get("role"))
    };
    let expected = [format!("{tag}1"), format!("{tag}2")];
    let roles = [role(first), role(second)];
    let is = |order: [usize; 2]| roles == order.map(|at| Some(expected[at].as_str()));
    if roles == [None, None] || is([0, 1]) {
        Some([first, second])
    } else if is([1, 0]) {
        Some([second, first])
    } else {
        None
    }
}
