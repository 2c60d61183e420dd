//! Platforms with parasitic motion: a free body and all joints, closed by the equations of all leg
//! ends.
//!
//! No leg is solved separately, and no matrix of the dependent coordinates is formed. Let Φ be the
//! derivative of all end equations by the joint rates and the platform's twist t. Φ [q̇; t] = 0 and
//! S t = v, which selects the independent components, are solved together by least squares. The
//! result is the null space of Φ in the basis with unit independent components. Accelerations use
//! the same matrix with the bias accelerations of both sides of every end.

use super::{State, closure_residual};
use crate::reference::Error;
use crate::reference::jacobians::{Jacobians, attachment_jacobian, end_jacobian, longest_rows};
use crate::reference::kinematics::{
    BodyMotion, end_components, end_equations, end_from_leg, end_from_platform, leg_motion,
    platform_motion,
};
use crate::reference::linear::pseudo_inverse;
use crate::reference::mechanism::{Leg, Mechanism};
use crate::reference::motion::Motion;
use crate::reference::motors::transmission;
use nalgebra::{DMatrix, DVector};

/// Relative residual of the equations up to which it counts as rounding.
const CONSISTENCY: f64 = 1e-9;
/// Largest closure residual, metres and radians.
const LARGEST_RESIDUAL: f64 = 1e-12;
/// Residual at which Newton's method stops, near rounding.
const EXACT: f64 = 3e-16;
/// Continuation steps to a pose.
const STEPS: usize = 8;

/// The robot with a free platform, whose six components are all independent.
#[must_use]
pub fn with_free_platform(mechanism: &Mechanism) -> Mechanism {
    Mechanism {
        motion: Motion::Spatial,
        ..mechanism.clone()
    }
}

/// Φ: velocity of each end relative to its place, for unit joint rates and unit components of t.
fn closures(free: &Mechanism, pose: &[f64], q: &DVector<f64>) -> DMatrix<f64> {
    let equations: usize = free.legs.iter().map(end_equations).sum();
    let joints = free.joints();
    let mut all = DMatrix::zeros(equations, joints + 6);
    let mut first = 0;
    for (leg, range) in free.legs.iter().zip(free.leg_ranges()) {
        let end = end_jacobian(leg, &q.as_slice()[range.clone()]);
        let place = attachment_jacobian(free, leg, pose);
        all.view_mut((first, range.start), end.shape())
            .copy_from(&end);
        all.view_mut((first, joints), place.shape())
            .copy_from(&-place);
        first += end.nrows();
    }
    all
}

/// Selection matrix of the independent components.
fn selection(mechanism: &Mechanism, joints: usize) -> DMatrix<f64> {
    let own = mechanism.motion.independent();
    let mut rows = DMatrix::zeros(own.len(), joints + 6);
    for (row, at) in own.into_iter().enumerate() {
        rows[(row, joints + at)] = 1.0;
    }
    rows
}

/// Solves the closures with the independent components for given right-hand sides.
fn solve(
    mechanism: &Mechanism,
    closures: &DMatrix<f64>,
    sides: [&DMatrix<f64>; 2],
) -> Result<DMatrix<f64>, Error> {
    let own = selection(mechanism, mechanism.joints());
    let matrix = stacked(closures, &own);
    let sides = stacked(sides[0], sides[1]);
    let found = pseudo_inverse(&matrix) * &sides;
    let residual = (matrix * &found - &sides).amax() / (1.0 + sides.amax() + found.amax());
    if residual < CONSISTENCY {
        Ok(found)
    } else {
        Err(Error::Inconsistent { leg: 0, residual })
    }
}

fn stacked(above: &DMatrix<f64>, below: &DMatrix<f64>) -> DMatrix<f64> {
    let mut all = DMatrix::zeros(above.nrows() + below.nrows(), above.ncols());
    all.rows_mut(0, above.nrows()).copy_from(above);
    all.rows_mut(above.nrows(), below.nrows()).copy_from(below);
    all
}

