//! Closed loop over all runs of an experiment.
//!
//! At each sample t_k the encoder is read, and the controller computes torques from it without
//! delay. The robot then moves under the drives' torques until t_{k+1}. The recorded torque at t_k
//! is the mean of the currents (in units of torque) before and after t_k. Positions and torques
//! thus belong to one instant; otherwise the record would be half a sample early or late.
//!
//! Runs are independent and use all threads of the machine. Progress is reported on the caller's
//! thread.

use std::{
    cell::Cell,
    num::NonZero,
    sync::{
        atomic::{AtomicUsize, Ordering},
        mpsc,
    },
    thread,
};

use overact::{Function, Model};

use crate::{
    controller::{Control, Controller, Desired, effective_inertia},
    drivetrain::Drivetrain,
    error::{Cause, Error, RunError, Stage},
    experiment::{Experiment, Run},
    plant::Plant,
    reference::{AtSample, BLOCK, Reference, follow, pose_at},
    sensors::Sensors,
};

/// Tracking error (rad or m) at which an actuator has left its trajectory.
const LOST: f64 = 1.0;

/// Poses along a run at which the gains are checked.
const GAIN_POSES: usize = 64;

/// Record of one run.
#[derive(Debug, Clone, PartialEq)]
pub struct Record {
    /// Name of the run.
    pub name: String,
    /// Whether the payload was on the platform.
    pub payload: bool,
    /// Sampling frequency, Hz.
    pub sampling_hz: f64,
    /// Names of the n actuators.
    pub actuators: Vec<String>,
    /// Time of each sample, s.
    pub time: Vec<f64>,
    /// Measured actuator positions, samples x n, row-major, rad or m.
    pub positions: Vec<f64>,
    /// Measured torques, samples x n, row-major, N m or N.
    pub torques: Vec<f64>,
    /// Largest |q_d - q_m| of each actuator as in the paper's Table 4, n, rad or m.
    pub tracking_error: Vec<f64>,
}

/// Simulates all runs of an experiment.
///
/// `progress` is called with the completed fraction, from 0 to 1, and the name of the run that
/// advanced.
///
/// # Errors
/// All problems of the experiment, or all runs that failed.
pub fn simulate(
    model: &dyn Model,
    experiment: &Experiment,
    progress: &dyn Fn(f64, &str),
) -> Result<Vec<Record>, Error> {
    let problems = experiment.problems(&model.info());
    if !problems.is_empty() {
        return Err(Error::Experiment(problems));
    }
    let runs = &experiment.runs;
    let total: usize = runs.iter().map(|run| experiment.samples(run)).sum();
    let workers = thread::available_parallelism()
        .map_or(1, NonZero::get)
        .min(runs.len());
    let done = Cell::new(0);
    let tell = |index: usize, samples: usize| {
        done.set(done.get() + samples);
        progress(done.get() as f64 / total as f64, &runs[index].name);
    };
    let results = match workers {
        // With a single core, threads may not exist, as in a browser.
        1 => (runs.iter().enumerate())
            .map(|(index, run)| simulate_run(model, experiment, run, &|n| tell(index, n)))
            .collect(),
        _ => in_threads(model, experiment, workers, &tell),
    };
    let (mut records, mut errors) = (Vec::new(), Vec::new());
    for result in results {
        match result {
            Ok(record) => records.push(record),
            Err(error) => errors.push(error),
        }
    }
    if errors.is_empty() {
        Ok(records)
    } else {
        Err(Error::Runs(errors))
    }
}

