//! Forward kinematics of a parallel robot from all its actuators, including redundant ones.
//!
//! The pose minimises |q_measured - q(x)|², where q(x) is the inverse kinematics. Gauss-Newton with
//! the Jacobian J_p^inv converges in two or three steps from the previous sample. Redundant
//! actuators average the noise, and a close start keeps the assembly mode.
//!
//! All functions may be inlined: sizes are constants in generated code, and without them the
//! overhead of loops with three or four iterations exceeds their work.

use crate::{ActuatorGroup, Error, float::Float, guard};
use overact_core::limits::DOUBLE;

/// Largest number of Gauss-Newton steps.
pub const STEPS: usize = 20;

/// Steps end when the largest one, or a bound of the next one, falls below this (m, rad), in double
/// precision.
pub const TOLERANCE: f64 = DOUBLE.step;

/// Steps longer than this (m, rad) come from a distant start, and do not predict the next one.
const LONG_STEP: f64 = 1.0;

/// Largest distance from the start (m, rad) at which a pose in closed form becomes the start of the
/// steps.
const NEAR: f64 = 0.01;

/// Measured positions of the actuators, and whether each is an angle.
#[derive(Debug, Clone, Copy)]
pub struct Measured<'a, T = f64> {
    /// Positions of the n actuators (m, rad).
    pub positions: &'a [T],
    /// Whether each is an angle, whose differences are modulo a turn.
    pub is_revolute: &'a [bool],
}

/// Memory for [`gauss_newton`]: slices of lengths n, n r, r², r.
#[derive(Debug)]
pub struct Workspace<'a, T = f64> {
    /// n numbers.
    pub actuators: &'a mut [T],
    /// n r numbers.
    pub inverse_jacobian: &'a mut [T],
    /// r² numbers.
    pub normal: &'a mut [T],
    /// r numbers.
    pub step: &'a mut [T],
}

/// Finds the least-squares pose from the start in `pose` by Gauss-Newton.
///
/// `evaluate` writes q(x) and J_p^inv(x) (n × r, row-major) of a pose; `displace` moves a pose
/// along the twist coordinates. All numbers have to be finite.
///
/// The residual of a redundant robot with encoder noise is not zero, so convergence is judged by
/// the step. Steps decrease at least geometrically, so the last two bound the next one, which is
/// not computed only to check its size.
///
/// # Errors
/// [`Error::NoConvergence`], [`Error::SingularPlatform`], or what `evaluate` reports.
#[inline]
pub fn gauss_newton<T: Float>(
    measured: Measured<'_, T>,
    pose: &mut [T],
    workspace: Workspace<'_, T>,
    mut evaluate: impl FnMut(&[T], &mut [T], &mut [T]) -> Result<(), Error>,
    displace: impl FnMut(&mut [T], &[T]),
) -> Result<(), Error> {
    let Workspace {
        actuators,
        inverse_jacobian,
        normal,
        step,
    } = workspace;
    let mut residual = T::ZERO;
    let find = |pose: &[T], step: &mut [T]| {
        evaluate(pose, actuators, inverse_jacobian)?;
        normal.fill(T::ZERO);
        step.fill(T::ZERO);
        residual = accumulate(measured, actuators, inverse_jacobian, normal, step);
        solve_positive_definite(normal, step)
    };
    if iterate(pose, step, find, displace)? {
        Ok(())
    } else {
        Err(Error::NoConvergence {
            residual: residual.into(),
        })
    }
}

/// Takes Gauss-Newton steps that `find` computes in one call; returns whether they converged.
///
/// It is used by generated code that has positions and Jacobian in one function and solves the
/// system without a loop. It fails if a pivot vanishes although the Jacobian is regular, or if
/// steps diverge. The caller then continues with [`gauss_newton`] from the start.
#[inline]
pub fn steps<T: Float>(
    pose: &mut [T],
    step: &mut [T],
    find: impl FnMut(&[T], &mut [T]) -> Result<(), Error>,
    displace: impl FnMut(&mut [T], &[T]),
) -> bool {
    let ended = iterate(pose, step, find, displace).unwrap_or(false);
    ended && pose.iter().all(|x| x.abs() <= T::of(T::LIMITS.farthest))
}

