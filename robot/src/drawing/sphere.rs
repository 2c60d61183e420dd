//! Drawing of robots whose axes all meet in one point, on a sphere.
//!
//! Their descriptions have angles and no lengths. Joints are drawn where their axes meet the
//! sphere, bodies as arcs of great circles.

use super::scene::{DrawnPart, NOTHING, Point, Scene};
use nalgebra::{Isometry3, Vector3};
use overact_codegen::mechanism::{JointKind, Leg, Mechanism};

/// Radii of the first bodies, the next ones and the platform, so that they do not collide.
const RADII: [f64; 3] = [1.18, 1.0, 0.82];

/// Whether all joints rotate about axes through one point.
pub(super) fn has_no_lengths(mechanism: &Mechanism) -> bool {
    let leg_is_point = |(index, leg): (usize, &Leg)| {
        let frames = leg.frames(&mechanism.home.joints[mechanism.leg_range(index)]);
        let turns = leg.joints.iter().all(|j| j.kind != JointKind::Prismatic);
        let at = |f: &Isometry3<f64>| f.translation.vector.norm() < NOTHING;
        turns && leg.independent().count() > 1 && frames.iter().all(at)
    };
    let spherical = mechanism
        .platform
        .as_ref()
        .is_some_and(|p| p.motion.has_quaternion());
    spherical && mechanism.legs.iter().enumerate().all(leg_is_point)
}

/// Scene on the sphere.
pub(super) fn scene(mechanism: &Mechanism, platform: Option<Isometry3<f64>>) -> Scene {
    let mut scene = Scene {
        parts: Vec::new(),
        bases: Vec::new(),
        attachments: Vec::new(),
        platform,
        sphere: Some(RADII[2]),
    };
    for (index, leg) in mechanism.legs.iter().enumerate() {
        let frames = leg.frames(&mechanism.home.joints[mechanism.leg_range(index)]);
        let mut before: Option<(usize, Point)> = None;
        for (number, joint) in leg.joints.iter().enumerate() {
            if joint.kind != JointKind::Revolute {
                continue;
            }
            let axis = frames[number] * Vector3::z();
            // An axis meets the sphere twice; take the point nearer to the previous joint.
            let axis = match before {
                Some((_, last)) if axis.dot(&last) < -NOTHING => -axis,
                _ => axis,
            };
            let radius = radius(number);
            if let Some((body, last)) = before {
                let mut path = arc(&last, &axis, self::radius(body));
                path.push(axis * radius);
                scene.parts.push((index, DrawnPart::Link { body, path }));
            }
            if before.is_none() {
                scene.bases.push(axis * radius);
            }
            let at = axis * radius;
            let actuated = joint.actuated;
            scene
                .parts
                .push((index, DrawnPart::Revolute { at, axis, actuated }));
            before = Some((number, axis));
        }
        if let Some((_, last)) = before {
            scene.attachments.push(last * RADII[2]);
        }
    }
    scene
}

fn radius(body: usize) -> f64 {
    RADII[body.min(RADII.len() - 1)]
}

/// Great-circle arc between two directions.
fn arc(from: &Point, to: &Point, radius: f64) -> Vec<Point> {
    const STEPS: usize = 24;
    let angle = from.dot(to).clamp(-1.0, 1.0).acos();
    let across = (to - from * from.dot(to)).try_normalize(NOTHING);
    let Some(across) = across else {
        return vec![from * radius, to * radius];
    };
    let point = |step: usize| {
        let at = angle * step as f64 / STEPS as f64;
        (from * at.cos() + across * at.sin()) * radius
    };
    (0..=STEPS).map(point).collect()
}