/// Simulates the runs in several threads; `tell` receives on this thread a run and its new samples.
fn in_threads(
    model: &dyn Model,
    experiment: &Experiment,
    workers: usize,
    tell: &dyn Fn(usize, usize),
) -> Vec<Result<Record, RunError>> {
    let runs = &experiment.runs;
    let mut results: Vec<Option<Result<Record, RunError>>> = runs.iter().map(|_| None).collect();
    let next = AtomicUsize::new(0);
    thread::scope(|scope| {
        let (sender, receiver) = mpsc::channel();
        for _ in 0..workers {
            let (sender, next) = (sender.clone(), &next);
            scope.spawn(move || {
                // Sending fails only if the receiver has gone with its thread.
                while let index = next.fetch_add(1, Ordering::Relaxed)
                    && let Some(run) = runs.get(index)
                {
                    let tell = |samples| {
                        let _ = sender.send((index, News::Samples(samples)));
                    };
                    let result = simulate_run(model, experiment, run, &tell);
                    let _ = sender.send((index, News::Finished(result)));
                }
            });
        }
        drop(sender);
        for (index, news) in receiver {
            match news {
                News::Samples(samples) => tell(index, samples),
                News::Finished(result) => results[index] = Some(result),
            }
        }
    });
    results.into_iter().flatten().collect()
}

/// Simulates one run with the caller's controller.
///
/// Of the experiment's controller, only the feed-forward is computed, for [`Desired::torques`]. The
/// caller's controller must apply the torque limit itself.
///
/// # Errors
/// All problems of the experiment with this run, or the cause that ended the run.
pub fn simulate_controlled(
    model: &dyn Model,
    experiment: &Experiment,
    run: &Run,
    control: &mut dyn Control,
) -> Result<Record, Error> {
    checked(model, experiment, run)?;
    controlled(model, experiment, run, control, &|_| {}).map_err(|error| Error::Runs(vec![error]))
}

/// Effective inertias of the actuators (kg m² or kg) for the controller gains of a run.
///
/// K_p = ω_c² m and K_d = 2ξω_c m. With these, no mode of the controlled robot is faster than the
/// bandwidth anywhere along the run.
///
/// # Errors
/// All problems of the experiment with this run, or a robot without such inertias at home.
pub fn actuator_inertias(
    model: &dyn Model,
    experiment: &Experiment,
    run: &Run,
) -> Result<Vec<f64>, Error> {
    checked(model, experiment, run)?;
    let nominal = experiment.controller_parameters(run, &model.info().sizes);
    inertias(model, experiment, run, &nominal).map_err(|cause| {
        Error::Runs(vec![RunError {
            run: run.name.clone(),
            time_s: 0.0,
            stage: Stage::Controller,
            cause,
        }])
    })
}

/// Validates an experiment with this run only.
fn checked(model: &dyn Model, experiment: &Experiment, run: &Run) -> Result<(), Error> {
    let alone = Experiment {
        runs: vec![run.clone()],
        ..experiment.clone()
    };
    let problems = alone.problems(&model.info());
    if problems.is_empty() {
        Ok(())
    } else {
        Err(Error::Experiment(problems))
    }
}

/// Message of a worker about a run.
enum News {
    /// Number of samples that were just completed.
    Samples(usize),
    /// Result of the run.
    Finished(Result<Record, RunError>),
}

/// Simulates one run with the experiment's controller; `tell` receives the number of new samples.
fn simulate_run(
    model: &dyn Model,
    experiment: &Experiment,
    run: &Run,
    tell: &dyn Fn(usize),
) -> Result<Record, RunError> {
    let nominal = experiment.controller_parameters(run, &model.info().sizes);
    // Report an unreachable trajectory before its effects on the controller.
    let mut reference = Reference::new(model, &run.trajectory, experiment.sampling_hz, None);
    let samples = experiment.samples(run);
    reference
        .fill(0, BLOCK.min(samples))
        .map_err(|(k, error)| at(experiment, run, k)((Stage::Trajectory, Cause::Model(error))))?;
    let inertia = inertias(model, experiment, run, &nominal)
        .map_err(|cause| at(experiment, run, 0)((Stage::Controller, cause)))?;
    let mut controller = Controller::new(model, experiment, &inertia);
    controlled(model, experiment, run, &mut controller, tell)
}

