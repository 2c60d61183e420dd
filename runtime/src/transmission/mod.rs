//! Transmissions between motors and joints at a pose: motion, torques, gains and limits.
//!
//! The motors of a parallel ankle, knee, wrist or Delta are not on its coordinates. The generated
//! J = `inverse_jacobian` maps the independent velocities v, here the velocities of the joints, to
//! those of the N motors. Everything else follows from J and the power balance:
//!
//! | quantity | from joints to motors | from motors to joints |
//! |---|---|---|
//! | position | `actuator_positions` | `pose_from_actuators` |
//! | velocity | J v | J⁺ q̇ |
//! | acceleration | J v̇ + J̇ v | J⁺ (q̈ - J̇ v) |
//! | torque | J⁺ᵀ τ, the least norm | Jᵀ τ |
//! | rotor inertia | | Jᵀ diag(I) J |
//! | gains | J⁺ᵀ K J⁺ | Jᵀ diag(k) J |
//! | stiffness under torques | J⁺ᵀ (K + Σ τ H) J⁺ | Jᵀ diag(k) J - Σ τ H |
//! | limits of speed and torque | | [`Interval`] |
//!
//! The positions are generated functions. H is the [`curvature`]: the derivative of J.
//! "Joints" are the coordinates of the twist: joints of a skeleton, or coordinates of a platform.
//!
//! ```
//! use overact::transmission::Transmission;
//!
//! // J of an ankle: both motors pitch the foot, and roll it against each other.
//! let ankle = Transmission::new(&[[0.8, 0.5], [0.8, -0.5]])?;
//! let torques = ankle.motor_torques(&[16.0, 2.0])?; // pitch, roll
//! let joints = ankle.joint_torques(&torques)?;
//! assert!((joints[0] - 16.0_f64).abs() < 1e-12 && (joints[1] - 2.0_f64).abs() < 1e-12);
//! // The rotors as the joints feel them.
//! let inertia = ankle.reflected_inertia(&[0.02, 0.02])?;
//! assert!((inertia[0][0] - 0.0256_f64).abs() < 1e-12);
//! # Ok::<(), overact::transmission::Error>(())
//! ```
//!
//! Nothing allocates or panics. [`C_FILES`] are the same functions in C and C++.

mod algebra;
mod c_files;
mod error;
mod gains;
mod limits;

use crate::float::Float;
use algebra::{finite, matrix, pseudo_inverse, times, transposed_times, vector};

pub use c_files::C_FILES;
pub use error::Error;
pub use limits::Interval;

/// Derivatives of the Jacobian: H of motor a is the symmetric R × R matrix ∂²θ_a/∂q².
pub type Curvature<const N: usize, const R: usize, T = f64> = [[[T; R]; R]; N];

/// Transmission of N motors and R joints at a pose.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Transmission<const N: usize, const R: usize, T = f64> {
    /// J, one row for each motor.
    jacobian: [[T; R]; N],
    /// J⁺, one row for each joint.
    inverse: [[T; N]; R],
    condition: T,
}

impl<const N: usize, const R: usize, T: Float> Transmission<N, R, T> {
    /// The transmission with the generated `inverse_jacobian` of a pose.
    ///
    /// # Errors
    /// [`Error::Singular`] if the motors do not determine all joints, [`Error::NotFinite`] or
    /// [`Error::Overflow`].
    pub fn new(jacobian: &[[T; R]; N]) -> Result<Self, Error> {
        finite("jacobian", jacobian.as_flattened())?;
        let (inverse, condition) = pseudo_inverse(jacobian)?;
        Ok(Self {
            jacobian: *jacobian,
            inverse: matrix(inverse)?,
            condition,
        })
    }

    /// Checks that no singularity separates the pose from home.
    ///
    /// Beyond a singularity two poses have the same motor positions, so forward kinematics from
    /// home finds another one. Call it at the corners of the joint limits, and between them. With
    /// more motors than joints, the test is whether the motors' directions of motion at home still
    /// determine the joints.
    ///
    /// ```
    /// use overact::transmission::{Error, Transmission};
    ///
    /// let home = Transmission::new(&[[0.8, 0.5], [0.8, -0.5]])?;
    /// let beyond = Transmission::new(&[[0.8, -0.2], [0.8, 0.2]])?;
    /// assert_eq!(beyond.in_mode_of(&home), Err(Error::AnotherMode));
    /// # Ok::<(), overact::transmission::Error>(())
    /// ```
    ///
    /// # Errors
    /// [`Error::AnotherMode`].
    pub fn in_mode_of(&self, home: &Self) -> Result<(), Error> {
        let product: [[T; R]; R] =
            core::array::from_fn(|i| transposed_times(&self.jacobian, &home.inverse[i]));
        if algebra::has_positive_determinant(product) {
            Ok(())
        } else {
            Err(Error::AnotherMode)
        }
    }

    /// J: motor velocities per joint velocity.
    #[must_use]
    pub const fn jacobian(&self) -> &[[T; R]; N] {
        &self.jacobian
    }

    /// J⁺, the pseudo-inverse, R × N.
    #[must_use]
    pub const fn inverse(&self) -> &[[T; N]; R] {
        &self.inverse
    }

    /// Condition number of J with columns scaled to the length 1; at least 1.
    #[must_use]
    pub const fn condition(&self) -> T {
        self.condition
    }

