//! The table `[experiment.drives]`: drives that are not ideal.

use crate::experiments::per_actuator::{effort, per_actuator};
use crate::expressions::dimension::Dimension;
use crate::robot::inventory::Inventory;
use crate::robot::model::JointKind;
use crate::toml_text::reader::Item;

/// Deviations of the drives from the controller's torques; lists have one value per actuator.
#[derive(Debug, Clone, PartialEq)]
pub struct Drives {
    /// Torque at the actuator per unit of torque in the log.
    pub gain: Option<Vec<f64>>,
    /// Delay from command to drive, s.
    pub delay: f64,
    /// Bandwidth of the current loop, Hz; 0 is ideal.
    pub current_bandwidth: Option<Vec<f64>>,
    /// Amplitude of the cogging torque, N m or N.
    pub cogging: Option<Vec<f64>>,
    /// Periods of the cogging per revolution or metre.
    pub cogging_periods: Option<Vec<f64>>,
    /// Natural frequency of the flexible drive, Hz; 0 is rigid.
    pub flexible_frequency: Option<Vec<f64>>,
    /// Damping factor of that mode.
    pub flexible_damping: f64,
    /// Stiffness between encoder and joint, N m/rad or N/m; 0 if the encoder is at the joint.
    pub flexible_stiffness: Option<Vec<f64>>,
}

impl Default for Drives {
    fn default() -> Self {
        Self {
            gain: None,
            delay: 0.0,
            current_bandwidth: None,
            cogging: None,
            cogging_periods: None,
            flexible_frequency: None,
            flexible_damping: 0.02,
            flexible_stiffness: None,
        }
    }
}

/// Reads the table.
pub(crate) fn read(item: &Item<'_, '_>, robot: &Inventory<'_>) -> Option<Drives> {
    let table = item.table("the table `[experiment.drives]`")?;
    let kinds = robot.actuator_kinds();
    let list = |key: &str, dimension: fn(JointKind) -> Dimension| {
        table
            .get(key)
            .and_then(|item| per_actuator(&item, &kinds, dimension, robot.scope))
    };
    let number = |key: &str, dimension, default: f64| {
        table
            .get(key)
            .and_then(|item| item.not_negative(dimension, robot.scope))
            .unwrap_or(default)
    };
    let usual = Drives::default();
    let drives = Drives {
        gain: list("gain", |_| Dimension::NONE),
        delay: number("delay", Dimension::TIME, usual.delay),
        current_bandwidth: list("current_bandwidth", |_| Dimension::FREQUENCY),
        cogging: list("cogging", effort),
        cogging_periods: list("cogging_periods", |_| Dimension::NONE),
        flexible_frequency: list("flexible_frequency", |_| Dimension::FREQUENCY),
        flexible_damping: number("flexible_damping", Dimension::NONE, usual.flexible_damping),
        flexible_stiffness: list("flexible_stiffness", stiffness),
    };
    table.finish();
    Some(drives)
}

fn stiffness(kind: JointKind) -> Dimension {
    match kind {
        JointKind::Prismatic => Dimension::LINEAR_STIFFNESS,
        _ => Dimension::ANGULAR_STIFFNESS,
    }
}
