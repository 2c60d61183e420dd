//! Columns of hypotheses that change the motion, by finite differences.
//!
//! They compare the estimate's prediction for the motion with that for a slightly different one.
//! The inverse dynamics with the estimated parameters give it with few operations. Friction that
//! the settings split by direction has no standard parameter, so it needs the regressor. Both take
//! the sign of a velocity at the sample or over the interval, the same before and after the change.

use std::borrow::Cow;

use overact::{Columns, Function, Model};

use super::{columns::rates, misreading::Misreading, shapes::ActuatorState};
use crate::{
    blocks::{BLOCK, evaluate, slice},
    kinematics::{Motion, distribution::least_norm},
    regression::{columns::ColumnSet, states::SampledStates},
};
use overact_logs::{Error, Variant};

/// Step of a position (m, rad), and relative step of the clock.
const STEP: f64 = 1e-5;

/// Step of the time, s.
const INSTANT: f64 = 1e-6;

/// Step of a smoothing, s²: that of a moving average over 5 ms.
///
/// It is large enough to move a reversal by more than its noise.
const SQUARE: f64 = 1e-6;

/// An estimate that predicts torques for a motion.
pub(super) struct Prediction<'a> {
    pub(super) model: &'a dyn Model,
    pub(super) columns: &'a ColumnSet,
    pub(super) base: &'a [usize],
    /// Estimate of each base parameter.
    pub(super) values: &'a [f64],
    /// J_p^inv of each sample, n × r.
    pub(super) jacobians: &'a [f64],
    /// Whether these are identities: the coordinates are the actuators' positions.
    pub(super) is_direct: bool,
}

/// Motion of the actuators at all samples, with the poses that belong to it.
struct ActuatorMotion {
    poses: Vec<f64>,
    /// Velocities and accelerations, samples × n.
    rates: Vec<f64>,
    changes: Vec<f64>,
}

impl ActuatorMotion {
    /// That of a motion.
    fn new(motion: &Motion, actuators: &[ActuatorState]) -> Self {
        Self {
            poses: motion.pose.clone(),
            rates: actuators.iter().map(|one| one.velocity).collect(),
            changes: actuators.iter().map(|one| one.acceleration).collect(),
        }
    }
}

/// A motion as it is, with what the derivatives with respect to its errors have in common.
pub(super) struct Unchanged<'a> {
    motion: &'a Motion,
    /// Torques of the actuators.
    torques: &'a [f64],
    actuators: &'a [ActuatorState],
    /// Motion of the actuators.
    own: ActuatorMotion,
    /// J_p^inv+ᵀ of each sample, n × r.
    distributions: Cow<'a, [f64]>,
    /// Y - W χ, samples × r.
    left: Vec<f64>,
}

impl<'a> Prediction<'a> {
    /// The same parameters for another robot.
    fn of(&self, model: &'a dyn Model) -> Self {
        Self { model, ..*self }
    }

    /// Predicted Γ¹, samples × r, for samples one `interval` (s) apart with these `jacobians`.
    pub(super) fn inputs(
        &self,
        motion: &Motion,
        states: [&[f64]; 3],
        jacobians: &[f64],
        interval: f64,
    ) -> Result<Vec<f64>, Error> {
        let sizes = self.model.info().sizes;
        let own = (self.base, self.values);
        let Some(parameters) = { self.columns }.parameters(own.0, own.1, &sizes, motion.carried())
        else {
            return self.inputs_by_regressor(motion, states, interval);
        };
        let at = |error: overact::SampleError| motion.outside(error.sample, error.error);
        let [pose, twist, acceleration] = states;
        let inputs = [pose, twist, acceleration, &parameters];
        let function = Function::InverseDynamics(Columns::Standard);
        let torques = match evaluate(self.model, function, &inputs, motion.samples) {
            // Parameters of a log in wrong units may be too large for the function.
            Err(error) if is_unavailable(&error.error) => {
                return self.inputs_by_regressor(motion, states, interval);
            }
            torques => torques.map_err(at)?,
        };
        if self.is_direct {
            return Ok(torques);
        }
        Ok(inputs_of(jacobians, &torques, sizes.actuators, sizes.dof))
    }