/// Takes steps until the next one would be too small; returns whether this happens.
#[inline]
fn iterate<T: Float>(
    pose: &mut [T],
    step: &mut [T],
    mut find: impl FnMut(&[T], &mut [T]) -> Result<(), Error>,
    mut displace: impl FnMut(&mut [T], &[T]),
) -> Result<bool, Error> {
    let mut before = T::ZERO;
    for _ in 0..STEPS {
        match find(pose, step) {
            // A diverged pose is not an input of the user.
            Err(Error::NotFinite { .. } | Error::OutOfRange { .. }) => break,
            found => found?,
        }
        displace(pose, step);
        // `max` ignores NaN, but a sum does not.
        let total: T = step.iter().map(|s| s.abs()).sum();
        if !total.is_finite() {
            break;
        }
        let largest = step.iter().fold(T::ZERO, |m, s| m.max(s.abs()));
        // The next step is at most largest²/before; a tenth of the tolerance leaves room for later
        // ones.
        let tolerated = T::of(T::LIMITS.step);
        if largest < tolerated || largest * largest < T::of(0.1) * tolerated * before {
            return Ok(true);
        }
        // The step after a long one does not show how fast steps decrease.
        before = largest.min(T::of(LONG_STEP));
    }
    Ok(false)
}

/// Fits a pose to redundant actuators, starting from a closed form that uses some of them.
///
/// From the closed form, steps only have to correct encoder noise, but its assembly mode is that of
/// the home configuration. So it is used if it is near `start`, as in successive samples, or if
/// `fit` fails from `start`.
///
/// # Errors
/// The error of `fit`.
#[inline]
pub fn from_closed_form<T: Float, P: AsRef<[T]>>(
    closed: Option<P>,
    start: P,
    mut fit: impl FnMut(P) -> Result<P, Error>,
) -> Result<P, Error> {
    let Some(closed) = closed else {
        return fit(start);
    };
    let mut coordinates = closed.as_ref().iter().zip(start.as_ref());
    let (first, second) = if coordinates.all(|(a, b)| (*a - *b).abs() <= T::of(NEAR)) {
        (closed, start)
    } else {
        (start, closed)
    };
    fit(first).or_else(|_| fit(second))
}

/// Adds the upper triangle of JᵀJ to `normal` and Jᵀ Δq to `step`, with J = J_p^inv; returns the
/// largest difference.
#[inline]
fn accumulate<T: Float>(
    measured: Measured<'_, T>,
    actuators: &[T],
    inverse_jacobian: &[T],
    normal: &mut [T],
    step: &mut [T],
) -> T {
    let mut residual = T::ZERO;
    let dof = step.len().max(1);
    let positions = measured.positions.iter().zip(measured.is_revolute);
    let rows = inverse_jacobian.chunks_exact(dof);
    for (((position, is_revolute), reached), row) in positions.zip(actuators).zip(rows) {
        let mut difference = *position - *reached;
        if *is_revolute {
            difference = difference.wrap_angle();
        }
        residual = residual.max(difference.abs());
        let sums = step.iter_mut().zip(normal.chunks_exact_mut(dof));
        for (k, ((step, normal), entry)) in sums.zip(row).enumerate() {
            *step += *entry * difference;
            for (normal, other) in normal.iter_mut().zip(row).skip(k) {
                *normal += *entry * *other;
            }
        }
    }
    residual
}

/// Solves S x = y in place by L D Lᵀ, for a symmetric positive definite S (row-major, overwritten).
///
/// Only the upper triangle of S is read.
///
/// # Errors
/// [`Error::SingularPlatform`] when a pivot vanishes, [`Error::Length`] for a matrix that is not square.
#[inline]
pub fn solve_positive_definite<T: Float>(matrix: &mut [T], vector: &mut [T]) -> Result<(), Error> {
    let n = vector.len();
    if n.checked_mul(n) != Some(matrix.len()) {
        return Err(Error::Length {
            expected: n.saturating_mul(n),
            found: matrix.len(),
        });
    }
    eliminate(matrix, vector)?;
    // From the last row upwards; later elements of the vector are already solved. Iterators avoid
    // bounds checks.
    for (k, row) in matrix.chunks_exact(n.max(1)).enumerate().rev() {
        let mut known = row.iter().zip(vector.iter_mut()).skip(k);
        if let Some((pivot, value)) = known.next() {
            let rest: T = known.map(|(entry, solved)| *entry * *solved).sum();
            *value = (*value - rest) / *pivot;
        }
    }
    Ok(())
}

