//! Forward kinematics of a run.
//!
//! Some samples, the anchors, are solved in sequence, each starting from the one before. This keeps
//! the assembly mode of the home pose. Samples between anchors start from a cubic through four
//! anchors, and Gauss-Newton needs one or two steps. Many samples step in parallel, since a model
//! evaluates them much faster together. Samples that do not converge are solved one by one, which
//! also finds where a run leaves the workspace.
//!
//! If there is a closed form, all samples start from it. It has the assembly mode of the home pose,
//! which is that of the run if it is continuous.

use overact::{Function, Model, math::wrap_angle};
use rayon::prelude::*;

use super::conditioning::couples;
use super::gauss_newton::refine_poses;
use super::motion::outside;
use crate::blocks::evaluate;
use overact_logs::{Error, Log};

/// Number of steps from the home pose to the first sample.
const APPROACH_STEPS: usize = 50;

/// Largest time (s) and number of samples between anchors, short enough to keep the mode.
const ANCHOR_SECONDS: f64 = 0.005;
const ANCHOR_SAMPLES: usize = 32;

/// Largest difference (m, rad) of successive closed-form poses of one assembly mode.
const NEAR: f64 = 0.01;

/// Samples stepped in parallel: enough for vector units, few enough for the cache.
const TOGETHER: usize = 256;

/// Forward kinematics along a run.
pub(super) struct Forward<'a> {
    model: &'a dyn Model,
    log: &'a Log,
    /// Last pose found; initially the home pose.
    pose: Vec<f64>,
    started: bool,
    /// Samples between anchors; 1 if each sample is solved separately.
    spacing: usize,
}

impl<'a> Forward<'a> {
    /// Starts at home.
    pub(super) fn new(model: &'a dyn Model, log: &'a Log) -> Self {
        // Without loops, the positions are the pose.
        let spacing = if couples(model) {
            (ANCHOR_SECONDS * log.sampling_frequency()) as usize
        } else {
            1
        };
        Self {
            pose: model.info().home_pose.to_vec(),
            spacing: spacing.clamp(1, ANCHOR_SAMPLES),
            model,
            log,
            started: false,
        }
    }

    /// Poses of the samples from number `first` on, from actuator positions, samples × n.
    ///
    /// # Errors
    /// The first sample outside the workspace.
    pub(super) fn poses(&mut self, first: usize, positions: &[f64]) -> Result<Vec<f64>, Error> {
        let n = self.log.actuators();
        if let (false, Some(start)) = (self.started, positions.get(..n)) {
            approach(self.model, start, &mut self.pose);
            self.started = true;
        }
        let together = if self.spacing > 1 {
            let closed = self.in_closed_form(positions);
            closed.or_else(|| self.together(positions))
        } else {
            None
        };
        let poses = match together {
            Some(poses) => poses,
            None => self.one_by_one(first, positions)?,
        };
        if let Some(last) = poses.rchunks_exact(self.pose.len()).next() {
            self.pose.copy_from_slice(last);
        }
        Ok(poses)
    }

    /// All poses, each from the one before.
    fn one_by_one(&self, first: usize, positions: &[f64]) -> Result<Vec<f64>, Error> {
        let n = self.log.actuators();
        let mut pose = self.pose.clone();
        let mut poses = Vec::with_capacity(positions.len() / n * pose.len());
        for (index, actuators) in positions.chunks_exact(n).enumerate() {
            self.model
                .pose_from_actuators(actuators, &mut pose)
                .map_err(|error| {
                    let frequency = self.log.sampling_frequency();
                    outside(self.log.name(), first + index, frequency, error)
                })?;
            poses.extend_from_slice(&pose);
        }
        Ok(poses)
    }

    /// All poses from the closed form; `None` without one, or if poses jump.
    fn in_closed_form(&self, positions: &[f64]) -> Option<Vec<f64>> {
        let samples = positions.len() / self.log.actuators();
        let function = Function::PoseInClosedForm;
        let poses = evaluate(self.model, function, &[positions], samples).ok()?;
        let rows = || poses.chunks_exact(self.pose.len());
        let mut steps = std::iter::once(&self.pose[..]).chain(rows()).zip(rows());
        let is_near = |(a, b): (&f64, &f64)| (a - b).abs() <= NEAR;
        let goes_on = steps.all(|(from, to)| from.iter().zip(to).all(is_near));
        goes_on.then(|| self.settled(poses, positions)).flatten()
    }

