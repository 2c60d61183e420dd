//! Drives of one run, simulated in step with the controller.
//!
//! The linear part is integrated exactly. Commands are held over a sampling period, so the matrix
//! exponential of a step gives the states and the integrals of i and τ. The robot receives the mean
//! torque of each step.

use std::{collections::VecDeque, f64::consts::TAU};

use nalgebra::{Matrix6, Vector6};

use crate::{drives::Drives, experiment::Experiment};

/// Indices in the state of a drive: current i, torque τ and its rate, command, integrals of i and
/// τ.
const CURRENT: usize = 0;
const TORQUE: usize = 1;
const RATE: usize = 2;
const COMMAND: usize = 3;
const CURRENT_SUM: usize = 4;
const TORQUE_SUM: usize = 5;

/// One drive with its transition over an integration step.
#[derive(Debug, Clone)]
struct Drive {
    /// State indices of current and torque; for ideal ones, that of the command.
    places: (usize, usize),
    /// Transition of the state over a step.
    transition: Matrix6<f64>,
    state: Vector6<f64>,
    is_ideal: bool,
}

/// Mode of a flexible drive.
struct Mode {
    /// Natural frequency, Hz.
    frequency: f64,
    /// Damping factor.
    damping: f64,
}

impl Drive {
    /// Drive with a current loop and a mode; a frequency (Hz) of zero omits either.
    fn new(loop_hz: f64, mode: &Mode, step: f64) -> Self {
        let current = if loop_hz > 0.0 { CURRENT } else { COMMAND };
        let torque = if mode.frequency > 0.0 {
            TORQUE
        } else {
            current
        };
        let mut rates = Matrix6::zeros();
        if loop_hz > 0.0 {
            rates[(CURRENT, COMMAND)] = TAU * loop_hz;
            rates[(CURRENT, CURRENT)] = -TAU * loop_hz;
        }
        if mode.frequency > 0.0 {
            let natural = TAU * mode.frequency;
            rates[(TORQUE, RATE)] = 1.0;
            rates[(RATE, current)] += natural * natural;
            rates[(RATE, TORQUE)] -= natural * natural;
            rates[(RATE, RATE)] -= 2.0 * mode.damping * natural;
        }
        rates[(CURRENT_SUM, current)] = 1.0;
        rates[(TORQUE_SUM, torque)] = 1.0;
        Self {
            places: (current, torque),
            transition: (rates * step).exp(),
            state: Vector6::zeros(),
            is_ideal: torque == COMMAND,
        }
    }

    /// Sets the state to rest under a command.
    fn settle(&mut self, command: f64) {
        self.state = Vector6::new(command, command, 0.0, command, 0.0, 0.0);
    }

    /// Mean current and torque over the next step under a command.
    fn advance(&mut self, command: f64, step: f64) -> (f64, f64) {
        self.state[COMMAND] = command;
        if self.is_ideal {
            return (command, command);
        }
        self.state[CURRENT_SUM] = 0.0;
        self.state[TORQUE_SUM] = 0.0;
        self.state = self.transition * self.state;
        (
            self.state[CURRENT_SUM] / step,
            self.state[TORQUE_SUM] / step,
        )
    }

    /// Torque of the drive, before its gain.
    fn torque(&self) -> f64 {
        self.state[self.places.1]
    }
}

/// The drives of one run.
pub(crate) struct Drivetrain<'a> {
    drives: &'a Drives,
    each: Vec<Drive>,
    /// Delayed commands, the oldest first.
    waiting: VecDeque<Vec<f64>>,
    delay: usize,
    started: bool,
    /// Length of a step, s, and number of steps per sampling period.
    step: (f64, usize),
    /// Cogging periods per radian or metre, times 2π.
    waves: Vec<f64>,
    /// Mean currents over the next sampling period, n.
    pub(crate) currents: Vec<f64>,
    /// Mean torques over each step of the period, steps x n.
    pub(crate) torques: Vec<f64>,
}

