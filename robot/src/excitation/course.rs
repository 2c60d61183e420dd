//! Evaluates a period of a run and the peaks of all limited quantities.

use super::fourier_run::FourierRun;
use super::kind::LimitKind;
use nalgebra::DMatrix;
use overact::{Columns, Error, Function, Info, Model, math::wrap_angle};
use overact_simulation::{Sampled, Trajectory, sample, trajectory::Displacement};
use std::f64::consts::{PI, TAU};

/// Bound on a smooth series between two samples, relative to its largest second difference.
const BETWEEN_SAMPLES: f64 = 0.125;

/// Safety factor on second differences of series that are not Fourier series.
const UNKNOWN_BETWEEN: f64 = 2.0;

/// Robot on which runs are evaluated.
pub(super) struct Bench<'a> {
    pub(super) model: &'a dyn Model,
    pub(super) info: Info<'a>,
    pub(super) has_platform: bool,
    /// Whether it has a platform or chains, whose actuators may be singular.
    pub(super) has_loop: bool,
    /// Whether each coordinate is a length.
    pub(super) lengths: Vec<bool>,
    /// Actuators whose rows of J_p^inv must be regular: all, or the kept ones of an overactuated
    /// robot.
    pub(super) kept: Vec<usize>,
    /// Inverse norms of the columns of J_p^inv at home.
    pub(super) scales: Vec<f64>,
    /// Parameters for torque prediction, the payload's last; `None` if unknown.
    pub(super) parameters: Option<Vec<f64>>,
}

/// One period of a run, with one row of numbers per sample.
pub(super) struct Course {
    pub(super) samples: usize,
    pub(super) states: Sampled,
    /// J_p^inv, n x r each.
    pub(super) jacobian: Vec<f64>,
    /// Displacements of the coordinates from home, m or rad.
    displacement: Vec<f64>,
    /// Bound on the rise of each coordinate between two samples, m or rad.
    rise: Vec<f64>,
    travel: Vec<f64>,
    velocity: Vec<f64>,
    acceleration: Vec<f64>,
    torque: Vec<f64>,
    condition: Vec<f64>,
    actuators: usize,
}

impl<'a> Bench<'a> {
    pub(super) fn is_length(&self, coordinate: usize) -> bool {
        self.lengths.get(coordinate).copied().unwrap_or(false)
    }

