//! Faults for which a report states detection limits.

use overact_identification::{Check, Detectable, FaultKind, Identification};

/// A fault for which a report states a detection limit.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct KnownFault {
    /// Kind.
    pub fault: FaultKind,
    /// Dependence of a missing torque on the motion, as in the report; `None` for other faults.
    pub shape: Option<&'static str>,
    /// Place of the fault.
    pub place: Place,
    /// Size in the unit of the report; `None` if it depends on the records.
    pub size: Option<f64>,
}

/// Place of a fault.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Place {
    /// The whole robot.
    Robot,
    /// The actuator with this number.
    Actuator(usize),
    /// A length.
    Length(&'static str),
}

impl KnownFault {
    /// A fault of the whole robot.
    pub(super) const fn of_robot(fault: FaultKind, size: f64) -> Self {
        Self {
            fault,
            shape: None,
            place: Place::Robot,
            size: Some(size),
        }
    }

    /// A fault of the actuator with this number.
    pub(super) const fn of_actuator(fault: FaultKind, actuator: usize, size: f64) -> Self {
        Self {
            fault,
            shape: None,
            place: Place::Actuator(actuator),
            size: Some(size),
        }
    }

    /// A torque of this shape at the actuator with this number.
    pub(super) const fn torque(shape: &'static str, actuator: usize, size: Option<f64>) -> Self {
        Self {
            fault: FaultKind::MissingTorque,
            shape: Some(shape),
            place: Place::Actuator(actuator),
            size,
        }
    }

    /// Check that states a limit of this fault, and the limit.
    pub(super) fn limit_in<'a>(
        &self,
        result: &'a Identification,
        actuators: &[&str],
    ) -> Option<(&'a Check, &'a Detectable)> {
        let name = match self.place {
            Place::Robot => "",
            Place::Actuator(number) => actuators.get(number)?,
            Place::Length(name) => name,
        };
        let checks = result.checks.iter();
        let mut limits =
            checks.flat_map(|check| check.detectable.iter().map(move |one| (check, one)));
        limits
            .find(|(_, one)| one.fault == self.fault && one.shape == self.shape && one.name == name)
    }

    /// The limit, if the report states that a fault of this size may be hidden and do harm.
    #[must_use]
    pub fn stated_in<'a>(
        &self,
        result: &'a Identification,
        actuators: &[&str],
    ) -> Option<&'a Detectable> {
        let (check, limit) = self.limit_in(result, actuators)?;
        let is_below = self.size.is_none_or(|size| size.abs() <= limit.size);
        (check.passed && limit.is_harmful() && is_below).then_some(limit)
    }
}
