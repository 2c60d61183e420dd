//! Writes parameters to MJCF: attributes of `<inertial>` and `<joint>`.
//!
//! Settings of `<compiler>` that change inertias, and springs given by time constants, would change
//! what is written. They are replaced by their results.

use super::patch::{Patch, numbers};
use crate::model::{Inertia, Model};
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
    let t = &own.tensor;
    let full = [
        t[(0, 0)],
        t[(1, 1)],
        t[(2, 2)],
        t[(0, 1)],
        t[(0, 2)],
        t[(1, 2)],
    ];
    let [centre, mass] = [own.centre.coords.as_slice(), &[own.mass]].map(numbers);
    let full = numbers(&full);
    let Some(inertial) = body.children().find(|child| child.has_tag_name("inertial")) else {
        // The file computes the inertia from geoms.
        let element =
            format!("<inertial pos=\"{centre}\" mass=\"{mass}\" fullinertia=\"{full}\"/>");
        patch.append(text, body, &element);
        return;
    };
    patch.set(inertial, "pos", &centre);
    patch.set(inertial, "mass", &mass);
    if inertial.has_attribute("fullinertia") {
        patch.set(inertial, "fullinertia", &full)
    } else {
        patch.rename(inertial, "diaginertia", "fullinertia", &full)
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
    // A spring given by time constants would replace stiffness and damping.
    if values.iter().any(|(name, _)| *name == "stiffness") {
        let is_set = |node: &Node<'_, '_>| node.has_attribute("springdamper");
        if is_set(&joint) || joint.document().descendants().any(|node| is_set(&node)) {
            patch.set(joint, "springdamper", "0 0");
        }
    }
}

/// Writes stiffness and damping of a tendon.
pub(super) fn tendon(patch: &mut Patch, tendon: Node<'_, '_>, values: &[(&'static str, f64)]) {
    for (name, value) in values {
        patch.set(tendon, name, &numbers(&[*value]));
    }
}

/// Attributes of `<compiler>` that change inertias after they are read.
const ADJUSTMENTS: [&str; 5] = [
    "boundmass",
    "boundinertia",
    "balanceinertia",
    "settotalmass",
    "inertiafromgeom",
];

/// Removes the settings that would change the written inertias.
pub(super) fn without_adjustments(
    patch: &mut Patch,
    text: &str,
    document: &roxmltree::Document<'_>,
) {
    let all = document.descendants();
    for compiler in all.filter(|node| node.has_tag_name("compiler")) {
        for name in ADJUSTMENTS {
            patch.remove(text, compiler, name);
        }
    }
}

/// Inertias of all bodies that such settings may have changed, by body.
pub(super) fn adjusted_inertias(model: &Model) -> impl Iterator<Item = (usize, Inertia)> + '_ {
    let bodies = model.bodies.iter().enumerate();
    bodies.filter_map(|(at, body)| Some((at, body.inertia.filter(|own| own.mass > 0.0)?)))
}