    /// Units of a limited quantity for each coordinate or actuator.
    pub(super) fn units(&self, kind: LimitKind) -> Vec<&'static str> {
        let unit = |is_length: &bool| kind.unit(*is_length);
        match kind {
            LimitKind::Position => self.lengths.iter().map(unit).collect(),
            LimitKind::Condition => vec![kind.unit(false)],
            _ => {
                let revolute = self.info.actuator_is_revolute.iter();
                revolute.map(|revolute| kind.unit(!revolute)).collect()
            }
        }
    }

    /// Evaluates a period of a run at `samples` samples.
    ///
    /// # Errors
    /// The model's error if the robot cannot reach the motion.
    pub(super) fn course(
        &self,
        frame: &FourierRun,
        trajectory: &Trajectory,
        samples: usize,
    ) -> Result<Course, Error> {
        let sizes = self.info.sizes;
        let sampling = frame.fundamental * samples as f64;
        let states = sample(self.model, trajectory, sampling, samples)?;
        let ask = |function: Function, inputs: &[&[f64]]| -> Result<Vec<f64>, Error> {
            let (rows, columns) = function.shape(&sizes);
            let mut values = vec![0.0; samples * rows * columns];
            let done = self.model.evaluate(function, inputs, &mut values);
            done.map(|()| values).map_err(|error| error.error)
        };
        let motion: [&[f64]; 3] = [&states.pose, &states.twist, &states.acceleration];
        let jacobian = ask(Function::InverseJacobian, &motion[..1])?;
        let joints = ask(Function::JointAccelerations, &motion)?;
        let torque = match &self.parameters {
            None => Vec::new(),
            Some(parameters) => {
                let mut own = parameters.clone();
                if !frame.payload {
                    own[sizes.parameters..].fill(0.0);
                }
                ask(
                    Function::InverseDynamics(Columns::Standard),
                    &[motion[0], motion[1], motion[2], &own],
                )?
            }
        };
        let (n, r) = (sizes.actuators, sizes.dof);
        let rates = jacobian
            .chunks_exact(n * r)
            .zip(states.twist.chunks_exact(r));
        let rate =
            |row: &[f64], twist: &[f64]| row.iter().zip(twist).map(|(j, v)| j * v).sum::<f64>();
        let velocity = rates.flat_map(|(j, v)| j.chunks_exact(r).map(move |row| rate(row, v)));
        let accelerations = joints.chunks_exact(sizes.joints);
        let acceleration = accelerations
            .flat_map(|row| (0..n).map(|actuator| self.model.of_actuator(actuator, row)));
        let (displacement, rise) = self.displacement(frame, trajectory, samples);
        Ok(Course {
            samples,
            displacement,
            rise,
            travel: self.travel(&states.positions),
            velocity: velocity.collect(),
            acceleration: acceleration.collect(),
            torque,
            condition: self.conditions(&jacobian),
            jacobian,
            states,
            actuators: n,
        })
    }

    /// Displacements of the coordinates, and bounds on their rise between two samples.
    fn displacement(
        &self,
        frame: &FourierRun,
        trajectory: &Trajectory,
        samples: usize,
    ) -> (Vec<f64>, Vec<f64>) {
        let dof = self.info.sizes.dof;
        let mut displacement = vec![0.0; samples * dof];
        let (mut velocity, mut acceleration) = (vec![0.0; dof], vec![0.0; dof]);
        for (k, position) in displacement.chunks_exact_mut(dof).enumerate() {
            let time = k as f64 / (frame.fundamental * samples as f64);
            let mut out = Displacement {
                position,
                velocity: &mut velocity,
                acceleration: &mut acceleration,
            };
            trajectory.evaluate(self.info.coordinates, time, &mut out);
        }
        let mut rise = vec![0.0; dof];
        if let Trajectory::Periodic { terms, .. } = trajectory {
            for term in terms {
                let step = TAU * f64::from(term.harmonic) / samples as f64;
                let at = self
                    .info
                    .coordinates
                    .iter()
                    .position(|name| *name == term.coordinate);
                if let Some(rise) = at.and_then(|at| rise.get_mut(at)) {
                    *rise += BETWEEN_SAMPLES * term.amplitude.abs() * step * step;
                }
            }
        }
        (displacement, rise)
    }

    /// Displacements of the actuators from home; angles start within half a turn of home.
    fn travel(&self, positions: &[f64]) -> Vec<f64> {
        let n = self.info.sizes.actuators;
        let from = |index: usize| {
            let home = self.model.of_actuator(index, self.info.home_joints);
            let start = positions.get(index).copied().unwrap_or(home) - home;
            let turns =
                self.has_platform && self.info.actuator_is_revolute[index] && start.abs() > PI;
            if turns {
                home + start - wrap_angle(start)
            } else {
                home
            }
        };
        let from: Vec<f64> = (0..n).map(from).collect();
        let rows = positions.chunks_exact(n);
        rows.flat_map(|row| row.iter().zip(&from).map(|(at, from)| at - from))
            .collect()
    }

    /// Condition number at each sample.
    ///
    /// It is infinite where the determinant has another sign than at the first sample: the motion
    /// then crosses a singularity.
    fn conditions(&self, jacobians: &[f64]) -> Vec<f64> {
        let (n, r) = (self.info.sizes.actuators, self.info.sizes.dof);
        if !self.has_loop {
            return Vec::new();
        }
        let mut side = 0.0;
        let condition = |jacobian: &[f64]| {
            let kept = DMatrix::from_fn(r, r, |row, column| {
                jacobian[self.kept[row] * r + column] * self.scales[column]
            });
            let determinant = kept.determinant();
            let crossed = side * determinant < 0.0;
            if side == 0.0 {
                side = determinant;
            }
            let values = kept.singular_values();
            let condition = values.max() / values.min();
            if crossed || condition.is_nan() {
                f64::INFINITY
            } else {
                condition
            }
        };
        jacobians.chunks_exact(n * r).map(condition).collect()
    }

    /// Condition number at a displacement from home; `None` if it is not reached.
    pub(super) fn condition_at(&self, displacement: &[f64]) -> Option<f64> {
        let sizes = self.info.sizes;
        let mut pose = self.info.home_pose.to_vec();
        self.model.displace(&mut pose, displacement);
        let mut jacobian = vec![0.0; sizes.actuators * sizes.dof];
        self.model
            .evaluate(Function::InverseJacobian, &[&pose], &mut jacobian)
            .ok()?;
        self.conditions(&jacobian).first().copied()
    }
}

impl Course {
    /// Largest magnitudes of a limited quantity, optionally with a bound between samples.
    pub(super) fn peaks(&self, kind: LimitKind, between: bool) -> Vec<f64> {
        let (series, width) = match kind {
            LimitKind::Position => (&self.displacement, self.rise.len()),
            LimitKind::Travel => (&self.travel, self.actuators),
            LimitKind::Velocity => (&self.velocity, self.actuators),
            LimitKind::Acceleration => (&self.acceleration, self.actuators),
            LimitKind::Torque => (&self.torque, self.actuators),
            LimitKind::Condition => (&self.condition, 1),
        };
        let rows = series.len() / width;
        let peak = |at: usize| {
            let value = |row: usize| series[row % rows * width + at];
            let largest = (0..rows).map(|row| value(row).abs()).fold(0.0, f64::max);
            if !between {
                return largest;
            }
            if kind == LimitKind::Position {
                return largest + self.rise[at];
            }
            let bend = |row: usize| (value(row + 2) - 2.0 * value(row + 1) + value(row)).abs();
            // Friction sign changes cause a jump between two samples, which is excluded from the
            // smooth bound.
            let smooth = |row: usize| bend(row).min(bend(row + 1)).min(bend(row + 2));
            let largest_bend = (0..rows).map(smooth).fold(0.0, f64::max);
            largest + UNKNOWN_BETWEEN * BETWEEN_SAMPLES * largest_bend
        };
        (0..width).map(peak).collect()
    }
}
