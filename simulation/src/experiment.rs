//! Experiment as plain data: control, measurement and runs.
//!
//! The defaults are those of the DualV in section 5.1 of the paper: PD control of 70 Hz bandwidth
//! and damping 0.7 at 5 kHz. The derivative is filtered at 70 Hz; feed-forward and projection (50)
//! are on.

use overact::Sizes;
use serde::{Deserialize, Serialize};

use crate::{drives::Drives, trajectory::Trajectory};

/// A virtual experiment.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(default, deny_unknown_fields)]
pub struct Experiment {
    /// Sampling frequency of controller and sensors, Hz.
    pub sampling_hz: f64,
    /// Default duration of a run, s.
    pub duration_s: f64,
    /// Natural frequency of the controlled robot f_c, Hz: ω_c = 2π f_c.
    pub bandwidth_hz: f64,
    /// Damping factor ξ of the second-order equation that sets the gains.
    pub damping: f64,
    /// Cutoff of the first-order low-pass filter of the derivative, Hz.
    pub derivative_cutoff_hz: f64,
    /// Whether the inverse dynamics on the desired trajectory is added to the PD torques.
    pub feed_forward: bool,
    /// Whether internal torques are removed from the controller's output, eq. (50).
    pub project_internal: bool,
    /// Encoder resolution of each of the n actuators, rad or m; 0 is ideal. Empty: all ideal.
    pub encoder_resolution: Vec<f64>,
    /// Delay of the positions for controller and log, s, rounded to samples.
    pub encoder_delay_s: f64,
    /// Standard deviation of the torque measurement of each of the n actuators, N m or N. Empty: 0.
    pub torque_noise: Vec<f64>,
    /// Largest absolute torque of each of the n actuators, N m or N.
    pub torque_limit: Option<Vec<f64>>,
    /// Non-ideal drives.
    pub drives: Drives,
    /// Seed of all noise.
    pub seed: u64,
    /// True parameters of the robot in the model's column order, the payload's last (SI units).
    pub parameters: Vec<f64>,
    /// Parameters of the controller's model, in the same order; by default the true ones.
    pub nominal_parameters: Option<Vec<f64>>,
    /// The runs.
    pub runs: Vec<Run>,
    /// Integration steps per sampling period.
    pub integration_steps: usize,
}

/// One run of an experiment.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Run {
    /// Unique name; it also seeds the run's noise.
    pub name: String,
    /// Whether the payload is on the platform.
    #[serde(default)]
    pub payload: bool,
    /// Duration, s; by default that of the experiment.
    #[serde(default)]
    pub duration_s: Option<f64>,
    /// The desired motion of the platform.
    pub trajectory: Trajectory,
}

impl Default for Experiment {
    fn default() -> Self {
        Self {
            sampling_hz: 5000.0,
            duration_s: 10.0,
            bandwidth_hz: 70.0,
            damping: 0.7,
            derivative_cutoff_hz: 70.0,
            feed_forward: true,
            project_internal: true,
            encoder_resolution: Vec::new(),
            encoder_delay_s: 0.0,
            torque_noise: Vec::new(),
            torque_limit: None,
            drives: Drives::default(),
            seed: 0,
            parameters: Vec::new(),
            nominal_parameters: None,
            runs: Vec::new(),
            integration_steps: 1,
        }
    }
}

impl Experiment {
    /// Number of samples of a run: those at t = k / sampling_hz with 0 <= t < duration.
    #[must_use]
    pub fn samples(&self, run: &Run) -> usize {
        // The experiment is validated: the product is positive and far below 2^53.
        (run.duration_s.unwrap_or(self.duration_s) * self.sampling_hz).round() as usize
    }

    /// True parameters in a run; the payload's are zero without payload.
    pub(crate) fn true_parameters(&self, run: &Run, sizes: &Sizes) -> Vec<f64> {
        loaded(&self.parameters, run.payload, sizes)
    }

    /// Parameters of the controller's model in a run.
    pub(crate) fn controller_parameters(&self, run: &Run, sizes: &Sizes) -> Vec<f64> {
        let nominal = self.nominal_parameters.as_ref().unwrap_or(&self.parameters);
        loaded(nominal, run.payload, sizes)
    }
}

/// Parameters with the payload's set to zero in runs without payload.
fn loaded(parameters: &[f64], payload: bool, sizes: &Sizes) -> Vec<f64> {
    let mut parameters = parameters.to_vec();
    if !payload {
        parameters[sizes.parameters..].fill(0.0);
    }
    parameters
}
