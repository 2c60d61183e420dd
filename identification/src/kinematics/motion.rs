//! Motion of the platform over some samples.

use overact::{Code, Function, Model};
use overact_logs::{Load, Problem};

use crate::blocks::slice;

/// Motion of the platform and actuator torques in some successive samples of a run.
#[derive(Debug, Clone, PartialEq)]
#[non_exhaustive]
pub struct Motion {
    /// Name of the run.
    pub run: String,
    /// Whether the platform carried the payload.
    pub payload: bool,
    /// Name of the payload, if there are several.
    pub payload_name: Option<String>,
    /// Sampling frequency f_m, Hz.
    pub sampling_frequency: f64,
    /// Number of the first sample in the log.
    pub first_sample: usize,
    /// Number of samples.
    pub samples: usize,
    /// Poses x, samples × pose coordinates (m, rad).
    pub pose: Vec<f64>,
    /// Twist coordinates v, samples × r (m/s, rad/s).
    pub twist: Vec<f64>,
    /// Derivatives v̇, samples × r (m/s², rad/s²).
    pub acceleration: Vec<f64>,
    /// Joint velocities of the actuators, samples × n (m/s, rad/s).
    pub velocities: Vec<f64>,
    /// Torques minus known ones, samples × n (N, N m); filtered only with `filter_torques`.
    ///
    /// Those of cables are forces on their lengths, so they are negative.
    pub torques: Vec<f64>,
    /// Known torques and those of held parameters, samples × n (N, N m); empty without held
    /// parameters.
    ///
    /// The sum with `torques` is the measured torque, to which relative residuals then refer.
    pub subtracted: Vec<f64>,
    /// Largest difference between filtered actuator positions and those of the pose (m, rad).
    ///
    /// Zero without redundancy; otherwise it shows errors of geometry and encoder offsets.
    pub closure_residual: f64,
}

impl Motion {
    /// The payload that the platform carried.
    #[must_use]
    pub fn carried(&self) -> Load<'_> {
        Load::new(self.payload, self.payload_name.as_deref())
    }

    /// Time of a sample of the motion, s from the start of the log.
    #[must_use]
    pub fn time(&self, sample: usize) -> f64 {
        (self.first_sample + sample) as f64 / self.sampling_frequency
    }

    /// The problem of a model without a value at a sample of the motion.
    pub(crate) fn outside(&self, sample: usize, error: overact::Error) -> Problem {
        outside(
            &self.run,
            self.first_sample + sample,
            self.sampling_frequency,
            error,
        )
    }

    /// Jacobians J_p^inv of `count` samples from number `first` on, row by row.
    ///
    /// # Errors
    /// A sample at which the model has no value.
    pub(crate) fn inverse_jacobians(
        &self,
        model: &dyn Model,
        first: usize,
        count: usize,
    ) -> Result<Vec<f64>, Problem> {
        let sizes = model.info().sizes;
        let pose = slice(&self.pose, sizes.pose, first, count);
        let mut jacobians = vec![0.0; count * sizes.actuators * sizes.dof];
        model
            .evaluate(Function::InverseJacobian, &[pose], &mut jacobians)
            .map_err(|error| self.outside(first + error.sample, error.error))?;
        Ok(jacobians)
    }

    /// Appends the following samples.
    pub(super) fn append(&mut self, next: Self) {
        self.samples += next.samples;
        self.pose.extend(next.pose);
        self.twist.extend(next.twist);
        self.acceleration.extend(next.acceleration);
        self.velocities.extend(next.velocities);
        self.torques.extend(next.torques);
        self.subtracted.extend(next.subtracted);
        self.closure_residual = self.closure_residual.max(next.closure_residual);
    }
}

/// The problem of a sample at which the model has no value.
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
