//! The poses of a run, each found from the one before.

use overact::{Function, Model, math::wrap_angle};

use super::outside;
use crate::{data::Log, error::Error};

/// Steps in which the first sample is approached from the home pose, should it be far from it.
const APPROACH_STEPS: usize = 50;

/// Forward kinematics that follows a run.
pub(super) struct Forward<'a> {
    model: &'a dyn Model,
    log: &'a Log,
    /// The last pose that was found; the home pose at first.
    pose: Vec<f64>,
    started: bool,
}

impl<'a> Forward<'a> {
    /// Starts at home.
    pub(super) fn new(model: &'a dyn Model, log: &'a Log) -> Self {
        Self {
            pose: model.info().home_pose.to_vec(),
            model,
            log,
            started: false,
        }
    }

    /// The poses of the samples from number `first` on, from the actuator positions, samples x n.
    ///
    /// # Errors
    /// The first sample outside the workspace.
    pub(super) fn poses(&mut self, first: usize, positions: &[f64]) -> Result<Vec<f64>, Error> {
        let n = self.log.actuators();
        if let (false, Some(start)) = (self.started, positions.get(..n)) {
            approach(self.model, start, &mut self.pose);
            self.started = true;
        }
        let mut poses = Vec::with_capacity(positions.len() / n * self.pose.len());
        for (index, actuators) in positions.chunks_exact(n).enumerate() {
            self.model
                .pose_from_actuators(actuators, &mut self.pose)
                .map_err(|error| {
                    let frequency = self.log.sampling_frequency();
                    outside(self.log.name(), first + index, frequency, error)
                })?;
            poses.extend_from_slice(&self.pose);
        }
        Ok(poses)
    }
}

/// Walks from the home pose towards the first sample in small steps, so that its assembly mode is
/// that of the home pose. Should the way lead outside the workspace, the pose stays at home, and
/// the first sample is tried from there.
pub(crate) fn approach(model: &dyn Model, first: &[f64], pose: &mut [f64]) {
    let info = model.info();
    let mut home = vec![0.0; first.len()];
    if model
        .evaluate(Function::ActuatorPositions, &[pose], &mut home)
        .is_err()
    {
        return;
    }
    let way: Vec<f64> = first
        .iter()
        .zip(&home)
        .zip(info.actuator_is_revolute)
        .map(|((to, from), revolute)| {
            if *revolute {
                wrap_angle(to - from)
            } else {
                to - from
            }
        })
        .collect();
    let mut reached = pose.to_vec();
    for step in 1..=APPROACH_STEPS {
        let part = step as f64 / APPROACH_STEPS as f64;
        let target: Vec<f64> = home.iter().zip(&way).map(|(h, w)| h + part * w).collect();
        if model.pose_from_actuators(&target, &mut reached).is_err() {
            return;
        }
    }
    pose.copy_from_slice(&reached);
}
