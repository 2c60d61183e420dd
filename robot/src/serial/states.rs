//! States of the workspace, and inertia matrix, gravity and velocity torques of the robot there.

use super::Refusal;
use crate::robot::Robot;
use nalgebra::{DMatrix, DVector};
use overact::{Columns, Error, Function, Info, Model};
use overact_codegen::description::Run;
use rand_distr::{Distribution, StandardUniform};
use rand_pcg::Pcg64;
use serde::Serialize;
use std::f64::consts::TAU;

/// Half range of a coordinate without runs and limits, rad and m.
const ASSUMED: [f64; 2] = [std::f64::consts::FRAC_PI_4, 0.1];
/// States that decide whether an assumed range is within reach, and how often it is halved.
const TRIED: usize = 100;
const HALVINGS: usize = 6;
/// Number of draws for each state.
const DRAWS: usize = 20;
/// Samples of a run for its largest displacements.
const SAMPLES: usize = 1024;

/// Origin of the ranges of the coordinates.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize)]
#[serde(rename_all = "lowercase")]
pub enum RangeOrigin {
    /// `position` of `[excitation]`.
    Limits,
    /// Largest displacements of the runs of `[experiment]`; the states are those of the runs.
    Runs,
    /// Assumed, and halved until most states are within reach.
    Assumed,
}

/// A state with the robot's dynamics without friction and springs.
#[derive(Debug, Clone)]
pub(super) struct State {
    pub(super) pose: Vec<f64>,
    pub(super) twist: Vec<f64>,
    /// Inertia matrix, r × r.
    pub(super) inertia: DMatrix<f64>,
    /// Torque of gravity.
    pub(super) gravity: DVector<f64>,
    /// Centrifugal and Coriolis torques.
    pub(super) velocity: DVector<f64>,
    /// Whether a singularity of the motors separates it from home.
    pub(super) is_beyond: bool,
}

/// A number between 0 and 1.
fn uniform(random: &mut Pcg64) -> f64 {
    StandardUniform.sample(random)
}

/// States drawn around home, and the number of draws outside the workspace.
#[derive(Debug)]
pub(super) struct States {
    pub(super) all: Vec<State>,
    pub(super) rejected: usize,
}

/// The robot's dynamics for fixed parameters.
pub(super) struct Plant<'a> {
    robot: &'a Robot,
    info: Info<'a>,
    /// Values of inertias and rotors, and zeros.
    parameters: Vec<f64>,
    nothing: Vec<f64>,
    /// J⁺ at home of a robot with loops.
    inverse_at_home: Option<DMatrix<f64>>,
    pub(super) ranges: Vec<f64>,
    pub(super) origin: RangeOrigin,
}

impl<'a> Plant<'a> {
    /// The robot with values of its standard parameters; `value` returns those of a name.
    pub(super) fn new(robot: &'a Robot, value: &dyn Fn(&str) -> f64) -> Result<Self, Error> {
        let info = robot.model().info();
        let own = info.parameters.iter().map(|one| {
            let is_inertial = one.symbol.is_inertial() || one.symbol.name() == "ia";
            if is_inertial { value(one.name) } else { 0.0 }
        });
        let payload = info.payload_parameters.iter().map(|_| 0.0);
        let parameters: Vec<f64> = own.chain(payload).collect();
        let mut plant = Self {
            robot,
            info,
            nothing: vec![0.0; parameters.len()],
            parameters,
            inverse_at_home: None,
            ranges: Vec::new(),
            origin: RangeOrigin::Assumed,
        };
        if !robot.model().model().is_tree() {
            let jacobian = plant.jacobian(info.home_pose)?;
            plant.inverse_at_home = jacobian.pseudo_inverse(1e-12).ok();
        }
        plant.set_ranges();
        Ok(plant)
    }

    /// Diagonal of the rotors' inertia matrix at home.
    pub(super) fn rotors_at_home(&self) -> Result<Vec<f64>, Error> {
        let names = self
            .info
            .parameters
            .iter()
            .chain(self.info.payload_parameters);
        let pairs = names.zip(&self.parameters);
        let rotors: Vec<f64> = pairs
            .map(|(one, value)| {
                if one.symbol.name() == "ia" {
                    *value
                } else {
                    0.0
                }
            })
            .collect();
        let r = self.info.sizes.dof;
        let inputs = [self.info.home_pose, &rotors];
        let matrix = self.call(Function::MassMatrix(Columns::Standard), &inputs)?;
        Ok((0..r).map(|at| matrix[at * r + at]).collect())
    }

    fn call(&self, function: Function, inputs: &[&[f64]]) -> Result<Vec<f64>, Error> {
        let (rows, columns) = function.shape(&self.info.sizes);
        let mut output = vec![0.0; rows * columns];
        let model = self.robot.model();
        let done = model.evaluate(function, inputs, &mut output);
        done.map(|()| output).map_err(|failed| failed.error)
    }

    fn jacobian(&self, pose: &[f64]) -> Result<DMatrix<f64>, Error> {
        let sizes = self.info.sizes;
        let flat = self.call(Function::InverseJacobian, &[pose])?;
        Ok(DMatrix::from_row_slice(sizes.actuators, sizes.dof, &flat))
    }