/// Reduces S to upper triangular form, together with the right-hand side.
///
/// The remaining submatrix stays symmetric, so an entry below the pivot equals its counterpart in
/// the pivot row.
#[inline]
fn eliminate<T: Float>(matrix: &mut [T], vector: &mut [T]) -> Result<(), Error> {
    let n = vector.len().max(1);
    let diagonal = matrix.chunks_exact(n).enumerate();
    let diagonal = diagonal.filter_map(|(k, row)| row.get(k));
    let largest = diagonal.fold(T::ZERO, |m, entry| m.max(*entry));
    let (mut matrix, mut vector) = (matrix, vector);
    let mut k = 0;
    while let (Some((row, below)), Some((known, unknown))) =
        (matrix.split_at_mut_checked(n), vector.split_first_mut())
    {
        let pivot = row.get(k).copied().unwrap_or(T::ZERO);
        let is_regular = pivot > T::of(T::LIMITS.pivot) * largest;
        if !is_regular {
            return Err(Error::SingularPlatform {
                actuators: ActuatorGroup::All,
                condition: (largest / pivot.abs()).into(),
            });
        }
        let rows = below.chunks_exact_mut(n).zip(unknown.iter_mut());
        for (i, (other, value)) in rows.enumerate() {
            let rest_of_row = row.iter().skip(k + 1 + i);
            let factor = rest_of_row
                .clone()
                .next()
                .map_or(T::ZERO, |first| *first / pivot);
            for (entry, above) in other.iter_mut().skip(k + 1 + i).zip(rest_of_row) {
                *entry -= factor * *above;
            }
            *value -= factor * *known;
        }
        (matrix, vector) = (below, unknown);
        k += 1;
    }
    Ok(())
}

/// Displaces a pose whose coordinates are integrals of its twist coordinates: x + step.
#[inline]
pub fn displace<T: Float>(pose: &mut [T], step: &[T]) {
    for (coordinate, step) in pose.iter_mut().zip(step) {
        *coordinate += *step;
    }
}

/// Displaces a pose that ends with a unit quaternion (w, x, y, z).
///
/// The last three numbers of `step` are a rotation vector in the base frame. The quaternion is
/// multiplied by its exponential from the left.
pub fn displace_quaternion<T: Float>(pose: &mut [T], step: &[T]) {
    let Some((linear, turn)) = step.split_last_chunk::<3>() else {
        return;
    };
    displace(pose, linear);
    let Some([w, x, y, z]) = pose.last_chunk_mut::<4>() else {
        return;
    };
    let square = turn[0] * turn[0] + turn[1] * turn[1] + turn[2] * turn[2];
    let (scale, a) = half_turn(square);
    let (b, c, d) = (scale * turn[0], scale * turn[1], scale * turn[2]);
    (*w, *x, *y, *z) = (
        a * *w - b * *x - c * *y - d * *z,
        a * *x + b * *w + c * *z - d * *y,
        a * *y - b * *z + c * *w + d * *x,
        a * *z + b * *y - c * *x + d * *w,
    );
    // Without a valid quaternion the pose stays; functions of the pose reject a zero quaternion.
    let _ = guard::normalise(pose, "pose");
}

/// Squares of angles (rad²) up to which four terms of the series are exact: the next one is
/// 2 · 10⁻¹⁷.
const SMALL_TURN: f64 = 1.0 / 256.0;

/// sin(a/2)/a and cos(a/2) of an angle a (rad) from its square.
///
/// Steps of an iteration rotate by small angles, and a series in a² needs neither root nor
/// quotient.
#[inline]
fn half_turn<T: Float>(square: T) -> (T, T) {
    if square < T::of(SMALL_TURN) {
        let [first, second, third, fourth] =
            [1.0 / 2.0, 1.0 / 48.0, 1.0 / 3840.0, 1.0 / 645_120.0].map(T::of);
        let scale = first - square * (second - square * (third - square * fourth));
        let [first, second, third, fourth] =
            [1.0, 1.0 / 8.0, 1.0 / 384.0, 1.0 / 46_080.0].map(T::of);
        return (
            scale,
            first - square * (second - square * (third - square * fourth)),
        );
    }
    let angle = square.sqrt();
    let (sine, cosine) = (T::of(0.5) * angle).sin_cos();
    (sine / angle, cosine)
}

