//! From measured actuator positions to platform motion, block by block.
//!
//! Positions pass a zero-phase Butterworth low-pass, and so do measured velocities. Otherwise
//! velocities are central differences, like accelerations. The pose x is the least-squares forward
//! kinematics of all n actuators, each sample starting from the previous one. This keeps the
//! assembly mode of the home pose. The twist v and its derivative follow from eqs. (21) and (24).
//! The pose of a robot without loops is its joint positions.

pub(crate) mod conditioning;
mod dense;
pub(crate) mod distribution;
mod forward;
mod gauss_newton;
pub(crate) mod gears;
mod known_torques;
mod motion;
mod stream;

use overact::Code;
use overact::{Function, Model, math::wrap_angle};

use crate::{blocks::evaluate, settings::Settings, units::time_of_sampling};
use overact_logs::{Error, Log, Problem, monitor::Monitor, significant};

use forward::Forward;
pub(crate) use forward::approach;
use gears::Gears;
use known_torques::KnownTorques;
pub use motion::Motion;
use motion::outside;
use stream::{Derivatives, Stream};

/// Motion of a run in one piece, without the samples that the settings exclude.
///
/// `progress` gets the numbers of finished and of all samples. Use [`Motions`] for long runs.
///
/// # Errors
/// As [`Motions::new`] and [`Motions::next`].
pub fn motion(
    model: &dyn Model,
    log: &Log,
    settings: &Settings,
    progress: &dyn Fn(usize, usize),
) -> Result<Motion, Error> {
    let mut motions = Motions::new(model, log, settings)?;
    let mut whole = motions.empty();
    while let Some(block) = motions.next()? {
        progress(motions.done(), log.samples());
        whole.append(block);
    }
    progress(log.samples(), log.samples());
    Ok(whole)
}

/// Motion of a run, block by block, without the samples that the settings exclude.
pub struct Motions<'a> {
    model: &'a dyn Model,
    log: &'a Log,
    stream: Stream<'a>,
    forward: Forward<'a>,
    known: KnownTorques<'a>,
    gears: Gears,
    /// Samples to keep.
    kept: std::ops::Range<usize>,
    /// Whether closure and raw numbers are monitored.
    is_watched: bool,
}

impl<'a> Motions<'a> {
    /// Starts with the first sample.
    ///
    /// # Errors
    /// A run with another number of actuators or too few samples, a cutoff above the Nyquist
    /// frequency, a file that cannot be read.
    pub fn new(model: &'a dyn Model, log: &'a Log, settings: &Settings) -> Result<Self, Error> {
        check(model, log, settings)?;
        Ok(Self {
            model,
            log,
            stream: Stream::new(log, settings)?,
            forward: Forward::new(model, log),
            known: KnownTorques::new(model, &settings.prior),
            gears: Gears::new(settings),
            kept: settings.skip_start..log.samples() - settings.skip_end,
            is_watched: true,
        })
    }

    /// Turns off monitoring, for runs derived from another one.
    pub(crate) fn unwatched(mut self) -> Self {
        self.is_watched = false;
        self.stream.leave_unwatched();
        self
    }

    /// Number of samples to keep.
    #[must_use]
    pub fn samples(&self) -> usize {
        self.kept.len()
    }

    /// Number of processed samples of the log.
    #[must_use]
    pub fn done(&self) -> usize {
        self.stream.done()
    }

    /// Statistics of the processed raw numbers.
    pub(crate) fn into_monitor(self) -> Monitor {
        self.stream.into_monitor()
    }

    /// A motion without samples, for appending.
    fn empty(&self) -> Motion {
        Motion {
            run: self.log.name().to_owned(),
            payload: self.log.payload(),
            payload_name: self.log.payload_name().map(str::to_owned),
            sampling_frequency: self.log.sampling_frequency(),
            first_sample: self.kept.start,
            samples: 0,
            pose: Vec::new(),
            twist: Vec::new(),
            acceleration: Vec::new(),
            velocities: Vec::new(),
            torques: Vec::new(),
            subtracted: Vec::new(),
            closure_residual: 0.0,
        }
    }

    /// The next block, or `None` at the end.
    ///
    /// # Errors
    /// A sample outside the workspace, or a file that cannot be read any more.
    #[expect(clippy::should_implement_trait, reason = "an iterator has no errors")]
    pub fn next(&mut self) -> Result<Option<Motion>, Error> {
        while let Some(block) = self.stream.next()? {
            let poses = self.forward.poses(block.first, &block.positions)?;
            let start = self
                .kept
                .start
                .clamp(block.first, block.first + block.samples);
            let end = self
                .kept
                .end
                .clamp(block.first, block.first + block.samples);
            if start < end {
                return self.completed(&block, poses, start..end).map(Some);
            }
        }
        Ok(None)
    }

