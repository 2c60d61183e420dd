//! Dimensions of the loops: points and axes of joints and closures.

use crate::assembly::{
    blocks::Blocks,
    motion::State,
    network::{Origin, edges, edges_at, grouped},
};
use crate::model::{ClosureKind, JointType, Misfit, Model, Pose};
use nalgebra::{Point3, Rotation3, Vector3};

/// A dimension, whose change is a displacement (m) or a rotation (rad).
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct Dimension {
    of: Origin,
    /// Direction of the displacement, or axis of the rotation, in the body's frame.
    direction: Vector3<f64>,
    pub(super) is_angle: bool,
}

/// Dimensions of all loops: displacements of their points and, with `with_axes`, rotations of
/// their axes.
pub(super) fn dimensions(model: &Model, with_axes: bool) -> Vec<Dimension> {
    let of_body = grouped(model);
    let edges = edges(model, &of_body);
    let count = of_body.iter().copied().max().unwrap_or(0) + 1;
    let ends: Vec<[usize; 2]> = edges.iter().map(|edge| edge.groups).collect();
    let blocks = Blocks::new(&edges_at(count, &edges), &ends);
    let mut all = Vec::new();
    for (at, edge) in edges.iter().enumerate() {
        if blocks.is_bridge[at] {
            continue;
        }
        let mut push = |direction: Vector3<f64>, is_angle: bool| {
            if with_axes || !is_angle {
                let of = edge.origin;
                all.push(Dimension {
                    of,
                    direction,
                    is_angle,
                });
            }
        };
        match edge.origin {
            Origin::Platform => {}
            Origin::Joint(joint) => {
                let own = &model.joints[joint];
                let across = [across(&own.axis), own.axis.cross(&across(&own.axis))];
                match own.kind {
                    JointType::Ball => units().for_each(|e| push(e, false)),
                    JointType::Revolute => {
                        across.iter().for_each(|e| push(*e, false));
                        across.iter().for_each(|e| push(*e, true));
                    }
                    JointType::Prismatic => across.iter().for_each(|e| push(*e, true)),
                }
            }
            Origin::Closure(closure) => {
                units().for_each(|e| push(e, false));
                if !matches!(model.closures[closure].kind, ClosureKind::Point { .. }) {
                    units().for_each(|e| push(e, true));
                }
            }
        }
    }
    all
}

/// The three unit vectors.
fn units() -> impl Iterator<Item = Vector3<f64>> {
    (0..3).map(|axis| Vector3::ith(axis, 1.0))
}

/// A unit vector perpendicular to another one.
fn across(axis: &Vector3<f64>) -> Vector3<f64> {
    let least = axis.iamin();
    axis.cross(&Vector3::ith(least, 1.0)).normalize()
}

impl Dimension {
    /// Changes the dimension of a model by a displacement or an angle.
    pub(super) fn change(&self, model: &mut Model, by: f64) {
        let moved = self.direction * by;
        let turn = Rotation3::from_scaled_axis(moved);
        match self.of {
            Origin::Platform => {}
            Origin::Joint(joint) => {
                let own = &mut model.joints[joint];
                if self.is_angle {
                    own.axis = (turn * own.axis).normalize();
                } else {
                    own.at += moved;
                }
            }
            Origin::Closure(closure) => match &mut model.closures[closure].kind {
                ClosureKind::Point { at, .. } => at[1] += moved,
                ClosureKind::Weld { at, .. } | ClosureKind::Pin { at, .. } => {
                    let (by, turn) = if self.is_angle {
                        (Vector3::zeros(), turn)
                    } else {
                        (moved, Rotation3::identity())
                    };
                    let own = &mut at[1];
                    let centre = own.translation.vector + by;
                    *own = Pose::from_parts(centre.into(), turn * own.rotation);
                }
            },
        }
    }
}

/// Adds the changes of joints and closures to the misfits of a model.
pub(super) fn report(model: &mut Model, dimensions: &[Dimension], changes: &[f64]) {
    for (at, own) in dimensions.iter().enumerate() {
        if at > 0 && dimensions[at - 1].of == own.of {
            continue;
        }
        let amount = |is_angle: bool| {
            let same = dimensions.iter().zip(changes);
            let same = same.filter(|(other, _)| other.of == own.of && other.is_angle == is_angle);
            same.map(|(_, by)| by * by).sum::<f64>().sqrt()
        };
        let (length, angle) = (amount(false), amount(true));
        let named = match own.of {
            Origin::Joint(joint) => {
                let own = &model.joints[joint];
                Some((own.name.clone(), own.place.clone()))
            }
            Origin::Closure(closure) => {
                let own = &model.closures[closure];
                Some((own.name.clone(), own.place.clone()))
            }
            Origin::Platform => None,
        };
        if let Some((name, place)) = named.filter(|_| length.max(angle) > ROUNDING) {
            model.misfits.push(Misfit {
                name,
                place,
                length,
                angle,
            });
        }
    }
}

/// Changes below this are rounding errors, m or rad.
const ROUNDING: f64 = 1e-12;

/// Largest extent of the joints and closures of all loops, m, or of all joints without loops.
pub(crate) fn size(model: &Model, state: &State) -> f64 {
    let of_body = grouped(model);
    let edges = edges(model, &of_body);
    let count = of_body.iter().copied().max().unwrap_or(0) + 1;
    let ends: Vec<[usize; 2]> = edges.iter().map(|edge| edge.groups).collect();
    let blocks = Blocks::new(&edges_at(count, &edges), &ends);
    let carried = model.carried();
    let of_joint = |joint: usize| state.poses[carried[joint]] * model.joints[joint].at;
    let point = |origin: Origin| -> Option<Point3<f64>> {
        Some(match origin {
            Origin::Platform => return None,
            Origin::Joint(joint) => of_joint(joint),
            Origin::Closure(closure) => match &model.closures[closure].kind {
                ClosureKind::Point { bodies, at } => state.poses[bodies[0]] * at[0],
                ClosureKind::Weld { bodies, at } | ClosureKind::Pin { bodies, at } => {
                    (state.poses[bodies[0]] * at[0]).translation.vector.into()
                }
            },
        })
    };
    let in_loops = edges.iter().zip(&blocks.is_bridge);
    let in_loops = in_loops.filter(|(_, is_bridge)| !**is_bridge);
    let of_loops = extent(in_loops.filter_map(|(edge, _)| point(edge.origin)));
    let size = of_loops.unwrap_or_else(|| {
        let all = extent((0..model.joints.len()).map(of_joint));
        all.unwrap_or_default()
    });
    size.max(1e-9)
}

/// Diagonal of the smallest box around points; `None` without points.
fn extent(points: impl Iterator<Item = Point3<f64>>) -> Option<f64> {
    let boxed = points.fold(None, |found: Option<[Point3<f64>; 2]>, point| {
        let [low, high] = found.unwrap_or([point; 2]);
        Some([low.inf(&point), high.sup(&point)])
    });
    boxed.map(|[low, high]| (high - low).norm())
}