    /// The same by the columns of the model.
    fn inputs_by_regressor(
        &self,
        motion: &Motion,
        states: [&[f64]; 3],
        interval: f64,
    ) -> Result<Vec<f64>, Error> {
        let sizes = self.model.info().sizes;
        let r = sizes.dof;
        let mut all = Vec::with_capacity(motion.samples * r);
        for first in (0..motion.samples).step_by(BLOCK) {
            let count = BLOCK.min(motion.samples - first);
            let widths = [sizes.pose, r, r];
            let [pose, twist, acceleration] =
                [0, 1, 2].map(|i| slice(states[i], widths[i], first, count));
            let states = SampledStates {
                samples: count,
                interval,
                pose,
                twist,
                acceleration,
                carried: motion.carried(),
            };
            let lines = self
                .columns
                .evaluate(self.model, &states, self.base, 0)
                .map_err(|error| motion.outside(first + error.sample, error.error))?;
            let held = self
                .columns
                .held_inputs(self.model, &states)
                .map_err(|error| motion.outside(first + error.sample, error.error))?;
            let p = self.base.len();
            for sample in 0..count {
                all.extend(lines.iter().enumerate().map(|(line, rows)| {
                    let held = held.get(sample * r + line).copied().unwrap_or(0.0);
                    held + dot(slice(rows, p, sample, 1), &self.values[..p])
                }));
            }
        }
        Ok(all)
    }

    /// Actuator velocities J v and accelerations J v̇ + J̇ v, samples × n, with J = J_p^inv.
    pub(super) fn actuators(&self, motion: &Motion) -> Result<[Vec<f64>; 2], Error> {
        if self.is_direct {
            return Ok([motion.twist.clone(), motion.acceleration.clone()]);
        }
        let jacobians = self.jacobians;
        let sizes = self.model.info().sizes;
        let (n, r) = (sizes.actuators, sizes.dof);
        let mut poses = motion.pose.clone();
        let steps: Vec<f64> = motion.twist.iter().map(|v| v * INSTANT).collect();
        let moved = poses.chunks_exact_mut(sizes.pose);
        moved
            .zip(steps.chunks_exact(r))
            .for_each(|(pose, step)| self.model.displace(pose, step));
        let at = |error: overact::SampleError| motion.outside(error.sample, error.error);
        let function = Function::InverseJacobian;
        let later = evaluate(self.model, function, &[&poses], motion.samples).map_err(at)?;
        let mut all = [vec![0.0; motion.samples * n], vec![0.0; motion.samples * n]];
        for place in 0..motion.samples * n {
            let sample = place / n;
            let rows = [jacobians, later.as_slice()].map(|all| slice(all, r, place, 1));
            let rates = [&motion.twist, &motion.acceleration].map(|all| slice(all, r, sample, 1));
            let product = |row: &[f64], rate: &[f64]| -> f64 {
                row.iter().zip(rate).map(|(a, b)| a * b).sum()
            };
            let velocity = product(rows[0], rates[0]);
            let change = (product(rows[1], rates[0]) - velocity) / INSTANT;
            all[0][place] = velocity;
            all[1][place] = product(rows[0], rates[1]) + change;
        }
        Ok(all)
    }

    /// Derivative of Y - W χ with respect to the relative error of the clock, samples × r.
    ///
    /// The sampling interval changes, too, so that velocities reverse at the same fraction of an
    /// interval. `here` are the inputs of the motion as it is.
    pub(super) fn clock(&self, motion: &Motion, here: &[f64]) -> Result<Vec<f64>, Error> {
        let faster = 1.0 + STEP;
        let twist: Vec<f64> = motion.twist.iter().map(|v| v * faster).collect();
        let acceleration: Vec<f64> = motion
            .acceleration
            .iter()
            .map(|a| a * faster * faster)
            .collect();
        let interval = 1.0 / motion.sampling_frequency;
        let states: [&[f64]; 3] = [&motion.pose, &twist, &acceleration];
        let there = self.inputs(motion, states, self.jacobians, interval / faster)?;
        Ok(here
            .iter()
            .zip(there)
            .map(|(a, b)| (a - b) / STEP)
            .collect())
    }

