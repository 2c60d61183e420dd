//! Makes nearly parallel axes of a loop parallel.

use super::{
    blocks::Blocks,
    motion::Motion,
    network::{Origin, edges, edges_at, grouped},
};
use crate::model::{ClosureKind, JointType, Misfit, Model, Pose};
use nalgebra::{Rotation3, Vector3};
use std::collections::BTreeMap;

/// Angle below which axes are parallel up to rounding errors, rad.
const EXACT: f64 = 1e-12;

/// Axis of a loop in the world, in the file's configuration.
struct LoopAxis {
    axis_of: AxisOf,
    block: usize,
    is_prismatic: bool,
    direction: Vector3<f64>,
}

/// Element that has an axis.
#[derive(Clone, Copy)]
enum AxisOf {
    Joint(usize),
    /// A closure, and which of its two frames.
    Pin(usize, usize),
}

/// Model in which axes of a loop within the tolerance of parallel are parallel.
///
/// `None` if no axis changes. Slides within the tolerance of perpendicular to the axes of their
/// loop become perpendicular.
pub(super) fn parallel_axes(model: &Model, tolerance: f64) -> Option<Model> {
    let LoopAxes { axes, points } = loop_axes(model);
    let targets = targets(&axes, &points, tolerance);
    let tilts: Vec<f64> = axes
        .iter()
        .zip(&targets)
        .map(|(own, target)| own.direction.cross(target).norm())
        .collect();
    if tilts.iter().all(|tilt| *tilt < EXACT) {
        return None;
    }
    let mut changed = model.clone();
    // Poses depend on the axes before them, where joints are not at their reference positions.
    for _ in 0..3 {
        let poses = Motion::new(&changed).start().poses;
        let carried = changed.carried();
        for (own, target) in axes.iter().zip(&targets) {
            match own.axis_of {
                AxisOf::Joint(joint) => {
                    let turned = poses[carried[joint]].rotation;
                    changed.joints[joint].axis = (turned.inverse() * target).normalize();
                }
                AxisOf::Pin(closure, side) => {
                    if let ClosureKind::Pin { bodies, at } = &mut changed.closures[closure].kind {
                        let body = poses[bodies[side]];
                        at[side] = body.inv_mul(&along(&(body * at[side]), target));
                    }
                }
            }
        }
    }
    for (own, tilt) in axes.iter().zip(tilts) {
        if tilt < EXACT {
            continue;
        }
        let (name, place) = match own.axis_of {
            AxisOf::Joint(joint) => (&model.joints[joint].name, &model.joints[joint].place),
            AxisOf::Pin(closure, _) => (
                &model.closures[closure].name,
                &model.closures[closure].place,
            ),
        };
        changed.misfits.push(Misfit {
            name: name.clone(),
            place: place.clone(),
            length: 0.0,
            angle: tilt,
        });
    }
    Some(changed)
}

/// Frame rotated by the smallest angle such that its z axis has a direction.
fn along(frame: &Pose, z: &Vector3<f64>) -> Pose {
    let x = frame.rotation * Vector3::x();
    let x = (x - z * z.dot(&x)).normalize();
    let axes = nalgebra::Matrix3::from_columns(&[x, z.cross(&x), *z]);
    Pose::from_parts(frame.translation, Rotation3::from_matrix_unchecked(axes))
}

/// Axes of all joints and pins that belong to a loop, and the number of points in each block.
struct LoopAxes {
    axes: Vec<LoopAxis>,
    points: BTreeMap<usize, usize>,
}

fn loop_axes(model: &Model) -> LoopAxes {
    let poses = Motion::new(model).start().poses;
    let of_body = grouped(model);
    let edges = edges(model, &of_body);
    let count = of_body.iter().copied().max().unwrap_or(0) + 1;
    let ends: Vec<[usize; 2]> = edges.iter().map(|edge| edge.groups).collect();
    let blocks = Blocks::new(&edges_at(count, &edges), &ends);
    let carried = model.carried();
    let mut all = Vec::new();
    let mut points = BTreeMap::new();
    for (at, edge) in edges.iter().enumerate() {
        let Some(block) = blocks.of_edge(edge.groups) else {
            continue;
        };
        if edge.kind == JointType::Ball {
            *points.entry(block).or_default() += 1;
        }
        if blocks.is_bridge[at] || edge.kind == JointType::Ball {
            continue;
        }
        let mut push = |axis_of, direction| {
            all.push(LoopAxis {
                axis_of,
                block,
                is_prismatic: edge.kind == JointType::Prismatic,
                direction,
            });
        };
        match edge.origin {
            Origin::Platform => {}
            Origin::Joint(joint) => {
                let turned = poses[carried[joint]].rotation;
                push(AxisOf::Joint(joint), turned * model.joints[joint].axis);
            }
            Origin::Closure(closure) => {
                if let ClosureKind::Pin { bodies, at } = &model.closures[closure].kind {
                    for side in [0, 1] {
                        let frame = poses[bodies[side]] * at[side];
                        push(AxisOf::Pin(closure, side), frame.rotation * Vector3::z());
                    }
                }
            }
        }
    }
    LoopAxes { axes: all, points }
}

/// New direction of each axis, given the number of points in each block.
fn targets(
    axes: &[LoopAxis],
    points: &BTreeMap<usize, usize>,
    tolerance: f64,
) -> Vec<Vector3<f64>> {
    let mut clusters: Vec<Vec<usize>> = Vec::new();
    for (at, own) in axes.iter().enumerate() {
        let near = clusters.iter_mut().find(|cluster| {
            let first = &axes[cluster[0]];
            first.block == own.block && first.direction.cross(&own.direction).norm() < tolerance
        });
        match near {
            Some(cluster) => cluster.push(at),
            None => clusters.push(vec![at]),
        }
    }
    let mut targets: Vec<Vector3<f64>> = axes.iter().map(|own| own.direction).collect();
    for cluster in &clusters {
        let direction = representative(axes, cluster);
        for &at in cluster {
            let is_opposite = axes[at].direction.dot(&direction) < 0.0;
            targets[at] = if is_opposite { -direction } else { direction };
        }
    }
    for cluster in &clusters {
        let normal = targets[cluster[0]];
        // In a plane a point turns like a hinge.
        let turning = { cluster.iter() }.filter(|&&at| !axes[at].is_prismatic);
        let points = points.get(&axes[cluster[0]].block).copied().unwrap_or(0);
        let turning = turning.count();
        if turning == 0 || turning + points < 2 {
            continue;
        }
        for (at, own) in axes.iter().enumerate() {
            let is_own = own.is_prismatic && own.block == axes[cluster[0]].block;
            if is_own && own.direction.dot(&normal).abs() < tolerance {
                let own = targets[at];
                targets[at] = (own - normal * normal.dot(&own)).normalize();
            }
        }
    }
    targets
}

/// Direction of a cluster: that of a coordinate axis if it has one, or the most frequent one.
fn representative(axes: &[LoopAxis], cluster: &[usize]) -> Vector3<f64> {
    let score = |&at: &usize| {
        let own = &axes[at].direction;
        let is_plain = own.iter().any(|v| (v.abs() - 1.0).abs() < EXACT * EXACT)
            && own.iter().filter(|v| **v == 0.0).count() == 2;
        let equal = cluster
            .iter()
            .filter(|&&other| axes[other].direction.cross(own).norm() < EXACT);
        (is_plain, equal.count())
    };
    let best = cluster.iter().rev().max_by_key(|at| score(at));
    best.map_or_else(Vector3::z, |&at| axes[at].direction)
}
