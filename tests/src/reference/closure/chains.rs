//! Robots with loops between bodies of a tree, closed by cut equations.
//!
//! All joints are free at first; every loop is a cut that equations between two bodies close again.
//! The equations of all cuts, Φ q̇ = 0, and those of the independent joints are solved together by
//! least squares. Positions of the other joints come from Newton's method on the same equations.
//! The equations of a cut are expressed in the axes of the body where its chain starts.

use super::State;
use crate::reference::Error;
use crate::reference::jacobians::{Jacobians, end_jacobian, end_rows, longest_rows};
use crate::reference::kinematics::{
    BodyMotion, all_legs, end_components, end_from_leg, end_from_platform,
};
use crate::reference::linear::pseudo_inverse;
use crate::reference::mechanism::{Leg, Mechanism};
use crate::reference::motors::transmission;
use crate::reference::placement::{Frame, logarithm};
use nalgebra::{DMatrix, DVector, Vector6};

/// Relative residual of the equations up to which it counts as rounding.
const CONSISTENCY: f64 = 1e-9;
/// Largest distance of the two sides of a cut, metres and radians.
const LARGEST_GAP: f64 = 1e-12;
/// Residual at which Newton's method stops, near rounding.
const EXACT: f64 = 3e-16;
/// Steps from the home pose.
const STEPS: usize = 8;

/// Spatial vector in other axes.
fn in_axes(axes: &Frame, of: &Vector6<f64>) -> Vector6<f64> {
    let into = axes.rotation.transpose();
    let (linear, angular) = (into * of.fixed_rows::<3>(0), into * of.fixed_rows::<3>(3));
    Vector6::new(
        linear.x, linear.y, linear.z, angular.x, angular.y, angular.z,
    )
}

/// Motions of both sides of a chain's cut, and the frame of its equations.
fn sides(leg: &Leg, k: usize, bodies: &[Vec<BodyMotion>]) -> (BodyMotion, BodyMotion, Frame) {
    let other = leg.body.map_or(bodies[0][0], |(of, body)| bodies[of][body]);
    let axes = leg
        .carrier
        .map_or_else(Frame::identity, |(of, body)| bodies[of][body].frame);
    let own = end_from_leg(leg, &bodies[k]);
    (own, end_from_platform(leg, &other), axes)
}

/// For all cuts: a quantity of both sides, in the constrained components.
fn of_cuts(
    mechanism: &Mechanism,
    bodies: &[Vec<BodyMotion>],
    difference: impl Fn(&BodyMotion, &BodyMotion) -> Vector6<f64>,
) -> DVector<f64> {
    let mut all = Vec::new();
    for (k, leg) in mechanism.legs.iter().enumerate() {
        let components = end_components(leg);
        if components.is_empty() {
            continue;
        }
        let (own, other, axes) = sides(leg, k, bodies);
        let values = in_axes(&axes, &difference(&own, &other));
        all.extend(components.into_iter().map(|at| values[at]));
    }
    DVector::from_vec(all)
}

/// Φ: relative velocity of the sides of all cuts for unit joint rates.
fn cuts(mechanism: &Mechanism, q: &DVector<f64>) -> DMatrix<f64> {
    let zero = DVector::zeros(q.len());
    let columns: Vec<DVector<f64>> = (0..q.len())
        .map(|at| {
            let mut unit = zero.clone();
            unit[at] = 1.0;
            let bodies = all_legs(mechanism, q, &unit, &zero);
            of_cuts(mechanism, &bodies, |own, other| own.twist() - other.twist())
        })
        .collect();
    DMatrix::from_columns(&columns)
}

/// Equations of the cuts above those of the independent joints.
fn equations(mechanism: &Mechanism, cuts: &DMatrix<f64>) -> DMatrix<f64> {
    let own = mechanism.independent();
    let mut all = DMatrix::zeros(cuts.nrows() + own.len(), cuts.ncols());
    all.rows_mut(0, cuts.nrows()).copy_from(cuts);
    for (row, at) in own.into_iter().enumerate() {
        all[(cuts.nrows() + row, at)] = 1.0;
    }
    all
}