impl<'a> Drivetrain<'a> {
    /// Drives of the actuators; `revolute` marks revolute ones.
    pub(crate) fn new(experiment: &'a Experiment, revolute: &[bool]) -> Self {
        let drives = &experiment.drives;
        let steps = experiment.integration_steps;
        let step = 1.0 / (experiment.sampling_hz * steps as f64);
        let n = revolute.len();
        let drive = |i: usize| {
            let mode = Mode {
                frequency: value(&drives.flexible_hz, i, 0.0),
                damping: drives.flexible_damping,
            };
            Drive::new(value(&drives.current_bandwidth_hz, i, 0.0), &mode, step)
        };
        let wave = |(i, revolute): (usize, &bool)| {
            let periods = value(&drives.cogging_periods, i, 1.0);
            if *revolute { periods } else { TAU * periods }
        };
        Self {
            drives,
            each: (0..n).map(drive).collect(),
            waiting: VecDeque::new(),
            // The experiment is validated: the product is small and not negative.
            delay: (drives.delay_s * experiment.sampling_hz).round() as usize,
            started: false,
            step: (step, steps),
            waves: revolute.iter().enumerate().map(wave).collect(),
            currents: vec![0.0; n],
            torques: vec![0.0; n * steps],
        }
    }

    /// Takes the commands of a sample and computes currents and torques of the next period.
    ///
    /// The drives start at rest under the first commands.
    pub(crate) fn take(&mut self, commands: &[f64]) {
        if !self.started {
            self.started = true;
            self.waiting = vec![commands.to_vec(); self.delay].into();
            let drives = self.each.iter_mut().zip(commands);
            drives.for_each(|(drive, command)| drive.settle(*command));
        }
        self.waiting.push_back(commands.to_vec());
        let Some(commands) = self.waiting.pop_front() else {
            return;
        };
        let (step, steps) = self.step;
        self.currents.fill(0.0);
        for torques in self.torques.chunks_exact_mut(commands.len()) {
            for (i, drive) in self.each.iter_mut().enumerate() {
                let (current, torque) = drive.advance(commands[i], step);
                self.currents[i] += current / steps as f64;
                torques[i] = value(&self.drives.gain, i, 1.0) * torque;
            }
        }
    }

    /// Converts joint positions to those of encoders on the motor side.
    pub(crate) fn deflect(&self, positions: &mut [f64]) {
        for (i, position) in positions.iter_mut().enumerate() {
            let stiffness = value(&self.drives.flexible_stiffness, i, 0.0);
            if stiffness > 0.0 {
                *position += value(&self.drives.gain, i, 1.0) * self.each[i].torque() / stiffness;
            }
        }
    }

    /// Whether there is any cogging.
    pub(crate) fn cogs(&self) -> bool {
        self.drives.cogging.iter().any(|amplitude| *amplitude > 0.0)
    }

    /// Adds the cogging torques at the given positions of the joints.
    pub(crate) fn cog(&self, positions: &[f64], torques: &mut [f64]) {
        for ((torque, amplitude), (position, wave)) in torques
            .iter_mut()
            .zip(&self.drives.cogging)
            .zip(positions.iter().zip(&self.waves))
        {
            *torque += amplitude * (wave * position).sin();
        }
    }
}

