//! Poses of skeletons with dependent joints: some joints are independent, the chains determine the
//! others.

use crate::Error;
use crate::float::Float;
use crate::inverse::System;

/// Largest number of Newton steps.
const STEPS: usize = 40;
/// Largest Newton step (m, rad): longer ones may lead to another assembly mode.
const LONGEST_STEP: f64 = 0.5;
/// Largest displacement of an independent joint (m, rad) after which the others are corrected.
const LONGEST_PART: f64 = 0.2;
/// Largest number of parts of a displacement.
const PARTS: u32 = 100;

/// Memory for [`displace`], for d dependent ones of p joints: slices of lengths d, d p, d².
#[derive(Debug)]
pub struct Workspace<'a, T = f64> {
    /// d numbers.
    pub errors: &'a mut [T],
    /// d p numbers.
    pub jacobian: &'a mut [T],
    /// d² numbers.
    pub square: &'a mut [T],
}

/// Displaces the independent joints of a pose, and corrects the others until the chains close.
///
/// `step` are the displacements of the joints whose indices in the pose are given. Newton's method
/// finds the others. `evaluate` writes the closure errors of a pose, and their derivatives with
/// respect to all joints of the pose (row-major). Long displacements are divided, so that the
/// assembly mode stays. If the iteration does not converge, the dependent joints have the smallest
/// errors found; functions reject the pose if it is not closed.
pub fn displace<T: Float>(
    pose: &mut [T],
    step: &[T],
    independent: &[usize],
    workspace: Workspace<'_, T>,
    mut evaluate: impl FnMut(&[T], &mut [T], &mut [T]) -> Result<(), Error>,
) {
    let Workspace {
        errors,
        jacobian,
        square,
    } = workspace;
    let longest = largest(step);
    let mut parts = 1;
    while parts < PARTS && longest > T::of(LONGEST_PART * f64::from(parts)) {
        parts += 1;
    }
    for _ in 0..parts {
        for (&at, step) in independent.iter().zip(step) {
            if let Some(joint) = pose.get_mut(at) {
                *joint += *step / T::of(f64::from(parts));
            }
        }
        let matrices = Workspace {
            errors: &mut *errors,
            jacobian: &mut *jacobian,
            square: &mut *square,
        };
        if !close(pose, independent, matrices, &mut evaluate) {
            return;
        }
    }
}

/// Corrects the dependent joints of a pose until the chains close; whether the iteration converges.
///
/// A step that does not reduce the largest error is halved, so that a pose near a dead centre is
/// not left for one that is less closed.
fn close<T: Float>(
    pose: &mut [T],
    independent: &[usize],
    workspace: Workspace<'_, T>,
    mut evaluate: impl FnMut(&[T], &mut [T], &mut [T]) -> Result<(), Error>,
) -> bool {
    let Workspace {
        errors,
        jacobian,
        square,
    } = workspace;
    let joints = pose.len();
    let count = joints.saturating_sub(independent.len());
    let dependent = || (0..joints).filter(|at| !independent.contains(at));
    // Takes a part of the last step back, whose negative rest stays at the start of `square`.
    let take_back = |pose: &mut [T], square: &mut [T], part: f64| {
        for (at, step) in dependent().zip(square) {
            if let Some(joint) = pose.get_mut(at) {
                *joint -= *step * T::of(part);
            }
            *step -= *step * T::of(part);
        }
    };
    let mut before: Option<T> = None;
    for _ in 0..STEPS {
        let is_evaluated = evaluate(pose, errors, jacobian).is_ok();
        let size = largest(errors);
        let is_closer = is_evaluated && before.is_none_or(|before| size < before);
        match before {
            None if !is_closer => return false,
            Some(_) if !is_closer => {
                take_back(pose, square, 0.5);
                continue;
            }
            _ => before = Some(size),
        }
        let rows = square.chunks_exact_mut(count.max(1));
        for (row, of_pose) in rows.zip(jacobian.chunks_exact(joints.max(1))) {
            for (entry, at) in row.iter_mut().zip(dependent()) {
                *entry = of_pose.get(at).copied().unwrap_or(T::ZERO);
            }
        }
        let _ = System::new(count, square, errors).eliminate(0..count);
        if errors.iter().any(|error| !error.is_finite()) {
            return false;
        }
        let longest = largest(errors);
        if longest < T::of(T::LIMITS.joint_step) {
            return true;
        }
        let scale = if longest > T::of(LONGEST_STEP) {
            T::of(LONGEST_STEP) / longest
        } else {
            T::of(1.0)
        };
        for ((at, error), step) in dependent().zip(errors.iter()).zip(square.iter_mut()) {
            *step = -scale * *error;
            if let Some(joint) = pose.get_mut(at) {
                *joint += *step;
            }
        }
    }
    take_back(pose, square, 1.0);
    false
}

/// Largest magnitude of the numbers.
fn largest<T: Float>(numbers: &[T]) -> T {
    numbers
        .iter()
        .fold(T::ZERO, |m, number| m.max(number.abs()))
}

#[cfg(test)]
mod tests {
    use super::{Workspace, displace};

    /// A point on the unit circle whose abscissa is independent.
    fn moved(pose: &mut [f64; 2], step: f64) {
        let workspace = Workspace {
            errors: &mut [0.0; 1],
            jacobian: &mut [0.0; 2],
            square: &mut [0.0; 1],
        };
        displace::<f64>(pose, &[step], &[0], workspace, |pose, errors, jacobian| {
            errors.copy_from_slice(&[pose[0] * pose[0] + pose[1] * pose[1] - 1.0]);
            jacobian.copy_from_slice(&[2.0 * pose[0], 2.0 * pose[1]]);
            Ok(())
        });
    }

    #[test]
    fn dependent_joints_follow_the_closure() {
        let mut pose = [0.0, 1.0];
        moved(&mut pose, 0.6);
        assert!((pose[0] - 0.6).abs() < 1e-15, "{pose:?}");
        assert!((pose[1] - 0.8).abs() < 1e-13, "{pose:?}");
    }

    #[test]
    fn poses_that_cannot_be_closed_stay_finite() {
        let mut pose = [0.0, 1.0];
        moved(&mut pose, 2.0);
        assert!(pose.iter().all(|number| number.is_finite()), "{pose:?}");
    }

    /// The unit circle ends where the abscissa is 1. A pose just beyond it has an error that no
    /// ordinate removes.
    #[test]
    fn poses_near_a_dead_centre_do_not_become_less_closed() {
        for beyond in [1e-12, 1e-9, 1e-7] {
            for height in [1e-4, 1e-6, 1e-8] {
                let mut pose = [1.0 + beyond, height];
                let error = |pose: &[f64; 2]| pose[0] * pose[0] + pose[1] * pose[1] - 1.0;
                let before = error(&pose).abs();
                moved(&mut pose, 0.0);
                let after = error(&pose).abs();
                assert!(
                    after <= before * (1.0 + 1e-9),
                    "{before:e} became {after:e}"
                );
            }
        }
    }
}
