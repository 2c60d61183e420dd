//! The motion of the platform over some samples.

use crate::{data::Load, error::Problem};
use overact::Code;

/// The motion of the platform in some successive samples of a run and the torques that belong to
/// them.
#[derive(Debug, Clone, PartialEq)]
#[non_exhaustive]
pub struct Motion {
    /// Name of the run.
    pub run: String,
    /// Whether the platform carried the payload.
    pub payload: bool,
    /// Name of the payload, where there are several.
    pub payload_name: Option<String>,
    /// f_m, Hz.
    pub sampling_frequency: f64,
    /// Number of the first sample in the log.
    pub first_sample: usize,
    /// Number of samples.
    pub samples: usize,
    /// Poses x, samples x pose coordinates (m, rad).
    pub pose: Vec<f64>,
    /// Twist coordinates v, samples x r (m/s, rad/s).
    pub twist: Vec<f64>,
    /// Their derivatives, samples x r (m/s², rad/s²).
    pub acceleration: Vec<f64>,
    /// Velocities of the actuators' joints, samples x n (m/s, rad/s).
    pub velocities: Vec<f64>,
    /// Torques, samples x n (N, N m), unfiltered, without those that the description knows.
    pub torques: Vec<f64>,
    /// Largest distance of a filtered actuator position from the one that the pose asks for (m,
    /// rad): zero without redundancy, else the quality of the geometry and the encoders' offsets.
    pub closure_residual: f64,
}

impl Motion {
    /// What the platform carried.
    #[must_use]
    pub fn carried(&self) -> Load<'_> {
        let own = self.payload_name.as_deref().map(Load::Named);
        own.unwrap_or(Load::from(self.payload))
    }

    /// Time of a sample of the motion, s from the start of the log.
    #[must_use]
    pub fn time(&self, sample: usize) -> f64 {
        (self.first_sample + sample) as f64 / self.sampling_frequency
    }

    /// The problem of a model that has no value at a sample of the motion.
    pub(crate) fn outside(&self, sample: usize, error: overact::Error) -> Problem {
        outside(
            &self.run,
            self.first_sample + sample,
            self.sampling_frequency,
            error,
        )
    }

    /// Appends the samples that follow.
    pub(super) fn append(&mut self, next: Self) {
        self.samples += next.samples;
        self.pose.extend(next.pose);
        self.twist.extend(next.twist);
        self.acceleration.extend(next.acceleration);
        self.velocities.extend(next.velocities);
        self.torques.extend(next.torques);
        self.closure_residual = self.closure_residual.max(next.closure_residual);
    }
}

/// A sample of a log at which the model has no value.
pub(super) fn outside(run: &str, sample: usize, frequency: f64, error: overact::Error) -> Problem {
    Problem::new(
        Code::OUTSIDE_WORKSPACE,
        format!(
            "sample {sample} (t = {:.4} s) is outside the workspace: {error}",
            sample as f64 / frequency
        ),
    )
    .file(run)
    .help("check the units, signs and offsets of the positions, the geometry and the home pose")
}
