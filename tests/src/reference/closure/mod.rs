//! Closing the loops: joint positions (7), velocities (9) and accelerations (10) from the platform.
//!
//! Positions come from Newton's method on every leg: the residual is the vector between the two
//! ends and the rotation vector between their orientations, its derivative the leg's Jacobian with
//! all rows. The path from the home pose is walked in steps, so that a leg keeps its working mode.
//!
//! Accelerations need no derivative of a matrix. With zero accelerations of joints and twist
//! coordinates, the forward recursion gives the ends' bias accelerations J̇_k q̇ and J̇_tk v; then
//! J_k q̈ = J_tk v̇ + J̇_tk v - J̇_k q̇.

pub mod chains;
pub mod parasitic_motion;

use crate::reference::Error;
use crate::reference::cables;
use crate::reference::jacobians::{Jacobians, end_jacobian, follow};
use crate::reference::kinematics::{
    BodyMotion, all_legs, end_components, end_from_leg, end_from_platform, leg_motion,
    platform_motion,
};
use crate::reference::linear::pseudo_inverse;
use crate::reference::mechanism::{End, Leg, Mechanism};
use crate::reference::motion::Motion;
use crate::reference::placement::logarithm;
use nalgebra::{DMatrix, DVector};

/// Number of steps from the home pose.
const STEPS: usize = 8;
/// Largest closure residual of a solved leg, metres and radians.
const LARGEST_RESIDUAL: f64 = 1e-12;
/// Residual at which Newton's method stops, near rounding.
const EXACT: f64 = 3e-16;
/// Residual that is sufficient on the way to the pose.
const INTERMEDIATE_RESIDUAL: f64 = 1e-5;

/// Motion of a robot at an instant; joint vectors have the layout of [`Mechanism::variables`].
#[derive(Clone, Debug, PartialEq)]
pub struct State {
    /// Pose coordinates of the platform.
    pub pose: Vec<f64>,
    /// Twist coordinates v.
    pub twist: DVector<f64>,
    /// Their derivatives v̇.
    pub acceleration: DVector<f64>,
    /// Joint positions.
    pub q: DVector<f64>,
    /// Joint velocities.
    pub qd: DVector<f64>,
    /// Joint accelerations.
    pub qdd: DVector<f64>,
}

impl State {
    /// State of given platform motion, the joints in the working mode of the legs' start.
    ///
    /// Without a platform, pose, twist and acceleration are those of the joints.
    ///
    /// # Errors
    ///
    /// If a leg can't reach the pose or follow the motion.
    pub fn solve(
        mechanism: &Mechanism,
        pose: &[f64],
        twist: &DVector<f64>,
        acceleration: &DVector<f64>,
    ) -> Result<Self, Error> {
        let q = if mechanism.motion == Motion::None {
            DVector::from_column_slice(pose)
        } else {
            joint_positions(mechanism, pose)?
        };
        Self::with_joints(mechanism, pose, &q, twist, acceleration)
    }

    /// State of given platform motion, the joints near known ones: no walk from the home pose.
    ///
    /// # Errors
    ///
    /// If a leg can't reach the pose or follow the motion.
    pub fn solve_near(
        mechanism: &Mechanism,
        near: &DVector<f64>,
        pose: &[f64],
        twist: &DVector<f64>,
        acceleration: &DVector<f64>,
    ) -> Result<Self, Error> {
        if mechanism.motion == Motion::None {
            return Self::solve(mechanism, pose, twist, acceleration);
        }
        if !mechanism.motion.has_platform() {
            let q = chains::close(mechanism, pose, near)?;
            return Self::with_joints(mechanism, pose, &q, twist, acceleration);
        }
        let mut all = Vec::with_capacity(near.len());
        for (k, range) in mechanism.leg_ranges().into_iter().enumerate() {
            all.extend(close(mechanism, k, pose, &near.as_slice()[range])?);
        }
        Self::with_joints(
            mechanism,
            pose,
            &DVector::from_vec(all),
            twist,
            acceleration,
        )
    }

