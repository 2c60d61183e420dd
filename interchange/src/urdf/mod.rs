//! Reader of URDF: a tree of links and joints, and loops in several notations.

mod gazebo;
mod joints;
mod loops;
mod massless;
mod others;
mod transmissions;
mod yaml;

use crate::{
    account::{URDF, Use},
    bounds,
    couplings::Couplings,
    files::{Files, Place},
    geometry::exact,
    model::{Body, Inertia, Model, Pose},
    options::Options,
    prune::keep_honoured,
    xml::{self, Element},
};
use nalgebra::{Matrix3, Point3, Translation3};
use std::collections::BTreeMap;

/// Reads a robot; errors are recorded in `files`.
pub(crate) fn read(files: &Files, file: usize, options: &Options) -> Option<Model> {
    let mut root = xml::parse(files, file)?;
    if root.name != "robot" {
        let message = format!("`{}` is not a URDF robot", root.name);
        files.report(&root.place, message, "the first element of URDF is <robot>");
        return None;
    }
    refuse_macros(files, file)?;
    let shaped = massless::shaped_links(&root);
    keep_honoured(files, &URDF, &mut root);
    bounds::check_elements(files, &root)?;
    let mut model = Model::new(root.get("name").unwrap_or("robot"));
    let links = links(files, &root);
    let mut tree = joints::tree(files, &root, &links, options, &mut model)?;
    transmissions::read(files, &root, &tree, &mut model);
    loops::read(files, &root, &tree, &mut model);
    gazebo::read(files, &root, &tree, &mut model);
    yaml::read(files, file, &mut tree, &mut model);
    others::report(files, file, &tree);
    massless::report(files, &shaped, &tree, &model);
    // After the YAML file, which may change joints to ball joints.
    let mut couplings = Couplings::default();
    joints::mimics(files, &root, &model, &mut couplings);
    loops::couplings(files, &root, &tree, &model, &mut couplings);
    couplings.resolve(files, &mut model);
    files.is_clean().then_some(model)
}

/// Rejects files with elements of xacro, which stand for others; `None` after an error.
fn refuse_macros(files: &Files, file: usize) -> Option<()> {
    let text = files.text(file);
    let mut rest = 0;
    while let Some(at) = text[rest..].find('<').map(|at| rest + at) {
        if text[at..].starts_with("<!--") {
            rest = text[at..].find("-->").map_or(text.len(), |end| at + end);
        } else if text[at..].starts_with("<xacro:") {
            let place = Place {
                file,
                span: at..at + "<xacro".len(),
            };
            let help = "expand its macros first: `xacro FILE -o robot.urdf`";
            files.report(&place, "this is a xacro file, not URDF", help);
            return None;
        } else {
            rest = at + 1;
        }
    }
    Some(())
}

/// Links by name.
type Links<'e> = BTreeMap<&'e str, &'e Element>;

fn links<'e>(files: &Files, root: &'e Element) -> Links<'e> {
    let mut links = Links::new();
    for link in root.all("link") {
        let Some(name) = link.required(files, "name") else {
            continue;
        };
        if links.insert(name, link).is_some() {
            let message = format!("two links have the name `{name}`");
            files.report(&link.place, message, "give each link a name of its own");
        }
    }
    links
}

/// Pose of `<origin>`, or of an element with `xyz` and `rpy`.
pub(crate) fn origin(files: &Files, of: Option<&Element>) -> Pose {
    let Some(element) = of else {
        return Pose::identity();
    };
    let [x, y, z] = element.numbers(files, "xyz").unwrap_or_default();
    let rotation = match element.numbers::<4>(files, "quat_xyzw") {
        Some([qx, qy, qz, qw]) => exact::quaternion([qw, qx, qy, qz]),
        None => {
            let angles = element.numbers(files, "rpy").unwrap_or_default();
            bounds::check_angles(files, &element.place, &angles);
            Some(exact::roll_pitch_yaw(angles))
        }
    };
    Pose::from_parts(Translation3::new(x, y, z), rotation.unwrap_or_default())
}

/// Body of a link, without its joint.
fn body(files: &Files, link: &Element, parent: usize, placement: Pose) -> Body {
    Body {
        name: link.get("name").unwrap_or_default().to_owned(),
        parent,
        placement,
        place: Some(link.place.clone()),
        joint: None,
        inertia: link
            .child("inertial")
            .map(|inertial| inertia(files, inertial)),
        has_unknown_inertia: false,
    }
}

fn inertia(files: &Files, inertial: &Element) -> Inertia {
    let reason = "absent: zero in the model";
    for (tag, values) in [
        ("mass", &["value"][..]),
        ("inertia", &["ixx", "iyy", "izz"]),
    ] {
        let Some(own) = inertial.child(tag) else {
            let place = &inertial.place;
            files.record(Use::Reported, place, "inertial", Some(tag), reason);
            continue;
        };
        for value in values.iter().filter(|value| own.get(value).is_none()) {
            files.record(Use::Reported, &own.place, tag, Some(value), reason);
        }
    }
    let mass = inertial
        .child("mass")
        .map_or(0.0, |mass| mass.number(files, "value", 0.0));
    let value = |name: &str| {
        let found = inertial.child("inertia");
        found.map_or(0.0, |inertia| inertia.number(files, name, 0.0))
    };
    let [xx, xy, xz] = [value("ixx"), value("ixy"), value("ixz")];
    let [yy, yz, zz] = [value("iyy"), value("iyz"), value("izz")];
    let tensor = Matrix3::new(xx, xy, xz, xy, yy, yz, xz, yz, zz);
    let frame = origin(files, inertial.child("origin"));
    if mass < 0.0 {
        let message = "a mass is negative";
        files.report(&inertial.place, message, "give a mass that is zero or more");
    }
    Inertia {
        mass,
        centre: Point3::origin(),
        tensor,
    }
    .transformed(&frame)
}

/// Bodies by the names of links and joints.
#[derive(Debug)]
struct Tree {
    bodies: BTreeMap<String, usize>,
    /// Body that each joint carries, fixed joints included; its frame is that of the joint.
    by_joint: BTreeMap<String, usize>,
}

impl Tree {
    /// Body of a link or of a joint's name; reports an error if there is neither.
    fn find(&self, files: &Files, name: &str, place: &Place) -> Option<usize> {
        let found = self.bodies.get(name).or_else(|| self.by_joint.get(name));
        let found = found.copied();
        if found.is_none() {
            let message = format!("there is no link or joint `{name}`");
            let names = self.bodies.keys().map(String::as_str);
            let help = files.did_you_mean(name, names);
            files.report(
                place,
                message,
                help.unwrap_or_else(|| "name a <link>".to_owned()),
            );
        }
        found
    }

    /// Inserts an auxiliary body before another one; both maps are kept up to date.
    fn insert_before(&mut self, body: usize, new: Body, model: &mut Model) {
        model.insert_body(body, new);
        let all = self.bodies.values_mut().chain(self.by_joint.values_mut());
        for own in all.filter(|own| **own >= body) {
            *own += 1;
        }
    }
}
