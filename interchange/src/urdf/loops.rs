//! Loop closures and couplings in a URDF file.
//!
//! Four notations of closures are read:
//! - `<loop>` of URDF+ (Chignoli, Slotine, Wensing, Kim 2024),
//! - `<constraint>` as proposed for urdfdom,
//! - `<loop_joint>` of Isaac Sim,
//! - `<drake:ball_constraint>` of Drake.
//!
//! Couplings are `<coupling>` of URDF+.

use super::{Tree, joints, origin};
use crate::{
    couplings::{Coupling, Couplings},
    files::Files,
    geometry::exact,
    model::{Closure, ClosureKind, Model, Pose},
    xml::Element,
};
use nalgebra::{Point3, Rotation3, Vector3};

/// Reads all closures of a file into the model.
pub(super) fn read(files: &Files, root: &Element, tree: &Tree, model: &mut Model) {
    let named = |element: &Element| element.get("name").unwrap_or(&element.name).to_owned();
    ball_constraints(files, root, tree, model);
    for (tag, ends, frames) in NOTATIONS {
        for element in root.all(tag) {
            let frame = |at: usize| {
                let end = element.child(ends[at])?;
                let link = end.required(files, "link")?;
                let body = tree.find(files, link, &end.place)?;
                let own = match frames[at] {
                    "" => end.child("origin").or(Some(end)),
                    frame => element.child(frame),
                };
                Some((body, origin(files, own)))
            };
            if ends.iter().any(|end| element.child(end).is_none()) {
                let [first, second] = ends;
                let message = format!(
                    "`{}` does not name the links that it connects",
                    named(element)
                );
                let help = format!("write <{first} link=\"…\"/> and <{second} link=\"…\"/>");
                files.report(&element.place, message, help);
                continue;
            }
            let (Some(a), Some(b)) = (frame(0), frame(1)) else {
                continue;
            };
            let Some(kind) = kind(files, element, [a.0, b.0], [a.1, b.1]) else {
                continue;
            };
            let place = element.place.clone();
            model.closures.push(Closure {
                name: named(element),
                kind,
                place,
            });
        }
    }
}

/// Reads `<drake:ball_constraint>`: coincident points of two bodies.
fn ball_constraints(files: &Files, root: &Element, tree: &Tree, model: &mut Model) {
    for element in root.all("ball_constraint") {
        let end = |body: &str, point: &str| {
            let body = element.child(body)?;
            let body = tree.find(files, body.required(files, "name")?, &body.place)?;
            let point = element.child(point);
            let point = point.map_or(Some([0.0; 3]), |point| point.numbers(files, "value"))?;
            Some((body, Point3::from(point)))
        };
        let first = end("ball_constraint_body_A", "ball_constraint_p_AP");
        let second = end("ball_constraint_body_B", "ball_constraint_p_BQ");
        let (Some(first), Some(second)) = (first, second) else {
            let message = "the constraint does not name the coinciding points and their links";
            let help = "give drake:ball_constraint_body_A, _p_AP, _body_B and _p_BQ";
            files.report(&element.place, message, help);
            continue;
        };
        model.closures.push(Closure {
            name: element.name.clone(),
            kind: ClosureKind::Point {
                bodies: [first.0, second.0],
                at: [first.1, second.1],
            },
            place: element.place.clone(),
        });
    }
}

/// Tags of each notation: the closure, its two ends, and the frames of the ends.
///
/// An empty frame tag means that the end contains the frame: in `<origin>`, or as attributes.
const NOTATIONS: [(&str, [&str; 2], [&str; 2]); 3] = [
    ("loop", ["predecessor", "successor"], ["", ""]),
    (
        "constraint",
        ["parent", "child"],
        ["parent_origin", "child_origin"],
    ),
    ("loop_joint", ["link1", "link2"], ["", ""]),
];