    /// Velocities of the motors, J v.
    ///
    /// # Errors
    /// [`Error::NotFinite`] or [`Error::Overflow`].
    pub fn motor_velocities(&self, joint_velocities: &[T; R]) -> Result<[T; N], Error> {
        finite("joint_velocities", joint_velocities)?;
        vector(times(&self.jacobian, joint_velocities))
    }

    /// Velocities of the joints, J⁺ q̇: least squares if there are more motors than joints.
    ///
    /// # Errors
    /// [`Error::NotFinite`] or [`Error::Overflow`].
    pub fn joint_velocities(&self, motor_velocities: &[T; N]) -> Result<[T; R], Error> {
        finite("motor_velocities", motor_velocities)?;
        vector(times(&self.inverse, motor_velocities))
    }

    /// Accelerations of the motors, J v̇ + J̇ v.
    ///
    /// `bias` is J̇ v, the accelerations of the motors while v is constant: those of the motors
    /// among the generated `joint_accelerations` with acceleration zero.
    ///
    /// # Errors
    /// [`Error::NotFinite`] or [`Error::Overflow`].
    pub fn motor_accelerations(
        &self,
        joint_accelerations: &[T; R],
        bias: &[T; N],
    ) -> Result<[T; N], Error> {
        finite("joint_accelerations", joint_accelerations)?;
        finite("bias", bias)?;
        let mut all = times(&self.jacobian, joint_accelerations);
        for (own, bias) in all.iter_mut().zip(bias) {
            *own += *bias;
        }
        vector(all)
    }

    /// Accelerations of the joints, J⁺ (q̈ - J̇ v); `bias` is J̇ v.
    ///
    /// # Errors
    /// [`Error::NotFinite`] or [`Error::Overflow`].
    pub fn joint_accelerations(
        &self,
        motor_accelerations: &[T; N],
        bias: &[T; N],
    ) -> Result<[T; R], Error> {
        finite("motor_accelerations", motor_accelerations)?;
        finite("bias", bias)?;
        let rest = core::array::from_fn(|a| motor_accelerations[a] - bias[a]);
        vector(times(&self.inverse, &rest))
    }

    /// Torques that the joints receive from motor torques, Jᵀ τ.
    ///
    /// # Errors
    /// [`Error::NotFinite`] or [`Error::Overflow`].
    pub fn joint_torques(&self, motor_torques: &[T; N]) -> Result<[T; R], Error> {
        finite("motor_torques", motor_torques)?;
        vector(transposed_times(&self.jacobian, motor_torques))
    }

    /// Motor torques of least norm that give joint torques, J⁺ᵀ τ.
    ///
    /// # Errors
    /// [`Error::NotFinite`] or [`Error::Overflow`].
    pub fn motor_torques(&self, joint_torques: &[T; R]) -> Result<[T; N], Error> {
        finite("joint_torques", joint_torques)?;
        vector(transposed_times(&self.inverse, joint_torques))
    }

    /// Inertia of the rotors as the joints feel it, Jᵀ diag(I) J.
    ///
    /// `rotor_inertias` are those of the parameters `ia`, after the gear (kg m², kg).
    ///
    /// # Errors
    /// [`Error::NotFinite`] or [`Error::Overflow`].
    pub fn reflected_inertia(&self, rotor_inertias: &[T; N]) -> Result<[[T; R]; R], Error> {
        finite("rotor_inertias", rotor_inertias)?;
        matrix(algebra::congruence(&self.jacobian, rotor_inertias))
    }
}

/// Derivative of the Jacobian at a pose, from accelerations J̇ v of the motors.
///
/// `bias` returns J̇ v for a velocity v, see
/// [`motor_accelerations`](Transmission::motor_accelerations). It is a quadratic form vᵀ H v of each
/// motor, so R (R + 1)/2 calls determine H exactly. If the twist has several rotations in space, H
/// is the symmetric part of ∂J/∂δ.
///
/// ```
/// use overact::transmission::curvature;
///
/// // A motor at the angle q² / 2 has J = q and J̇ v = v².
/// let [[[h]]] = curvature(|&[v]: &[f64; 1]| Ok::<_, ()>([v * v]))?;
/// assert_eq!(h, 1.0);
/// # Ok::<(), ()>(())
/// ```
///
/// # Errors
/// The first error of `bias`.
pub fn curvature<const N: usize, const R: usize, T: Float, E>(
    mut bias: impl FnMut(&[T; R]) -> Result<[T; N], E>,
) -> Result<Curvature<N, R, T>, E> {
    let mut curvature = [[[T::ZERO; R]; R]; N];
    let unit = |i: usize, j: usize| {
        let is_one = |k: usize| if k == i || k == j { 1.0 } else { 0.0 };
        core::array::from_fn(|k| T::of(is_one(k)))
    };
    for i in 0..R {
        for (second, own) in curvature.iter_mut().zip(bias(&unit(i, i))?) {
            second[i][i] = own;
        }
    }
    for i in 0..R {
        for j in 0..i {
            for (second, both) in curvature.iter_mut().zip(bias(&unit(i, j))?) {
                let mixed = T::of(0.5) * (both - second[i][i] - second[j][j]);
                second[i][j] = mixed;
                second[j][i] = mixed;
            }
        }
    }
    Ok(curvature)
}
