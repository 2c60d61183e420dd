//! One run: uniformly sampled positions and torques of all actuators.

use crate::error::{Error, Problem};

/// A step of time may differ from the usual one by this fraction.
const STEP_TOLERANCE: f64 = 1e-3;

/// One measured or virtual run.
#[derive(Debug, Clone, PartialEq)]
pub struct Log {
    name: String,
    sampling_frequency: f64,
    actuators: usize,
    positions: Vec<f64>,
    torques: Vec<f64>,
    payload: bool,
}

impl Log {
    /// Makes a run of `actuators` actuators from `positions` (m, rad) and `torques` (N, N m), both
    /// samples x n and row-major, sampled at `sampling_frequency` (Hz). `payload` tells whether the
    /// platform carried the payload.
    ///
    /// # Errors
    /// An empty run, arrays of different or broken lengths, numbers that are not finite, a
    /// frequency that is not positive.
    pub fn new(
        name: impl Into<String>,
        sampling_frequency: f64,
        actuators: usize,
        positions: Vec<f64>,
        torques: Vec<f64>,
        payload: bool,
    ) -> Result<Self, Error> {
        let name = name.into();
        let problem = |message: String| Problem::new(message).file(name.as_str());
        let mut problems = Vec::new();
        if !(sampling_frequency.is_finite() && sampling_frequency > 0.0) {
            problems.push(problem(format!(
                "the sampling frequency is {sampling_frequency} Hz"
            )));
        }
        if positions.is_empty() || actuators == 0 {
            problems.push(problem(String::from("the run is empty")));
        } else if positions.len() != torques.len() || !positions.len().is_multiple_of(actuators) {
            problems.push(problem(format!(
                "{} positions and {} torques are not samples of {actuators} actuators",
                positions.len(),
                torques.len()
            )));
        }
        for (what, values) in [("position", &positions), ("torque", &torques)] {
            if let Some(index) = values.iter().position(|value| !value.is_finite()) {
                problems.push(problem(format!(
                    "sample {}: the {what} of actuator {} is not a finite number",
                    index / actuators.max(1),
                    index % actuators.max(1)
                )));
            }
        }
        Error::check(problems)?;
        Ok(Self {
            name,
            sampling_frequency,
            actuators,
            positions,
            torques,
            payload,
        })
    }

    /// Name of the run: its file as the caller named it.
    #[must_use]
    pub fn name(&self) -> &str {
        &self.name
    }

    /// f_m, Hz.
    #[must_use]
    pub const fn sampling_frequency(&self) -> f64 {
        self.sampling_frequency
    }

    /// Number of samples.
    #[must_use]
    pub const fn samples(&self) -> usize {
        self.positions.len() / self.actuators
    }

    /// n, number of actuators.
    #[must_use]
    pub const fn actuators(&self) -> usize {
        self.actuators
    }

    /// Positions, samples x n, row-major (m, rad).
    #[must_use]
    pub fn positions(&self) -> &[f64] {
        &self.positions
    }

    /// Torques, samples x n, row-major (N, N m).
    #[must_use]
    pub fn torques(&self) -> &[f64] {
        &self.torques
    }

    /// Whether the platform carried the payload.
    #[must_use]
    pub const fn payload(&self) -> bool {
        self.payload
    }

    /// The position of one actuator over time (m, rad).
    pub(crate) fn position_column(&self, actuator: usize) -> Vec<f64> {
        self.positions
            .iter()
            .skip(actuator)
            .step_by(self.actuators)
            .copied()
            .collect()
    }
}

/// The sampling frequency (Hz) of a time column, from its mean step. `lines` are the lines of the
/// file on which the samples stand.
///
/// # Errors
/// Fewer than two samples, or the first step that is not the usual one.
pub(super) fn uniform_frequency(
    file: &str,
    time: &[f64],
    lines: Option<&[usize]>,
) -> Result<f64, Error> {
    let (Some(first), Some(last)) = (time.first(), time.last()) else {
        return Err(Problem::new("the run is empty").file(file).into());
    };
    if time.len() < 2 {
        return Err(Problem::new("the run has a single sample")
            .file(file)
            .into());
    }
    let mut steps: Vec<f64> = time.windows(2).map(|pair| pair[1] - pair[0]).collect();
    let found = steps.clone();
    steps.sort_by(f64::total_cmp);
    // The median stays right when samples are missing; the mean would not.
    let expected = steps[steps.len() / 2];
    let bad = found.iter().position(|step| {
        // Written so that a step that is not a number counts as bad.
        let uniform = expected > 0.0 && (step - expected).abs() <= STEP_TOLERANCE * expected;
        !uniform
    });
    if let Some(index) = bad {
        let mut problem = Problem::new(format!(
            "the time is not uniform: between samples {index} and {} it steps by {:.9} s, expected {expected:.9} s",
            index + 1,
            found[index]
        ))
        .file(file)
        .help("resample the run at a constant frequency, or cut it where samples are missing");
        if let Some(line) = lines.and_then(|lines| lines.get(index + 1)) {
            problem = problem.line(*line);
        }
        return Err(problem.into());
    }
    Ok((time.len() - 1) as f64 / (last - first))
}