/// Kind of a closure from its `type`; `None` after an error.
fn kind(
    files: &Files,
    element: &Element,
    bodies: [usize; 2],
    frames: [Pose; 2],
) -> Option<ClosureKind> {
    match element.get("type").unwrap_or("no type") {
        "spherical" | "ball" => {
            let at = frames.map(|frame| Point3::from(frame.translation.vector));
            Some(ClosureKind::Point { bodies, at })
        }
        "fixed" => Some(ClosureKind::Weld { bodies, at: frames }),
        "revolute" | "continuous" => {
            let of = |tag: &str| axis_of(files, element, tag);
            let axes = [
                of("parent_axis").or_else(|| of("axis")),
                of("child_axis").or_else(|| of("axis")),
            ];
            let [Some(a), Some(b)] = axes else {
                return None;
            };
            let [frame_a, frame_b] = frames;
            let at = [frame_a * frame_with_z(&a), frame_b * frame_with_z(&b)];
            Some(ClosureKind::Pin { bodies, at })
        }
        other => {
            let message = format!("a closure by `{other}` is not supported");
            let help = "supported are spherical, revolute, continuous and fixed closures";
            files.report(&element.place, message, help);
            None
        }
    }
}

/// Axis in a child element; without `<axis>`, the default of URDF.
fn axis_of(files: &Files, element: &Element, tag: &str) -> Option<Vector3<f64>> {
    if tag == "axis" {
        return joints::axis(files, element);
    }
    let [x, y, z] = element.child(tag)?.numbers(files, "xyz")?;
    exact::unit(&Vector3::new(x, y, z), exact::SHORTEST)
}

/// Frame with a given z axis, by the smallest rotation.
pub(super) fn frame_with_z(axis: &Vector3<f64>) -> Pose {
    let rotation = Rotation3::rotation_between(&Vector3::z(), axis);
    let rotation = rotation
        .unwrap_or_else(|| Rotation3::from_axis_angle(&Vector3::x_axis(), std::f64::consts::PI));
    Pose::from_parts(Vector3::zeros().into(), rotation)
}

/// Reads `<coupling>` of URDF+.
///
/// Sum of the joints to the successor = `ratio` × sum of the joints to the predecessor; both sums
/// begin at the nearest common ancestor of the two links.
pub(super) fn couplings(
    files: &Files,
    root: &Element,
    tree: &Tree,
    model: &Model,
    couplings: &mut Couplings,
) {
    for element in root.all("coupling") {
        let link = |tag: &str| {
            let Some(end) = element.child(tag) else {
                let message = format!("the coupling has no <{tag}>");
                let help = format!("write <{tag} link=\"…\"/>");
                files.report(&element.place, message, help);
                return None;
            };
            tree.find(files, end.required(files, "link")?, &end.place)
        };
        let (Some(predecessor), Some(successor)) = (link("predecessor"), link("successor")) else {
            continue;
        };
        let ratio = element
            .child("ratio")
            .map_or(1.0, |ratio| ratio.number(files, "value", 1.0));
        let [to_predecessor, to_successor] = paths(model, [predecessor, successor]);
        let terms: Vec<(usize, f64)> = to_successor
            .iter()
            .map(|joint| (*joint, 1.0))
            .chain(to_predecessor.iter().map(|joint| (*joint, -ratio)))
            .collect();
        match Coupling::of_sum(&terms, 0.0, &element.place) {
            Some(coupling) => couplings.add(coupling),
            None => {
                let names: Vec<String> = terms
                    .iter()
                    .map(|(joint, _)| format!("`{}`", model.joints[*joint].name))
                    .collect();
                let message = format!(
                    "the coupling is between {} joints, not two: {}",
                    names.len(),
                    names.join(", ")
                );
                let help = "only two joints between both links and their nearest common ancestor can be coupled; \
                            write other couplings as <mimic>";
                files.report(&element.place, message, help);
            }
        }
    }
}

/// Joints from the nearest common ancestor of two bodies to each of them.
fn paths(model: &Model, ends: [usize; 2]) -> [Vec<usize>; 2] {
    let to_ground = |end: usize| {
        let bodies =
            std::iter::successors(Some(end), |at| (*at != 0).then(|| model.bodies[*at].parent));
        let mut bodies: Vec<usize> = bodies.collect();
        bodies.reverse();
        bodies
    };
    let all = ends.map(to_ground);
    let shared = all[0].iter().zip(&all[1]).take_while(|(a, b)| a == b);
    let shared = shared.count();
    all.map(|bodies| {
        let own = bodies[shared..].iter();
        own.filter_map(|body| model.bodies[*body].joint).collect()
    })
}
