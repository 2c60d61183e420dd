//! From measured actuator positions to the platform's motion.
//!
//! Positions pass a zero-phase Butterworth low-pass; velocities and accelerations are central
//! differences. The pose x is the least-squares forward kinematics of all n actuators, sample after
//! sample from the previous one, so that the assembly mode is that of the home pose. The twist v
//! and its derivative follow from eqs. (21) and (24). A robot without a loop is the same: its pose
//! are its joint positions.

use overact::{Function, Model, math::wrap_angle};

use crate::{
    blocks::evaluate,
    data::Log,
    error::{Error, Problem},
    filters::{butterworth, central_differences, filtfilt},
    settings::Settings,
};

/// Steps in which the first sample is approached from the home pose, should it be far from it.
const APPROACH_STEPS: usize = 50;

/// Samples between two reports of progress.
const REPORT: usize = 1000;

/// The motion of the platform in one run and the torques that belong to it, after the samples that
/// the settings drop.
#[derive(Debug, Clone, PartialEq)]
pub struct Motion {
    /// Name of the run.
    pub run: String,
    /// Whether the platform carried the payload.
    pub payload: bool,
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
    /// Torques, samples x n (N, N m), unfiltered.
    pub torques: Vec<f64>,
    /// Largest distance of a filtered actuator position from the one that the pose asks for (m,
    /// rad): zero without redundancy, else the quality of the geometry and the encoders' offsets.
    pub closure_residual: f64,
}

impl Motion {
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
}

/// A sample of a log at which the model has no value.
fn outside(run: &str, sample: usize, frequency: f64, error: overact::Error) -> Problem {
    Problem::new(format!(
        "sample {sample} (t = {:.4} s) is outside the workspace: {error}",
        sample as f64 / frequency
    ))
    .file(run)
    .help("check the units, signs and offsets of the positions, the geometry and the home pose")
}

/// Computes the motion of a run. `progress` is told how many samples are done, of how many.
///
/// # Errors
/// A run of another number of actuators or of too few samples, a cutoff above the Nyquist
/// frequency, or a sample outside the workspace.
pub fn motion(
    model: &dyn Model,
    log: &Log,
    settings: &Settings,
    progress: &dyn Fn(usize, usize),
) -> Result<Motion, Error> {
    check(model, log, settings)?;
    let info = model.info();
    let (frequency, samples, n) = (log.sampling_frequency(), log.samples(), log.actuators());
    let [positions, velocities, accelerations] = differentiate(log, settings)?;
    let pose = poses(model, log, &positions, progress)?;
    // From here on, only the samples that are kept.
    let first = settings.skip_start;
    let kept = samples - settings.skip_start - settings.skip_end;
    let keep =
        |values: &[f64], width: usize| values[first * width..(first + kept) * width].to_vec();
    let pose = keep(&pose, info.sizes.pose);
    let (positions, velocities) = (keep(&positions, n), keep(&velocities, n));
    let accelerations = keep(&accelerations, n);
    let at = |error: overact::SampleError| -> Error {
        outside(log.name(), first + error.sample, frequency, error.error).into()
    };
    let twist = evaluate(
        model,
        Function::TwistFromActuators,
        &[&pose, &velocities],
        kept,
    )
    .map_err(at)?;
    let inputs: [&[f64]; 3] = [&pose, &twist, &accelerations];
    let acceleration =
        evaluate(model, Function::AccelerationFromActuators, &inputs, kept).map_err(at)?;
    let reached = evaluate(model, Function::ActuatorPositions, &[&pose], kept).map_err(at)?;
    let closure_residual = largest_difference(&positions, &reached, info.actuator_is_revolute);
    Ok(Motion {
        run: log.name().to_owned(),
        payload: log.payload(),
        sampling_frequency: frequency,
        first_sample: first,
        samples: kept,
        pose,
        twist,
        acceleration,
        torques: keep(log.torques(), n),
        closure_residual,
    })
}

/// Filtered positions, velocities and accelerations of the actuators, samples x n each.
fn differentiate(log: &Log, settings: &Settings) -> Result<[Vec<f64>; 3], Error> {
    let (frequency, n) = (log.sampling_frequency(), log.actuators());
    let cutoff = settings.filter_cutoff_hz * 2.0 / frequency;
    let filter = butterworth(settings.filter_order, cutoff)?;
    let mut rows = [(); 3].map(|()| vec![0.0; log.samples() * n]);
    for actuator in 0..n {
        let position = filtfilt(&filter, &log.position_column(actuator))?;
        let velocity = central_differences(&position, frequency);
        let acceleration = central_differences(&velocity, frequency);
        for (rows, column) in rows.iter_mut().zip([position, velocity, acceleration]) {
            scatter(&column, rows, actuator, n);
        }
    }
    Ok(rows)
}