#[cfg(test)]
mod tests {
    use super::{
        Error, Measured, Workspace, displace, displace_quaternion, from_closed_form, gauss_newton,
        half_turn, solve_positive_definite, steps,
    };

    #[test]
    fn half_angle_series_and_sines_agree() {
        for angle in [
            0.0, 1e-200, 1e-9, 1e-3, 0.03, 0.0624, 0.0626, 0.5, 3.0, 7.0_f64,
        ] {
            let (scale, cosine) = half_turn(angle * angle);
            let half = 0.5 * angle;
            let wanted = if angle > 0.0 { half.sin() / angle } else { 0.5 };
            assert!((scale - wanted).abs() < 2e-16, "{angle}: {scale} {wanted}");
            assert!((cosine - half.cos()).abs() < 3e-16, "{angle}: {cosine}");
            let (single, _) = half_turn((angle * angle) as f32);
            assert!(
                (f64::from(single) - wanted).abs() < 1e-7,
                "{angle}: {single}"
            );
        }
        let (scale, cosine) = half_turn(f64::NAN);
        assert!(scale.is_nan() && cosine.is_nan());
    }

    #[test]
    fn many_small_rotations_sum_to_the_whole_rotation() {
        let axis = [0.48, -0.6, 0.64];
        for (count, angle) in [(1, 2.0), (100, 0.02), (1000, 0.002), (2, 1.0_f64)] {
            let mut pose = [0.0, 1.0, 0.0, 0.0, 0.0];
            for _ in 0..count {
                displace_quaternion(
                    &mut pose,
                    &[0.5, angle * axis[0], angle * axis[1], angle * axis[2]],
                );
            }
            let wanted = axis.map(|a| a * 1.0_f64.sin());
            assert!((pose[1] - 1.0_f64.cos()).abs() < 1e-14, "{pose:?}");
            for (found, wanted) in pose[2..].iter().zip(wanted) {
                assert!((found - wanted).abs() < 1e-14, "{pose:?}");
            }
            let length: f64 = pose[1..].iter().map(|q| q * q).sum();
            assert!((length - 1.0).abs() < 1e-15, "{length}");
        }
    }

    #[test]
    fn a_positive_definite_system_is_solved() {
        let matrix = [[4.0, 2.0, -2.0], [2.0, 10.0, 2.0], [-2.0, 2.0, 6.0]];
        let solution = [3.0, -1.0, 2.0];
        let product = matrix.map(|row| row.iter().zip(solution).map(|(a, x)| a * x).sum::<f64>());
        let (mut found, mut factors) = (product, matrix);
        solve_positive_definite(factors.as_flattened_mut(), &mut found).expect("regular");
        for (found, wanted) in found.iter().zip(solution) {
            assert!((found - wanted).abs() < 1e-14, "{found} {wanted}");
        }
    }

    #[test]
    fn iterations_that_stop_far_from_the_start_have_not_converged() {
        for (far, has_led) in [(1e16, false), (1e3, true)] {
            let find = |pose: &[f64], step: &mut [f64]| {
                step[0] = if pose[0] < far { far } else { 0.0 };
                Ok(())
            };
            assert_eq!(steps(&mut [0.0], &mut [0.0], find, displace), has_led);
        }
    }

    #[test]
    fn a_huge_step_does_not_end_the_iteration_early() {
        let mut lengths = [1e12, 0.3, 1e-3, 1e-14].into_iter();
        let find = |_: &[f64], step: &mut [f64]| {
            step[0] = lengths.next().unwrap_or_default();
            Ok(())
        };
        assert!(!steps(&mut [-1e12], &mut [0.0], find, |_, _| ()));
        assert_eq!(lengths.next(), None);
    }

