//! Joints of URDF: the tree, couplings and actuated joints.

use super::{Links, Tree, body, origin};
use crate::{
    account::Use,
    bounds::record_empty_range,
    couplings::{Coupling, Couplings},
    files::Files,
    geometry::exact,
    model::{Joint, JointType, Model, Pose},
    options::Options,
    xml::Element,
};
use nalgebra::Vector3;
use std::collections::{BTreeMap, BTreeSet};

/// A joint element with its links.
struct Edge<'e> {
    element: &'e Element,
    name: &'e str,
    parent: &'e str,
    child: &'e str,
}

/// Builds the tree of bodies; `None` if links and joints form none.
pub(super) fn tree<'e>(
    files: &Files,
    root: &'e Element,
    links: &Links<'e>,
    options: &Options,
    model: &mut Model,
) -> Option<Tree> {
    let edges = edges(files, root, links);
    let base = base(files, root, links, &edges)?;
    let mut below: BTreeMap<&str, Vec<&Edge<'_>>> = BTreeMap::new();
    for edge in &edges {
        below.entry(edge.parent).or_default().push(edge);
    }
    let (mut bodies, mut by_joint) = (BTreeMap::new(), BTreeMap::new());
    model
        .bodies
        .push(body(files, links[base], 0, Pose::identity()));
    bodies.insert(base.to_owned(), 1);
    let mut open = vec![base];
    // Depth first, in the order of the file.
    while let Some(parent) = open.pop() {
        let at = bodies[parent];
        let edges = below.get(parent).map_or(&[][..], Vec::as_slice);
        for edge in edges {
            let placement = origin(files, edge.element.child("origin"));
            let mut own = body(files, links[edge.child], at, placement);
            own.joint = joint(files, edge, options, model);
            bodies.insert(edge.child.to_owned(), model.bodies.len());
            by_joint.insert(edge.name.to_owned(), model.bodies.len());
            model.bodies.push(own);
        }
        open.extend(edges.iter().rev().map(|edge| edge.child));
    }
    let reached: BTreeSet<&str> = bodies.keys().map(String::as_str).collect();
    for (name, link) in links.iter().filter(|(name, _)| !reached.contains(*name)) {
        let message =
            format!("the link `{name}` is not connected to `{base}`: its joints form a cycle");
        let help = "a <joint> may not close a loop: cut it, and name the frames of the closure in <loop>, <constraint> or a YAML file next to it";
        files.report(&link.place, message, help);
    }
    files.is_clean().then_some(Tree { bodies, by_joint })
}

fn edges<'e>(files: &Files, root: &'e Element, links: &Links<'e>) -> Vec<Edge<'e>> {
    let mut names = BTreeSet::new();
    let mut children = BTreeMap::new();
    let mut edges = Vec::new();
    for element in root.all("joint") {
        let Some(name) = element.required(files, "name") else {
            continue;
        };
        if !names.insert(name) {
            let message = format!("two joints have the name `{name}`");
            files.report(&element.place, message, "give each joint a name of its own");
        }
        let end = |tag: &str| {
            let Some(end) = element.child(tag) else {
                let message = format!("the joint `{name}` has no <{tag}>");
                files.report(
                    &element.place,
                    message,
                    format!("write <{tag} link=\"…\"/>"),
                );
                return None;
            };
            let link = end.required(files, "link")?;
            if !links.contains_key(link) {
                let message = format!("there is no link `{link}`");
                let near = files.did_you_mean(link, links.keys().copied());
                let help = near.unwrap_or_else(|| "name a <link>".to_owned());
                files.report(&end.place, message, help);
                return None;
            }
            Some(link)
        };
        let (Some(parent), Some(child)) = (end("parent"), end("child")) else {
            continue;
        };
        if let Some(other) = children.insert(child, name) {
            let message =
                format!("the link `{child}` is the child of two joints, `{other}` and `{name}`");
            let help = "a loop is cut at one joint: name the frames of the closure in <loop>, <constraint> or a YAML file next to it";
            files.report(&element.place, message, help);
            continue;
        }
        edges.push(Edge {
            element,
            name,
            parent,
            child,
        });
    }
    edges
}