/// Checks a run against the model and the settings.
fn check(model: &dyn Model, log: &Log, settings: &Settings) -> Result<(), Error> {
    let info = model.info();
    let mut problems = Vec::new();
    if log.actuators() != info.sizes.actuators {
        problems.push(
            Problem::new(format!(
                "the run has {}, the robot `{}` has {}",
                counted(log.actuators(), "actuator"),
                info.name,
                info.sizes.actuators
            ))
            .file(log.name())
            .help("map one position and one torque column to each actuator"),
        );
    }
    let needed = settings.samples_needed();
    if log.samples() < needed {
        problems.push(
            Problem::new(format!(
                "the run has {} samples; the filters, the decimation and the skipped samples need at least {needed}",
                log.samples()
            ))
            .file(log.name())
            .help("record a longer run, or skip fewer samples"),
        );
    }
    let nyquist = log.sampling_frequency() / 2.0;
    // Written so that a cutoff that is not a number is a problem, too.
    let below = settings.filter_cutoff_hz < nyquist;
    if !below {
        problems.push(
            Problem::new(format!(
                "the cutoff frequency of {} Hz is not below half the sampling frequency, {nyquist} Hz",
                settings.filter_cutoff_hz
            ))
            .file(log.name())
            .help("choose about ten times the bandwidth of the motion"),
        );
    }
    Error::check(problems)
}

/// `1 actuator`, `2 actuators`.
fn counted(count: usize, what: &str) -> String {
    format!("{count} {what}{}", if count == 1 { "" } else { "s" })
}

/// Writes a column into a row-major array of `width` columns.
fn scatter(column: &[f64], rows: &mut [f64], index: usize, width: usize) {
    for (row, value) in rows.chunks_exact_mut(width).zip(column) {
        if let Some(place) = row.get_mut(index) {
            *place = *value;
        }
    }
}

/// The poses of all samples, each found from the one before.
fn poses(
    model: &dyn Model,
    log: &Log,
    positions: &[f64],
    progress: &dyn Fn(usize, usize),
) -> Result<Vec<f64>, Error> {
    let n = log.actuators();
    let mut pose = model.info().home_pose.to_vec();
    let mut poses = Vec::with_capacity(pose.len() * log.samples());
    if let Some(first) = positions.get(..n) {
        approach(model, first, &mut pose);
    }
    for (sample, actuators) in positions.chunks_exact(n).enumerate() {
        model
            .pose_from_actuators(actuators, &mut pose)
            .map_err(|error| outside(log.name(), sample, log.sampling_frequency(), error))?;
        poses.extend_from_slice(&pose);
        if sample % REPORT == 0 {
            progress(sample, log.samples());
        }
    }
    progress(log.samples(), log.samples());
    Ok(poses)
}

/// Walks from the home pose towards the first sample in small steps, so that its assembly mode is
/// that of the home pose. Should the way lead outside the workspace, the pose stays at home, and
/// the first sample is tried from there.
fn approach(model: &dyn Model, first: &[f64], pose: &mut [f64]) {
    let info = model.info();
    let mut home = vec![0.0; first.len()];
    if model
        .evaluate(Function::ActuatorPositions, &[pose], &mut home)
        .is_err()
    {
        return;
    }
    let way: Vec<f64> = first
        .iter()
        .zip(&home)
        .zip(info.actuator_is_revolute)
        .map(|((to, from), revolute)| {
            if *revolute {
                wrap_angle(to - from)
            } else {
                to - from
            }
        })
        .collect();
    let mut reached = pose.to_vec();
    for step in 1..=APPROACH_STEPS {
        let part = step as f64 / APPROACH_STEPS as f64;
        let target: Vec<f64> = home.iter().zip(&way).map(|(h, w)| h + part * w).collect();
        if model.pose_from_actuators(&target, &mut reached).is_err() {
            return;
        }
    }
    pose.copy_from_slice(&reached);
}

/// The largest difference between measured and reached positions, angles modulo a turn.
fn largest_difference(measured: &[f64], reached: &[f64], revolute: &[bool]) -> f64 {
    measured
        .iter()
        .zip(reached)
        .zip(revolute.iter().cycle())
        .map(|((m, q), revolute)| if *revolute { wrap_angle(m - q) } else { m - q })
        .fold(0.0, |largest, difference| largest.max(difference.abs()))
}
