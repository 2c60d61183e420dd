//! Joints in `<gazebo>`, which Gazebo adds to the converted robot: they close loops.
//!
//! They are in SDFormat: the pose is relative to the child link, the axis is in the frame of the
//! joint. As all joints of SDFormat, they are at zero in the configuration of the file.

use super::{Tree, loops::frame_with_z};
use crate::{
    assembly::motion::Motion,
    bounds,
    files::Files,
    geometry::exact,
    model::{Closure, ClosureKind, Model, Pose},
    xml::{Element, numbers},
};
use nalgebra::{Point3, Translation3};

/// Reads all closures of `<gazebo>` into the model.
pub(super) fn read(files: &Files, root: &Element, tree: &Tree, model: &mut Model) {
    let joints: Vec<&Element> = root
        .all("gazebo")
        .flat_map(|own| own.all("joint"))
        .collect();
    if joints.is_empty() {
        return;
    }
    let poses = Motion::new(model).start().poses;
    for joint in joints {
        if let Some(kind) = kind(files, joint, tree, &poses) {
            model.closures.push(Closure {
                name: joint.get("name").unwrap_or("joint").to_owned(),
                kind,
                place: joint.place.clone(),
            });
        }
    }
}

/// Closure of a joint; `None` after an error.
fn kind(files: &Files, joint: &Element, tree: &Tree, poses: &[Pose]) -> Option<ClosureKind> {
    let end = |tag: &str| {
        let Some(link) = joint.child(tag) else {
            let message = format!("the joint has no <{tag}>");
            files.report(&joint.place, message, format!("write <{tag}>LINK</{tag}>"));
            return None;
        };
        let (name, place) = &link.text;
        if name == "world" {
            return Some(0);
        }
        tree.find(files, name, place)
    };
    let bodies = [end("parent")?, end("child")?];
    let in_child = pose(files, joint)?;
    let in_parent = poses[bodies[0]].inv_mul(&poses[bodies[1]]) * in_child;
    let at = [in_parent, in_child];
    match joint.get("type").unwrap_or("no type") {
        "revolute" | "continuous" => {
            let axis = frame_with_z(&axis(files, joint)?);
            let at = at.map(|frame| frame * axis);
            Some(ClosureKind::Pin { bodies, at })
        }
        "ball" => {
            let at = at.map(|frame| Point3::from(frame.translation.vector));
            Some(ClosureKind::Point { bodies, at })
        }
        "fixed" => Some(ClosureKind::Weld { bodies, at }),
        other => {
            let message = format!("a joint of <gazebo> of type `{other}` is not supported");
            let help = "supported are revolute, continuous, ball and fixed joints; or convert the file by \
                        `gz sdf -p FILE` and import the SDFormat";
            files.report(&joint.place, message, help);
            None
        }
    }
}

/// Pose in the child link; `None` after an error.
fn pose(files: &Files, joint: &Element) -> Option<Pose> {
    let Some(pose) = joint.child("pose") else {
        return Some(Pose::identity());
    };
    let [x, y, z, roll, pitch, yaw] = several(files, pose)?;
    bounds::check_angles(files, &pose.place, &[roll, pitch, yaw]);
    let rotation = exact::roll_pitch_yaw([roll, pitch, yaw]);
    Some(Pose::from_parts(Translation3::new(x, y, z), rotation))
}

/// Unit axis in the frame of the joint; `None` after an error.
fn axis(files: &Files, joint: &Element) -> Option<nalgebra::Vector3<f64>> {
    let Some(xyz) = joint.child("axis").and_then(|axis| axis.child("xyz")) else {
        let help = "write <axis><xyz>0 0 1</xyz></axis>";
        files.report(&joint.place, "the joint has no axis", help);
        return None;
    };
    let found = exact::direction(several(files, xyz)?);
    if found.is_none() {
        let help = "write for instance <xyz>0 0 1</xyz>";
        files.report(&xyz.place, "the axis has no direction", help);
    }
    found
}

/// Numbers in the text of an element; `None` after an error.
fn several<const N: usize>(files: &Files, element: &Element) -> Option<[f64; N]> {
    let (text, place) = &element.text;
    let found = numbers(text).and_then(|all| <[f64; N]>::try_from(all).ok());
    if found.is_none() {
        let message = format!("<{}> must be {N} finite numbers", element.name);
        files.report(
            place,
            message,
            "write numbers with a decimal point, without units, and with blanks between them",
        );
    }
    found
}
