//! Springs and dampers between two points of bodies.

use super::{Bodies, names::Names};
use crate::{assembly::network::Network, files::Files, model::PointSpring};
use nalgebra::Point3;

/// A spring and damper of the file, as one or two springs of the description.
#[derive(Debug)]
pub(crate) struct Spring {
    pub(crate) name: String,
    /// Names of the two bodies, and the points in their frames.
    pub(crate) ends: [(String, Point3<f64>); 2],
    /// Length without force, m.
    pub(crate) rest: f64,
    /// Stiffness, N/m; `None` for a damper.
    pub(crate) stiffness: Option<f64>,
    /// Damping, N s/m, and the name of the damper.
    pub(crate) damper: Option<(String, f64)>,
    /// Number of the file's spring.
    pub(crate) of: usize,
}

/// Springs of the model between the bodies of the description.
pub(super) fn between_points(files: &Files, network: &Network<'_>, bodies: &Bodies) -> Vec<Spring> {
    let mut names = Names::default();
    let springs = network.model.springs.iter().enumerate();
    springs
        .filter_map(|(of, own)| spring(files, network, bodies, &mut names, of, own))
        .collect()
}

fn spring(
    files: &Files,
    network: &Network<'_>,
    bodies: &Bodies,
    names: &mut Names,
    of: usize,
    own: &PointSpring,
) -> Option<Spring> {
    let groups = own.bodies.map(|body| {
        let mut groups = network.groups.iter();
        groups.position(|group| group.bodies.contains(&body))
    });
    if groups[0] == groups[1] {
        let reason = "connects points of one body, so it has no effect";
        files.demote(&own.place, "spatial", None, reason);
        return None;
    }
    let end = |at: usize| {
        let (name, frame) = bodies[groups[at]?].clone()?;
        let world = network.states[0].poses[own.bodies[at]] * own.at[at];
        Some((name, frame.inverse_transform_point(&world)))
    };
    let (Some(from), Some(to)) = (end(0), end(1)) else {
        let message = format!(
            "the spring `{}` acts on a body that the description does not have",
            own.name
        );
        let help = "attach it to a body that moves with a joint";
        files.report(&own.place, message, help);
        return None;
    };
    let word = if own.name.is_empty() {
        "spring"
    } else {
        &own.name
    };
    let name = names.unique(word);
    let is_spring = own.stiffness != 0.0;
    let damper = (own.damping != 0.0).then(|| {
        let name = if is_spring {
            names.unique(&format!("{word}_damper"))
        } else {
            name.clone()
        };
        (name, own.damping)
    });
    Some(Spring {
        name,
        ends: [from, to],
        rest: own.rest,
        stiffness: is_spring.then_some(own.stiffness),
        damper,
        of,
    })
}