    /// Torques at a constant velocity of inertias alone, without known torques.
    fn bias(&self, pose: &[f64], twist: &[f64]) -> Result<DVector<f64>, Error> {
        let function = Function::Bias(Columns::Standard);
        let whole = self.call(function, &[pose, twist, &self.parameters])?;
        let known = self.call(function, &[pose, twist, &self.nothing])?;
        Ok(DVector::from_vec(whole) - DVector::from_vec(known))
    }

    /// Dynamics at a state.
    pub(super) fn state(&self, pose: Vec<f64>, twist: Vec<f64>) -> Result<State, Error> {
        let r = self.info.sizes.dof;
        let function = Function::MassMatrix(Columns::Standard);
        let inertia = self.call(function, &[&pose, &self.parameters])?;
        let gravity = self.bias(&pose, &vec![0.0; r])?;
        let velocity = self.bias(&pose, &twist)? - &gravity;
        let is_beyond = match &self.inverse_at_home {
            Some(inverse) => (inverse * self.jacobian(&pose)?).determinant() <= 0.0,
            None => false,
        };
        Ok(State {
            inertia: DMatrix::from_row_slice(r, r, &inertia),
            pose,
            twist,
            gravity,
            velocity,
            is_beyond,
        })
    }

    /// Half ranges of the coordinates from limits or runs; otherwise assumed.
    fn set_ranges(&mut self) {
        let description = self.robot.description();
        let limits = description.excitation.as_ref();
        if let Some(position) = limits.and_then(|limits| limits.position.clone()) {
            (self.ranges, self.origin) = (position, RangeOrigin::Limits);
            return;
        }
        let runs = description.experiment.iter().flat_map(|table| &table.runs);
        let mut peaks = vec![0.0_f64; self.info.sizes.dof];
        for run in runs {
            for sample in 0..SAMPLES {
                let [displacement, _] = self.motion(run, sample as f64 / SAMPLES as f64);
                let pairs = peaks.iter_mut().zip(displacement);
                pairs.for_each(|(peak, own)| *peak = peak.max(own.abs()));
            }
        }
        if peaks.iter().any(|peak| *peak > 0.0) {
            (self.ranges, self.origin) = (peaks, RangeOrigin::Runs);
            return;
        }
        let mechanism = &self.robot.model().model().mechanism;
        let joints = mechanism.joints();
        let own = mechanism.coordinate_joints().into_iter();
        let is_length = |at: usize| {
            use overact_codegen::mechanism::JointKind;
            mechanism.joint(joints[at]).kind == JointKind::Prismatic
        };
        self.ranges = own.map(|at| ASSUMED[usize::from(is_length(at))]).collect();
        for _ in 0..HALVINGS {
            let states = self.drawn(TRIED, 0);
            if states.is_ok_and(|states| states.rejected < TRIED) {
                break;
            }
            self.ranges.iter_mut().for_each(|range| *range *= 0.5);
        }
    }

    /// Displacement from home and velocity of a run at a fraction of its period.
    fn motion(&self, run: &Run, fraction: f64) -> [Vec<f64>; 2] {
        let mut motion = [(); 2].map(|()| vec![0.0; self.info.sizes.dof]);
        for term in &run.terms {
            let multiple = f64::from(term.harmonic);
            let (sine, cosine) = (TAU * multiple * fraction + term.phase).sin_cos();
            motion[0][term.index] += term.amplitude * sine;
            motion[1][term.index] += term.amplitude * cosine * TAU * multiple * run.fundamental;
        }
        motion
    }

    /// Random displacement from home and velocity: of the runs, or in the ranges, with velocities of
    /// up to a half range per second.
    fn draw(&self, random: &mut Pcg64) -> [Vec<f64>; 2] {
        let experiment = self.robot.description().experiment.as_ref();
        let runs = experiment.map_or(&[][..], |table| &table.runs);
        let chosen = (uniform(random) * runs.len() as f64) as usize;
        match runs
            .get(chosen)
            .filter(|_| self.origin == RangeOrigin::Runs)
        {
            Some(run) => self.motion(run, uniform(random)),
            None => [(); 2].map(|()| {
                let ranges = self.ranges.iter();
                ranges
                    .map(|range| range * (2.0 * uniform(random) - 1.0))
                    .collect()
            }),
        }
    }

    /// Random states within reach.
    pub(super) fn drawn(&self, count: usize, seed: u64) -> Result<States, Refusal> {
        let mut random = Pcg64::new(u128::from(seed), 0);
        let mut states = States {
            all: Vec::with_capacity(count),
            rejected: 0,
        };
        while states.all.len() < count {
            let [displacement, twist] = self.draw(&mut random);
            let pairs = self.info.home_pose.iter().zip(displacement);
            let pose = pairs.map(|(home, own)| home + own).collect();
            match self.state(pose, twist) {
                Ok(state) => states.all.push(state),
                Err(error) => {
                    states.rejected += 1;
                    if states.rejected > DRAWS * count {
                        return Err(Refusal {
                            message: format!(
                                "only {} of {} states around home are in the workspace: {error}",
                                states.all.len(),
                                states.all.len() + states.rejected
                            ),
                            help: "give smaller ranges, `position` of [excitation]".to_owned(),
                        });
                    }
                }
            }
        }
        Ok(states)
    }
}
