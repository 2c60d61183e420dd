//! Inverse kinematics by Newton's method, for legs that no closed form solves.
//!
//! Each leg's closure error e(x, q) is driven to zero with the generated leg Jacobian J_k, eq. (9):
//! J_k Δq = e. The iteration starts from the home configuration; when a leg does not follow, or changes
//! its working mode (the sign of its determinant), the way from the home pose is walked in more and
//! smaller steps.

use crate::{Error, SINGULAR};

/// A robot's legs and home configuration.
#[derive(Debug, Clone, Copy)]
pub struct Legs<'a> {
    /// Names.
    pub names: &'a [&'static str],
    /// Joints of each leg.
    pub joints: &'a [usize],
    /// Home pose.
    pub home_pose: &'a [f64],
    /// Home joint positions.
    pub home_joints: &'a [f64],
    /// Whether the pose ends with a quaternion.
    pub has_quaternion: bool,
}

/// Memory for [`solve`]: slices of lengths n_t, n_t², and of a pose.
#[derive(Debug)]
pub struct Workspace<'a> {
    /// n_t numbers.
    pub error: &'a mut [f64],
    /// n_t² numbers.
    pub jacobian: &'a mut [f64],
    /// One pose.
    pub pose: &'a mut [f64],
}

const ITERATIONS: usize = 30;
const TOLERANCE: f64 = 1e-13;
const LONGEST_STEP: f64 = 0.5;

/// Finds the joint positions of a pose in the working mode of the home configuration. `evaluate` writes
/// the closure error (n_t) and J_k (n_t x n_t, row-major) of a pose and joint positions. The pose is finite:
/// the caller has seen to that.
///
/// # Errors
/// [`Error::OutOfReach`] or [`Error::SingularLeg`] of the leg that does not follow.
pub fn solve(
    legs: Legs<'_>,
    pose: &[f64],
    joints: &mut [f64],
    workspace: Workspace<'_>,
    mut evaluate: impl FnMut(&[f64], &[f64], &mut [f64], &mut [f64]) -> Result<(), Error>,
) -> Result<(), Error> {
    let Workspace {
        error,
        jacobian,
        pose: way,
    } = workspace;
    let mut result = Ok(());
    for steps in [1_u32, 8, 64] {
        joints.copy_from_slice(legs.home_joints);
        result = Ok(());
        for step in 1..=steps {
            between(&legs, pose, f64::from(step) / f64::from(steps), way);
            result = newton(&legs, way, joints, error, jacobian, &mut evaluate);
            if result.is_err() {
                break;
            }
        }
        if result.is_ok() {
            result = same_mode(&legs, pose, joints, error, jacobian, &mut evaluate);
        }
        if result.is_ok() {
            return result;
        }
    }
    result
}

/// The pose a part of the way from home.
fn between(legs: &Legs<'_>, pose: &[f64], part: f64, way: &mut [f64]) {
    for ((w, h), p) in way.iter_mut().zip(legs.home_pose).zip(pose) {
        *w = if part >= 1.0 { *p } else { h + part * (p - h) };
    }
    if legs.has_quaternion {
        let start = way.len().saturating_sub(4);
        let norm = crate::math::sqrt(way[start..].iter().map(|q| q * q).sum());
        way[start..].iter_mut().for_each(|q| *q /= norm);
    }
}

