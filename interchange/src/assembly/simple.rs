//! Simplifies a model: merges revolute joints into ball joints and drops trivial closures.
//!
//! Three passive revolute joints with intersecting axes and massless bodies between them are a ball
//! joint. Two revolute joints on one axis are one.

use super::motion::{Motion, gaps_of};
use crate::account::Use;
use crate::files::Files;
use crate::geometry::exact;
use crate::model::{Closure, ClosureKind, Inertia, Joint, JointType, Model};
use nalgebra::Matrix3;

/// Merges successive revolute joints with intersecting axes into ball joints.
pub(crate) fn join_balls(model: &mut Model) {
    while let Some([first, second, third]) = (1..model.bodies.len()).find_map(|at| ball(model, at))
    {
        let [outer, middle, inner] = [first, second, third].map(|body| {
            let joint = model.bodies[body].joint.unwrap_or(0);
            model.joints[joint].name.clone()
        });
        let own = model.bodies[first].joint.unwrap_or(0);
        let centre = model.joints[model.bodies[third].joint.unwrap_or(0)].at;
        let between = model.bodies[second].placement * model.bodies[third].placement;
        let name = common(&outer, &inner);
        model.notes.push(format!(
            "`{outer}`, `{middle}` and `{inner}` meet in a point: spherical joint `{name}` here."
        ));
        let place = model.joints[own].place.clone();
        let turn = [first, second, third].map(|body| {
            let joint = &model.joints[model.bodies[body].joint.unwrap_or(0)];
            exact::turn(&joint.axis, joint.home - joint.reference)
        });
        let [second_in, third_in] =
            [second, third].map(|body| model.bodies[body].placement.rotation);
        let turned = turn[0] * second_in * turn[1] * third_in * turn[2];
        model.joints[own] = Joint {
            at: centre,
            home_turn: exact::cleaned(&(between.rotation.inverse() * turned)),
            ..Joint::new(&name, JointType::Ball, place)
        };
        let (placement, parent) = (
            model.bodies[first].placement * between,
            model.bodies[first].parent,
        );
        let last = &mut model.bodies[third];
        (last.joint, last.placement, last.parent) = (Some(own), placement, parent);
        // The two intermediate bodies keep their pose, without joint or contents.
        for empty in [first, second] {
            model.bodies[empty].joint = None;
            model.bodies[empty].inertia = None;
            model.bodies[empty].name.clear();
        }
    }
}

/// Three bodies whose joints form a ball joint, the last of which is `third`.
fn ball(model: &Model, third: usize) -> Option<[usize; 3]> {
    let second = model.bodies[third].parent;
    let first = model.bodies[second].parent;
    if second == 0 || first == 0 {
        return None;
    }
    for empty in [first, second] {
        let children = model
            .bodies
            .iter()
            .skip(1)
            .filter(|body| body.parent == empty)
            .count();
        let closes = model
            .closures
            .iter()
            .any(|closure| closure.bodies().contains(&empty));
        let has_spring = { model.springs.iter() }.any(|own| own.bodies.contains(&empty));
        let has_mass = model.bodies[empty].has_unknown_inertia
            || !is_massless(model.bodies[empty].inertia.as_ref());
        if children != 1 || closes || has_mass || has_spring {
            return None;
        }
    }
    let bodies = [first, second, third];
    let joints = bodies.map(|body| model.bodies[body].joint.map(|at| &model.joints[at]));
    let is_plain = |joint: &Option<&Joint>| joint.is_some_and(is_free);
    if !joints.iter().all(is_plain) {
        return None;
    }
    let leads = |body: usize| {
        let joint = model.bodies[body].joint;
        model
            .joints
            .iter()
            .any(|other| other.follow.is_some_and(|f| Some(f.joint) == joint))
    };
    if bodies.into_iter().any(leads) {
        return None;
    }
    // In the frame of the first body, with all joints at their reference.
    let second_in = model.bodies[second].placement;
    let third_in = second_in * model.bodies[third].placement;
    let [a, b, c] = joints.map(|joint| joint.cloned());
    let (a, b, c) = (a?, b?, c?);
    let centre = third_in * c.at;
    let meets = |at: nalgebra::Point3<f64>, axis: nalgebra::Vector3<f64>| {
        (centre - at).cross(&axis).norm() < 1e-9
    };
    let axes = [
        a.axis,
        second_in.rotation * b.axis,
        third_in.rotation * c.axis,
    ];
    let volume = Matrix3::from_columns(&axes).determinant().abs();
    let meet = meets(a.at, axes[0]) && meets(second_in * b.at, axes[1]);
    (meet && volume > 0.3).then_some(bodies)
}

/// Whether a body has neither mass nor inertia.
pub(crate) fn is_massless(inertia: Option<&Inertia>) -> bool {
    inertia.is_none_or(|inertia| inertia.mass == 0.0 && inertia.tensor == Matrix3::zeros())
}

/// Whether a revolute joint has neither motor nor coupling nor torques.
pub(crate) fn is_free(joint: &Joint) -> bool {
    joint.kind == JointType::Revolute
        && !joint.actuated
        && joint.follow.is_none()
        && [joint.damping, joint.friction, joint.armature]
            .iter()
            .all(|value| *value == 0.0)
        && joint.spring.is_none()
}

/// Common prefix of two names, or the first name.
fn common(a: &str, b: &str) -> String {
    let same = a.chars().zip(b.chars()).take_while(|(a, b)| a == b);
    let text: String = same.map(|(a, _)| a).collect();
    let text = text
        .trim_end_matches("rev")
        .trim_end_matches(['_', '-', '.']);
    if text.len() < 3 {
        a.to_owned()
    } else {
        text.to_owned()
    }
}

/// Largest gap of a closure between bodies that are fixed together, m or rad.
const ON_ONE_BODY: f64 = 1e-3;

/// Drops closures between bodies that are already fixed together, and reports them.
///
/// One whose points or frames differ can't close, and is an error.
pub(crate) fn drop_closures_on_one_body(files: &Files, model: &mut Model) {
    let fixed = |body: usize| {
        let mut at = body;
        while at != 0 && model.bodies[at].joint.is_none() {
            at = model.bodies[at].parent;
        }
        at
    };
    let state = Motion::new(model).start();
    let is_between = |closure: &&Closure| {
        let [a, b] = closure.bodies().map(fixed);
        if a != b {
            return true;
        }
        let (length, angle) = gaps_of(&closure.kind, &state);
        let (place, name) = (&closure.place, &closure.name);
        let body = &model.bodies[a].name;
        if length.max(angle) > ON_ONE_BODY {
            let message = format!(
                "`{name}` connects two places of one body, `{body}`, that are {length:.2e} m and {angle:.2e} rad apart"
            );
            let help = "a closure connects two bodies that move: correct its bodies, or remove it";
            files.report(place, message, help);
        } else {
            let reason = format!("no effect: it connects `{body}` to itself");
            files.record(Use::Reported, place, name, None, &reason);
        }
        false
    };
    let kept: Vec<_> = { model.closures.iter() }
        .filter(is_between)
        .cloned()
        .collect();
    model.closures = kept;
}

/// Whether a closure has the kind that merges two bodies into one.
pub(crate) fn is_weld(kind: &ClosureKind) -> bool {
    matches!(kind, ClosureKind::Weld { .. })
}
