//! Turns point closures into pins and frames where the loops make them equal.

use crate::assembly::{
    blocks::Blocks,
    motion::{Motion, State},
    network::{Axis, Edge, Origin, edges, edges_at, grouped},
};
use crate::model::{ClosureKind, JointType, Misfit, Model, Pose};
use nalgebra::{Matrix3, Point3, Rotation3, Vector3};
use std::collections::BTreeMap;

/// Angle below which axes are parallel, rad.
const PARALLEL: f64 = 1e-9;

/// Replaces the points that close planar loops by pins perpendicular to the plane.
///
/// In a planar loop all bodies move in parallel planes, so a point holds as much as a pin. A pin
/// takes one joint of a chain instead of three. It also leaves no other solutions: the equations
/// of a point that are independent at home may be solved off the plane elsewhere.
pub(crate) fn planar(model: &mut Model) {
    if !model.closures.iter().any(|own| is_point(&own.kind)) {
        return;
    }
    let motion = Motion::new(model);
    let Ok(state) = motion.closed(&motion.start()) else {
        return;
    };
    let of_body = grouped(model);
    let edges = edges(model, &of_body);
    let count = of_body.iter().copied().max().unwrap_or(0) + 1;
    let ends: Vec<[usize; 2]> = edges.iter().map(|edge| edge.groups).collect();
    let blocks = Blocks::new(&edges_at(count, &edges), &ends);
    let mut of_block: BTreeMap<usize, Vec<&Edge>> = BTreeMap::new();
    for (at, edge) in edges.iter().enumerate() {
        if let Some(block) = blocks
            .of_edge(edge.groups)
            .filter(|_| !blocks.is_bridge[at])
        {
            of_block.entry(block).or_default().push(edge);
        }
    }
    let mut pins = Vec::new();
    for edges in of_block.values() {
        pins.extend(planar_points(model, &state, edges));
    }
    for (at, normal) in pins {
        let kind = &mut model.closures[at].kind;
        if let ClosureKind::Point { bodies, at } = kind {
            let poses = bodies.map(|body| state.poses[body]);
            let turn = along(&normal);
            let frames = [0, 1].map(|end| {
                let frame = Pose::from_parts((poses[end] * at[end]).coords.into(), turn);
                poses[end].inv_mul(&frame)
            });
            *kind = ClosureKind::Pin {
                bodies: *bodies,
                at: frames,
            };
        }
    }
}

fn is_point(kind: &ClosureKind) -> bool {
    matches!(kind, ClosureKind::Point { .. })
}

/// Point closures between bodies that joints keep in parallel planes, with the planes' normals.
///
/// The bodies are connected by hinges along the normal and slides across it. Other joints of the
/// block do not matter: a point between such bodies holds as much as a pin.
fn planar_points(model: &Model, state: &State, edges: &[&Edge]) -> Vec<(usize, Vector3<f64>)> {
    let carried = model.carried();
    let axes: Vec<Option<Vector3<f64>>> = edges
        .iter()
        .map(|edge| axis(model, state, &carried, edge).map(|own| own.direction))
        .collect();
    let mut normals: Vec<Vector3<f64>> = Vec::new();
    for (edge, axis) in edges.iter().zip(&axes) {
        if let Some(axis) = axis.filter(|_| edge.kind == JointType::Revolute)
            && !normals.iter().any(|normal| is_parallel(normal, &axis))
        {
            normals.push(axis);
        }
    }
    let mut found: BTreeMap<usize, Vector3<f64>> = BTreeMap::new();
    for normal in &normals {
        let plane = planes(edges, &axes, normal);
        for edge in edges.iter().filter(|edge| edge.kind == JointType::Ball) {
            let [a, b] = edge.groups.map(|group| plane[&group]);
            if let Origin::Closure(at) = edge.origin
                && a == b
            {
                found.entry(at).or_insert(*normal);
            }
        }
    }
    found.into_iter().collect()
}

/// Plane of each group of bodies: equal if joints keep the groups in parallel planes.
fn planes(
    edges: &[&Edge],
    axes: &[Option<Vector3<f64>>],
    normal: &Vector3<f64>,
) -> BTreeMap<usize, usize> {
    let groups = edges.iter().flat_map(|edge| edge.groups);
    let mut plane: BTreeMap<usize, usize> = groups.map(|group| (group, group)).collect();
    for (edge, axis) in edges.iter().zip(axes) {
        let is_planar = axis.is_some_and(|axis| match edge.kind {
            JointType::Revolute => is_parallel(normal, &axis),
            JointType::Prismatic => axis.dot(normal).abs() < PARALLEL,
            JointType::Ball => false,
        });
        if is_planar {
            let [a, b] = edge.groups.map(|group| plane[&group]);
            for own in plane.values_mut().filter(|own| **own == b) {
                *own = a;
            }
        }
    }
    plane
}

fn is_parallel(a: &Vector3<f64>, b: &Vector3<f64>) -> bool {
    a.cross(b).norm() < PARALLEL
}