/// Rates of all joints (n_t x r), and D of t = D v (6 x r).
///
/// # Errors
///
/// If the closures contradict the independent components.
pub fn rates(
    mechanism: &Mechanism,
    pose: &[f64],
    q: &DVector<f64>,
) -> Result<[DMatrix<f64>; 2], Error> {
    let closures = closures(&with_free_platform(mechanism), pose, q);
    let dof = mechanism.dof();
    let still = DMatrix::zeros(closures.nrows(), dof);
    let found = solve(mechanism, &closures, [&still, &DMatrix::identity(dof, dof)])?;
    let joints = mechanism.joints();
    Ok([
        found.rows(0, joints).into_owned(),
        found.rows(joints, 6).into_owned(),
    ])
}

/// Accelerations of all joints, and ṫ.
///
/// # Errors
///
/// If the closures contradict the independent components.
pub fn accelerations(mechanism: &Mechanism, state: &State) -> Result<[DVector<f64>; 2], Error> {
    let free = with_free_platform(mechanism);
    let closures = closures(&free, &state.pose, &state.q);
    let [_, velocities] = rates(mechanism, &state.pose, &state.q)?;
    let twist = velocities * &state.twist;
    let platform = platform_motion(&free.motion, &state.pose, &twist, &DVector::zeros(6));
    let mut wanted = Vec::new();
    for (leg, range) in free.legs.iter().zip(free.leg_ranges()) {
        let [q, qd] = [&state.q, &state.qd].map(|all| &all.as_slice()[range.clone()]);
        let still = vec![0.0; range.len()];
        let own = end_from_leg(leg, &leg_motion(leg, q, qd, &still)).twist_derivative();
        let bias = end_from_platform(leg, &platform).twist_derivative() - own;
        wanted.extend(end_components(leg).into_iter().map(|at| bias[at]));
    }
    let bias = DMatrix::from_vec(wanted.len(), 1, wanted);
    let own = DMatrix::from_column_slice(mechanism.dof(), 1, state.acceleration.as_slice());
    let found = solve(mechanism, &closures, [&bias, &own])?;
    let joints = mechanism.joints();
    let part = |from: usize, count: usize| found.rows(from, count).column(0).into_owned();
    Ok([part(0, joints), part(joints, 6)])
}

/// Motion of the platform.
///
/// # Errors
///
/// If the closures contradict the independent components.
pub fn platform(mechanism: &Mechanism, state: &State) -> Result<BodyMotion, Error> {
    let [_, velocities] = rates(mechanism, &state.pose, &state.q)?;
    let [_, growth] = accelerations(mechanism, state)?;
    let twist = velocities * &state.twist;
    Ok(platform_motion(
        &Motion::Spatial,
        &state.pose,
        &twist,
        &growth,
    ))
}

/// Jacobians at a pose and at joint positions that close the loops.
///
/// `attachments` are those of the free platform, with six columns, so that its wrench is not
/// projected.
///
/// # Errors
///
/// If the closures contradict the independent components.
pub fn jacobians(
    mechanism: &Mechanism,
    pose: &[f64],
    q: &DVector<f64>,
) -> Result<Jacobians, Error> {
    let free = with_free_platform(mechanism);
    let (total, dof) = (mechanism.joints(), mechanism.dof());
    let transmission = transmission(mechanism);
    let n = transmission.nrows();
    let [joints, velocities] = rates(mechanism, pose, q)?;
    let all = closures(&free, pose, q);
    let mut jacobians = Jacobians {
        ends: all.columns(0, total).into_owned(),
        attachments: -all.columns(total, 6).into_owned(),
        legs: DMatrix::zeros(total, total),
        platform: DMatrix::zeros(total, dof),
        inverse: &transmission * &joints,
        joints,
        a_p: DMatrix::zeros(n, dof),
        b_p: DMatrix::zeros(n, n),
        actuated: mechanism.actuated(),
        transmission,
    };
    let mut first = 0;
    for (leg, range) in mechanism.legs.iter().zip(mechanism.leg_ranges()) {
        let count = end_equations(leg);
        let rows: Vec<usize> = longest_rows(&end_jacobian(leg, &leg.start))
            .into_iter()
            .map(|row| first + row)
            .collect();
        let square = jacobians.ends.select_rows(&rows);
        let square = square.columns(range.start, range.len()).into_owned();
        let kept = jacobians.attachments.select_rows(&rows) * &velocities;
        jacobians
            .legs
            .view_mut((range.start, range.start), square.shape())
            .copy_from(&square);
        jacobians
            .platform
            .rows_mut(range.start, range.len())
            .copy_from(&kept);
        jacobians.reduce(range.start, &square, &kept);
        first += count;
    }
    jacobians.reduce_motors();
    Ok(jacobians)
}

