//! Parameters of drives at the side of the motor.

use serde::Serialize;

/// What an estimate of a drive's parameter is in front of the gear, where the motor turns.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct MotorParameter {
    /// Name of the motor.
    pub motor: String,
    /// The parameter as it is estimated, behind the gear; friction by direction keeps the direction of that side.
    pub name: String,
    /// Turns of the rotor for one behind the gear.
    pub ratio: f64,
    /// The estimate in front of the gear: inertia and viscous friction by the square of the ratio smaller, dry
    /// friction by its magnitude, an offset by the ratio.
    pub value: f64,
    /// Its standard deviation.
    pub deviation: f64,
    /// SI unit.
    pub unit: String,
}
