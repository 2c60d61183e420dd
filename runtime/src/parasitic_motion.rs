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
/// derivatives with respect to the six components of the platform's velocity (row-major). A step
/// that does not reduce the largest error is halved. If the iteration does not converge, the pose
/// has the smallest error found; functions reject it if it is not closed.
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
    let place = |pose: &mut [T], whole: &[T; SIX]| {
        pose.iter_mut().zip(start).for_each(|(to, from)| *to = from);
        displace_quaternion(pose, whole);
    };
    // The last step, and the largest error before it.
    let mut step = [T::ZERO; SIX];
    let mut before: Option<T> = None;
    for _ in 0..STEPS {
        place(pose, &whole);
        let (mut errors, mut jacobian) = ([T::ZERO; SIX], [T::ZERO; SIX * SIX]);
        let (Some(errors), Some(jacobian)) =
            (errors.get_mut(..count), jacobian.get_mut(..count * SIX))
        else {
            return;
        };
        let is_evaluated = evaluate(pose, errors, jacobian).is_ok();
        let size = largest(errors);
        let is_closer = is_evaluated && before.is_none_or(|before| size < before);
        match before {
            None if !is_closer => return,
            Some(_) if !is_closer => {
                for (component, step) in whole.iter_mut().zip(&mut step) {
                    *step *= T::of(0.5);
                    *component -= *step;
                }
                continue;
            }
            _ => before = Some(size),
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
        let longest = largest(errors);
        if longest < T::of(T::LIMITS.joint_step) {
            return;
        }
        let scale = if longest > T::of(LONGEST_STEP) {
            T::of(LONGEST_STEP) / longest
        } else {
            T::of(1.0)
        };
        for (at, error) in dependent().zip(errors.iter()) {
            if let (Some(component), Some(step)) = (whole.get_mut(at), step.get_mut(at)) {
                *step = -scale * *error;
                *component += *step;
            }
        }
    }
    for (component, step) in whole.iter_mut().zip(step) {
        *component -= step;
    }
    place(pose, &whole);
}

/// Largest magnitude of the numbers.
fn largest<T: Float>(numbers: &[T]) -> T {
    numbers
        .iter()
        .fold(T::ZERO, |m, number| m.max(number.abs()))
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

    /// The point is just outside the sphere, where no height closes it.
    #[test]
    fn poses_near_a_dead_centre_do_not_become_less_closed() {
        let error = |pose: &[f64]| pose[..3].iter().map(|x| x * x).sum::<f64>() - 1.0;
        for height in [1e-4, 1e-6, 1e-8] {
            let mut pose = [1.0 + 1e-7, 0.0, height, 1.0, 0.0, 0.0, 0.0];
            let before = error(&pose).abs();
            displace::<f64>(&mut pose, &[0.0; 2], &[0, 1], |pose, errors, jacobian| {
                errors.copy_from_slice(&[error(pose), pose[4], pose[5], pose[6]]);
                jacobian.fill(0.0);
                for (entry, x) in jacobian.iter_mut().zip(&pose[..3]) {
                    *entry = 2.0 * x;
                }
                for turn in 0..3 {
                    jacobian[6 * (turn + 1) + 3 + turn] = 0.5;
                }
                Ok(())
            });
            let after = error(&pose).abs();
            assert!(
                after <= before * (1.0 + 1e-9),
                "{before:e} became {after:e}"
            );
        }
    }
}
