//! Bodies, their joints and inertias.

use super::{
    BOOLEAN_OR_AUTO, Reader, Sites,
    adjust::SpringDamper,
    compensation::Compensation,
    defaults::MAIN,
    inertia,
    names::{TakenNames, WORLD},
};
use crate::{
    bounds::record_empty_range,
    files::Files,
    geometry::exact,
    model::{Body, Inertia, Joint, JointType, Model, Pose},
    xml::Element,
};
use nalgebra::{Matrix3, Point3, Vector3};
use std::collections::BTreeSet;

/// Reads all bodies; returns what depends on inertias.
pub(super) fn read(
    reader: &Reader<'_>,
    root: &Element,
    model: &mut Model,
    sites: &mut Sites,
) -> (Vec<SpringDamper>, Compensation) {
    let mut springs = Vec::new();
    let mut compensation = Compensation::default();
    let mut taken = TakenNames::of_file(root);
    for world in root.all("worldbody") {
        let class = world.get("childclass").unwrap_or(MAIN).to_owned();
        let mut tree = Tree {
            names: taken_bodies(model),
            taken: &mut taken,
            model: &mut *model,
            sites: &mut *sites,
            springs: &mut springs,
            compensation: &mut compensation,
        };
        inside(reader, world, 0, &Pose::identity(), &class, &mut tree);
    }
    (springs, compensation)
}

/// Output of the body reader.
struct Tree<'t> {
    /// Names of the bodies so far.
    names: BTreeSet<String>,
    taken: &'t mut TakenNames,
    model: &'t mut Model,
    sites: &'t mut Sites,
    springs: &'t mut Vec<SpringDamper>,
    compensation: &'t mut Compensation,
}

/// Reads the bodies, sites and frames in a body; `offset` is the pose of the enclosing frames.
fn inside(
    reader: &Reader<'_>,
    element: &Element,
    parent: usize,
    offset: &Pose,
    class: &str,
    tree: &mut Tree<'_>,
) {
    for child in &element.children {
        let inner_class = || child.get("childclass").unwrap_or(class);
        match child.name.as_str() {
            "body" => body(reader, child, parent, offset, inner_class(), tree),
            "frame" => {
                let offset = offset * reader.compiler.frame(reader.files, child);
                inside(reader, child, parent, &offset, inner_class(), tree);
            }
            "site" => {
                let whole = reader.defaults.apply(reader.files, child, class);
                let at = offset * reader.compiler.frame(reader.files, &whole);
                if let Some(name) = child.get("name") {
                    tree.sites.insert(name.to_owned(), (parent, at));
                }
            }
            _ => {}
        }
    }
}

fn body(
    reader: &Reader<'_>,
    element: &Element,
    parent: usize,
    offset: &Pose,
    class: &str,
    tree: &mut Tree<'_>,
) {
    let files = reader.files;
    let count = tree.model.bodies.len();
    let name = match element.get("name") {
        Some(name) => name.to_owned(),
        None => tree.taken.body(&format!("body{count}")),
    };
    if !tree.names.insert(name.clone()) {
        let message = format!("two bodies have the name `{name}`");
        files.report(&element.place, message, "give each body a name of its own");
    }
    let model = &mut *tree.model;
    let mut joints = Vec::new();
    gather_joints(reader, element, &Pose::identity(), class, &mut joints);
    let frame = reader.compiler.frame(files, element);
    let mut placement = offset * frame;
    let mut parent = parent;
    let count = joints.len();
    for (at, (own, offset)) in joints.iter().enumerate() {
        if own.name == "joint" {
            tree.compensation.joint(files, own);
        }
        if is_free(own) && reader.has_closures && !reader.options.fix_base {
            let joint = free_name(own, tree.taken, model);
            parent = carriers(own, &joint, parent, placement, model);
            placement = Pose::identity();
            push_free(own, &joint, &name, element, parent, model);
            continue;
        }
        let Some(mut joint) = joint(reader, own, tree.taken, model) else {
            continue;
        };
        joint.at = offset * joint.at;
        joint.axis = offset.rotation * joint.axis;
        model.joints.push(joint);
        let at_joint = model.joints.len() - 1;
        if let Some(spring) = spring_damper(reader, own, model, at_joint) {
            // The spring's damping replaces the joint's own.
            let own = &mut model.joints[at_joint];
            own.damping = 0.0;
            own.spring = None;
            own.given = Some([own.armature, 0.0, own.friction]);
            tree.springs.push(spring);
        }
        // All joints but the last carry a massless body at the same pose.
        let is_last = at + 1 == count;
        model.bodies.push(Body {
            name: if is_last {
                name.clone()
            } else {
                tree.taken.body(&format!("{name}_{}", at + 1))
            },
            parent,
            placement,
            place: is_last.then(|| element.place.clone()),
            joint: Some(model.joints.len() - 1),
            inertia: None,
            has_unknown_inertia: false,
        });
        parent = model.bodies.len() - 1;
        placement = Pose::identity();
    }
    if model.bodies.last().is_none_or(|body| body.name != name) {
        model.bodies.push(Body {
            name,
            parent,
            placement,
            place: Some(element.place.clone()),
            joint: None,
            inertia: None,
            has_unknown_inertia: false,
        });
    }
    let own = model.bodies.len() - 1;
    tree.compensation.body(files, element, own);
    let (inertia, is_unknown) = inertia::read(reader, element, class);
    // MuJoCo puts the least mass of a body without inertia at `pos` of the body, in its own frame.
    let is_bounded = reader.compiler.adjustments.has_bounds() && !is_unknown;
    let massless = Inertia {
        mass: 0.0,
        centre: frame.translation.vector.into(),
        tensor: Matrix3::zeros(),
    };
    model.bodies[own].inertia = inertia.or_else(|| is_bounded.then_some(massless));
    model.bodies[own].has_unknown_inertia = is_unknown;
    inside(reader, element, own, &Pose::identity(), class, tree);
}

