//! The closed loop over all runs of an experiment.
//!
//! At each sample t_k the encoder is read, the controller computes torques from it at once, and the
//! robot moves under what the drives make of them until t_{k+1}. The torque that is recorded for t_k is
//! the mean of the currents (in units of torque) before and after t_k, so that positions and torques belong to one instant; with either of the two
//! alone the record would be half a sample early or late.
//!
//! Runs are independent and go to as many threads as the machine has; progress is told on the caller's
//! thread.

use std::{
    num::NonZero,
    sync::{
        atomic::{AtomicUsize, Ordering},
        mpsc,
    },
    thread,
};

use overact::{Function, Model};

use crate::{
    controller::{Controller, Desired, effective_inertia},
    error::{Cause, Error, RunError, Stage},
    experiment::{Experiment, Run},
    plant::Plant,
    reference::{AtSample, BLOCK, Reference, follow, pose_at},
    sensors::Sensors,
    train::Train,
};

/// An actuator that is off by more than this (rad or m) has left its trajectory.
const LOST: f64 = 1.0;

/// Poses along a run at which the gains are checked.
const GAIN_POSES: usize = 64;

/// What one run records.
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

/// Makes all runs of an experiment. `progress` hears the fraction of the work that is done, from 0 to
/// 1, and the name of the run that has just advanced.
///
/// # Errors
/// All problems of the experiment, or all runs that could not be finished.
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
    let mut results: Vec<Option<Result<Record, RunError>>> = runs.iter().map(|_| None).collect();
    let next = AtomicUsize::new(0);
    let workers = thread::available_parallelism()
        .map_or(1, NonZero::get)
        .min(runs.len());
    thread::scope(|scope| {
        let (sender, receiver) = mpsc::channel();
        for _ in 0..workers {
            let (sender, next) = (sender.clone(), &next);
            scope.spawn(move || {
                // Sending fails only when the receiver has gone with its thread.
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
        let mut done = 0;
        for (index, news) in receiver {
            match news {
                News::Samples(samples) => {
                    done += samples;
                    progress(done as f64 / total as f64, &runs[index].name);
                }
                News::Finished(result) => results[index] = Some(result),
            }
        }
    });
    let (mut records, mut errors) = (Vec::new(), Vec::new());
    for result in results.into_iter().flatten() {
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

/// What a worker tells of a run.
enum News {
    /// So many samples more are done.
    Samples(usize),
    /// The run is over.
    Finished(Result<Record, RunError>),
}

/// Makes one run; `tell` hears the number of samples that have just been done.
fn simulate_run(
    model: &dyn Model,
    experiment: &Experiment,
    run: &Run,
    tell: &dyn Fn(usize),
) -> Result<Record, RunError> {
    let sizes = model.info().sizes;
    let samples = experiment.samples(run);
    let truth = experiment.true_parameters(run, &sizes);
    let nominal = experiment.controller_parameters(run, &sizes);
    let located = |k: usize| {
        move |(stage, cause)| RunError {
            run: run.name.clone(),
            time_s: k as f64 / experiment.sampling_hz,
            stage,
            cause,
        }
    };
    let off_course = |(k, error): AtSample| located(k)((Stage::Trajectory, Cause::Model(error)));

    let feed_forward = experiment.feed_forward.then_some(nominal.as_slice());
    let mut reference =
        Reference::new(model, &run.trajectory, experiment.sampling_hz, feed_forward);
    reference.fill(0, BLOCK.min(samples)).map_err(off_course)?;
    let controller = run_controller(model, experiment, run, &nominal)
        .map_err(|cause| located(0)((Stage::Controller, cause)))?;
    let mut state = Loop::new(model, experiment, run, &truth, controller, &reference);
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
    controller: Controller<'a>,
    drives: Train<'a>,
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
    /// The loop with the robot in the state in which the reference starts.
    fn new(
        model: &'a dyn Model,
        experiment: &'a Experiment,
        run: &Run,
        truth: &'a [f64],
        controller: Controller<'a>,
        reference: &Reference<'_>,
    ) -> Self {
        let info = model.info();
        let sizes = info.sizes;
        let (pose, twist) = (&reference.pose[..sizes.pose], &reference.twist[..sizes.dof]);
        let steps = experiment.integration_steps;
        Self {
            model,
            controller,
            drives: Train::new(experiment, info.actuator_is_revolute),
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

    /// Reads, controls and records sample k, then moves the robot to the next.
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
        self.controller
            .step(self.model, desired, measured, &mut self.commands)
            .map_err(|cause| (Stage::Controller, cause))?;
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
                // Teeth go by within a step: those in its middle count.
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

/// The controller of a run, its gains checked at poses spread along the run.
fn run_controller<'a>(
    model: &dyn Model,
    experiment: &'a Experiment,
    run: &Run,
    parameters: &[f64],
) -> Result<Controller<'a>, Cause> {
    let samples = experiment.samples(run);
    let poses: Vec<Vec<f64>> = (0..GAIN_POSES)
        .map(|i| (i * samples / GAIN_POSES) as f64 / experiment.sampling_hz)
        .map(|t| pose_at(model, &run.trajectory, t))
        .collect();
    let poses = poses.iter().map(Vec::as_slice);
    let inertia = effective_inertia(model, parameters, poses)?;
    Ok(Controller::new(
        experiment,
        &inertia,
        model.info().sizes.dof,
    ))
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

    /// Keeps the largest tracking errors; fails when an actuator is far off.
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

    /// Writes the measured torques of sample k between the torques held before and after it.
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