/// Axis of a joint or pin in a configuration; `None` for other edges.
fn axis(model: &Model, state: &State, carried: &[usize], edge: &Edge) -> Option<Axis> {
    match edge.origin {
        Origin::Platform => None,
        Origin::Joint(joint) => {
            let pose = state.poses[carried[joint]];
            Some(Axis {
                point: pose * model.joints[joint].at,
                direction: pose.rotation * model.joints[joint].axis,
            })
        }
        Origin::Closure(closure) => match &model.closures[closure].kind {
            ClosureKind::Pin { bodies, at } => {
                let frame = state.poses[bodies[0]] * at[0];
                Some(Axis {
                    point: Point3::from(frame.translation.vector),
                    direction: frame.rotation * Vector3::z(),
                })
            }
            ClosureKind::Point { .. } | ClosureKind::Weld { .. } => None,
        },
    }
}

/// Rotation with its z axis in a direction.
fn along(direction: &Vector3<f64>) -> Rotation3<f64> {
    let turn = Rotation3::rotation_between(&Vector3::z(), direction);
    turn.unwrap_or_else(|| Rotation3::from_axis_angle(&Vector3::x_axis(), std::f64::consts::PI))
}

/// Shortest distance between two points that give the direction of a pin, m.
const APART: f64 = 1e-6;
/// Distance of a third point from their line, as a fraction of the extent, that makes a frame.
const ASIDE: f64 = 1e-2;
/// Misfits below this are rounding errors, m.
const ROUNDING: f64 = 1e-9;

/// Joins points between the same two bodies: two are a pin, three a frame.
///
/// Points whose distances differ between the bodies by more than the tolerance stay as they are.
pub(crate) fn join_points(model: &mut Model, tolerance: f64) {
    let mut of_pair: BTreeMap<[usize; 2], Vec<usize>> = BTreeMap::new();
    for (at, closure) in model.closures.iter().enumerate() {
        if is_point(&closure.kind) {
            let mut bodies = closure.bodies().map(|body| fixed_to(model, body));
            bodies.sort_unstable();
            of_pair.entry(bodies).or_default().push(at);
        }
    }
    let mut dropped = Vec::new();
    for (bodies, same) in of_pair.iter().filter(|(_, same)| same.len() > 1) {
        let Some(Joined { kind, misfit }) = joined(model, *bodies, same, tolerance) else {
            continue;
        };
        let names = { same.iter() }.map(|&at| format!("`{}`", model.closures[at].name));
        let names: Vec<String> = names.collect();
        let what = match kind {
            ClosureKind::Weld { .. } => "fix both bodies to each other",
            _ => "are a pin through them",
        };
        model.notes.push(format!(
            "The points {} connect the same bodies: they {what}.",
            names.join(", ")
        ));
        if misfit > ROUNDING {
            let last = &model.closures[same[same.len() - 1]];
            model.misfits.push(Misfit {
                name: last.name.clone(),
                place: last.place.clone(),
                length: misfit,
                angle: 0.0,
            });
        }
        model.closures[same[0]].kind = kind;
        dropped.extend(&same[1..]);
    }
    let mut at = 0;
    model.closures.retain(|_| {
        at += 1;
        !dropped.contains(&(at - 1))
    });
}

/// Body that a body is fixed to.
fn fixed_to(model: &Model, body: usize) -> usize {
    let mut at = body;
    while at != 0 && model.bodies[at].joint.is_none() {
        at = model.bodies[at].parent;
    }
    at
}

/// Closure that several points are.
struct Joined {
    kind: ClosureKind,
    /// Largest difference of two points' distances in both bodies, m.
    misfit: f64,
}

/// Pin or frame of several points between two bodies; `None` if they have another distance.
fn joined(model: &Model, bodies: [usize; 2], same: &[usize], tolerance: f64) -> Option<Joined> {
    let poses = Motion::new(model).start().poses;
    let mut points: Vec<[Point3<f64>; 2]> = Vec::new();
    for &at in same {
        let ClosureKind::Point { bodies: own, at } = &model.closures[at].kind else {
            return None;
        };
        let is_swapped = fixed_to(model, own[0]) != bodies[0];
        let ends = if is_swapped { [1, 0] } else { [0, 1] };
        points.push([0, 1].map(|side| {
            let end = ends[side];
            poses[bodies[side]].inverse_transform_point(&(poses[own[end]] * at[end]))
        }));
    }
    let (mut misfit, mut extent) = (0.0_f64, 0.0_f64);
    for (at, first) in points.iter().enumerate() {
        for second in &points[at + 1..] {
            let [a, b] = [0, 1].map(|side| (second[side] - first[side]).norm());
            misfit = misfit.max((a - b).abs());
            extent = extent.max(a.max(b));
        }
    }
    if misfit > tolerance * extent {
        return None;
    }
    let apart = |at: usize| [0, 1].map(|side| points[at][side] - points[0][side]);
    let second = (1..points.len()).find(|&at| apart(at)[0].norm() > APART)?;
    let lines = apart(second).map(|line| line.normalize());
    let third = (1..points.len()).find(|&at| lines[0].cross(&apart(at)[0]).norm() > ASIDE * extent);
    let at = [0, 1].map(|side| {
        let z = lines[side];
        let turn = third.map_or_else(
            || along(&z),
            |third| {
                let other = apart(third)[side];
                let x = (other - z * z.dot(&other)).normalize();
                let axes = Matrix3::from_columns(&[x, z.cross(&x), z]);
                Rotation3::from_matrix_unchecked(axes)
            },
        );
        Pose::from_parts(points[0][side].coords.into(), turn)
    });
    let kind = if third.is_some() {
        ClosureKind::Weld { bodies, at }
    } else {
        ClosureKind::Pin { bodies, at }
    };
    Some(Joined { kind, misfit })
}
