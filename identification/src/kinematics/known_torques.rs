//! Known torques and forces of the description, subtracted from measured torques.
//!
//! They are the inverse dynamics with all parameters zero: the actuator torques that balance the
//! known torques of all joints, and the known forces of springs and dampers between points. With
//! redundant actuators these are the torques of least norm, whose projections are those of the known
//! torques.
//!
//! Parameters that the prior holds contribute their part of the inverse dynamics as well.

use overact::{Columns, Function, Model};

use super::distribution::least_torques;
use super::motion::Motion;
use crate::prior::Prior;
use overact_logs::Error;

/// Displacements from home at which they are looked for, rad or m.
///
/// They may vanish at home, and a large displacement may be out of a small robot's reach.
const PROBES: [f64; 4] = [0.0, 1e-3, 1e-2, 0.1];

/// Torques that are independent of parameters.
pub(super) struct KnownTorques<'a> {
    model: &'a dyn Model,
    /// Whether there are any.
    present: bool,
    /// Values of the held parameters among all, zero for the others.
    parameters: Vec<f64>,
    /// Whether there are held parameters.
    is_held: bool,
}

/// Motions at successive samples.
#[derive(Clone, Copy)]
struct States<'a> {
    poses: &'a [f64],
    twists: &'a [f64],
    accelerations: &'a [f64],
    samples: usize,
}

impl<'a> KnownTorques<'a> {
    /// Finds whether a model with the held parameters of a prior has them.
    pub(super) fn new(model: &'a dyn Model, prior: &Prior) -> Self {
        let info = model.info();
        let sizes = info.sizes;
        let all = info.parameters.iter().chain(info.payload_parameters);
        let value = |name: &str| prior.held.get(name).copied().unwrap_or(0.0);
        let known = Self {
            model,
            present: false,
            parameters: all.map(|one| value(one.name)).collect(),
            is_held: !prior.held.is_empty(),
        };
        let probe = |size: f64| {
            let step = |coordinate: usize| size * (1.0 + 0.3 * coordinate as f64);
            let step: Vec<f64> = (0..sizes.dof).map(step).collect();
            let mut pose = info.home_pose.to_vec();
            model.displace(&mut pose, &step);
            // A known force may depend on velocities only.
            let found = known.at(States {
                poses: &pose,
                twists: &vec![1.0; sizes.dof],
                accelerations: &vec![0.0; sizes.dof],
                samples: 1,
            });
            found.is_ok_and(|torques| torques.iter().any(|torque| *torque != 0.0))
        };
        Self {
            present: known.is_held || PROBES.into_iter().any(probe),
            ..known
        }
    }

    /// Torques at these states.
    fn at(&self, states: States<'_>) -> Result<Vec<f64>, overact::SampleError> {
        let sizes = self.model.info().sizes;
        if !self.model.pulls().is_empty() {
            return self.of_forces(states);
        }
        let mut torques = vec![0.0; states.samples * sizes.actuators];
        let inputs: [&[f64]; 4] = [
            states.poses,
            states.twists,
            states.accelerations,
            &self.parameters,
        ];
        self.model.evaluate(
            Function::InverseDynamics(Columns::Standard),
            &inputs,
            &mut torques,
        )?;
        Ok(torques)
    }

    /// Torques of a robot with cables, whose inverse dynamics includes the minimum tensions: the
    /// forces of least norm for the generalised forces.
    fn of_forces(&self, states: States<'_>) -> Result<Vec<f64>, overact::SampleError> {
        let sizes = self.model.info().sizes;
        let (n, r) = (sizes.actuators, sizes.dof);
        let States {
            poses,
            twists,
            accelerations,
            samples,
        } = states;
        let mut forces = vec![0.0; samples * r];
        let function = Function::Bias(Columns::Standard);
        self.model
            .evaluate(function, &[poses, twists, &self.parameters], &mut forces)?;
        if self.is_held {
            let mut masses = vec![0.0; samples * r * r];
            let function = Function::MassMatrix(Columns::Standard);
            self.model
                .evaluate(function, &[poses, &self.parameters], &mut masses)?;
            let rows = masses.chunks_exact(r);
            for (place, (row, force)) in rows.zip(&mut forces).enumerate() {
                let own = &accelerations[place / r * r..][..r];
                *force += row.iter().zip(own).map(|(m, a)| m * a).sum::<f64>();
            }
        }
        if forces.iter().all(|force| *force == 0.0) {
            return Ok(vec![0.0; samples * n]);
        }
        let mut jacobians = vec![0.0; samples * n * r];
        self.model
            .evaluate(Function::InverseJacobian, &[poses], &mut jacobians)?;
        let [torques] = least_torques(&jacobians, n, r, [&forces]);
        Ok(torques)
    }

    /// Subtracts them from the torques of a motion, and keeps them if parameters are held.
    ///
    /// # Errors
    /// A sample at which they have no value.
    pub(super) fn subtract(&self, motion: &mut Motion) -> Result<(), Error> {
        if !self.present {
            return Ok(());
        }
        let known = self.at(States {
            poses: &motion.pose,
            twists: &motion.twist,
            accelerations: &motion.acceleration,
            samples: motion.samples,
        });
        let known = known.map_err(|error| motion.outside(error.sample, error.error))?;
        for (torque, known) in motion.torques.iter_mut().zip(&known) {
            *torque -= known;
        }
        if self.is_held {
            motion.subtracted = known;
        }
        Ok(())
    }
}