    /// Derivative of Y - W χ with respect to errors of the lengths, samples × lengths × r.
    ///
    /// `here` are the inputs of the motion as it is, by the regressor, since the models of the variants
    /// have no inverse dynamics.
    pub(super) fn lengths(
        &self,
        motion: &Motion,
        variants: &[Variant<'a>],
        here: &[f64],
    ) -> Result<Vec<f64>, Error> {
        if variants.is_empty() {
            return Ok(Vec::new());
        }
        let r = self.model.info().sizes.dof;
        let interval = 1.0 / motion.sampling_frequency;
        let states: [&[f64]; 3] = [&motion.pose, &motion.twist, &motion.acceleration];
        let mut all = vec![0.0; here.len() * variants.len()];
        for (number, variant) in variants.iter().enumerate() {
            let there = self
                .of(variant.model)
                .inputs_by_regressor(motion, states, interval)?;
            for (place, (a, b)) in here.iter().zip(&there).enumerate() {
                let (sample, line) = (place / r, place % r);
                all[(sample * variants.len() + number) * r + line] = (a - b) / variant.step;
            }
        }
        Ok(all)
    }

    /// What the derivatives of a motion with these `torques` have in common.
    ///
    /// # Errors
    /// A sample at which the model has no value.
    pub(super) fn unchanged<'b>(
        &'b self,
        motion: &'b Motion,
        torques: &'b [f64],
        actuators: &'b [ActuatorState],
    ) -> Result<Unchanged<'b>, Error> {
        let sizes = self.model.info().sizes;
        let own = ActuatorMotion::new(motion, actuators);
        let distributions = if self.is_direct {
            Cow::Borrowed(self.jacobians)
        } else {
            Cow::Owned(distributions(self.jacobians, sizes.actuators, sizes.dof))
        };
        Ok(Unchanged {
            left: self.left(motion, &own, torques)?,
            motion,
            torques,
            actuators,
            own,
            distributions,
        })
    }

    /// Derivative of Y - W χ with respect to all position errors, samples × n × errors × r.
    ///
    /// An error changes position, velocity and acceleration of one actuator. The derivatives with
    /// respect to these three give those for all errors.
    pub(super) fn misread(&self, all: &Unchanged<'_>) -> Result<Vec<f64>, Error> {
        let sizes = self.model.info().sizes;
        let (n, r, count) = (sizes.actuators, sizes.dof, Misreading::ALL.len());
        let revolute = self.model.info().actuator_is_revolute;
        let mut misread = vec![0.0; all.motion.samples * n * count * r];
        for actuator in 0..n {
            let is_revolute = revolute.get(actuator) == Some(&true);
            let [shifted, faster, accelerated] = self.of_actuator(all, actuator)?;
            for sample in 0..all.motion.samples {
                let state = all.actuators[sample * n + actuator];
                let [shifted, faster, accelerated] =
                    [&shifted, &faster, &accelerated].map(|own| slice(own, r, sample, 1));
                for (number, error) in Misreading::ALL.iter().enumerate() {
                    if !error.concerns(is_revolute) {
                        continue;
                    }
                    let own = error.at(state);
                    let place = ((sample * n + actuator) * count + number) * r;
                    for (line, to) in misread[place..place + r].iter_mut().enumerate() {
                        *to = own.error * shifted[line]
                            + own.slope * faster[line]
                            + own.acceleration * accelerated[line];
                    }
                }
            }
        }
        Ok(misread)
    }

    /// Derivatives of Y - W χ with respect to position, relative velocity and acceleration of an
    /// actuator, samples × r.
    ///
    /// A relative change of the velocity never changes its sign.
    fn of_actuator(&self, all: &Unchanged<'_>, actuator: usize) -> Result<[Vec<f64>; 3], Error> {
        let sizes = self.model.info().sizes;
        let (n, r) = (sizes.actuators, sizes.dof);
        let derivative = |there: &ActuatorMotion| -> Result<Vec<f64>, Error> {
            let there = self.left(all.motion, there, all.torques)?;
            let both = all.left.iter().zip(&there);
            Ok(both.map(|(a, b)| (b - a) / STEP).collect())
        };
        let mut moved = ActuatorMotion {
            poses: all.own.poses.clone(),
            rates: all.own.rates.clone(),
            changes: all.own.changes.clone(),
        };
        let mut step = vec![0.0; r];
        for (sample, pose) in moved.poses.chunks_exact_mut(sizes.pose).enumerate() {
            let row = slice(&all.distributions, r, sample * n + actuator, 1);
            let parts = step.iter_mut().zip(row);
            parts.for_each(|(step, part)| *step = STEP * part);
            self.model.displace(pose, &step);
        }
        let shifted = derivative(&moved)?;
        moved.poses.clone_from(&all.own.poses);
        let own = moved.rates.iter_mut().skip(actuator).step_by(n);
        own.for_each(|rate| *rate += STEP * *rate);
        let faster = derivative(&moved)?;
        moved.rates.clone_from(&all.own.rates);
        let own = moved.changes.iter_mut().skip(actuator).step_by(n);
        own.for_each(|change| *change += STEP);
        Ok([shifted, faster, derivative(&moved)?])
    }

    /// Derivative of Y - W χ with respect to s when each signal x becomes x + s ẍ, samples × r.
    ///
    /// A filter that positions and torques pass has this effect, apart from its delay; see
    /// `checks::torques::smoothing`. Terms that are linear in the motion do not change.
    /// `torque_turns` are the second derivatives of the torques. The result is zero if the change
    /// leaves the workspace.
    pub(super) fn common_filter(&self, all: &Unchanged<'_>, torque_turns: &[f64]) -> Vec<f64> {
        let sizes = self.model.info().sizes;
        let (n, r) = (sizes.actuators, sizes.dof);
        let ActuatorMotion {
            poses,
            rates: velocities,
            changes: accelerations,
        } = &all.own;
        let jerks = rates(accelerations, n, all.motion.sampling_frequency);
        let snaps = rates(&jerks, n, all.motion.sampling_frequency);
        let smoothed = |values: &[f64], bends: &[f64]| -> Vec<f64> {
            let both = values.iter().zip(bends);
            both.map(|(value, bend)| value + SQUARE * bend).collect()
        };
        let mut poses = poses.clone();
        let steps = inputs_of(&all.distributions, accelerations, n, r);
        let mut step = vec![0.0; r];
        for (pose, own) in poses
            .chunks_exact_mut(sizes.pose)
            .zip(steps.chunks_exact(r))
        {
            let parts = step.iter_mut().zip(own);
            parts.for_each(|(step, part)| *step = SQUARE * part);
            self.model.displace(pose, &step);
        }
        let there = ActuatorMotion {
            poses,
            rates: smoothed(velocities, &jerks),
            changes: smoothed(accelerations, &snaps),
        };
        let torques = smoothed(all.torques, torque_turns);
        let Ok(there) = self.left(all.motion, &there, &torques) else {
            return vec![0.0; all.left.len()];
        };
        let both = all.left.iter().zip(&there);
        both.map(|(a, b)| (b - a) / SQUARE).collect()
    }

    /// Y - W χ for another motion of the actuators, with these torques.
    fn left(
        &self,
        motion: &Motion,
        there: &ActuatorMotion,
        torques: &[f64],
    ) -> Result<Vec<f64>, Error> {
        let sizes = self.model.info().sizes;
        let (n, r) = (sizes.actuators, sizes.dof);
        let interval = 1.0 / motion.sampling_frequency;
        let ActuatorMotion {
            poses,
            rates,
            changes,
        } = there;
        let (mut left, predicted) = if self.is_direct {
            let states: [&[f64]; 3] = [poses, rates, changes];
            let predicted = self.inputs(motion, states, self.jacobians, interval)?;
            (torques.to_vec(), predicted)
        } else {
            let at = |error: overact::SampleError| motion.outside(error.sample, error.error);
            let ask = |function: Function, inputs: &[&[f64]]| {
                evaluate(self.model, function, inputs, motion.samples).map_err(at)
            };
            let twist = ask(Function::TwistFromActuators, &[poses, rates])?;
            let inputs: [&[f64]; 3] = [poses, &twist, changes];
            let acceleration = ask(Function::AccelerationFromActuators, &inputs)?;
            let jacobians = ask(Function::InverseJacobian, &[poses])?;
            let states: [&[f64]; 3] = [poses, &twist, &acceleration];
            let predicted = self.inputs(motion, states, &jacobians, interval)?;
            (inputs_of(&jacobians, torques, n, r), predicted)
        };
        let both = left.iter_mut().zip(predicted);
        both.for_each(|(y, w)| *y -= w);
        Ok(left)
    }
}