/// Value of an actuator; that of an ideal drive if the list is empty.
fn value(values: &[f64], actuator: usize, ideal: f64) -> f64 {
    values.get(actuator).copied().unwrap_or(ideal)
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Torques of one actuator after each sample of a step from 0 to 1 at 10 kHz, and the drives.
    fn step_response(drives: Drives, samples: usize) -> (Vec<f64>, Vec<f64>) {
        let experiment = Experiment {
            sampling_hz: 1e4,
            drives,
            ..Experiment::default()
        };
        let mut train = Drivetrain::new(&experiment, &[true]);
        train.take(&[0.0]);
        let (mut currents, mut torques) = (Vec::new(), Vec::new());
        for _ in 0..samples {
            train.take(&[1.0]);
            currents.push(train.currents[0]);
            torques.push(train.torques[0]);
        }
        (currents, torques)
    }

    #[test]
    fn an_ideal_drive_transmits_the_command() {
        let (currents, torques) = step_response(Drives::default(), 3);
        assert_eq!((currents, torques), (vec![1.0; 3], vec![1.0; 3]));
    }

    #[test]
    fn torques_are_delayed_by_whole_samples() {
        let drives = Drives {
            delay_s: 3e-4,
            ..Drives::default()
        };
        assert_eq!(step_response(drives, 5).1, [0.0, 0.0, 0.0, 1.0, 1.0]);
    }

    #[test]
    fn the_current_loop_is_of_first_order() {
        let drives = Drives {
            current_bandwidth_hz: vec![500.0],
            gain: vec![1.2],
            ..Drives::default()
        };
        let (currents, torques) = step_response(drives, 20);
        let rate = TAU * 500.0;
        for (k, (current, torque)) in currents.iter().zip(torques).enumerate() {
            // Mean of 1 - exp(-ω t) over the period.
            let at = |t: f64| t + (-rate * t).exp() / rate;
            let (from, to) = (k as f64 * 1e-4, (k + 1) as f64 * 1e-4);
            let expected = (at(to) - at(from)) / 1e-4;
            assert!((current - expected).abs() < 1e-12, "{current} {expected}");
            assert!((torque - 1.2 * current).abs() < 1e-15);
        }
    }

    #[test]
    fn the_flexible_mode_has_its_frequency_and_damping() {
        let drives = Drives {
            flexible_hz: vec![50.0],
            flexible_damping: 0.1,
            ..Drives::default()
        };
        let (currents, torques) = step_response(drives, 400);
        assert!(currents.iter().all(|current| (current - 1.0).abs() < 1e-12));
        let largest = torques.iter().copied().fold(0.0, f64::max);
        let at = torques
            .iter()
            .position(|torque| *torque == largest)
            .unwrap();
        let damped = (1.0_f64 - 0.01).sqrt();
        let overshoot = (-0.1 * std::f64::consts::PI / damped).exp();
        assert!((largest - 1.0 - overshoot).abs() < 1e-3, "{largest}");
        assert!((at as f64 - 100.0 / damped).abs() <= 1.0, "{at}");
    }

    #[test]
    fn motor_encoders_measure_the_deflection() {
        let experiment = Experiment {
            drives: Drives {
                gain: vec![2.0, 1.0],
                flexible_stiffness: vec![1000.0, 0.0],
                ..Drives::default()
            },
            ..Experiment::default()
        };
        let mut train = Drivetrain::new(&experiment, &[true, true]);
        train.take(&[5.0, 5.0]);
        let mut positions = [0.5, 0.5];
        train.deflect(&mut positions);
        assert_eq!(positions, [0.51, 0.5]);
    }

    #[test]
    fn cogging_repeats_with_every_tooth() {
        let experiment = Experiment {
            drives: Drives {
                cogging: vec![0.3, 0.2],
                cogging_periods: vec![48.0, 25.0],
                ..Drives::default()
            },
            ..Experiment::default()
        };
        let train = Drivetrain::new(&experiment, &[true, false]);
        assert!(train.cogs());
        let at = |tooth: f64| {
            let mut torques = [0.0, 0.0];
            train.cog(&[tooth * TAU / 48.0, tooth / 25.0], &mut torques);
            torques
        };
        for tooth in [0.25, 1.25, 7.25] {
            let [a, b] = at(tooth);
            assert!((a - 0.3).abs() < 1e-12 && (b - 0.2).abs() < 1e-12);
        }
        assert!(at(3.5)[0].abs() < 1e-12);
    }
}
