//! Removes idle spins: motions of a single body between two revolute joints on one axis.
//!
//! By convention such a body does not rotate.

use super::network::{Network, Origin};
use crate::model::{JointType, Model, Pose};
use nalgebra::Rotation3;

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