/// Solves for all joints from the cuts and the independent joints.
fn solve(matrix: &DMatrix<f64>, sides: &DMatrix<f64>) -> Result<DMatrix<f64>, Error> {
    let found = pseudo_inverse(matrix) * sides;
    let residual = (matrix * &found - sides).amax() / (1.0 + sides.amax() + found.amax());
    if residual < CONSISTENCY {
        Ok(found)
    } else {
        Err(Error::Inconsistent { leg: 0, residual })
    }
}

/// Jacobians at joint positions that close all loops.
///
/// # Errors
///
/// If a chain's Jacobian isn't square, or its equations contradict the independent joints.
pub fn jacobians(mechanism: &Mechanism, q: &DVector<f64>) -> Result<Jacobians, Error> {
    let (total, dof) = (mechanism.joints(), mechanism.dof());
    let transmission = transmission(mechanism);
    let n = transmission.nrows();
    let cuts = cuts(mechanism, q);
    let mut wanted = DMatrix::zeros(cuts.nrows() + dof, dof);
    wanted.rows_mut(cuts.nrows(), dof).fill_with_identity();
    let joints = solve(&equations(mechanism, &cuts), &wanted)?;
    let mut all = Jacobians {
        attachments: DMatrix::zeros(cuts.nrows(), dof),
        legs: DMatrix::zeros(total, total),
        platform: DMatrix::zeros(total, dof),
        inverse: &transmission * &joints,
        joints,
        a_p: DMatrix::zeros(n, dof),
        b_p: DMatrix::zeros(n, n),
        actuated: mechanism.actuated(),
        transmission,
        ends: cuts,
    };
    let mut first = 0;
    for (k, (leg, range)) in mechanism
        .legs
        .iter()
        .zip(mechanism.leg_ranges())
        .enumerate()
    {
        let count = end_components(leg).len();
        let (square, kept) = if count == 0 {
            let own = all.joints.rows(range.start, range.len()).into_owned();
            (DMatrix::identity(range.len(), range.len()), own)
        } else {
            let rows = if mechanism.has_dependent_joints() {
                longest_rows(&end_jacobian(leg, &leg.start))
            } else {
                end_rows(k, leg)?
            };
            let own = all.ends.rows(first, count).select_rows(&rows);
            let square = own.columns(range.start, range.len()).into_owned();
            let before = all.joints.rows(0, range.start);
            (square, -own.columns(0, range.start) * before)
        };
        all.legs
            .view_mut((range.start, range.start), square.shape())
            .copy_from(&square);
        all.platform
            .rows_mut(range.start, range.len())
            .copy_from(&kept);
        all.reduce(range.start, &square, &kept);
        first += count;
    }
    all.reduce_motors();
    Ok(all)
}

/// Accelerations of all joints: the cuts stay closed, the independent joints have theirs.
///
/// # Errors
///
/// If the equations contradict each other.
pub fn accelerations(mechanism: &Mechanism, state: &State) -> Result<DVector<f64>, Error> {
    let cuts = cuts(mechanism, &state.q);
    let still = DVector::zeros(state.q.len());
    let bodies = all_legs(mechanism, &state.q, &state.qd, &still);
    let bias = of_cuts(mechanism, &bodies, |own, other| {
        own.twist_derivative() - other.twist_derivative()
    });
    let wanted: Vec<f64> = (-bias).iter().chain(&state.acceleration).copied().collect();
    let sides = DMatrix::from_vec(wanted.len(), 1, wanted);
    let found = solve(&equations(mechanism, &cuts), &sides)?;
    Ok(found.column(0).into_owned())
}