/// J_p^inv+ᵀ of each sample, samples × n × r; zero if the actuators do not determine the platform.
fn distributions(jacobians: &[f64], n: usize, r: usize) -> Vec<f64> {
    let one = |jacobian| least_norm(jacobian, r).unwrap_or_else(|| vec![0.0; n * r]);
    jacobians.chunks_exact(n * r).flat_map(one).collect()
}

/// Γ¹ = J_p^invᵀ τ of each sample, samples × r.
pub(super) fn inputs_of(jacobians: &[f64], torques: &[f64], n: usize, r: usize) -> Vec<f64> {
    let mut inputs = vec![0.0; torques.len() / n * r];
    let torques = torques.chunks_exact(n);
    let jacobians = jacobians.chunks_exact(n * r).zip(torques);
    for (own, (jacobian, torques)) in inputs.chunks_exact_mut(r).zip(jacobians) {
        for (row, torque) in jacobian.chunks_exact(r).zip(torques) {
            let sums = own.iter_mut().zip(row);
            sums.for_each(|(sum, share)| *sum += share * torque);
        }
    }
    inputs
}

/// Number of partial sums of a dot product.
const SIDE_BY_SIDE: usize = 8;

/// Dot product of two vectors of equal length.
pub(super) fn dot(left: &[f64], right: &[f64]) -> f64 {
    let (left, last) = left.as_chunks::<SIDE_BY_SIDE>();
    let (right, end) = right.as_chunks::<SIDE_BY_SIDE>();
    let mut sums = [0.0; SIDE_BY_SIDE];
    for (left, right) in left.iter().zip(right) {
        for (sum, (a, b)) in sums.iter_mut().zip(left.iter().zip(right)) {
            *sum += a * b;
        }
    }
    let rest = last.iter().zip(end).map(|(a, b)| a * b);
    sums.iter().sum::<f64>() + rest.sum::<f64>()
}

/// Whether the torques have to be computed by the columns of the model.
fn is_unavailable(error: &overact::Error) -> bool {
    use overact::Error::{NotOffered, OutOfRange};
    matches!(error, NotOffered { .. } | OutOfRange { .. })
}
