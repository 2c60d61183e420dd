//! Between the controller's torques and the robot: drives that are not ideal.
//!
//! The command waits for the drive's delay, goes through the current loop, a low-pass of first order
//! i̇ = ω_i (u - i), and becomes the torque g i of gain g. A flexible drive passes it on through the mode
//!
//! ```text
//! τ̈ + 2ζω τ̇ + ω² τ = ω² g i,
//! ```
//!
//! that of a motor behind a spring whose inertia is small against the one before it. Where the spring's
//! stiffness k is given, the encoder sits on the motor's side and shows q + τ/k. Cogging adds
//! A sin(N q) to the torque at the joint, N periods a turn, or A sin(2πN q), N periods a metre.
//!
//! What a real drive would log is the current: the log has i, in units of torque, so a gain other than
//! one, the mode and the cogging are what an identification does not know of.

use serde::{Deserialize, Serialize};

/// Drives that are not ideal. Lists have one value for each of the n actuators; empty ones are ideal.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(default, deny_unknown_fields)]
pub struct Drives {
    /// Torque at the actuator for each unit of torque in the log. Empty: 1.
    pub gain: Vec<f64>,
    /// Time from command to drive, s, rounded to samples.
    pub delay_s: f64,
    /// Bandwidth of the current loop, Hz; 0 is ideal.
    pub current_bandwidth_hz: Vec<f64>,
    /// Amplitude of the cogging torque, N m or N.
    pub cogging: Vec<f64>,
    /// Periods of the cogging in a turn, or in a metre.
    pub cogging_periods: Vec<f64>,
    /// Natural frequency of the flexible drive, Hz; 0 is rigid.
    pub flexible_hz: Vec<f64>,
    /// Damping factor of that mode.
    pub flexible_damping: f64,
    /// Stiffness between encoder and joint, N m/rad or N/m; 0 where the encoder is at the joint.
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
