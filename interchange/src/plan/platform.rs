//! Plan of a robot with a platform in space, some motions of which its legs block.

use super::{Bodies, Leg, Names, Plan, chain, joints, motors, notes, springs};
use crate::assembly::simple::is_massless;
use crate::{
    assembly::{layout::Layout, network::Network, parasitic::ParasiticPlatform},
    files::Files,
    model::Pose,
};
use nalgebra::Rotation3;

/// Coordinates of a platform in space.
const COORDINATES: [&str; 6] = ["x", "y", "z", "rx", "ry", "rz"];

/// Platform of a description.
#[derive(Debug)]
pub(crate) struct PlanPlatform {
    pub(crate) comment: String,
    /// Names of the independent coordinates.
    pub(crate) independent: Vec<&'static str>,
    /// Its position at home; its axes are then those of the base frame.
    pub(crate) home: Pose,
    /// Whether it has inertia.
    pub(crate) has_inertia: bool,
    /// Inertial parameters by symbol, if known.
    pub(crate) values: Vec<(&'static str, f64)>,
}

impl Plan {
    /// Legs and platform; `None` after an error.
    pub(crate) fn on_platform(
        files: &Files,
        network: &Network<'_>,
        platform: &ParasiticPlatform,
    ) -> Option<Self> {
        let group = &network.groups[platform.group];
        let at = network.states[0].poses[group.bodies[0]].translation;
        let home = Pose::from_parts(at, Rotation3::identity());
        let mut bodies: Bodies = vec![None; network.groups.len()];
        bodies[0] = Some(("ground".to_owned(), Pose::identity()));
        bodies[platform.group] = Some((PLATFORM.to_owned(), home));
        let mut names = Names::default();
        let each = platform.legs.iter();
        let legs: Option<Vec<Leg>> = { each }
            .map(|leg| chain(files, network, leg, &mut bodies, &mut names))
            .collect();
        let legs = legs?;
        let motors = motors::of_robot(network.model, &legs);
        let mut springs = springs::between_points(files, network, &bodies);
        for (name, _) in springs.iter_mut().flat_map(|spring| &mut spring.ends) {
            if name == PLATFORM {
                "platform".clone_into(name);
            }
        }
        let inertia = group.inertia.filter(|own| !is_massless(Some(own)));
        let values = inertia.map(|own| joints::inertial(&own.transformed(&home.inverse())));
        let name = network.group_name(platform.group);
        let independent = { platform.independent.iter() }.map(|&at| COORDINATES[at]);
        Some(Self {
            legs,
            motors,
            springs,
            axes: Vec::new(),
            platform: Some(PlanPlatform {
                comment: format!(
                    "`{name}` is the platform. Its axes are those of the world at home; the legs determine its other coordinates."
                ),
                independent: independent.collect(),
                home,
                has_inertia: inertia.is_some() || group.has_unknown_inertia,
                values: values.map(Vec::from).unwrap_or_default(),
            }),
            notes: notes(network, &Layout::default()),
        })
    }
}

/// Name of the platform as the end of a leg; no joint has it.
const PLATFORM: &str = "";
