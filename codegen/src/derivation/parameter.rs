//! The standard parameters of a robot and the order of their columns.

use crate::mechanism::{Mechanism, StandardParameter};

/// A standard parameter of the robot.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash, PartialOrd, Ord)]
pub enum BodyParameter {
    /// Of a leg's body or joint.
    Leg {
        /// The leg.
        leg: usize,
        /// The joint in its leg.
        joint: usize,
        /// Which parameter.
        symbol: StandardParameter,
    },
    /// Of the platform.
    Platform(StandardParameter),
    /// Of the payload.
    Payload(StandardParameter),
    /// Of a payload with a table of its own.
    Load {
        /// The payload.
        payload: usize,
        /// Which parameter.
        symbol: StandardParameter,
    },
    /// The coefficient of the spring between two points of this index.
    Spring(usize),
    /// Of a motor that drives a combination of joints.
    Motor {
        /// The motor.
        motor: usize,
        /// Which parameter.
        symbol: StandardParameter,
    },
}

impl BodyParameter {
    /// All parameters that are not absent, in column order: leg by leg, body by body, then the
    /// platform's, those of springs between two points, and those of motors.
    #[must_use]
    pub fn all(mechanism: &Mechanism) -> Vec<Self> {
        let mut parameters = Vec::new();
        for (leg, of_leg) in mechanism.legs.iter().enumerate() {
            for (joint, of_joint) in of_leg.joints.iter().enumerate() {
                let symbols = of_joint.parameters.iter();
                parameters.extend(symbols.map(|&symbol| Self::Leg { leg, joint, symbol }));
            }
        }
        let platform = mechanism.platform.iter().flat_map(|p| &p.parameters);
        parameters.extend(platform.map(|&symbol| Self::Platform(symbol)));
        let springs = mechanism.springs.iter().enumerate();
        let springs = springs.filter(|(_, spring)| spring.force.is_some());
        parameters.extend(springs.map(|(index, _)| Self::Spring(index)));
        for (motor, own) in mechanism.motors.iter().enumerate() {
            let symbols = own.parameters.iter();
            parameters.extend(symbols.map(|&symbol| Self::Motor { motor, symbol }));
        }
        parameters
    }

    /// Name of the parameter: `zz_2_leg3`, `m_platform` or `m_payload`.
    #[must_use]
    pub fn name(self, mechanism: &Mechanism) -> String {
        match self {
            Self::Leg { leg, joint, symbol } => mechanism.parameter_name(symbol, leg, joint),
            Self::Platform(symbol) => format!("{}_platform", symbol.name()),
            Self::Payload(symbol) => format!("{}_payload", symbol.name()),
            Self::Load { payload, symbol } => {
                let name = &mechanism.payloads[payload].name;
                format!("{}_payload_{name}", symbol.name())
            }
            Self::Spring(index) => {
                let name = &mechanism.springs[index].name;
                format!("{}_{name}", self.symbol().name())
            }
            Self::Motor { motor, symbol } => mechanism.motor_parameter_name(symbol, motor),
        }
    }

    /// The standard parameter of the body or joint.
    #[must_use]
    pub const fn symbol(self) -> StandardParameter {
        match self {
            Self::Leg { symbol, .. }
            | Self::Platform(symbol)
            | Self::Payload(symbol)
            | Self::Load { symbol, .. }
            | Self::Motor { symbol, .. } => symbol,
            Self::Spring(_) => StandardParameter::K,
        }
    }

    /// The parameters of all payloads.
    #[must_use]
    pub fn of_payload(mechanism: &Mechanism) -> Vec<Self> {
        let payload = mechanism.platform.iter().flat_map(|p| &p.payload);
        let payload = payload.flatten().map(|&s| Self::Payload(s));
        let loads = mechanism.payloads.iter().enumerate();
        let loads = loads.flat_map(|(payload, own)| {
            let symbols = own.parameters.iter();
            symbols.map(move |&symbol| Self::Load { payload, symbol })
        });
        payload.chain(loads).collect()
    }

    /// The symbol of a parameter of a leg's body or joint.
    pub(super) fn of_joint(self, leg: usize, joint: usize) -> Option<StandardParameter> {
        match self {
            Self::Leg {
                leg: l,
                joint: j,
                symbol,
            } if (l, j) == (leg, joint) => Some(symbol),
            _ => None,
        }
    }

    /// The symbol of a parameter of the platform or its payload.
    pub(super) const fn of_platform(self) -> Option<StandardParameter> {
        match self {
            Self::Platform(symbol) | Self::Payload(symbol) => Some(symbol),
            Self::Leg { .. } | Self::Load { .. } | Self::Spring(_) | Self::Motor { .. } => None,
        }
    }
}