/// Error at sample k of a run.
fn at<'a>(
    experiment: &'a Experiment,
    run: &'a Run,
    k: usize,
) -> impl Fn((Stage, Cause)) -> RunError + 'a {
    move |(stage, cause)| RunError {
        run: run.name.clone(),
        time_s: k as f64 / experiment.sampling_hz,
        stage,
        cause,
    }
}

/// Simulates one run; `tell` receives the number of new samples.
fn controlled(
    model: &dyn Model,
    experiment: &Experiment,
    run: &Run,
    control: &mut dyn Control,
    tell: &dyn Fn(usize),
) -> Result<Record, RunError> {
    let sizes = model.info().sizes;
    let samples = experiment.samples(run);
    let truth = experiment.true_parameters(run, &sizes);
    let nominal = experiment.controller_parameters(run, &sizes);
    let located = |k: usize| at(experiment, run, k);
    let off_course = |(k, error): AtSample| located(k)((Stage::Trajectory, Cause::Model(error)));

    let feed_forward = experiment.feed_forward.then_some(nominal.as_slice());
    let mut reference =
        Reference::new(model, &run.trajectory, experiment.sampling_hz, feed_forward);
    reference.fill(0, BLOCK.min(samples)).map_err(off_course)?;
    let mut state = Loop::new(model, experiment, run, &truth, control, &reference);
    for first in (0..samples).step_by(BLOCK) {
        let count = BLOCK.min(samples - first);
        if first > 0 {
            reference.fill(first, count).map_err(off_course)?;
        }
        for row in 0..count {
            state
                .sample(first + row, &reference.row(row))
                .map_err(located(first + row))?;
        }
        tell(count);
    }
    Ok(state.record)
}

/// The closed loop of one run.
struct Loop<'a> {
    model: &'a dyn Model,
    control: &'a mut dyn Control,
    drives: Drivetrain<'a>,
    plant: Plant<'a>,
    sensors: Sensors<'a>,
    record: Record,
    /// Length of an integration step, s.
    step: f64,
    revolute: &'a [bool],
    /// Positions of the actuators at the previous sample, before quantisation.
    last: Vec<f64>,
    /// Currents of the previous period.
    held: Vec<f64>,
    commands: Vec<f64>,
}

impl<'a> Loop<'a> {
    /// Closed loop with the robot in the initial state of the reference.
    fn new(
        model: &'a dyn Model,
        experiment: &'a Experiment,
        run: &Run,
        truth: &'a [f64],
        control: &'a mut dyn Control,
        reference: &Reference<'_>,
    ) -> Self {
        let info = model.info();
        let sizes = info.sizes;
        let (pose, twist) = (&reference.pose[..sizes.pose], &reference.twist[..sizes.dof]);
        let steps = experiment.integration_steps;
        Self {
            model,
            control,
            drives: Drivetrain::new(experiment, info.actuator_is_revolute),
            plant: Plant::new(model, truth, pose, twist),
            sensors: Sensors::new(experiment, sizes.actuators, &run.name),
            record: Record::new(experiment, run, info.actuators),
            step: 1.0 / (experiment.sampling_hz * steps as f64),
            revolute: info.actuator_is_revolute,
            last: reference.positions[..sizes.actuators].to_vec(),
            held: vec![0.0; sizes.actuators],
            commands: vec![0.0; sizes.actuators],
        }
    }

