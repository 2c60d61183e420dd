//! Joint positions of the keyframe.

use crate::{
    model::{JointType, Model},
    xml::Element,
};
use nalgebra::{Rotation3, Vector3};

/// Positions `qpos` of the keyframe `home`, or of the first one.
pub(super) fn positions(root: &Element) -> Option<Vec<f64>> {
    let attribute = |key: &Element, name: &str| {
        let mut all = key.attributes.iter();
        let found = all.find(|(own, ..)| own == name);
        found.map(|(_, value, _)| value.clone())
    };
    let sections = root.children.iter().filter(|own| own.name == "keyframe");
    let keys = sections.flat_map(|section| &section.children);
    let with_positions = keys.filter_map(|key| Some((key, attribute(key, "qpos")?)));
    let all: Vec<(&Element, String)> = with_positions.collect();
    let home = all
        .iter()
        .find(|(key, _)| attribute(key, "name").as_deref() == Some("home"));
    let (_, text) = home.or(all.first())?;
    let numbers = text.split_whitespace().map(|word| word.parse::<f64>().ok());
    let numbers: Option<Vec<f64>> = numbers.collect();
    numbers.filter(|all| all.iter().all(|value| value.is_finite()))
}

/// Sets the joints' positions in the keyframe, if it has one number for each coordinate.
pub(super) fn apply(positions: &[f64], model: &mut Model) {
    let count = |kind: JointType| if kind == JointType::Ball { 4 } else { 1 };
    let all: usize = model.joints.iter().map(|joint| count(joint.kind)).sum();
    if all != positions.len() {
        return;
    }
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
