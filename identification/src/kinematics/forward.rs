//! The poses of a run.
//!
//! Some samples, the anchors, are solved one after the other, each from the one before, so that the
//! assembly mode stays that of the home pose. The samples between two anchors start from the cubic through
//! four anchors around them, where Gauss-Newton needs one or two steps, and all of them step
//! together: a model evaluates many samples at once much faster than one by one. What does not
//! converge that way is solved sample by sample, which also tells where a run leaves the workspace.
//!
//! Where there is a closed form, all samples start from it: it is in the assembly mode of the home pose, and that of
//! the run as long as it goes on without a jump.

use overact::{Function, Model, math::wrap_angle};
use rayon::prelude::*;

use super::conditioning::couples;
use super::motion::outside;
use super::settling::settle;
use crate::{blocks::evaluate, data::Log, error::Error};

/// Steps in which the first sample is approached from the home pose, should it be far from it.
const APPROACH_STEPS: usize = 50;

/// Time (s) and samples from one anchor to the next, at most. The time is one in which a robot moves
/// little, so that no other assembly mode is near.
const ANCHOR_SECONDS: f64 = 0.005;
const ANCHOR_SAMPLES: usize = 32;

/// Closed forms of successive samples that are not farther apart than this (m, rad) are of one assembly mode.
const NEAR: f64 = 0.01;

/// Samples that step together: enough to fill vector units, few enough for the cache.
const TOGETHER: usize = 256;

/// Forward kinematics that follows a run.
pub(super) struct Forward<'a> {
    model: &'a dyn Model,
    log: &'a Log,
    /// The last pose that was found; the home pose at first.
    pose: Vec<f64>,
    started: bool,
    /// Samples from one anchor to the next; 1 where each is solved by itself.
    spacing: usize,
}

impl<'a> Forward<'a> {
    /// Starts at home.
    pub(super) fn new(model: &'a dyn Model, log: &'a Log) -> Self {
        // Without loops the positions are the pose: nothing is to be solved.
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

    /// All poses from those in closed form; `None` where there are none, or where they jump.
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

    /// Poses that are found from others, which are near, or `None` where that does not converge.
    fn settled(&self, mut poses: Vec<f64>, positions: &[f64]) -> Option<Vec<f64>> {
        let (n, size) = (self.log.actuators(), self.pose.len());
        poses
            .par_chunks_mut(TOGETHER * size)
            .zip(positions.par_chunks(TOGETHER * n))
            .try_for_each(|(poses, positions)| settle(self.model, positions, poses))?;
        Some(poses)
    }

    /// All poses from anchors, or `None` where that does not converge.
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
        // Poses with a quaternion have no way between: all start from the anchor before.
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

/// Weights of anchors at the samples of an interval between two of them.
#[derive(Default)]
struct Between {
    /// The anchors, seen from the first sample.
    places: Vec<f64>,
    samples: usize,
    /// For each sample the weight of each anchor.
    weights: Vec<f64>,
}

impl Between {
    /// Finds them, unless they are those of the interval before, as those of intervals of one length are.
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

/// The weight of place number `own` in the polynomial through some places, at `x`.
fn lagrange(places: &[f64], own: usize, x: f64) -> f64 {
    let others = places.iter().enumerate().filter(|(place, _)| *place != own);
    others
        .map(|(_, other)| (x - other) / (places[own] - other))
        .product()
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