/// Whether the first joint of the file, in document order, is a free joint.
pub(super) fn has_free_base(root: &Element) -> bool {
    fn first(element: &Element) -> Option<&Element> {
        element.children.iter().find_map(|child| {
            if ["joint", "freejoint"].contains(&child.name.as_str()) {
                return Some(child);
            }
            let holds_bodies = ["worldbody", "body", "frame"].contains(&child.name.as_str());
            if holds_bodies { first(child) } else { None }
        })
    }
    first(root).is_some_and(is_free)
}

/// Whether a joint lets its body move freely.
fn is_free(joint: &Element) -> bool {
    joint.name == "freejoint" || joint.get("type") == Some("free")
}

/// Name of a joint.
fn free_name(joint: &Element, taken: &mut TakenNames, model: &Model) -> String {
    match joint.get("name") {
        Some(name) => name.to_owned(),
        None => taken.joint(&format!("joint{}", model.joints.len() + 1)),
    }
}

/// Adds massless bodies that translate along x, y and z, and returns the last one.
fn carriers(
    joint: &Element,
    name: &str,
    parent: usize,
    placement: Pose,
    model: &mut Model,
) -> usize {
    let (mut parent, mut placement) = (parent, placement);
    for (axis, letter) in ["x", "y", "z"].into_iter().enumerate() {
        model.joints.push(Joint {
            axis: Vector3::ith(axis, 1.0),
            is_virtual: true,
            ..Joint::new(
                &format!("{name} {letter}"),
                JointType::Prismatic,
                joint.place.clone(),
            )
        });
        model.bodies.push(Body {
            name: String::new(),
            parent,
            placement,
            place: None,
            joint: Some(model.joints.len() - 1),
            inertia: None,
            has_unknown_inertia: false,
        });
        parent = model.bodies.len() - 1;
        placement = Pose::identity();
    }
    parent
}

/// Adds a body that rotates freely about its parent's origin.
fn push_free(
    joint: &Element,
    joint_name: &str,
    name: &str,
    element: &Element,
    parent: usize,
    model: &mut Model,
) {
    model.joints.push(Joint {
        is_virtual: true,
        ..Joint::new(joint_name, JointType::Ball, joint.place.clone())
    });
    model.bodies.push(Body {
        name: name.to_owned(),
        parent,
        placement: Pose::identity(),
        place: Some(element.place.clone()),
        joint: Some(model.joints.len() - 1),
        inertia: None,
        has_unknown_inertia: false,
    });
}

/// Joints of a body in file order, with their enclosing frames' pose in the body.
fn gather_joints(
    reader: &Reader<'_>,
    element: &Element,
    offset: &Pose,
    class: &str,
    joints: &mut Vec<(Element, Pose)>,
) {
    for child in &element.children {
        match child.name.as_str() {
            "freejoint" => joints.push((child.clone(), *offset)),
            "joint" => {
                let whole = reader.defaults.apply(reader.files, child, class);
                joints.push((whole, *offset));
            }
            "frame" => {
                let class = child.get("childclass").unwrap_or(class);
                let offset = offset * reader.compiler.frame(reader.files, child);
                gather_joints(reader, child, &offset, class, joints);
            }
            _ => {}
        }
    }
}

