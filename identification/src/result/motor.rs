//! Motor-side parameters of drives.

use serde::Serialize;

/// Motor-side value of an estimated drive parameter.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct MotorParameter {
    /// Name of the motor.
    pub motor: String,
    /// Name of the estimated joint-side parameter; split friction keeps the joint's direction.
    pub name: String,
    /// Gear ratio: turns of the rotor per turn of the output.
    pub ratio: f64,
    /// Motor-side value.
    ///
    /// Inertia and viscous friction are divided by the squared ratio, dry friction by its
    /// magnitude, and an offset by the ratio.
    pub value: f64,
    /// Standard deviation of the value.
    pub deviation: f64,
    /// SI unit.
    pub unit: String,
}
