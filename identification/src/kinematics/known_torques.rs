//! Known torques and forces of the description, subtracted from measured torques.
//!
//! They are the inverse dynamics with all parameters zero: the actuator torques that balance the
//! known torques of all joints, and the known forces of springs and dampers between points. With
//! redundant actuators these are the torques of least norm, whose projections are those of the known
//! torques.

use overact::{Columns, Function, Model};

use super::distribution::least_torques;
use super::motion::Motion;
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
}

impl<'a> KnownTorques<'a> {
    /// Finds whether a model has them.
    pub(super) fn new(model: &'a dyn Model) -> Self {
        let info = model.info();
        let sizes = info.sizes;
        let known = Self {
            model,
            present: false,
        };
        let probe = |size: f64| {
            let step = |coordinate: usize| size * (1.0 + 0.3 * coordinate as f64);
            let step: Vec<f64> = (0..sizes.dof).map(step).collect();
            let mut pose = info.home_pose.to_vec();
            model.displace(&mut pose, &step);
            // A known force may depend on velocities only.
            let moving = vec![1.0; sizes.dof];
            let found = known.at(&pose, &moving, 1);
            found.is_ok_and(|torques| torques.iter().any(|torque| *torque != 0.0))
        };
        Self {
            present: PROBES.into_iter().any(probe),
            ..known
        }
    }

    /// Torques at poses and twists.
    fn at(
        &self,
        poses: &[f64],
        twists: &[f64],
        samples: usize,
    ) -> Result<Vec<f64>, overact::SampleError> {
        let sizes = self.model.info().sizes;
        let still = vec![0.0; samples * sizes.dof];
        let parameters = vec![0.0; sizes.parameters + sizes.payload_parameters];
        if !self.model.pulls().is_empty() {
            return self.of_bias(poses, twists, &parameters, samples);
        }
        let mut torques = vec![0.0; samples * sizes.actuators];
        let inputs: [&[f64]; 4] = [poses, twists, &still, &parameters];
        self.model.evaluate(
            Function::InverseDynamics(Columns::Standard),
            &inputs,
            &mut torques,
        )?;
        Ok(torques)
    }

    /// Torques of a robot with cables, whose inverse dynamics includes the minimum tensions: the
    /// forces of least norm for the bias.
    fn of_bias(
        &self,
        poses: &[f64],
        twists: &[f64],
        parameters: &[f64],
        samples: usize,
    ) -> Result<Vec<f64>, overact::SampleError> {
        let sizes = self.model.info().sizes;
        let (n, r) = (sizes.actuators, sizes.dof);
        let mut bias = vec![0.0; samples * r];
        let function = Function::Bias(Columns::Standard);
        self.model
            .evaluate(function, &[poses, twists, parameters], &mut bias)?;
        if bias.iter().all(|force| *force == 0.0) {
            return Ok(vec![0.0; samples * n]);
        }
        let mut jacobians = vec![0.0; samples * n * r];
        self.model
            .evaluate(Function::InverseJacobian, &[poses], &mut jacobians)?;
        let [torques] = least_torques(&jacobians, n, r, [&bias]);
        Ok(torques)
    }

    /// Subtracts them from the torques of a motion.
    ///
    /// # Errors
    /// A sample at which they have no value.
    pub(super) fn subtract(&self, motion: &mut Motion) -> Result<(), Error> {
        if !self.present {
            return Ok(());
        }
        let known = self.at(&motion.pose, &motion.twist, motion.samples);
        let known = known.map_err(|error| motion.outside(error.sample, error.error))?;
        for (torque, known) in motion.torques.iter_mut().zip(known) {
            *torque -= known;
        }
        Ok(())
    }
}
