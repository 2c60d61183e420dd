//! Non-ideal drives between the controller's torques and the robot.
//!
//! The command is delayed and passes the current loop, a first-order low-pass filter i̇ = ω_i (u -
//! i). It becomes the torque g i with gain g. A flexible drive adds the mode
//!
//! ```text
//! τ̈ + 2ζω τ̇ + ω² τ = ω² g i,
//! ```
//!
//! of a motor behind a spring, whose inertia is small against that of the joint. If the spring's
//! stiffness k is given, the encoder is on the motor side and shows q + τ/k. Cogging adds A sin(N
//! q) to the torque at the joint, N periods per turn, or A sin(2πN q), N periods per metre.
//!
//! Real drives log the current. The log therefore contains i in units of torque, and an
//! identification does not know gain, mode and cogging.

use serde::{Deserialize, Serialize};

/// Non-ideal drives; lists have one value per actuator, empty ones are ideal.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(default, deny_unknown_fields)]
pub struct Drives {
    /// Torque at the actuator for each unit of logged torque. Empty: 1.
    pub gain: Vec<f64>,
    /// Time from command to drive, s, rounded to samples.
    pub delay_s: f64,
    /// Bandwidth of the current loop, Hz; 0 is ideal.
    pub current_bandwidth_hz: Vec<f64>,
    /// Amplitude of the cogging torque, N m or N.
    pub cogging: Vec<f64>,
    /// Cogging periods per turn or metre.
    pub cogging_periods: Vec<f64>,
    /// Natural frequency of the flexible drive, Hz; 0 is rigid.
    pub flexible_hz: Vec<f64>,
    /// Damping factor of that mode.
    pub flexible_damping: f64,
    /// Stiffness between encoder and joint, N m/rad or N/m; 0 for an encoder at the joint.
    pub flexible_stiffness: Vec<f64>,
}

impl Default for Drives {
    fn default() -> Self {
        Self {
            gain: Vec::new(),
            delay_s: 0.0,
            current_bandwidth_hz: Vec::new(),
            cogging: Vec::new(),
            cogging_periods: Vec::new(),
            flexible_hz: Vec::new(),
            flexible_damping: 0.02,
            flexible_stiffness: Vec::new(),
        }
    }
}