    /// State of given pose and joint positions that close the loops.
    ///
    /// # Errors
    ///
    /// If a leg can't follow the motion.
    pub fn with_joints(
        mechanism: &Mechanism,
        pose: &[f64],
        q: &DVector<f64>,
        twist: &DVector<f64>,
        acceleration: &DVector<f64>,
    ) -> Result<Self, Error> {
        let jacobians = Jacobians::at(mechanism, pose, q)?;
        let qd = &jacobians.joints * twist;
        let mut state = Self {
            pose: pose.to_vec(),
            twist: twist.clone(),
            acceleration: acceleration.clone(),
            q: q.clone(),
            qdd: DVector::zeros(qd.len()),
            qd,
        };
        state.qdd = joint_accelerations(mechanism, &state)?;
        Ok(state)
    }

    /// Motion of the platform.
    #[must_use]
    pub fn platform(&self, mechanism: &Mechanism) -> BodyMotion {
        if matches!(mechanism.motion, Motion::Parasitic(_)) {
            let still = BodyMotion::at_rest(mechanism.motion.placement(&self.pose));
            return parasitic_motion::platform(mechanism, self).unwrap_or(still);
        }
        platform_motion(
            &mechanism.motion,
            &self.pose,
            &self.twist,
            &self.acceleration,
        )
    }

    /// Motions of all leg bodies.
    #[must_use]
    pub fn legs(&self, mechanism: &Mechanism) -> Vec<Vec<BodyMotion>> {
        all_legs(mechanism, &self.q, &self.qd, &self.qdd)
    }

    /// Jacobians of this state.
    ///
    /// # Errors
    ///
    /// If a leg's Jacobian isn't square or the leg can't follow the platform.
    pub fn jacobians(&self, mechanism: &Mechanism) -> Result<Jacobians, Error> {
        Jacobians::at(mechanism, &self.pose, &self.q)
    }
}

/// Pose, and positions of all joints.
pub type PoseAndJoints = (Vec<f64>, DVector<f64>);

/// Pose and joints after a displacement of the independent coordinates, if the pose has others.
///
/// # Errors
///
/// If the loops do not close.
pub fn displaced(
    mechanism: &Mechanism,
    pose: &[f64],
    q: &DVector<f64>,
    step: &DVector<f64>,
) -> Result<Option<PoseAndJoints>, Error> {
    if matches!(mechanism.motion, Motion::Parasitic(_)) {
        return parasitic_motion::displaced(mechanism, pose, q, step).map(Some);
    }
    if mechanism.has_dependent_joints() {
        return chains::displaced(mechanism, q, step).map(Some);
    }
    Ok(None)
}

/// Joint positions at a pose, reached from the home pose in the legs' working mode (7).
///
/// # Errors
///
/// If a leg can't reach the pose.
pub fn joint_positions(mechanism: &Mechanism, pose: &[f64]) -> Result<DVector<f64>, Error> {
    if !mechanism.motion.has_platform() {
        return chains::positions(mechanism, pose);
    }
    let path = mechanism.motion.displacement(&mechanism.home, pose);
    let mut all = Vec::new();
    for (k, leg) in mechanism.legs.iter().enumerate() {
        if matches!(leg.end, End::Cable { .. }) {
            all.push(cables::length_at(mechanism, leg, pose));
            continue;
        }
        let mut q = leg.start.clone();
        for step in 0..STEPS {
            let part = &path * (step as f64 / STEPS as f64);
            let between = mechanism.motion.displace(&mechanism.home, &part);
            q = newton(mechanism, leg, &between, &q, INTERMEDIATE_RESIDUAL).0;
        }
        all.extend(close(mechanism, k, pose, &q)?);
    }
    Ok(DVector::from_vec(all))
}

/// Positions of one leg's variables at a pose, by damped Newton from `start`.
///
/// # Errors
///
/// If the residual stays above the tolerance.
pub fn close(
    mechanism: &Mechanism,
    k: usize,
    pose: &[f64],
    start: &[f64],
) -> Result<Vec<f64>, Error> {
    let leg = &mechanism.legs[k];
    if matches!(leg.end, End::Cable { .. }) {
        return Ok(vec![cables::length_at(mechanism, leg, pose)]);
    }
    let (q, residual) = newton(mechanism, leg, pose, start, EXACT);
    if residual < LARGEST_RESIDUAL {
        Ok(q)
    } else {
        Err(Error::NoConvergence { leg: k, residual })
    }
}

