//! Units of coordinates, positions and torques, by name.

use std::collections::BTreeMap;

use overact::Info;

/// Physical dimension of a coordinate or actuator.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
enum DimensionKind {
    /// Metres, newtons.
    Length,
    /// Radians, newton metres.
    Angle,
    /// A component of a unit quaternion; its row of Γ is a moment.
    Quaternion,
}

/// Units of a robot's coordinates and actuators.
#[derive(Debug, Clone, PartialEq, Eq, Default)]
pub struct Units {
    kinds: BTreeMap<String, DimensionKind>,
    /// Whether the robot has a platform, whose coordinates have their own names.
    has_platform: bool,
}

impl Units {
    /// Units of a robot.
    ///
    /// A platform's coordinates are x, y, z, phi, or qw, qx, qy, qz; those of a serial robot are
    /// its joints.
    #[must_use]
    pub fn new(info: &Info<'_>) -> Self {
        let actuators = info.actuators.iter().zip(info.actuator_is_revolute);
        let mut kinds: BTreeMap<String, DimensionKind> = actuators
            .map(|(name, revolute)| {
                let kind = if *revolute {
                    DimensionKind::Angle
                } else {
                    DimensionKind::Length
                };
                ((*name).to_owned(), kind)
            })
            .collect();
        for name in info.coordinates {
            let kind = match *name {
                "x" | "y" | "z" => DimensionKind::Length,
                "phi" => DimensionKind::Angle,
                "qw" | "qx" | "qy" | "qz" => DimensionKind::Quaternion,
                _ => continue,
            };
            kinds.entry((*name).to_owned()).or_insert(kind);
        }
        // A serial robot has one coordinate per actuator, in the same order.
        if info.coordinates.len() == info.actuators.len() {
            for (name, actuator) in info.coordinates.iter().zip(info.actuators) {
                if let Some(kind) = kinds.get(*actuator).copied() {
                    kinds.entry((*name).to_owned()).or_insert(kind);
                }
            }
        }
        let of_platform = |name: &&str| ["x", "y", "z", "phi", "qw", "rx"].contains(name);
        Self {
            kinds,
            has_platform: info.coordinates.iter().any(of_platform),
        }
    }

    /// Whether the robot has a platform.
    pub(crate) const fn has_platform(&self) -> bool {
        self.has_platform
    }

    /// Unit of a position or coordinate; empty if unknown.
    #[must_use]
    pub fn position(&self, name: &str) -> &'static str {
        match self.kinds.get(name) {
            Some(DimensionKind::Length) => "m",
            Some(DimensionKind::Angle) => "rad",
            Some(DimensionKind::Quaternion) | None => "",
        }
    }

    /// Unit of an actuator's torque or a row of Γ; empty if unknown.
    #[must_use]
    pub fn torque(&self, name: &str) -> &'static str {
        match self.kinds.get(name) {
            Some(DimensionKind::Length) => "N",
            Some(DimensionKind::Angle | DimensionKind::Quaternion) => "N m",
            None => "",
        }
    }
}

/// `x (m)`, or the name only if the unit is unknown.
pub(super) fn with_unit(name: &str, unit: &str) -> String {
    if unit.is_empty() {
        name.to_owned()
    } else {
        format!("{name} ({unit})")
    }
}