/// Residuals of all cuts.
#[must_use]
pub fn gaps(mechanism: &Mechanism, q: &DVector<f64>) -> DVector<f64> {
    let still = DVector::zeros(q.len());
    let bodies = all_legs(mechanism, q, &still, &still);
    of_cuts(mechanism, &bodies, |own, other| {
        let shift = own.frame.position - other.frame.position;
        let turn = logarithm(&(own.frame.rotation * other.frame.rotation.transpose()));
        Vector6::new(shift.x, shift.y, shift.z, turn.x, turn.y, turn.z)
    })
}

/// Positions of all joints at a pose, reached from home in steps.
///
/// # Errors
///
/// If a loop does not close.
pub fn positions(mechanism: &Mechanism, pose: &[f64]) -> Result<DVector<f64>, Error> {
    let start = mechanism.legs.iter().flat_map(|leg| leg.start.clone());
    let mut q = DVector::from_iterator(mechanism.joints(), start);
    let path = mechanism.motion.displacement(&mechanism.home, pose);
    for step in 1..STEPS {
        let part = &path * (step as f64 / STEPS as f64);
        let between = mechanism.motion.displace(&mechanism.home, &part);
        q = newton(mechanism, &mechanism.in_pose(), &between, &q, 1e-5).0;
    }
    close(mechanism, pose, &q)
}

/// Positions of all joints at a pose, near known ones.
///
/// # Errors
///
/// If a loop does not close.
pub fn close(
    mechanism: &Mechanism,
    pose: &[f64],
    near: &DVector<f64>,
) -> Result<DVector<f64>, Error> {
    let (q, residual) = newton(mechanism, &mechanism.in_pose(), pose, near, EXACT);
    if residual < LARGEST_GAP {
        Ok(q)
    } else {
        Err(Error::NoConvergence { leg: 0, residual })
    }
}

/// Pose and joints after a displacement of the independent joints, reached in steps.
///
/// # Errors
///
/// If a loop does not close.
pub fn displaced(
    mechanism: &Mechanism,
    near: &DVector<f64>,
    step: &DVector<f64>,
) -> Result<(Vec<f64>, DVector<f64>), Error> {
    let own = mechanism.independent();
    let (mut q, mut residual) = (near.clone(), f64::INFINITY);
    for part in 1..=STEPS {
        let part = part as f64 / STEPS as f64;
        let moved = own
            .iter()
            .zip(step)
            .map(|(&at, step)| near[at] + part * step);
        let moved: Vec<f64> = moved.collect();
        (q, residual) = newton(mechanism, &own, &moved, &q, EXACT);
    }
    if residual < LARGEST_GAP {
        let pose = mechanism.in_pose().into_iter().map(|at| q[at]);
        Ok((pose.collect(), q))
    } else {
        Err(Error::NoConvergence { leg: 0, residual })
    }
}

/// Damped Newton's method on all cuts at once with some joints at given positions.
fn newton(
    mechanism: &Mechanism,
    own: &[usize],
    positions: &[f64],
    near: &DVector<f64>,
    enough: f64,
) -> (DVector<f64>, f64) {
    let mut q = near.clone();
    for (&at, &position) in own.iter().zip(positions) {
        q[at] = position;
    }
    let chains: Vec<usize> = (0..q.len()).filter(|at| !own.contains(at)).collect();
    let mut gap = gaps(mechanism, &q);
    for _ in 0..60 {
        if gap.norm() < enough {
            break;
        }
        let jacobian = cuts(mechanism, &q).select_columns(&chains);
        let mut step = pseudo_inverse(&jacobian) * -&gap;
        step *= (0.5 / step.amax()).min(1.0);
        let better = (0..12).find_map(|halvings| {
            let mut moved = q.clone();
            for (&at, change) in chains.iter().zip(&step) {
                moved[at] += 0.5_f64.powi(halvings) * change;
            }
            let left = gaps(mechanism, &moved);
            (left.norm() < gap.norm()).then_some((moved, left))
        });
        let Some((moved, left)) = better else { break };
        (q, gap) = (moved, left);
    }
    (q, gap.norm())
}