    /// Refines approximate poses; `None` if that does not converge.
    fn settled(&self, mut poses: Vec<f64>, positions: &[f64]) -> Option<Vec<f64>> {
        let (n, size) = (self.log.actuators(), self.pose.len());
        poses
            .par_chunks_mut(TOGETHER * size)
            .zip(positions.par_chunks(TOGETHER * n))
            .try_for_each(|(poses, positions)| refine_poses(self.model, positions, poses))?;
        Some(poses)
    }

    /// All poses from anchors; `None` if that does not converge.
    fn together(&self, positions: &[f64]) -> Option<Vec<f64>> {
        let (n, size) = (self.log.actuators(), self.pose.len());
        let samples = positions.len() / n;
        // The last sample is an anchor, too.
        let mut anchors: Vec<usize> = (self.spacing - 1..samples).step_by(self.spacing).collect();
        if anchors.last() != Some(&(samples - 1)) {
            anchors.push(samples - 1);
        }
        let mut found = vec![self.pose.clone()];
        for &anchor in &anchors {
            let mut pose = found.last()?.clone();
            let actuators = &positions[anchor * n..(anchor + 1) * n];
            self.model.pose_from_actuators(actuators, &mut pose).ok()?;
            found.push(pose);
        }
        // Poses with quaternions are not interpolated; they start from the previous anchor.
        let is_straight = size == self.model.info().sizes.dof;
        // The pose before the first sample is an anchor, too.
        let places: Vec<f64> = std::iter::once(-1.0)
            .chain(anchors.iter().map(|anchor| *anchor as f64))
            .collect();
        let mut poses = Vec::with_capacity(samples * size);
        let mut between = Between::default();
        for (interval, &anchor) in anchors.iter().enumerate() {
            let first = interval
                .saturating_sub(1)
                .min(found.len().saturating_sub(4));
            let around = first..(first + 4).min(found.len());
            let start = poses.len() / size;
            if is_straight {
                between.prepare(&places[around.clone()], start as f64, anchor - start);
                for weights in between.weights.chunks_exact(around.len()) {
                    let here = poses.len();
                    poses.resize(here + size, 0.0);
                    for (weight, own) in weights.iter().zip(&found[around.clone()]) {
                        let to = poses[here..].iter_mut().zip(own);
                        to.for_each(|(to, from)| *to += weight * from);
                    }
                }
            } else {
                (start..anchor).for_each(|_| poses.extend_from_slice(&found[interval]));
            }
            poses.extend_from_slice(&found[interval + 1]);
        }
        self.settled(poses, positions)
    }
}

/// Interpolation weights of anchors at the samples between two of them.
#[derive(Default)]
struct Between {
    /// Anchors, relative to the first sample.
    places: Vec<f64>,
    samples: usize,
    /// For each sample the weight of each anchor.
    weights: Vec<f64>,
}

impl Between {
    /// Computes the weights, unless they equal those of the previous interval.
    fn prepare(&mut self, places: &[f64], first: f64, samples: usize) {
        let seen = || places.iter().map(|place| place - first);
        if self.samples == samples && seen().eq(self.places.iter().copied()) {
            return;
        }
        self.places = seen().collect();
        self.samples = samples;
        self.weights.clear();
        for sample in 0..samples {
            let weight = |own: usize| lagrange(&self.places, own, sample as f64);
            self.weights.extend((0..self.places.len()).map(weight));
        }
    }
}

/// Lagrange polynomial of node `own` among `places`, at `x`.
fn lagrange(places: &[f64], own: usize, x: f64) -> f64 {
    let others = places.iter().enumerate().filter(|(place, _)| *place != own);
    others
        .map(|(_, other)| (x - other) / (places[own] - other))
        .product()
}

/// Moves from the home pose to the first sample in small steps, to keep the assembly mode.
///
/// If the path leaves the workspace, the pose stays at home, and the first sample starts from
/// there.
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