/// Pose after a displacement of the independent components, with joints that close the loops.
///
/// The dependent components of the displacement are solved for at the same time. The start must be
/// closed.
///
/// # Errors
///
/// If the loops do not close.
pub fn displaced(
    mechanism: &Mechanism,
    pose: &[f64],
    near: &DVector<f64>,
    step: &DVector<f64>,
) -> Result<(Vec<f64>, DVector<f64>), Error> {
    let free = with_free_platform(mechanism);
    let own = mechanism.motion.independent();
    let others: Vec<usize> = (0..6).filter(|at| !own.contains(at)).collect();
    let mut whole = DVector::zeros(6);
    let mut q = near.clone();
    let mut left = f64::INFINITY;
    for part in 1..=STEPS {
        for (&at, step) in own.iter().zip(step) {
            whole[at] = step * part as f64 / STEPS as f64;
        }
        left = solve_closures(&free, pose, &others, &mut whole, &mut q);
    }
    if left < LARGEST_RESIDUAL {
        Ok((free.motion.displace(pose, &whole), q))
    } else {
        Err(Error::NoConvergence {
            leg: 0,
            residual: left,
        })
    }
}

/// Newton's method on all leg ends, in the joints and the dependent displacement components;
/// returns the residual.
fn solve_closures(
    free: &Mechanism,
    from: &[f64],
    others: &[usize],
    whole: &mut DVector<f64>,
    q: &mut DVector<f64>,
) -> f64 {
    let joints = free.joints();
    let mut best = f64::INFINITY;
    let mut since = 0;
    for step in 0..60 {
        let pose = free.motion.displace(from, whole);
        let residual = residual(free, &pose, q);
        let size = residual.norm();
        if size < 0.9 * best {
            (best, since) = (size, step);
        }
        if size < EXACT || step > since + 4 || !size.is_finite() {
            return size;
        }
        let all = closures(free, &pose, q);
        let columns: Vec<usize> = (0..joints)
            .chain(others.iter().map(|at| joints + at))
            .collect();
        let moved = pseudo_inverse(&all.select_columns(&columns)) * residual;
        *q += moved.rows(0, joints);
        for (&at, change) in others.iter().zip(moved.iter().skip(joints)) {
            whole[at] += change;
        }
    }
    best
}

/// Remaining displacement of all ends.
fn residual(free: &Mechanism, pose: &[f64], q: &DVector<f64>) -> DVector<f64> {
    let legs = free.legs.iter().zip(free.leg_ranges());
    let of_leg = |(leg, range): (&Leg, std::ops::Range<usize>)| {
        closure_residual(free, leg, pose, &q.as_slice()[range])
    };
    let all: Vec<f64> = legs
        .flat_map(|leg| of_leg(leg).as_slice().to_vec())
        .collect();
    DVector::from_vec(all)
}

/// The legs' joints at home.
#[must_use]
pub fn start(mechanism: &Mechanism) -> DVector<f64> {
    let all: Vec<f64> = mechanism
        .legs
        .iter()
        .flat_map(|leg| leg.start.clone())
        .collect();
    DVector::from_vec(all)
}
