//! Modified Denavit-Hartenberg frames of a leg.
//!
//! Each z axis is a joint axis; each x axis is the common normal to the next joint axis. Most of
//! the six constants are then zero.

use super::step::{Line, NEARLY, PARALLEL, Step, feet};
use crate::model::Pose;
use nalgebra::{Matrix3, Point3, Rotation3, Vector3};

/// A joint with one degree of freedom, at its home position.
#[derive(Debug, Clone)]
pub(crate) struct Node {
    /// Preceding joint; `None` on the base.
    pub(crate) antecedent: Option<usize>,
    pub(crate) is_prismatic: bool,
    /// Whether it is the slide of a screw, which must lie on the screw axis.
    pub(crate) is_screw: bool,
    pub(crate) point: Point3<f64>,
    pub(crate) direction: Vector3<f64>,
    /// Home position, which is not part of the constants.
    pub(crate) home: f64,
}

/// A joint with its constants.
#[derive(Debug, Clone)]
pub(crate) struct Framed {
    /// Whether a massless body, rotated by 90° about x, precedes it.
    pub(crate) is_behind_turn: bool,
    /// Constants; the joint variable excludes the home position.
    pub(crate) step: Step,
    /// Frame in the world at home.
    pub(crate) frame: Pose,
}

/// Element that follows a joint.
enum Next {
    Line {
        point: Point3<f64>,
        direction: Vector3<f64>,
        is_prismatic: bool,
    },
    Point(Point3<f64>),
    Nothing,
}

/// Rotation of the massless body that is inserted between nearly parallel axes.
pub(crate) fn quarter() -> Pose {
    Pose::from_parts(
        Vector3::zeros().into(),
        crate::geometry::exact::about(0, std::f64::consts::FRAC_PI_2),
    )
}

/// Base frame for which a leg's first joint needs no constants.
pub(crate) fn base(nodes: &[Node], on: &Pose, end: Option<Point3<f64>>) -> Pose {
    let Some(first) = nodes.first() else {
        return *on;
    };
    let frame = placed(first, on, &next(nodes, 0, end));
    let back = if first.is_prismatic {
        Pose::from_parts((Vector3::z() * -first.home).into(), Rotation3::identity())
    } else {
        Pose::from_parts(
            Vector3::zeros().into(),
            crate::geometry::exact::about(2, -first.home),
        )
    };
    frame * back
}

/// Joints with their constants.
pub(crate) fn framed(nodes: &[Node], base: &Pose, end: Option<Point3<f64>>) -> Vec<Framed> {
    let mut all: Vec<Framed> = Vec::new();
    for (at, node) in nodes.iter().enumerate() {
        let before = node.antecedent.map_or(*base, |a| all[a].frame);
        let wanted = placed(node, &before, &next(nodes, at, end));
        let (is_behind_turn, before, step) = match Step::between(&before, &wanted) {
            Some(step) => (false, before, step),
            None => {
                let turned = before * quarter();
                (
                    true,
                    turned,
                    Step::between(&turned, &wanted).unwrap_or_default(),
                )
            }
        };
        // Recompute the frame from the constants, so that rounding errors do not accumulate.
        let frame = before * step.frame();
        let mut step = step;
        if node.is_prismatic {
            step.r -= node.home
        } else {
            step.theta = super::step::round(wrapped(step.theta - node.home))
        }
        all.push(Framed {
            is_behind_turn,
            step,
            frame,
        });
    }
    all
}

/// Angle normalised to a half turn in either direction.
pub(crate) fn wrapped(angle: f64) -> f64 {
    let turn = std::f64::consts::TAU;
    let left = angle.rem_euclid(turn);
    if left > std::f64::consts::PI + 1e-12 {
        left - turn
    } else {
        left
    }
}

