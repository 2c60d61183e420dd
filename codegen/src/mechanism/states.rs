//! Random regular states of a mechanism: poses around home, with joints that close every leg in the
//! working mode of the home configuration.

use super::cable::wrap_within;
use super::dependent;
use super::home::{REGULAR, close_finely, close_within, condition, lenient_limit};
use super::parasitic::closed;
use super::{JointKind, Mechanism, Motion};
use crate::cas::Stream;

/// A state of a robot.
#[derive(Debug, Clone)]
pub struct State {
    /// Pose; joint positions of a tree.
    pub pose: Vec<f64>,
    /// Joint positions.
    pub joints: Vec<f64>,
    /// Twist coordinates; joint velocities of a tree.
    pub twist: Vec<f64>,
    /// Their derivatives.
    pub acceleration: Vec<f64>,
}

/// Distribution of states around home, in units of the robot's length scale and in radians.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Spread {
    /// Initial distance from home.
    first: f64,
    /// Factor of the distance after a state that some leg's Newton iteration does not reach.
    shrink: f64,
}

impl Spread {
    /// States near home.
    pub(crate) const NEAR: Self = Self {
        first: 0.4,
        shrink: 0.5,
    };
    /// States up to the legs' reach.
    pub(crate) const FAR: Self = Self {
        first: 1.6,
        shrink: 0.8,
    };
}

/// `count` random states near home.
///
/// If some leg's Newton iteration does not reach a state, the distance from home is halved. Then
/// legs are compared with their own condition at home. A state that stays out of reach becomes home
/// with random rates.
#[must_use]
pub fn random_states(mechanism: &Mechanism, count: usize, seed: u64) -> Vec<State> {
    spread_states(mechanism, count, seed, Spread::NEAR)
}

/// `count` random states with the distribution `by`.
pub(crate) fn spread_states(
    mechanism: &Mechanism,
    count: usize,
    seed: u64,
    by: Spread,
) -> Vec<State> {
    let mut stream = Stream::new(seed);
    let dof = mechanism.dof();
    let mut states = Vec::with_capacity(count);
    for _ in 0..count {
        let direction: Vec<f64> = (0..mechanism.pose_len()).map(|_| stream.number()).collect();
        let mut spread = by.first;
        let mut is_lenient = false;
        let (pose, joints) = loop {
            match displaced(mechanism, &direction, spread, is_lenient) {
                Some(found) => break found,
                None if spread < 1e-4 && !is_lenient => (spread, is_lenient) = (by.first, true),
                None if spread < 1e-4 => {
                    break (mechanism.home.pose.clone(), mechanism.home.joints.clone());
                }
                None => spread *= by.shrink,
            }
        };
        let twist = (0..dof).map(|_| stream.number()).collect();
        let acceleration = (0..dof).map(|_| 10.0 * stream.number()).collect();
        states.push(State {
            pose,
            joints,
            twist,
            acceleration,
        });
    }
    states
}

fn displaced(
    mechanism: &Mechanism,
    direction: &[f64],
    spread: f64,
    is_lenient: bool,
) -> Option<(Vec<f64>, Vec<f64>)> {
    let home = &mechanism.home;
    if mechanism.is_tree() {
        // Joints of a tree may have any position.
        let joints: Vec<f64> = home
            .joints
            .iter()
            .zip(direction)
            .map(|(h, d)| h + 3.0 * d)
            .collect();
        return Some((joints.clone(), joints));
    }
    if mechanism.is_parasitic() {
        return displaced_parasitic(mechanism, direction, spread, is_lenient);
    }
    if mechanism.has_dependent_joints() {
        let pose = joints_towards(mechanism, direction, spread);
        return dependent::follow(mechanism, &pose, is_lenient);
    }
    let pose = match &mechanism.platform {
        Some(platform) => pose_towards(mechanism, platform.motion, direction, spread),
        None => joints_towards(mechanism, direction, spread),
    };
    let joints = follow(mechanism, &pose, is_lenient)?;
    Some((pose, joints))
}

