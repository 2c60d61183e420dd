//! Poses of platforms with parasitic motion: some coordinates are independent, the legs' closures
//! give the others.

use crate::Error;
use crate::float::Float;
use crate::forward::displace_quaternion;
use crate::inverse::System;

/// Number of velocity components of a free body.
const SIX: usize = 6;
/// Numbers in a pose.
const POSE: usize = 7;
/// Largest number of steps.
const STEPS: usize = 40;
/// Largest step (m, rad): longer ones may lead to another assembly mode.
const LONGEST_STEP: f64 = 0.5;

/// Displaces a pose along its independent coordinates, and corrects the others until the legs
/// close.
///
/// `step` are the independent components, whose indices among the six are given. Newton's method
/// finds the others. `evaluate` writes the closure errors of a pose (6 - r numbers), and their
/// derivatives with respect to the six components of the platform's velocity (row-major). If the
/// iteration does not converge, the pose is not closed and functions reject it.
///
/// The six components are one rotation vector and one translation, because successive rotations
/// would change each other's axes.
pub fn displace<T: Float>(
    pose: &mut [T],
    step: &[T],
    independent: &[usize],
    mut evaluate: impl FnMut(&[T], &mut [T], &mut [T]) -> Result<(), Error>,
) {
    let Some(start) = pose.first_chunk::<POSE>().copied() else {
        return;
    };
    let mut whole = [T::ZERO; SIX];
    for (&at, step) in independent.iter().zip(step) {
        if let Some(component) = whole.get_mut(at) {
            *component = *step;
        }
    }
    let count = SIX.saturating_sub(independent.len());
    let dependent = || (0..SIX).filter(|at| !independent.contains(at));
    for _ in 0..STEPS {
        pose.iter_mut().zip(start).for_each(|(to, from)| *to = from);
        displace_quaternion(pose, &whole);
        let (mut errors, mut jacobian) = ([T::ZERO; SIX], [T::ZERO; SIX * SIX]);
        let (Some(errors), Some(jacobian)) =
            (errors.get_mut(..count), jacobian.get_mut(..count * SIX))
        else {
            return;
        };
        if evaluate(pose, errors, jacobian).is_err() {
            return;
        }
        let mut square = [T::ZERO; SIX * SIX];
        let rows = square.chunks_exact_mut(count.max(1));
        for (row, of_six) in rows.zip(jacobian.chunks_exact(SIX)) {
            for (entry, at) in row.iter_mut().zip(dependent()) {
                *entry = of_six.get(at).copied().unwrap_or(T::ZERO);
            }
        }
        let _ = System::new(count, &mut square, errors).eliminate(0..count);
        if errors.iter().any(|error| !error.is_finite()) {
            return;
        }
        let largest = errors.iter().fold(T::ZERO, |m, e| m.max(e.abs()));
        if largest < T::of(T::LIMITS.joint_step) {
            return;
        }
        let longest = T::of(LONGEST_STEP);
        let scale = if largest > longest {
            longest / largest
        } else {
            T::of(1.0)
        };
        for (at, error) in dependent().zip(errors.iter()) {
            if let Some(component) = whole.get_mut(at) {
                *component -= scale * *error;
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use super::displace;

    /// A point on the unit sphere above x and y, which does not rotate.
    #[test]
    fn dependent_coordinates_follow_the_closure() {
        let mut pose = [0.0, 0.0, 1.0, 1.0, 0.0, 0.0, 0.0];
        displace::<f64>(&mut pose, &[0.6, 0.1], &[0, 1], |pose, errors, jacobian| {
            let [x, y, z] = [pose[0], pose[1], pose[2]];
            errors.copy_from_slice(&[x * x + y * y + z * z - 1.0, pose[4], pose[5], pose[6]]);
            jacobian.fill(0.0);
            jacobian[..3].copy_from_slice(&[2.0 * x, 2.0 * y, 2.0 * z]);
            for turn in 0..3 {
                jacobian[6 * (turn + 1) + 3 + turn] = 0.5;
            }
            Ok(())
        });
        assert_eq!(pose[..2], [0.6, 0.1]);
        assert!((pose[2] - 0.63_f64.sqrt()).abs() < 1e-13, "{pose:?}");
        assert_eq!(pose[3..], [1.0, 0.0, 0.0, 0.0]);
    }

    #[test]
    fn poses_that_cannot_be_closed_stay_finite() {
        let mut pose = [0.0, 0.0, 1.0, 1.0, 0.0, 0.0, 0.0];
        displace::<f64>(
            &mut pose,
            &[0.1; 5],
            &[0, 1, 3, 4, 5],
            |_, errors, jacobian| {
                errors.fill(1.0);
                jacobian.fill(0.0);
                Ok(())
            },
        );
        assert!(pose.iter().all(|number| number.is_finite()), "{pose:?}");
    }
}