/// Link that no joint carries.
fn base<'e>(
    files: &Files,
    root: &Element,
    links: &Links<'e>,
    edges: &[Edge<'e>],
) -> Option<&'e str> {
    let carried: BTreeSet<&str> = edges.iter().map(|edge| edge.child).collect();
    let mut free = links.keys().copied().filter(|name| !carried.contains(name));
    let (first, second) = (free.next(), free.next());
    let message = match (first, second) {
        (Some(base), None) => return Some(base),
        (Some(a), Some(b)) => format!("the links `{a}` and `{b}` are children of no joint"),
        _ => "every link is the child of a joint: there is no base".to_owned(),
    };
    files.report(
        &root.place,
        message,
        "a robot has one base, the link that is the child of no joint",
    );
    None
}

/// Reads the joint before a link; `None` for a fixed joint and after an error.
fn joint(files: &Files, edge: &Edge<'_>, options: &Options, model: &mut Model) -> Option<usize> {
    let element = edge.element;
    let kind = match element.get("type") {
        Some("revolute" | "continuous") => JointType::Revolute,
        Some("prismatic") => JointType::Prismatic,
        Some("spherical" | "ball") => JointType::Ball,
        Some("fixed") => return None,
        Some("floating") if options.fix_base => {
            model.notes.push(format!(
                "The joint `{}` floats; it is fixed here at its position.",
                edge.name
            ));
            return None;
        }
        other => {
            let other = other.unwrap_or("no type");
            let message = format!(
                "the joint `{}` is `{other}`, which is not supported",
                edge.name
            );
            let help = match other {
                "floating" => {
                    "a floating base has no motor to identify it with: `--fix-base` fixes it"
                }
                _ => "supported are revolute, continuous, prismatic, fixed and spherical joints",
            };
            files.report(&element.place, message, help);
            return None;
        }
    };
    let mut joint = Joint::new(edge.name, kind, element.place.clone());
    if kind != JointType::Ball {
        joint.axis = axis(files, element)?;
    }
    if let Some(dynamics) = element.child("dynamics") {
        joint.damping = dynamics.number(files, "damping", 0.0);
        joint.friction = dynamics.number(files, "friction", 0.0);
    }
    if let Some(limit) = element.child("limit") {
        let ends = ["lower", "upper"].map(|key| limit.number(files, key, 0.0));
        let is_limited = element.get("type") != Some("continuous");
        if is_limited && ends[0] >= ends[1] && ends != [0.0; 2] {
            record_empty_range(files, limit);
        }
        let is_limited = is_limited && ends[0] < ends[1];
        joint.range = (is_limited && kind != JointType::Ball).then_some(ends);
        let speed = limit.number(files, "velocity", 0.0);
        joint.speed = (speed > 0.0).then_some(speed);
    }
    model.joints.push(joint);
    Some(model.joints.len() - 1)
}

/// Unit axis with rounding errors removed.
pub(super) fn axis(files: &Files, of: &Element) -> Option<Vector3<f64>> {
    let Some(element) = of.child("axis") else {
        return Some(Vector3::x());
    };
    if element.get("xyz").is_none() {
        let reason = "absent: the axis is x in the model";
        files.record(Use::Reported, &element.place, "axis", Some("xyz"), reason);
    }
    let xyz = element.numbers(files, "xyz").unwrap_or([1.0, 0.0, 0.0]);
    let found = exact::direction(xyz);
    if found.is_none() {
        files.report(
            &element.place,
            "the axis has no direction",
            "write for instance xyz=\"0 0 1\"",
        );
    }
    found
}

/// Reads the couplings of `<mimic>`.
pub(super) fn mimics(files: &Files, root: &Element, model: &Model, couplings: &mut Couplings) {
    for element in root.all("joint") {
        let Some(mimic) = element.child("mimic") else {
            continue;
        };
        let own = element.get("name").and_then(|name| model.joint_named(name));
        let Some(follower) = own else {
            let reason = "the joint does not move";
            files.record(Use::Ignored, &mimic.place, "mimic", None, reason);
            continue;
        };
        let Some(name) = mimic.required(files, "joint") else {
            continue;
        };
        let Some(leader) = model.joint_named(name) else {
            let message = format!("there is no moving joint `{name}` to couple to");
            let help = "name another joint that is not fixed";
            files.report(&mimic.place, message, help);
            continue;
        };
        couplings.add(Coupling {
            follower,
            leader,
            factor: mimic.number(files, "multiplier", 1.0),
            offset: mimic.number(files, "offset", 0.0),
            place: mimic.place.clone(),
        });
    }
}
