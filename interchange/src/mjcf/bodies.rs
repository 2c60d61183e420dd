//! Bodies, their joints and inertias.

use super::{Reader, Sites, defaults::MAIN};
use crate::{
    files::Files,
    geometry::exact,
    model::{Body, Inertia, Joint, Kind, Model, Pose},
    xml::Element,
};
use nalgebra::{Matrix3, Point3, Vector3};

pub(super) fn read(reader: &Reader<'_>, root: &Element, model: &mut Model, sites: &mut Sites) {
    for world in root.all("worldbody") {
        let class = world.get("childclass").unwrap_or(MAIN).to_owned();
        inside(reader, world, 0, &Pose::identity(), &class, model, sites);
    }
}

/// The bodies, sites and frames in a body; `offset` is that of frames around them.
fn inside(
    reader: &Reader<'_>,
    element: &Element,
    parent: usize,
    offset: &Pose,
    class: &str,
    model: &mut Model,
    sites: &mut Sites,
) {
    for child in &element.children {
        let class = child.get("childclass").unwrap_or(class).to_owned();
        match child.name.as_str() {
            "body" => body(reader, child, parent, offset, &class, model, sites),
            "frame" => {
                let offset = offset * reader.compiler.frame(reader.files, child);
                inside(reader, child, parent, &offset, &class, model, sites);
            }
            "site" => {
                let whole = reader.defaults.apply(reader.files, child, &class);
                let at = offset * reader.compiler.frame(reader.files, &whole);
                if let Some(name) = child.get("name") {
                    sites.insert(name.to_owned(), (parent, at));
                }
            }
            "replicate" | "attach" => {
                let message = format!("<{}> can't be said", child.name);
                reader.files.report(
                    &child.place,
                    message,
                    "write the bodies out: save the model as MJCF from MuJoCo",
                );
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
    model: &mut Model,
    sites: &mut Sites,
) {
    let files = reader.files;
    let name = element
        .get("name")
        .map_or_else(|| format!("body{}", model.bodies.len()), str::to_owned);
    if model.body_named(&name).is_some() {
        let message = format!("two bodies are called `{name}`");
        files.report(&element.place, message, "give each body a name of its own");
    }
    let joints: Vec<Element> = element
        .children
        .iter()
        .filter(|child| child.name == "joint" || child.name == "freejoint")
        .map(|joint| reader.defaults.apply(files, joint, class))
        .collect();
    let mut placement = offset * reader.compiler.frame(files, element);
    let mut parent = parent;
    let count = joints.len();
    for (at, own) in joints.iter().enumerate() {
        let Some(joint) = joint(reader, own, model) else {
            continue;
        };
        model.joints.push(joint);
        // All joints but the last carry a massless body in the same place.
        let is_last = at + 1 == count;
        model.bodies.push(Body {
            name: if is_last {
                name.clone()
            } else {
                format!("{name}_{}", at + 1)
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
    model.bodies[own].inertia = inertia(reader, element, model);
    inside(reader, element, own, &Pose::identity(), class, model, sites);
}

fn joint(reader: &Reader<'_>, element: &Element, model: &mut Model) -> Option<Joint> {
    let files = reader.files;
    let name = element
        .get("name")
        .map_or_else(|| format!("joint{}", model.joints.len() + 1), str::to_owned);
    let kind = match (element.name.as_str(), element.get("type")) {
        ("freejoint", _) | (_, Some("free")) => {
            if reader.options.fix_base {
                model.notes.push(format!(
                    "`{name}` lets the base float; it is fixed here where it stands."
                ));
            } else {
                let message = format!("`{name}` is a free joint, which can't be said");
                let help = "a base that floats has no motor to identify from: `--fix-base` fixes it where it stands";
                files.report(&element.place, message, help);
            }
            return None;
        }
        (_, None | Some("hinge")) => Kind::Revolute,
        (_, Some("slide")) => Kind::Prismatic,
        (_, Some("ball")) => Kind::Ball,
        (_, Some(other)) => {
            let message = format!("the joint `{name}` is `{other}`, which can't be said");
            files.report(&element.place, message, "hinge, slide and ball joints can");
            return None;
        }
    };
    if model.joint_named(&name).is_some() {
        let message = format!("two joints are called `{name}`");
        files.report(&element.place, message, "give each joint a name of its own");
    }
    let mut joint = Joint::new(&name, kind, element.place.clone());
    joint.at = Point3::from(element.numbers(files, "pos").unwrap_or_default());
    if kind != Kind::Ball {
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
        if kind == Kind::Revolute {
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
    let stiffness = first(files, element, "stiffness");
    if stiffness != 0.0 {
        joint.spring = Some((stiffness, position("springref")));
    }
    Some(joint)
}

/// The limits of a joint where it has some.
fn range(reader: &Reader<'_>, element: &Element, kind: Kind) -> Option<[f64; 2]> {
    let limits: [f64; 2] = element.numbers(reader.files, "range")?;
    let is_limited = match element.get("limited") {
        Some("true") => true,
        Some("false") => false,
        _ => reader.compiler.limits_ranges,
    };
    let limits = match kind {
        Kind::Revolute => limits.map(|limit| reader.compiler.angle(limit)),
        Kind::Prismatic => limits,
        Kind::Ball => return None,
    };
    (is_limited && limits[0] < limits[1]).then_some(limits)
}

/// The first number of an attribute: of polynomials the linear one.
fn first(files: &Files, element: &Element, key: &str) -> f64 {
    let all = element.list(files, key).unwrap_or_default();
    if let Some((_, place)) = element
        .attribute(key)
        .filter(|_| all.iter().skip(1).any(|v| *v != 0.0))
    {
        let message = format!("`{key}` is a polynomial, which can't be said");
        files.report(place, message, "give one number");
    }
    all.first().copied().unwrap_or(0.0)
}

fn inertia(reader: &Reader<'_>, element: &Element, model: &mut Model) -> Option<Inertia> {
    let files = reader.files;
    let name = element.get("name").unwrap_or("a body");
    let Some(inertial) = element
        .child("inertial")
        .filter(|_| !reader.compiler.inertia_from_geometry)
    else {
        model.notes.push(format!(
            "`{name}` has no <inertial>: its mass and inertia, which MuJoCo takes from its geometry, are zero here."
        ));
        return None;
    };
    let mass = inertial.number(files, "mass", 0.0);
    let frame = reader.compiler.frame(files, inertial);
    if let Some([xx, yy, zz, xy, xz, yz]) = inertial.numbers(files, "fullinertia") {
        let tensor = Matrix3::new(xx, xy, xz, xy, yy, yz, xz, yz, zz);
        // MuJoCo turns its frame to the principal axes; the tensor is that of the body's.
        let frame = Pose::from_parts(frame.translation, nalgebra::Rotation3::identity());
        return Some(
            Inertia {
                mass,
                centre: Point3::origin(),
                tensor,
            }
            .seen(&frame),
        );
    }
    let diagonal = inertial
        .numbers::<3>(files, "diaginertia")
        .unwrap_or_default();
    let tensor = Matrix3::from_diagonal(&Vector3::from(diagonal));
    let rotation = exact::cleaned(&frame.rotation);
    let frame = Pose::from_parts(frame.translation, rotation);
    Some(
        Inertia {
            mass,
            centre: Point3::origin(),
            tensor,
        }
        .seen(&frame),
    )
}
