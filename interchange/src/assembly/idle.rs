//! Idle spins: motions of a single body between two revolute joints on one axis, and of rods.
//!
//! By convention such a body does not rotate. A rod between two ball joints needs a length, which
//! is the axis of its spin.

use super::network::{Network, Origin};
use crate::{
    files::Files,
    model::{JointType, Model, Pose},
};
use nalgebra::{Point3, Rotation3};

/// Smallest length of a rod, relative to the largest distance between joints.
const SHORTEST_ROD: f64 = 1e-6;

/// Model without idle spins of this kind; `None` if there are none.
pub(crate) fn without_idle_pins(network: &Network<'_>) -> Option<Model> {
    let mut model = network.model.clone();
    let mut is_changed = false;
    let mut locked = vec![false; network.edges.len()];
    for group in 1..network.groups.len() {
        let [a, b] = network.edges_at[group][..] else {
            continue;
        };
        let pins = [a, b].map(|edge| &network.edges[edge]);
        let are_free = pins
            .iter()
            .all(|edge| edge.kind == JointType::Revolute && edge.is_free);
        if !are_free || locked[a] || locked[b] || !are_coaxial(network, a, b) {
            continue;
        }
        let Some((edge, joint)) =
            [a, b]
                .into_iter()
                .find_map(|edge| match network.edges[edge].origin {
                    Origin::Joint(joint) => Some((edge, joint)),
                    Origin::Closure(_) | Origin::Platform => None,
                })
        else {
            continue;
        };
        locked[edge] = true;
        lock(&mut model, network, joint);
        is_changed = true;
        let ends = network.edges[edge].groups;
        let other = ends[usize::from(ends[0] == group)];
        model.notes.push(format!(
            "`{}` spins freely between two pins on one axis; by convention it is fixed to `{}`, and `{}` is not a joint. Home: `{}` = {:?}",
            network.group_name(group),
            network.group_name(other),
            model.joints[joint].name,
            model.joints[joint].name,
            network.states[0].positions[joint]
        ));
    }
    is_changed.then_some(model)
}

/// Fixes a joint at its home position.
fn lock(model: &mut Model, network: &Network<'_>, joint: usize) {
    let body = model.carried_by(joint);
    let own = &model.joints[joint];
    let by = network.states[0].positions[joint] - own.reference;
    let turn: Rotation3<f64> = crate::geometry::exact::turn(&own.axis, by);
    let centre = own.at.coords;
    let moved = Pose::from_parts((centre - turn * centre).into(), turn);
    model.bodies[body].placement *= moved;
    model.bodies[body].joint = None;
}

fn are_coaxial(network: &Network<'_>, a: usize, b: usize) -> bool {
    let [a, b] = [a, b].map(|edge| network.axis(&network.edges[edge], &network.states[0]));
    let aside = (b.point - a.point).cross(&a.direction).norm();
    a.direction.cross(&b.direction).norm() < 1e-7 && aside < 1e-7
}

/// Reports a rod whose ball joints are at the same point; `None` then.
pub(crate) fn check_rods(files: &Files, network: &Network<'_>) -> Option<()> {
    let point = |edge: usize| network.axis(&network.edges[edge], &network.states[0]).point;
    let distance = |a: Point3<f64>, b: Point3<f64>| (b - a).norm();
    let all = 0..network.edges.len();
    let size = all.fold(0.0, |most: f64, edge| {
        most.max(distance(point(0), point(edge)))
    });
    for (at, group) in network.groups.iter().enumerate() {
        let Some(ends) = group.rod_ends else { continue };
        let parts = network.groups.iter();
        let parts = parts.filter(|other| other.rod_ends == Some(ends)).count();
        let length = distance(point(ends[0]), point(ends[1]));
        // The slides of a rod of several parts may give it a length.
        if parts > 1 || length > SHORTEST_ROD * size {
            continue;
        }
        let place = ends
            .iter()
            .rev()
            .find_map(|end| match network.edges[*end].origin {
                Origin::Joint(joint) => Some(&network.model.joints[joint].place),
                Origin::Closure(closure) => Some(&network.model.closures[closure].place),
                Origin::Platform => None,
            })?;
        let message = format!(
            "the ball joints at both ends of `{}` are at the same point: it has a length of {length:.1e} m",
            network.group_name(at)
        );
        let help = "give the rod its length, or connect its neighbours by one ball joint";
        files.report(place, message, help);
        return None;
    }
    Some(())
}