fn next(nodes: &[Node], at: usize, end: Option<Point3<f64>>) -> Next {
    let follows = nodes.iter().find(|node| node.antecedent == Some(at));
    match (follows, end) {
        (Some(node), _) => Next::Line {
            point: node.point,
            direction: node.direction,
            is_prismatic: node.is_prismatic,
        },
        (None, Some(point)) if at + 1 == nodes.len() => Next::Point(point),
        _ => Next::Nothing,
    }
}

/// Frame of a joint at home.
fn placed(node: &Node, before: &Pose, next: &Next) -> Pose {
    let z = node.direction;
    let (foot, normal) = incoming(node, before);
    let across = |v: Vector3<f64>| (v - z * z.dot(&v)).try_normalize(1e-9);
    let (origin, x) = match next {
        Next::Line { direction, .. } if z.cross(direction).norm() < NEARLY => {
            let Next::Line {
                point,
                is_prismatic,
                ..
            } = next
            else {
                return *before;
            };
            let aside = if *is_prismatic {
                None
            } else {
                across(point - foot)
            };
            (foot, aside)
        }
        Next::Line {
            direction,
            is_prismatic: true,
            ..
        } => (foot, across(z.cross(direction))),
        Next::Line {
            point, direction, ..
        } => {
            let axis = Line {
                point: node.point,
                direction: z,
            };
            let next = Line {
                point: *point,
                direction: *direction,
            };
            let (own, other) = feet(axis, next);
            let x = (other - own).try_normalize(1e-9);
            let x = x.filter(|x| x.dot(&z).abs() < 1e-6).and_then(across);
            let origin = if node.is_prismatic { foot } else { own };
            (origin, x.or_else(|| across(z.cross(direction))))
        }
        Next::Point(point) if !node.is_prismatic => {
            let own = node.point + z * z.dot(&(point - node.point));
            (own, across(point - own))
        }
        Next::Point(_) | Next::Nothing => (foot, None),
    };
    let turned = || {
        let by = if node.is_prismatic { 0.0 } else { node.home };
        crate::geometry::exact::turn(&z, by) * normal
    };
    let x = x.unwrap_or_else(turned);
    let along = if node.is_prismatic {
        z * node.home
    } else {
        Vector3::zeros()
    };
    let axes = Matrix3::from_columns(&[x, z.cross(&x), z]);
    Pose::from_parts(
        (origin + along).coords.into(),
        Rotation3::from_matrix_unchecked(axes),
    )
}

/// Foot on the joint axis of its common normal with the preceding axis, and the normal's direction.
fn incoming(node: &Node, before: &Pose) -> (Point3<f64>, Vector3<f64>) {
    let (z, start) = (node.direction, Point3::from(before.translation.vector));
    let [x_before, z_before] = [Vector3::x(), Vector3::z()].map(|e| before.rotation * e);
    // A prismatic joint may lie anywhere along its direction, except for the slide of a screw.
    let may_stand = node.is_prismatic && !node.is_screw;
    let point = if may_stand { start } else { node.point };
    let across = |v: Vector3<f64>| (v - z * z.dot(&v)).try_normalize(1e-9);
    let normal = z_before.cross(&z);
    if normal.norm() < PARALLEL.max(NEARLY) {
        let foot = point + z * z.dot(&(start - point));
        let x = across(foot - start).or_else(|| across(x_before));
        return (foot, x.unwrap_or_else(|| any_across(&z)));
    }
    let before = Line {
        point: start,
        direction: z_before,
    };
    let axis = Line {
        point,
        direction: z,
    };
    let (_, foot) = feet(before, axis);
    let normal = normal.normalize();
    let x = if normal.dot(&x_before) < -1e-9 {
        -normal
    } else {
        normal
    };
    (foot, x)
}

/// Unit vector perpendicular to `z`.
pub(crate) fn any_across(z: &Vector3<f64>) -> Vector3<f64> {
    let helper = if z.x.abs() < 0.7 {
        Vector3::x()
    } else {
        Vector3::y()
    };
    (helper - z * z.dot(&helper)).normalize()
}
