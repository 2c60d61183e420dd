//! Writes parameters to MJCF: attributes of `<inertial>` and `<joint>`.

use super::patch::{Patch, numbers};
use crate::model::Inertia;
use roxmltree::Node;

/// Attribute of `<joint>` for a parameter.
pub(super) fn attribute(symbol: &str) -> Option<&'static str> {
    Some(match symbol {
        "ia" => "armature",
        "fv" => "damping",
        "fs" => "frictionloss",
        "k" => "stiffness",
        _ => return None,
    })
}

/// Writes a body's inertia as mass, position and `fullinertia`, which needs no rotation.
pub(super) fn inertia(patch: &mut Patch, text: &str, body: Node<'_, '_>, own: &Inertia) {
    let Some(inertial) = body.children().find(|child| child.has_tag_name("inertial")) else {
        return;
    };
    let t = &own.tensor;
    patch.set(inertial, "pos", &numbers(own.centre.coords.as_slice()));
    patch.set(inertial, "mass", &numbers(&[own.mass]));
    let full = [
        t[(0, 0)],
        t[(1, 1)],
        t[(2, 2)],
        t[(0, 1)],
        t[(0, 2)],
        t[(1, 2)],
    ];
    if inertial.has_attribute("fullinertia") {
        patch.set(inertial, "fullinertia", &numbers(&full))
    } else {
        patch.rename(inertial, "diaginertia", "fullinertia", &numbers(&full))
    }
    for turn in ["quat", "axisangle", "xyaxes", "zaxis", "euler"] {
        patch.remove(text, inertial, turn);
    }
}

/// Writes the parameters of a joint.
pub(super) fn joint(patch: &mut Patch, joint: Node<'_, '_>, values: &[(&'static str, f64)]) {
    for (name, value) in values {
        patch.set(joint, name, &numbers(&[*value]));
    }
}
