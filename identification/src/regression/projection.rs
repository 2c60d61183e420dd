//! Projections of the inputs, and the corresponding models.

use std::fmt;

use overact::Info;
use serde::{Deserialize, Serialize};

/// Model, by the projection of its inputs.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord, Hash, Serialize, Deserialize)]
#[serde(rename_all = "lowercase")]
pub enum ModelKind {
    /// Platform projection Γ¹; case 1 in the paper.
    Platform,
    /// Actuator projection Γ² on r kept actuators; case 2 in the paper.
    Actuators,
    /// Inputs of all joints of a robot without redundancy.
    Joints,
}

impl ModelKind {
    /// `platform`, `actuators` or `joints`.
    #[must_use]
    pub const fn name(self) -> &'static str {
        match self {
            Self::Platform => "platform",
            Self::Actuators => "actuators",
            Self::Joints => "joints",
        }
    }

    /// Name in texts: `platform projection`, `actuator projection`; `joint model` without redundancy.
    #[must_use]
    pub const fn label(self) -> &'static str {
        match self {
            Self::Platform => "platform projection",
            Self::Actuators => "actuator projection",
            Self::Joints => "joint model",
        }
    }
}

impl fmt::Display for ModelKind {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.pad(self.name())
    }
}

/// Projection of the inputs.
#[derive(Debug, Clone, PartialEq, Eq)]
pub enum Projection {
    /// Platform projection; case 1 in the paper.
    Platform,
    /// Actuator projection on these r kept actuators of a redundant robot; case 2 in the paper.
    Actuators(Vec<usize>),
    /// All actuators of a robot without redundancy.
    Joints,
}

impl Projection {
    /// Projections of a robot: platform and actuator projection, or its joints without redundancy.
    #[must_use]
    pub fn usual(info: &Info<'_>, kept_actuators: &[usize]) -> Vec<Self> {
        if info.sizes.actuators > info.sizes.dof {
            vec![Self::Platform, Self::Actuators(kept_actuators.to_vec())]
        } else {
            vec![Self::Joints]
        }
    }

    /// Model of this projection.
    #[must_use]
    pub const fn model(&self) -> ModelKind {
        match self {
            Self::Platform => ModelKind::Platform,
            Self::Actuators(_) => ModelKind::Actuators,
            Self::Joints => ModelKind::Joints,
        }
    }

    /// Kept actuators; `None` for the platform projection.
    #[must_use]
    pub fn kept(&self, info: &Info<'_>) -> Option<Vec<usize>> {
        match self {
            Self::Platform => None,
            Self::Actuators(kept) => Some(kept.clone()),
            Self::Joints => Some((0..info.sizes.actuators).collect()),
        }
    }

    /// Units of the lines of Γ, `N` or `N m`; empty if the model does not say.
    #[must_use]
    pub fn line_units(&self, info: &Info<'_>) -> Vec<&'static str> {
        let units = actuator_units(info);
        let of_coordinate = |line: usize| match info.coordinates.get(line).copied() {
            Some("x" | "y" | "z") => "N",
            Some("phi" | "rx" | "ry" | "rz" | "qw" | "qx" | "qy" | "qz") => "N m",
            // A coordinate of a robot without a platform is a joint.
            Some(name) => {
                let place = info.actuators.iter().position(|own| *own == name);
                place.map_or("", |place| units[place])
            }
            None => "",
        };
        match self.kept(info) {
            None => (0..info.sizes.dof).map(of_coordinate).collect(),
            Some(kept) => {
                let unit = |actuator: &usize| units.get(*actuator).copied().unwrap_or_default();
                kept.iter().map(unit).collect()
            }
        }
    }

    /// Names of the lines of Γ.
    #[must_use]
    pub fn line_names(&self, info: &Info<'_>) -> Vec<String> {
        let named = |names: &[&str], index: usize| {
            names
                .get(index)
                .map_or_else(|| format!("line {index}"), |name| (*name).to_owned())
        };
        match self.kept(info) {
            None => (0..info.sizes.dof)
                .map(|line| named(info.coordinates, line))
                .collect(),
            Some(kept) => kept
                .iter()
                .map(|&actuator| named(info.actuators, actuator))
                .collect(),
        }
    }
}

/// Units of the torques of all actuators, `N` or `N m`.
pub(crate) fn actuator_units(info: &Info<'_>) -> Vec<&'static str> {
    let unit = |is_revolute: &bool| if *is_revolute { "N m" } else { "N" };
    info.actuator_is_revolute.iter().map(unit).collect()
}