    #[test]
    fn only_the_upper_triangle_of_the_matrix_is_read() {
        let mut upper = [
            [4.0, 2.0, -2.0],
            [f64::NAN, 10.0, 2.0],
            [f64::NAN, f64::NAN, 6.0],
        ];
        let mut found = [-4.0, -2.0, 14.0];
        solve_positive_definite(upper.as_flattened_mut(), &mut found).expect("regular");
        for (found, wanted) in found.iter().zip([1.0, -1.0, 3.0]) {
            assert!((found - wanted).abs() < 1e-14, "{found} {wanted}");
        }
    }

    /// A fit that records where it starts.
    fn tried(closed: Option<[f64; 2]>, start: [f64; 2], fails: bool) -> Vec<[f64; 2]> {
        let mut tried = Vec::new();
        let fit = |pose| {
            tried.push(pose);
            if fails {
                Err(Error::NoConvergence { residual: 1.0 })
            } else {
                Ok(pose)
            }
        };
        assert_eq!(from_closed_form(closed, start, fit).is_err(), fails);
        tried
    }

    #[test]
    fn newton_starts_from_a_nearby_closed_form_pose() {
        let (start, near, far) = ([1.0, 2.0], [1.005, 1.995], [1.0, 2.5]);
        assert_eq!(tried(None, start, false), [start]);
        assert_eq!(tried(Some(near), start, false), [near]);
        // Another assembly mode, or the first sample of a log.
        assert_eq!(tried(Some(far), start, false), [start]);
        assert_eq!(tried(Some(near), start, true), [near, start]);
        assert_eq!(tried(Some(far), start, true), [start, far]);
        assert_eq!(tried(Some([f64::NAN, 2.0]), start, false), [start]);
    }

    #[test]
    fn negligible_newton_steps_are_skipped() {
        // q(x) = x² to 4: Newton's steps are 1e-4, 2.5e-9, and then 1.6e-18.
        let (mut pose, mut evaluations) = ([1.9999], 0);
        let measured = Measured {
            positions: &[4.0],
            is_revolute: &[false],
        };
        let workspace = Workspace {
            actuators: &mut [0.0],
            inverse_jacobian: &mut [0.0],
            normal: &mut [0.0],
            step: &mut [0.0],
        };
        let evaluate = |pose: &[f64], reached: &mut [f64], jacobian: &mut [f64]| {
            evaluations += 1;
            (reached[0], jacobian[0]) = (pose[0] * pose[0], 2.0 * pose[0]);
            Ok(())
        };
        gauss_newton(measured, &mut pose, workspace, evaluate, super::displace).expect("a root");
        assert_eq!(evaluations, 2);
        assert!((pose[0] - 2.0).abs() < 1e-14, "{}", pose[0]);
    }

    #[test]
    fn non_finite_steps_do_not_converge() {
        for wrong in [[0.0, f64::NAN], [f64::NAN, 0.0], [f64::INFINITY, 0.0]] {
            let find = |_: &[f64], step: &mut [f64]| {
                step.copy_from_slice(&wrong);
                Ok(())
            };
            let found = super::steps(&mut [1.0, 2.0], &mut [0.0; 2], find, super::displace);
            assert!(!found, "{wrong:?}");
        }
    }

    #[test]
    fn singular_and_misshapen_systems_are_rejected() {
        let mut singular = [[1.0, 2.0], [2.0, 4.0]];
        let found = solve_positive_definite(singular.as_flattened_mut(), &mut [1.0, 2.0]);
        assert!(
            matches!(found, Err(Error::SingularPlatform { .. })),
            "{found:?}"
        );
        let mut broken = [[f64::NAN, 0.0], [0.0, 1.0]];
        let found = solve_positive_definite(broken.as_flattened_mut(), &mut [1.0, 2.0]);
        assert!(
            matches!(found, Err(Error::SingularPlatform { .. })),
            "{found:?}"
        );
        let expected = Error::Length {
            expected: 4,
            found: 3,
        };
        assert_eq!(
            solve_positive_definite(&mut [1.0; 3], &mut [1.0; 2]),
            Err(expected)
        );
        assert_eq!(solve_positive_definite::<f64>(&mut [], &mut []), Ok(()));
    }
}
