//! Joint positions of the keyframe.

use crate::{
    account::Use,
    files::{Files, Place},
    model::{JointType, Model},
    xml::Element,
};
use nalgebra::{Rotation3, Vector3};

/// Positions of a keyframe, as in the file.
#[derive(Debug)]
pub(super) struct Keyframe {
    text: String,
    place: Place,
}

/// Positions `qpos` of the keyframe `home`, or of the first one.
pub(super) fn positions(root: &Element) -> Option<Keyframe> {
    let sections = root.children.iter().filter(|own| own.name == "keyframe");
    let keys = sections.flat_map(|section| &section.children);
    let with_positions = keys.filter(|key| attribute(key, "qpos").is_some());
    let all: Vec<&Element> = with_positions.collect();
    let is_home = |key: &&&Element| attribute(key, "name").is_some_and(|(name, _)| name == "home");
    let key = all.iter().find(is_home).or(all.first())?;
    let (text, place) = attribute(key, "qpos")?;
    Some(Keyframe {
        text: text.to_owned(),
        place: place.clone(),
    })
}

/// Attribute of an element that the account does not follow.
fn attribute<'e>(key: &'e Element, name: &str) -> Option<(&'e str, &'e Place)> {
    let mut all = key.attributes.iter();
    let found = all.find(|(own, ..)| own == name);
    found.map(|(_, value, place)| (value.as_str(), place))
}

/// Sets the joints' positions in the keyframe; one that does not fit the joints is reported.
///
/// `has_fixed_base`: whether a free joint, the first one, is fixed here. Its seven numbers are left
/// out.
pub(super) fn apply(files: &Files, keyframe: &Keyframe, has_fixed_base: bool, model: &mut Model) {
    if model.closures.is_empty() {
        return;
    }
    let numbers = keyframe.text.split_whitespace();
    let numbers = numbers.map(|word| word.parse::<f64>().ok().filter(|own| own.is_finite()));
    let numbers: Option<Vec<f64>> = numbers.collect();
    let report = |reason: &str| {
        files.record(Use::Reported, &keyframe.place, "key", Some("qpos"), reason);
    };
    let Some(numbers) = numbers else {
        report("not a list of numbers: home is the configuration of the joints");
        return;
    };
    let all: usize = model.joints.iter().map(|joint| count(joint.kind)).sum();
    let positions = match numbers.len().checked_sub(all) {
        Some(0) => &numbers[..],
        Some(FREE) if has_fixed_base => &numbers[FREE..],
        _ => {
            report(&format!(
                "{} numbers, and the joints have {all} positions: home is the configuration of the joints",
                numbers.len()
            ));
            return;
        }
    };
    set(positions, model);
}

/// Number of positions of a free joint.
const FREE: usize = 7;

/// Number of positions of a joint.
fn count(kind: JointType) -> usize {
    if kind == JointType::Ball { 4 } else { 1 }
}

/// Sets one position for each coordinate.
fn set(positions: &[f64], model: &mut Model) {
    let carried = model.carried();
    let mut rest = positions;
    // Axes and origin in which a free joint's displacement is given.
    let mut start = (Rotation3::identity(), Vector3::zeros());
    for (at, &body) in carried.iter().enumerate() {
        let joint = &model.joints[at];
        let (own, after) = rest.split_at(count(joint.kind));
        rest = after;
        let body = &model.bodies[body];
        let is_first = joint.is_virtual && joint.axis == Vector3::x() && body.parent == 0;
        if is_first {
            start = (body.placement.rotation, body.placement.translation.vector);
        }
        let keyframe = match joint.kind {
            JointType::Ball => {
                let [w, x, y, z] = own[..] else { return };
                let turn = crate::geometry::exact::quaternion([w, x, y, z]).unwrap_or_default();
                let turn = if joint.is_virtual {
                    start.0.inverse() * turn
                } else {
                    turn
                };
                (joint.home, turn)
            }
            _ if joint.is_virtual => {
                // Displacements along the body's axes, which start at its placement.
                let first =
                    at - usize::from(joint.axis.y == 1.0) - 2 * usize::from(joint.axis.z == 1.0);
                let offset: usize = (0..first).map(|own| count(model.joints[own].kind)).sum();
                let position = Vector3::from_column_slice(&positions[offset..offset + 3]);
                let moved = start.0.inverse() * (position - start.1);
                (moved.dot(&joint.axis), Rotation3::identity())
            }
            _ => (own[0], Rotation3::identity()),
        };
        model.joints[at].keyframe = Some(keyframe);
    }
}
