//! Forward kinematics of a parallel robot from all its actuators, redundant ones included.
//!
//! The pose minimises |q_measured - q(x)|², where q(x) is the inverse kinematics. Gauss-Newton with
//! the Jacobian J_p^inv converges in two or three steps when it starts from the previous sample; the
//! redundant actuators average the noise of the others, and starting near keeps the assembly mode.

use crate::{
    Error,
    math::{sin_cos, sqrt, wrap_angle},
};

/// Largest number of Gauss-Newton steps.
pub const STEPS: usize = 20;

/// The steps end when the largest one falls below this (m, rad).
pub const TOLERANCE: f64 = 1e-12;

/// The measured actuators, and which of them are angles.
#[derive(Debug, Clone, Copy)]
pub struct Measured<'a> {
    /// Positions of the n actuators (m, rad).
    pub positions: &'a [f64],
    /// Whether each is an angle, whose differences are taken modulo a turn.
    pub is_revolute: &'a [bool],
}

/// Memory for [`gauss_newton`]: slices of lengths n, n r, r², r.
#[derive(Debug)]
pub struct Workspace<'a> {
    /// n numbers.
    pub actuators: &'a mut [f64],
    /// n r numbers.
    pub inverse_jacobian: &'a mut [f64],
    /// r² numbers.
    pub normal: &'a mut [f64],
    /// r numbers.
    pub step: &'a mut [f64],
}

/// Finds the pose of least squares from the start in `pose`. `evaluate` writes q(x) and J_p^inv(x)
/// (n x r, row-major) of a pose; `displace` moves a pose along the twist coordinates.
///
/// The remaining residual of a redundant robot is not zero when its encoders are noisy, so
/// convergence is judged by the step.
///
/// # Errors
/// [`Error::NoConvergence`], [`Error::SingularPlatform`], or what `evaluate` reports.
pub fn gauss_newton(
    measured: Measured<'_>,
    pose: &mut [f64],
    workspace: Workspace<'_>,
    mut evaluate: impl FnMut(&[f64], &mut [f64], &mut [f64]) -> Result<(), Error>,
    mut displace: impl FnMut(&mut [f64], &[f64]),
) -> Result<(), Error> {
    let Workspace {
        actuators,
        inverse_jacobian,
        normal,
        step,
    } = workspace;
    if measured.positions.iter().any(|q| !q.is_finite()) {
        return Err(Error::NotFinite);
    }
    let dof = step.len();
    let mut residual = 0.0_f64;
    for _ in 0..STEPS {
        evaluate(pose, actuators, inverse_jacobian)?;
        residual = 0.0;
        normal.fill(0.0);
        step.fill(0.0);
        for (i, q) in actuators.iter().enumerate() {
            let mut difference = measured.positions[i] - q;
            if measured.is_revolute[i] {
                difference = wrap_angle(difference);
            }
            residual = residual.max(difference.abs());
            let row = &inverse_jacobian[i * dof..(i + 1) * dof];
            for a in 0..dof {
                step[a] += row[a] * difference;
                for b in 0..dof {
                    normal[a * dof + b] += row[a] * row[b];
                }
            }
        }
        solve_positive_definite(normal, step)?;
        displace(pose, step);
        let largest = step.iter().fold(0.0_f64, |m, s| m.max(s.abs()));
        if !largest.is_finite() {
            break;
        }
        if largest < TOLERANCE {
            return Ok(());
        }
    }
    Err(Error::NoConvergence { residual })
}

/// Solves S x = y in place for a symmetric positive definite S (row-major, overwritten) by L D Lᵀ.
///
/// # Errors
/// [`Error::SingularPlatform`] when a pivot vanishes.
pub fn solve_positive_definite(matrix: &mut [f64], vector: &mut [f64]) -> Result<(), Error> {
    let n = vector.len();
    let largest = (0..n).fold(0.0_f64, |m, i| m.max(matrix[i * n + i]));
    for k in 0..n {
        let pivot = matrix[k * n + k];
        if pivot.is_nan() || pivot <= 1e-15 * largest {
            return Err(Error::SingularPlatform {
                actuators: "actuators",
                condition: largest / pivot.abs(),
            });
        }
        for i in k + 1..n {
            let factor = matrix[i * n + k] / pivot;
            for j in k + 1..n {
                matrix[i * n + j] -= factor * matrix[k * n + j];
            }
            vector[i] -= factor * vector[k];
        }
    }
    for k in (0..n).rev() {
        for j in k + 1..n {
            vector[k] -= matrix[k * n + j] * vector[j];
        }
        vector[k] /= matrix[k * n + k];
    }
    Ok(())
}

/// Moves a pose whose coordinates are its twist coordinates' integrals: x + step.
pub fn displace(pose: &mut [f64], step: &[f64]) {
    for (coordinate, step) in pose.iter_mut().zip(step) {
        *coordinate += step;
    }
}

/// Moves a pose that ends with a unit quaternion (w, x, y, z): the last three numbers of `step` are a
/// rotation vector in the base frame, by whose exponential the quaternion is multiplied from the left.
pub fn displace_quaternion(pose: &mut [f64], step: &[f64]) {
    let (Some(linear), Some(turn)) = (step.len().checked_sub(3), step.last_chunk::<3>()) else {
        return;
    };
    for (coordinate, step) in pose.iter_mut().zip(&step[..linear]) {
        *coordinate += step;
    }
    let Some([w, x, y, z]) = pose.last_chunk_mut::<4>() else {
        return;
    };
    let angle = sqrt(turn[0] * turn[0] + turn[1] * turn[1] + turn[2] * turn[2]);
    let (sine, cosine) = sin_cos(0.5 * angle);
    // sin(a/2)/a tends to 1/2.
    let scale = if angle > 1e-12 { sine / angle } else { 0.5 };
    let (a, b, c, d) = (cosine, scale * turn[0], scale * turn[1], scale * turn[2]);
    let product = [
        a * *w - b * *x - c * *y - d * *z,
        a * *x + b * *w + c * *z - d * *y,
        a * *y - b * *z + c * *w + d * *x,
        a * *z + b * *y - c * *x + d * *w,
    ];
    let norm = sqrt(product.iter().map(|q| q * q).sum());
    [*w, *x, *y, *z] = product.map(|q| q / norm);
}