fn joint(
    reader: &Reader<'_>,
    element: &Element,
    taken: &mut TakenNames,
    model: &mut Model,
) -> Option<Joint> {
    let files = reader.files;
    let name = free_name(element, taken, model);
    let kind = if element.name == "freejoint" {
        Some("free")
    } else {
        element.get("type")
    };
    let kind = match kind {
        Some("free") => {
            if reader.options.fix_base {
                model.notes.push(format!(
                    "`{name}` lets the base float; it is fixed here at its position."
                ));
            } else {
                let message = format!("`{name}` is a free joint, which is not supported");
                let help =
                    "a floating base has no motor to identify it with: `--fix-base` fixes it";
                files.report(&element.place, message, help);
            }
            return None;
        }
        None | Some("hinge") => JointType::Revolute,
        Some("slide") => JointType::Prismatic,
        Some("ball") => JointType::Ball,
        Some(other) => {
            let message = format!("the joint `{name}` is `{other}`, which is not supported");
            files.report(
                &element.place,
                message,
                "supported are hinge, slide and ball joints",
            );
            return None;
        }
    };
    if model.joint_named(&name).is_some() {
        let message = format!("two joints have the name `{name}`");
        files.report(&element.place, message, "give each joint a name of its own");
    }
    let mut joint = Joint::new(&name, kind, element.place.clone());
    joint.at = Point3::from(element.numbers(files, "pos").unwrap_or_default());
    if kind != JointType::Ball {
        let [x, y, z] = element.numbers(files, "axis").unwrap_or([0.0, 0.0, 1.0]);
        let Some(axis) = exact::unit(&Vector3::new(x, y, z), exact::SHORTEST) else {
            files.report(
                &element.place,
                "the axis has no direction",
                "write for instance axis=\"0 0 1\"",
            );
            return None;
        };
        joint.axis = axis;
    }
    let position = |key: &str| {
        let value = element.number(files, key, 0.0);
        if kind == JointType::Revolute {
            reader.compiler.angle(value)
        } else {
            value
        }
    };
    joint.reference = position("ref");
    joint.range = range(reader, element, kind);
    joint.home = joint.reference;
    [joint.damping, joint.friction, joint.armature] =
        ["damping", "frictionloss", "armature"].map(|key| first(files, element, key));
    joint.given = Some([joint.armature, joint.damping, joint.friction]);
    let stiffness = first(files, element, "stiffness");
    let rest = position("springref");
    joint.rest = Some(rest);
    if stiffness != 0.0 {
        joint.spring = Some((stiffness, rest));
    }
    Some(joint)
}

/// Spring and damper given by `springdamper`.
fn spring_damper(
    reader: &Reader<'_>,
    element: &Element,
    model: &Model,
    joint: usize,
) -> Option<SpringDamper> {
    let files = reader.files;
    let [time_constant, damping_ratio] = element.numbers(files, "springdamper")?;
    if [time_constant, damping_ratio] == [0.0; 2] {
        return None;
    }
    let kind = model.joints[joint].kind;
    if kind == JointType::Ball {
        let reason = "LEFT OUT: torques of ball joints are not supported";
        files.demote(&element.place, "joint", Some("springdamper"), reason);
        return None;
    }
    if time_constant <= 0.0 || damping_ratio <= 0.0 {
        let message = "`springdamper` has to be two positive numbers";
        let help = "write a time constant in s and a damping ratio, for instance \"0.1 1\"";
        files.report(&element.place, message, help);
        return None;
    }
    let rest = element.number(files, "springref", 0.0);
    Some(SpringDamper {
        joint,
        time_constant,
        damping_ratio,
        rest: if kind == JointType::Revolute {
            reader.compiler.angle(rest)
        } else {
            rest
        },
    })
}

/// Names of bodies that are taken; the ground has that of MJCF.
fn taken_bodies(model: &Model) -> BTreeSet<String> {
    let others = model.bodies.iter().skip(1).map(|body| body.name.clone());
    others.chain([WORLD.to_owned()]).collect()
}

/// Limits of a joint, if it is limited.
fn range(reader: &Reader<'_>, element: &Element, kind: JointType) -> Option<[f64; 2]> {
    let limits: [f64; 2] = element.numbers(reader.files, "range")?;
    let is_limited = match element.keyword(reader.files, "limited", BOOLEAN_OR_AUTO) {
        Some("true") => true,
        Some("false") => false,
        _ => reader.compiler.limits_ranges,
    };
    let limits = match kind {
        JointType::Revolute => limits.map(|limit| reader.compiler.angle(limit)),
        JointType::Prismatic => limits,
        JointType::Ball => return None,
    };
    if is_limited && limits[0] >= limits[1] && limits != [0.0; 2] {
        record_empty_range(reader.files, element);
    }
    (is_limited && limits[0] < limits[1]).then_some(limits)
}

/// First number of an attribute: the linear coefficient of a polynomial.
pub(super) fn first(files: &Files, element: &Element, key: &str) -> f64 {
    let all = element.list(files, key).unwrap_or_default();
    if let Some((_, place)) = element
        .attribute(key)
        .filter(|_| all.iter().skip(1).any(|v| *v != 0.0))
    {
        let message = format!("`{key}` is a polynomial, which is not supported");
        files.report(place, message, "give one number");
    }
    all.first().copied().unwrap_or(0.0)
}
