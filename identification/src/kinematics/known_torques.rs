//! Known position-dependent torques of the description, subtracted from measured ones.

use overact::{Columns, Function, Model};

use super::motion::Motion;
use overact_logs::Error;

/// Number of poses at which they are looked for.
const PROBES: u32 = 4;

/// Torques at rest that are independent of parameters.
pub(super) struct KnownTorques<'a> {
    model: &'a dyn Model,
    /// Whether there are any.
    present: bool,
}

impl<'a> KnownTorques<'a> {
    /// Finds whether a model has them; robots with a platform never do.
    pub(super) fn new(model: &'a dyn Model) -> Self {
        let info = model.info();
        let sizes = info.sizes;
        let known = Self {
            model,
            present: false,
        };
        let probe = |number: u32| {
            let step = |joint: usize| 0.1 * f64::from(number) * (1.0 + 0.3 * joint as f64);
            let step: Vec<f64> = (0..sizes.dof).map(step).collect();
            let mut pose = info.home_pose.to_vec();
            model.displace(&mut pose, &step);
            let found = known.at(&pose, 1);
            found.is_ok_and(|torques| torques.iter().any(|torque| *torque != 0.0))
        };
        let is_serial = sizes.dof == sizes.joints && sizes.dof == sizes.actuators;
        Self {
            present: is_serial && (0..PROBES).any(probe),
            ..known
        }
    }

    /// Torques at poses.
    fn at(&self, poses: &[f64], samples: usize) -> Result<Vec<f64>, overact::SampleError> {
        let sizes = self.model.info().sizes;
        let still = vec![0.0; samples * sizes.dof];
        let parameters = vec![0.0; sizes.parameters + sizes.payload_parameters];
        let mut torques = vec![0.0; samples * sizes.actuators];
        let inputs: [&[f64]; 4] = [poses, &still, &still, &parameters];
        self.model.evaluate(
            Function::InverseDynamics(Columns::Standard),
            &inputs,
            &mut torques,
        )?;
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
        let known = self.at(&motion.pose, motion.samples);
        let known = known.map_err(|error| motion.outside(error.sample, error.error))?;
        for (torque, known) in motion.torques.iter_mut().zip(known) {
            *torque -= known;
        }
        Ok(())
    }
}