fn newton(
    legs: &Legs<'_>,
    pose: &[f64],
    joints: &mut [f64],
    error: &mut [f64],
    jacobian: &mut [f64],
    evaluate: &mut impl FnMut(&[f64], &[f64], &mut [f64], &mut [f64]) -> Result<(), Error>,
) -> Result<(), Error> {
    let total = joints.len();
    for _ in 0..ITERATIONS {
        evaluate(pose, joints, error, jacobian)?;
        let mut start = 0;
        let mut largest = 0.0_f64;
        for (leg, &count) in legs.joints.iter().enumerate() {
            let range = start..start + count;
            let (_, condition) = eliminate(jacobian, error, total, range.clone());
            if condition.is_nan() || condition * SINGULAR > 1.0 {
                return Err(Error::SingularLeg {
                    leg: legs.names[leg],
                    condition,
                });
            }
            let step = error[range.clone()]
                .iter()
                .fold(0.0_f64, |m, s| m.max(s.abs()));
            let scale = if step > LONGEST_STEP {
                LONGEST_STEP / step
            } else {
                1.0
            };
            for (q, s) in joints[range.clone()].iter_mut().zip(&error[range]) {
                *q += scale * s;
            }
            largest = largest.max(step);
            start += count;
        }
        if largest < TOLERANCE {
            return Ok(());
        }
    }
    // The leg whose error is the largest is the one that cannot follow.
    evaluate(pose, joints, error, jacobian)?;
    let mut start = 0;
    let mut worst = (0, 0.0);
    for (leg, &count) in legs.joints.iter().enumerate() {
        let size = error[start..start + count]
            .iter()
            .fold(0.0_f64, |m, e| m.max(e.abs()));
        if size > worst.1 {
            worst = (leg, size);
        }
        start += count;
    }
    if worst.1 < 1e-10 {
        Ok(())
    } else {
        Err(Error::OutOfReach {
            leg: legs.names[worst.0],
        })
    }
}

/// Whether every leg's determinant has the sign that it has at home.
fn same_mode(
    legs: &Legs<'_>,
    pose: &[f64],
    joints: &[f64],
    error: &mut [f64],
    jacobian: &mut [f64],
    evaluate: &mut impl FnMut(&[f64], &[f64], &mut [f64], &mut [f64]) -> Result<(), Error>,
) -> Result<(), Error> {
    let total = joints.len();
    let mut start = 0;
    for (leg, &count) in legs.joints.iter().enumerate() {
        let range = start..start + count;
        evaluate(legs.home_pose, legs.home_joints, error, jacobian)?;
        let (home, _) = eliminate(jacobian, error, total, range.clone());
        evaluate(pose, joints, error, jacobian)?;
        let (here, condition) = eliminate(jacobian, error, total, range);
        if home * here <= 0.0 {
            return Err(Error::SingularLeg {
                leg: legs.names[leg],
                condition,
            });
        }
        start += count;
    }
    Ok(())
}

/// Solves the diagonal block `range` of a system in place by Gaussian elimination with row pivoting;
/// returns the sign of the block's determinant and the ratio of its largest and smallest pivots.
fn eliminate(
    matrix: &mut [f64],
    vector: &mut [f64],
    total: usize,
    range: core::ops::Range<usize>,
) -> (f64, f64) {
    let mut sign = 1.0;
    let (mut largest, mut smallest) = (0.0_f64, f64::INFINITY);
    for k in range.clone() {
        let mut pivot_row = k;
        for row in k + 1..range.end {
            if matrix[row * total + k].abs() > matrix[pivot_row * total + k].abs() {
                pivot_row = row;
            }
        }
        if pivot_row != k {
            for column in range.clone() {
                matrix.swap(k * total + column, pivot_row * total + column);
            }
            vector.swap(k, pivot_row);
            sign = -sign;
        }
        let pivot = matrix[k * total + k];
        largest = largest.max(pivot.abs());
        smallest = smallest.min(pivot.abs());
        if pivot == 0.0 || !pivot.is_finite() {
            return (0.0, f64::INFINITY);
        }
        if pivot < 0.0 {
            sign = -sign;
        }
        for row in k + 1..range.end {
            let factor = matrix[row * total + k] / pivot;
            for column in k..range.end {
                matrix[row * total + column] -= factor * matrix[k * total + column];
            }
            vector[row] -= factor * vector[k];
        }
    }
    for k in range.clone().rev() {
        for column in k + 1..range.end {
            vector[k] -= matrix[k * total + column] * vector[column];
        }
        vector[k] /= matrix[k * total + k];
    }
    (sign, largest / smallest)
}