/// Damped Newton's method until the residual is small enough or stops decreasing; returns positions
/// and residual.
fn newton(
    mechanism: &Mechanism,
    leg: &Leg,
    pose: &[f64],
    start: &[f64],
    enough: f64,
) -> (Vec<f64>, f64) {
    let mut q = start.to_vec();
    let mut residual = closure_residual(mechanism, leg, pose, &q);
    for _ in 0..60 {
        if residual.is_empty() || residual.norm() < enough {
            break;
        }
        let mut step = pseudo_inverse(&end_jacobian(leg, &q)) * &residual;
        // Steps of at most half a unit keep the iteration in its working mode.
        step *= (0.5 / step.amax()).min(1.0);
        let Some((better, smaller)) = backtrack(mechanism, leg, pose, &q, &step, residual.norm())
        else {
            break;
        };
        (q, residual) = (better, smaller);
    }
    (q, residual.norm())
}

/// Halves a step until the residual decreases; `None` if it never does.
fn backtrack(
    mechanism: &Mechanism,
    leg: &Leg,
    pose: &[f64],
    q: &[f64],
    step: &DVector<f64>,
    size: f64,
) -> Option<(Vec<f64>, DVector<f64>)> {
    (0..12).find_map(|halvings| {
        let factor = 0.5_f64.powi(halvings);
        let moved: Vec<f64> = q.iter().zip(step).map(|(q, dq)| q + factor * dq).collect();
        let residual = closure_residual(mechanism, leg, pose, &moved);
        (residual.norm() < size).then_some((moved, residual))
    })
}

/// Remaining displacement of the leg's end to its place on the platform (7).
#[must_use]
pub fn closure_residual(mechanism: &Mechanism, leg: &Leg, pose: &[f64], q: &[f64]) -> DVector<f64> {
    let zero = vec![0.0; q.len()];
    let platform = BodyMotion::at_rest(mechanism.motion.placement(pose));
    let target = end_from_platform(leg, &platform).frame;
    let reached = end_from_leg(leg, &leg_motion(leg, q, &zero, &zero)).frame;
    let shift = target.position - reached.position;
    let turn = logarithm(&(target.rotation * reached.rotation.transpose()));
    let components = end_components(leg);
    let both = components.iter().map(|&at| [shift, turn][at / 3][at % 3]);
    DVector::from_iterator(components.len(), both)
}

/// Joint accelerations from the closure's second derivative (10).
fn joint_accelerations(mechanism: &Mechanism, state: &State) -> Result<DVector<f64>, Error> {
    if mechanism.motion == Motion::None {
        return Ok(state.acceleration.clone());
    }
    if !mechanism.motion.has_platform() {
        return chains::accelerations(mechanism, state);
    }
    if matches!(mechanism.motion, Motion::Parasitic(_)) {
        let [joints, _] = parasitic_motion::accelerations(mechanism, state)?;
        return Ok(joints);
    }
    let platform = state.platform(mechanism);
    let mut all = Vec::new();
    for (k, (leg, range)) in mechanism
        .legs
        .iter()
        .zip(mechanism.leg_ranges())
        .enumerate()
    {
        if matches!(leg.end, End::Cable { .. }) {
            let (twist, acceleration) = (&state.twist, &state.acceleration);
            all.push(cables::acceleration(
                mechanism,
                leg,
                &state.pose,
                twist,
                acceleration,
            ));
            continue;
        }
        let (q, qd) = (
            &state.q.as_slice()[range.clone()],
            &state.qd.as_slice()[range.clone()],
        );
        let still = vec![0.0; range.len()];
        let bias = end_from_leg(leg, &leg_motion(leg, q, qd, &still)).twist_derivative();
        let wanted = end_from_platform(leg, &platform).twist_derivative() - bias;
        let components = end_components(leg);
        let values = components.iter().map(|&at| wanted[at]);
        let wanted = DMatrix::from_iterator(components.len(), 1, values);
        all.extend(follow(k, &end_jacobian(leg, q), &wanted)?.iter());
    }
    Ok(DVector::from_vec(all))
}
