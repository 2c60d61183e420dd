//! Actuators, coordinates and parameters of the robot by name, for the tables after the legs.

use crate::expressions::dimension::Dimension;
use crate::robot::actuator_names::ActuatorNames;
use crate::robot::leg::joint;
use crate::robot::model::{JointKind, Leg, Motion, Motor, Payload, Platform, Spanned, actuators};
use crate::robot::point_spring::PointSpring;
use crate::toml_text::scope::Scope;
use overact_core::StandardParameter;

/// A body that has parameters.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
pub enum Body {
    /// A joint and the body that it moves.
    Joint {
        /// Index of the leg.
        leg: usize,
        /// Index of the joint in its leg.
        joint: usize,
    },
    /// The platform.
    Platform,
    /// The payload.
    Payload,
    /// The spring between two points of this index.
    Spring(usize),
    /// The motor of this index, in a robot with loops.
    Motor(usize),
}

/// Data of the robot for the tables after the legs.
pub(crate) struct Inventory<'r> {
    pub(crate) platform: Option<&'r Platform>,
    pub(crate) legs: &'r [Leg],
    /// Motors of a robot with loops.
    pub(crate) motors: &'r [Motor],
    pub(crate) springs: &'r [PointSpring],
    pub(crate) scope: &'r Scope,
    /// Names of the payloads, if there are several.
    pub(crate) payloads: &'r [Spanned<String>],
    /// Payloads with tables of their own.
    pub(crate) payload_bodies: &'r [Payload],
}