    /// Motion of the samples `kept` of a block.
    fn completed(
        &self,
        block: &Derivatives,
        poses: Vec<f64>,
        kept: std::ops::Range<usize>,
    ) -> Result<Motion, Error> {
        let info = self.model.info();
        let (n, samples) = (self.log.actuators(), kept.len());
        let first = kept.start - block.first;
        let keep = |values: &[f64], width: usize| {
            values[first * width..(first + samples) * width].to_vec()
        };
        let pose = if samples == block.samples {
            poses
        } else {
            keep(&poses, info.sizes.pose)
        };
        let at = |error: overact::SampleError| -> Error {
            let sample = kept.start + error.sample;
            let frequency = self.log.sampling_frequency();
            outside(self.log.name(), sample, frequency, error.error).into()
        };
        let velocities = keep(&block.velocities, n);
        let accelerations = keep(&block.accelerations, n);
        let inputs: [&[f64]; 2] = [&pose, &velocities];
        let twist =
            evaluate(self.model, Function::TwistFromActuators, &inputs, samples).map_err(at)?;
        let inputs: [&[f64]; 3] = [&pose, &twist, &accelerations];
        let acceleration = evaluate(
            self.model,
            Function::AccelerationFromActuators,
            &inputs,
            samples,
        )
        .map_err(at)?;
        let mut closure_residual = 0.0;
        if self.is_watched {
            let reached = evaluate(self.model, Function::ActuatorPositions, &[&pose], samples);
            let measured = &block.positions[first * n..(first + samples) * n];
            let is_revolute = info.actuator_is_revolute;
            closure_residual = largest_difference(measured, &reached.map_err(at)?, is_revolute);
        }
        let mut motion = Motion {
            closure_residual,
            first_sample: kept.start,
            samples,
            pose,
            twist,
            acceleration,
            velocities,
            torques: actuator_forces(self.model, keep(&block.torques, n)),
            ..self.empty()
        };
        self.gears.take_losses(&mut motion, &accelerations);
        self.known.subtract(&mut motion)?;
        Ok(motion)
    }
}

/// Turns the sign of the cables' torques: a tension t is the force -t on the cable's length.
///
/// Applied twice, it gives the torques again.
pub(crate) fn actuator_forces(model: &dyn Model, mut torques: Vec<f64>) -> Vec<f64> {
    let pulls = model.pulls();
    if pulls.is_empty() {
        return torques;
    }
    for sample in torques.chunks_exact_mut(pulls.len()) {
        let cables = sample.iter_mut().zip(pulls).filter(|(_, pulls)| **pulls);
        cables.for_each(|(torque, _)| *torque = -*torque);
    }
    torques
}

/// Checks a run against the model and the settings.
pub(crate) fn check(model: &dyn Model, log: &Log, settings: &Settings) -> Result<(), Error> {
    let info = model.info();
    let mut problems = Vec::new();
    if log.actuators() != info.sizes.actuators {
        problems.push(
            Problem::new(
                Code::LOG_ACTUATORS,
                format!(
                    "the run has {}, the robot `{}` has {}",
                    counted(log.actuators(), "actuator"),
                    info.name,
                    info.sizes.actuators
                ),
            )
            .file(log.name())
            .help("map one position and one torque column to each actuator"),
        );
    }
    let needed = settings.samples_needed();
    if log.samples() < needed {
        problems.push(
            Problem::new(Code::LOG_TOO_SHORT, format!(
                "the run has {} samples; the filters, the decimation and the skipped samples need at least {needed}",
                log.samples()
            ))
            .file(log.name())
            .help(short_help(log)),
        );
    }
    let nyquist = log.sampling_frequency() / 2.0;
    // Also false for NaN.
    let below = settings.filter_cutoff_hz < nyquist;
    if !below {
        problems.push(
            Problem::new(Code::SETTINGS, format!(
                "the cutoff frequency of {} Hz is not below half the sampling frequency, {nyquist} Hz",
                settings.filter_cutoff_hz
            ))
            .file(log.name())
            .help(cutoff_help(log.sampling_frequency(), settings.filter_cutoff_hz)),
        );
    }
    Error::check(problems)
}

/// Help for a cutoff that the sampling frequency (Hz) does not allow.
fn cutoff_help(frequency: f64, cutoff: f64) -> String {
    let set = "`filter_cutoff` of [identification] about ten times the bandwidth of the motion";
    match time_of_sampling(frequency, cutoff) {
        Some(unit_error) => format!("{}. Else give {set}", unit_error.advice()),
        None => format!("give {set}"),
    }
}

/// Duration (s) below which the time of a run may be in a longer unit.
const SHORT_RUN: f64 = 2.0;

/// Help for a run with too few samples.
fn short_help(log: &Log) -> String {
    let longer = "record a longer run, or lower `skip_start`, `skip_end` or `decimation` of [identification]";
    let seconds = log.samples() as f64 / log.sampling_frequency();
    if seconds < SHORT_RUN {
        let seconds = significant(seconds, 2);
        format!(
            "{longer}; the run lasts {seconds} s: is the time in minutes? It must be in seconds"
        )
    } else {
        longer.to_owned()
    }
}

/// `1 actuator`, `2 actuators`.
fn counted(count: usize, what: &str) -> String {
    format!("{count} {what}{}", if count == 1 { "" } else { "s" })
}

/// Largest difference between measured and computed positions, angles modulo a turn.
fn largest_difference(measured: &[f64], reached: &[f64], revolute: &[bool]) -> f64 {
    measured
        .iter()
        .zip(reached)
        .zip(revolute.iter().cycle())
        .map(|((m, q), revolute)| if *revolute { wrap_angle(m - q) } else { m - q })
        .fold(0.0, |largest, difference| largest.max(difference.abs()))
}
