//! Writes parameters to URDF: elements of `<inertial>` and `<dynamics>` of joints.

use super::patch::{Patch, numbers};
use crate::{files::Files, model::Inertia, urdf, xml};
use roxmltree::Node;

/// Attribute of `<dynamics>` for a parameter.
pub(super) fn attribute(symbol: &str) -> Option<&'static str> {
    Some(match symbol {
        "fv" => "damping",
        "fs" => "friction",
        _ => return None,
    })
}

/// Writes a link's inertia; the rotation of the file's inertial frame is kept.
pub(super) fn inertia(
    patch: &mut Patch,
    files: &Files,
    text: &str,
    link: Node<'_, '_>,
    own: &Inertia,
    file: usize,
) {
    let child = |of: Node<'_, '_>, name: &str| {
        of.children()
            .find(|child| child.has_tag_name(name))
            .map(|c| c.id())
    };
    let document = link.document();
    let Some(inertial) = child(link, "inertial").and_then(|id| document.get_node(id)) else {
        return;
    };
    let part = |name: &str| child(inertial, name).and_then(|id| document.get_node(id));
    let origin = part("origin");
    let element = origin.and_then(|origin| xml::element(origin, file, 0));
    let turn = urdf::origin(files, element.as_ref()).rotation;
    let centre = numbers(own.centre.coords.as_slice());
    match origin {
        Some(origin) => patch.set(origin, "xyz", &centre),
        None => patch.append(text, inertial, &format!("<origin xyz=\"{centre}\"/>")),
    }
    let mass = numbers(&[own.mass]);
    match part("mass") {
        Some(element) => patch.set(element, "value", &mass),
        None => patch.append(text, inertial, &format!("<mass value=\"{mass}\"/>")),
    }
    let t = turn.matrix().transpose() * own.tensor * turn.matrix();
    let all = [
        t[(0, 0)],
        t[(0, 1)],
        t[(0, 2)],
        t[(1, 1)],
        t[(1, 2)],
        t[(2, 2)],
    ];
    let shown = numbers(&all);
    let named = ["ixx", "ixy", "ixz", "iyy", "iyz", "izz"]
        .into_iter()
        .zip(shown.split(' '));
    match part("inertia") {
        Some(element) => named.for_each(|(name, value)| patch.set(element, name, value)),
        None => {
            let list: Vec<String> = named
                .map(|(name, value)| format!("{name}=\"{value}\""))
                .collect();
            patch.append(text, inertial, &format!("<inertia {}/>", list.join(" ")));
        }
    }
}

/// Writes the parameters of a joint.
pub(super) fn joint(
    patch: &mut Patch,
    text: &str,
    joint: Node<'_, '_>,
    values: &[(&'static str, f64)],
) {
    match joint
        .children()
        .find(|child| child.has_tag_name("dynamics"))
    {
        Some(dynamics) => {
            for (name, value) in values {
                patch.set(dynamics, name, &numbers(&[*value]));
            }
        }
        None => {
            let list: Vec<String> = values
                .iter()
                .map(|(name, value)| format!("{name}=\"{}\"", numbers(&[*value])))
                .collect();
            patch.append(text, joint, &format!("<dynamics {}/>", list.join(" ")));
        }
    }
}