/// A state of a platform with parasitic motion at some distance from home.
///
/// The pose is projected onto the closures in small steps, so the working mode stays.
fn displaced_parasitic(
    mechanism: &Mechanism,
    direction: &[f64],
    spread: f64,
    is_lenient: bool,
) -> Option<(Vec<f64>, Vec<f64>)> {
    const STEPS: usize = 8;
    let motion = mechanism.platform.as_ref()?.motion;
    let mut at = mechanism.home.clone();
    for step in 1..=STEPS {
        let part = spread * step as f64 / STEPS as f64;
        at.pose = pose_towards(mechanism, motion, direction, part);
        at = closed(mechanism, &at)?.home;
        let legs = mechanism.legs.iter().enumerate();
        let mut is_regular = legs.map(|(index, leg)| {
            let range = mechanism.leg_range(index);
            let limit = if is_lenient {
                lenient_limit(leg, &mechanism.home.joints[range.clone()])
            } else {
                REGULAR
            };
            condition(&leg.closure_jacobian(&at.joints[range])) < limit
        });
        if !is_regular.all(|one| one) {
            return None;
        }
        mechanism.platform_jacobian(&at.pose, &at.joints)?;
    }
    Some((at.pose, at.joints))
}

/// The pose at a distance from home, in a direction of the pose's coordinates.
///
/// Lengths scale with the distance of the legs' bases from the platform; quaternions stay
/// normalised.
#[must_use]
pub fn pose_towards(
    mechanism: &Mechanism,
    motion: Motion,
    direction: &[f64],
    length: f64,
) -> Vec<f64> {
    let scale = mechanism.length_scale();
    let names = motion.pose_coordinates();
    let mut pose = mechanism.home.pose.clone();
    for ((coordinate, name), d) in pose.iter_mut().zip(&names).zip(direction) {
        let angular = *name == "phi" || name.starts_with('q');
        *coordinate += d * length * if angular { 1.0 } else { scale };
    }
    if motion.has_quaternion() {
        let start = pose.len() - 4;
        let norm = pose[start..].iter().map(|q| q * q).sum::<f64>().sqrt();
        pose[start..].iter_mut().for_each(|q| *q /= norm);
    }
    pose
}

/// The joints of the pose at a distance from home in a direction.
fn joints_towards(mechanism: &Mechanism, direction: &[f64], length: f64) -> Vec<f64> {
    let scale = mechanism.length_scale();
    let joints = mechanism.joints();
    let own = mechanism.coordinate_joints().into_iter();
    let kinds = own.map(|at| mechanism.joint(joints[at]).kind);
    let home = mechanism.home.pose.iter().zip(kinds);
    let moved = home.zip(direction).map(|((home, kind), d)| {
        let unit = if kind == JointKind::Prismatic {
            scale
        } else {
            1.0
        };
        home + d * length * unit
    });
    moved.collect()
}

/// Joints at a pose, tracked from home in small steps so that the working mode stays.
fn follow(mechanism: &Mechanism, pose: &[f64], is_lenient: bool) -> Option<Vec<f64>> {
    const STEPS: usize = 8;
    let home = &mechanism.home;
    let legs = mechanism.legs.iter().enumerate();
    let limits = legs.map(|(index, leg)| {
        if is_lenient && leg.cable.is_none() {
            lenient_limit(leg, &home.joints[mechanism.leg_range(index)])
        } else {
            REGULAR
        }
    });
    let limits: Vec<f64> = limits.collect();
    let mut joints = home.joints.clone();
    for step in 1..=STEPS {
        let part = step as f64 / STEPS as f64;
        let mut at: Vec<f64> = home
            .pose
            .iter()
            .zip(pose)
            .map(|(h, p)| h + part * (p - h))
            .collect();
        if step == STEPS {
            at.copy_from_slice(pose);
        }
        for (index, leg) in mechanism.legs.iter().enumerate() {
            let range = mechanism.leg_range(index);
            let Some(target) = mechanism.target(index, &at, &joints) else {
                // The joints of legs without an end are the pose.
                joints[range].copy_from_slice(&at[mechanism.coordinate_range(index)]);
                continue;
            };
            if let Some(cable) = &leg.cable {
                joints[range].fill(wrap_within(leg, cable, &target)?.length);
                continue;
            }
            let mut closed = close_within(leg, &joints[range.clone()], &target, limits[index])?;
            if step == STEPS {
                closed = close_finely(leg, &closed, &target);
            }
            joints[range].copy_from_slice(&closed);
        }
    }
    Some(joints)
}