    /// Measures, controls and records sample k, then moves the robot to the next sample.
    fn sample(&mut self, k: usize, desired: &Desired<'_>) -> Result<(), (Stage, Cause)> {
        let n = self.last.len();
        let measured = &mut self.record.positions[k * n..(k + 1) * n];
        self.model
            .evaluate(Function::ActuatorPositions, &[&self.plant.pose], measured)
            .map_err(|e| (Stage::Plant, Cause::Model(e.error)))?;
        follow(measured, &self.last, self.revolute);
        self.last.copy_from_slice(measured);
        self.drives.deflect(measured);
        self.sensors.delay(measured);
        self.sensors.encode(measured);
        self.control
            .step(desired, measured, &mut self.commands)
            .map_err(|error| (Stage::Controller, Cause::Model(error)))?;
        self.drives.take(&self.commands);
        self.record
            .track(k, desired)
            .map_err(|cause| (Stage::Plant, cause))?;
        self.record
            .torques(k, &self.held, &self.drives.currents, &mut self.sensors);
        self.advance().map_err(|cause| (Stage::Plant, cause))?;
        self.held.copy_from_slice(&self.drives.currents);
        Ok(())
    }

    /// Moves the robot through a sampling period.
    fn advance(&mut self) -> Result<(), Cause> {
        let (h, n) = (self.step, self.last.len());
        let mut torques = std::mem::take(&mut self.drives.torques);
        for torques in torques.chunks_exact_mut(n) {
            if self.drives.cogs() {
                // Cogging periods pass within a step; use the pose at its middle.
                let pose = self.plant.ahead(0.5 * h);
                let mut positions = self.last.clone();
                self.model
                    .evaluate(Function::ActuatorPositions, &[&pose], &mut positions)
                    .map_err(|e| Cause::Model(e.error))?;
                self.drives.cog(&positions, torques);
            }
            self.plant.advance(torques, h, 1)?;
        }
        self.drives.torques = torques;
        Ok(())
    }
}

/// Effective inertias of a run's actuators, checked at poses spread along the run.
fn inertias(
    model: &dyn Model,
    experiment: &Experiment,
    run: &Run,
    parameters: &[f64],
) -> Result<Vec<f64>, Cause> {
    let samples = experiment.samples(run);
    let poses: Vec<Vec<f64>> = (0..GAIN_POSES)
        .map(|i| (i * samples / GAIN_POSES) as f64 / experiment.sampling_hz)
        .map(|t| pose_at(model, &run.trajectory, t))
        .collect();
    effective_inertia(model, parameters, poses.iter().map(Vec::as_slice))
}

impl Record {
    fn new(experiment: &Experiment, run: &Run, actuators: &[&str]) -> Self {
        let (n, samples) = (actuators.len(), experiment.samples(run));
        Self {
            name: run.name.clone(),
            payload: run.payload,
            sampling_hz: experiment.sampling_hz,
            actuators: actuators.iter().map(ToString::to_string).collect(),
            time: (0..samples)
                .map(|k| k as f64 / experiment.sampling_hz)
                .collect(),
            positions: vec![0.0; samples * n],
            torques: vec![0.0; samples * n],
            tracking_error: vec![0.0; n],
        }
    }

    /// Updates the largest tracking errors; fails if an actuator has left its trajectory.
    fn track(&mut self, k: usize, desired: &Desired<'_>) -> Result<(), Cause> {
        let n = self.actuators.len();
        for (i, largest) in self.tracking_error.iter_mut().enumerate() {
            let error = (desired.positions[i] - self.positions[k * n + i]).abs();
            if error.is_nan() || error > LOST {
                return Err(Cause::Lost {
                    actuator: self.actuators[i].clone(),
                    error,
                });
            }
            *largest = largest.max(error);
        }
        Ok(())
    }

    /// Records the measured torques of sample k as the mean of the torques before and after it.
    fn torques(&mut self, k: usize, before: &[f64], after: &[f64], sensors: &mut Sensors<'_>) {
        let n = self.actuators.len();
        let row = &mut self.torques[k * n..(k + 1) * n];
        for (i, torque) in row.iter_mut().enumerate() {
            *torque = if k == 0 {
                after[i]
            } else {
                0.5 * (before[i] + after[i])
            };
        }
        sensors.disturb(row);
    }
}
