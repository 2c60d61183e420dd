//! Position and velocity gains of motors and joints.

use super::algebra::{
    congruence, dot, finite, matrix, scales, solve_definite, transformed, vector,
};
use super::{Curvature, Error, Transmission};
use crate::float::Float;

impl<const N: usize, const R: usize, T: Float> Transmission<N, R, T> {
    /// Joint gains Jᵀ diag(k) J of motor gains k.
    ///
    /// For velocity gains (N m s/rad) the result is exact. For position gains (N m/rad) it is the
    /// joint stiffness at a pose without motor torques; see
    /// [`joint_stiffness`](Self::joint_stiffness).
    ///
    /// ```
    /// use overact::transmission::Transmission;
    ///
    /// let ankle = Transmission::new(&[[0.8, 0.5], [0.8, -0.5]])?;
    /// let gains = ankle.joint_gains(&[100.0, 100.0])?;
    /// assert!((gains[0][0] - 128.0_f64).abs() < 1e-12 && gains[0][1].abs() < 1e-12);
    /// # Ok::<(), overact::transmission::Error>(())
    /// ```
    ///
    /// # Errors
    /// [`Error::NotFinite`] or [`Error::Overflow`].
    pub fn joint_gains(&self, motor_gains: &[T; N]) -> Result<[[T; R]; R], Error> {
        finite("motor_gains", motor_gains)?;
        matrix(congruence(&self.jacobian, motor_gains))
    }

    /// Joint stiffness -∂(Jᵀ τ)/∂q of position gains k of the motors, N m/rad.
    ///
    /// It is Jᵀ diag(k) J - Σ τ_a H_a. The second term is the geometric stiffness: the motor
    /// torques τ act along directions that change with the pose. H is a [`Curvature`].
    ///
    /// # Errors
    /// [`Error::NotFinite`] or [`Error::Overflow`].
    pub fn joint_stiffness(
        &self,
        motor_gains: &[T; N],
        motor_torques: &[T; N],
        curvature: &Curvature<N, R, T>,
    ) -> Result<[[T; R]; R], Error> {
        let mut stiffness = self.joint_gains(motor_gains)?;
        add(&mut stiffness, motor_torques, curvature, T::of(-1.0))?;
        matrix(stiffness)
    }

    /// Motor gains J⁺ᵀ K J⁺ of joint gains K.
    ///
    /// With as many motors as joints, Jᵀ times the result times J is K. The matrix is full: each
    /// motor's torque depends on the errors of all motors. See
    /// [`diagonal_motor_gains`](Self::diagonal_motor_gains) for independent drives.
    ///
    /// # Errors
    /// [`Error::NotFinite`] or [`Error::Overflow`].
    pub fn motor_gains(&self, joint_gains: &[[T; R]; R]) -> Result<[[T; N]; N], Error> {
        finite("joint_gains", joint_gains.as_flattened())?;
        matrix(transformed(&self.inverse, joint_gains))
    }

    /// Position gains of the motors for a joint stiffness K under motor torques τ.
    ///
    /// They are J⁺ᵀ (K + Σ τ_a H_a) J⁺, the inverse of [`joint_stiffness`](Self::joint_stiffness).
    ///
    /// # Errors
    /// [`Error::NotFinite`] or [`Error::Overflow`].
    pub fn motor_stiffness(
        &self,
        joint_stiffness: &[[T; R]; R],
        motor_torques: &[T; N],
        curvature: &Curvature<N, R, T>,
    ) -> Result<[[T; N]; N], Error> {
        finite("joint_stiffness", joint_stiffness.as_flattened())?;
        let mut gains = *joint_stiffness;
        add(&mut gains, motor_torques, curvature, T::of(1.0))?;
        matrix(transformed(&self.inverse, &gains))
    }

    /// Gains of independent drives whose joint gains Jᵀ diag(k) J are nearest to K.
    ///
    /// Least squares over the entries of the matrices, with joints scaled by the lengths of their
    /// columns of J. Gains may be negative if K cannot be approximated otherwise.
    ///
    /// ```
    /// use overact::transmission::Transmission;
    ///
    /// let ankle = Transmission::new(&[[0.8, 0.5], [0.8, -0.5]])?;
    /// let [left, right] = ankle.diagonal_motor_gains(&[[128.0, 0.0], [0.0, 50.0]])?;
    /// assert!((left - 100.0_f64).abs() < 1e-9 && (right - 100.0_f64).abs() < 1e-9);
    /// # Ok::<(), overact::transmission::Error>(())
    /// ```
    ///
    /// # Errors
    /// [`Error::Ambiguous`] if several motors act alike, or more than R (R + 1)/2 motors;
    /// [`Error::NotFinite`] or [`Error::Overflow`].
    pub fn diagonal_motor_gains(&self, joint_gains: &[[T; R]; R]) -> Result<[T; N], Error> {
        finite("joint_gains", joint_gains.as_flattened())?;
        let scales = scales(&self.jacobian);
        let scaled: [[T; R]; N] =
            core::array::from_fn(|a| core::array::from_fn(|i| self.jacobian[a][i] / scales[i]));
        let wanted: [[T; R]; R] = core::array::from_fn(|i| {
            core::array::from_fn(|j| joint_gains[i][j] / (scales[i] * scales[j]))
        });
        // The matrices of two motors have the scalar product (J_a J_bᵀ)².
        let squares: [T; N] = core::array::from_fn(|a| dot(&scaled[a], &scaled[a]));
        if squares.iter().any(|square| *square <= T::ZERO) {
            return Err(Error::Ambiguous);
        }
        let products: [[T; N]; N] = core::array::from_fn(|a| {
            core::array::from_fn(|b| {
                let product = dot(&scaled[a], &scaled[b]);
                product * product / (squares[a] * squares[b])
            })
        });
        let right: [T; N] = core::array::from_fn(|a| {
            let own = &scaled[a];
            let sum = wanted.iter().zip(own);
            let sum = sum.fold(T::ZERO, |sum, (row, factor)| sum + *factor * dot(row, own));
            sum / squares[a]
        });
        let solution = solve_definite(products, right).ok_or(Error::Ambiguous)?;
        vector(core::array::from_fn(|a| solution[a] / squares[a]))
    }
}

/// Adds `sign` Σ τ_a H_a.
fn add<const N: usize, const R: usize, T: Float>(
    gains: &mut [[T; R]; R],
    motor_torques: &[T; N],
    curvature: &Curvature<N, R, T>,
    sign: T,
) -> Result<(), Error> {
    finite("motor_torques", motor_torques)?;
    finite("curvature", curvature.as_flattened().as_flattened())?;
    for (torque, second) in motor_torques.iter().zip(curvature) {
        let factor = sign * *torque;
        for (row, entries) in gains.iter_mut().zip(second) {
            for (gain, entry) in row.iter_mut().zip(entries) {
                *gain += factor * *entry;
            }
        }
    }
    Ok(())
}