impl Inventory<'_> {
    /// Kind of each actuator: of the actuated joints, then of the motors.
    pub(crate) fn actuator_kinds(&self) -> Vec<JointKind> {
        let kind =
            |(leg, joint): (usize, usize)| Some(self.legs.get(leg)?.joints.get(joint)?.kind.value);
        let joints = actuators(self.legs).into_iter().filter_map(kind);
        joints
            .chain(self.motors.iter().map(|motor| motor.kind))
            .collect()
    }

    /// Number of actuators.
    pub(crate) fn actuator_count(&self) -> usize {
        actuators(self.legs).len() + self.motors.len()
    }

    /// Name of a motor's parameters: `fv_wrist`, or `fv_m1_left` of a leg's motor.
    fn motor_parameter(&self, motor: &Motor, symbol: StandardParameter) -> String {
        let name = format!("{}_{}", symbol.name(), motor.name.value);
        match motor.leg.and_then(|leg| self.legs.get(leg)) {
            Some(leg) => format!("{name}_{}", leg.name.value),
            None => name,
        }
    }

    /// Names and dimensions of the r coordinates.
    pub(crate) fn coordinates(&self) -> Vec<(String, Dimension)> {
        if let Some(platform) = self.platform {
            return platform_coordinates(platform.motion.value);
        }
        let own = independent_joints(self.legs).into_iter();
        own.filter_map(|(name, joint)| Some((name, joint::dimension(joint.kind.value)?)))
            .collect()
    }

    /// Names of all standard parameters with their bodies.
    pub(crate) fn parameters(&self) -> Vec<(String, Body, StandardParameter, Dimension)> {
        let mut all = Vec::new();
        let single = self.platform.is_none() && self.legs.len() == 1;
        for (leg_index, leg) in self.legs.iter().enumerate() {
            for (index, joint) in leg.joints.iter().enumerate() {
                let body = Body::Joint {
                    leg: leg_index,
                    joint: index,
                };
                for symbol in &joint.parameters {
                    let name = if single {
                        format!("{}_{}", symbol.name(), joint.name.value)
                    } else {
                        format!("{}_{}_{}", symbol.name(), joint.name.value, leg.name.value)
                    };
                    let dimension = joint.formula_of(*symbol).map_or_else(
                        || of_kind(*symbol, joint.kind.value),
                        |spring| spring.dimension,
                    );
                    all.push((name, body, *symbol, dimension));
                }
            }
        }
        let free = |body: Body, name: &str, symbols: &[StandardParameter]| {
            let own = symbols.iter().map(|symbol| {
                let dimension = of_kind(*symbol, JointKind::Fixed);
                (
                    format!("{}_{name}", symbol.name()),
                    body,
                    *symbol,
                    dimension,
                )
            });
            own.collect::<Vec<_>>()
        };
        if let Some(platform) = self.platform {
            all.extend(free(Body::Platform, "platform", &platform.parameters));
        }
        let springs = self.springs.iter().enumerate();
        let springs = springs.filter_map(|(index, one)| {
            let (symbol, force) = (StandardParameter::K, one.force.as_ref()?);
            let name = format!("{}_{}", symbol.name(), one.name.value);
            Some((name, Body::Spring(index), symbol, force.dimension))
        });
        all.extend(springs);
        for (index, motor) in self.motors.iter().enumerate() {
            let own = motor.parameters.iter().map(|symbol| {
                let name = self.motor_parameter(motor, *symbol);
                let dimension = of_kind(*symbol, motor.kind);
                (name, Body::Motor(index), *symbol, dimension)
            });
            all.extend(own);
        }
        if let Some(platform) = self.platform {
            let payload = platform.payload.as_deref().unwrap_or_default();
            all.extend(free(Body::Payload, "payload", payload));
        }
        for payload in self.payload_bodies {
            let name = format!("payload_{}", payload.name.value);
            all.extend(free(Body::Payload, &name, &payload.parameters));
        }
        let named = self.of_payloads(&all);
        all.extend(named);
        all
    }

    /// The parameters of the payload, once for each named payload.
    fn of_payloads(
        &self,
        all: &[(String, Body, StandardParameter, Dimension)],
    ) -> Vec<(String, Body, StandardParameter, Dimension)> {
        let is_load = |name: &str, symbol: StandardParameter| {
            name.strip_prefix(symbol.name()) == Some("_payload") && symbol.is_inertial()
        };
        let loads = all
            .iter()
            .filter(|(name, _, symbol, _)| is_load(name, *symbol));
        let loads: Vec<_> = loads.collect();
        let of = |load: &Spanned<String>| {
            let own = loads.iter().map(|(name, body, symbol, dimension)| {
                (format!("{name}_{}", load.value), *body, *symbol, *dimension)
            });
            own.collect::<Vec<_>>()
        };
        self.payloads.iter().flat_map(of).collect()
    }

    /// Names of the actuators.
    pub(crate) fn actuator_names(&self) -> ActuatorNames {
        let name = |(leg, joint): (usize, usize)| {
            let leg = self.legs.get(leg)?;
            Some((
                leg.name.value.as_str(),
                leg.joints.get(joint)?.name.value.as_str(),
            ))
        };
        let single = self.platform.is_none() && self.legs.len() == 1;
        let joints = actuators(self.legs).into_iter().filter_map(name);
        let motors = self.motors.iter().map(|motor| {
            let leg = motor.leg.and_then(|leg| self.legs.get(leg));
            let leg = leg.map(|leg| leg.name.value.as_str());
            (leg, motor.name.value.as_str())
        });
        ActuatorNames::with_motors(single, joints, motors)
    }
}

/// Independent joints of a robot without a platform, with the names of its coordinates.
///
/// Joints of the first leg have their own names, those of branches include their leg's. Joints of
/// chains, and joints with `dependent = true`, are dependent.
#[must_use]
pub fn independent_joints(legs: &[Leg]) -> Vec<(String, &crate::robot::model::Joint)> {
    let mut all = Vec::new();
    let free = legs.iter().enumerate().filter(|(_, leg)| leg.end.is_none());
    for (at, leg) in free {
        let own = leg.joints.iter().enumerate();
        let own = own.filter(|(index, joint)| joint.is_independent(*index));
        for (_, joint) in own.filter(|(_, joint)| joint.dependent.is_none()) {
            let name = &joint.name.value;
            all.push(match at {
                0 => (name.clone(), joint),
                _ => (format!("{}.{name}", leg.name.value), joint),
            });
        }
    }
    all
}

fn of_kind(parameter: StandardParameter, kind: JointKind) -> Dimension {
    Dimension::of_parameter(parameter, kind == JointKind::Prismatic)
}

fn platform_coordinates(motion: Motion) -> Vec<(String, Dimension)> {
    let dimension = |name: &str| match name {
        "x" | "y" | "z" => Dimension::LENGTH,
        _ => Dimension::ANGLE,
    };
    motion
        .coordinates()
        .into_iter()
        .map(|name| (name.to_owned(), dimension(name)))
        .collect()
}
