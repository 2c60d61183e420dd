//! Limits of motors as limits of joints at a pose.

use super::algebra::{finite, times, transposed_times};
use super::{Error, Transmission};
use crate::float::Float;

/// Interval of a speed or torque, which contains zero.
///
/// An infinite end means no limit.
///
/// ```
/// use overact::transmission::Interval;
///
/// let limit = Interval::symmetric(12.0);
/// assert_eq!((limit.least, limit.most), (-12.0, 12.0));
/// ```
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Interval<T = f64> {
    /// Smallest value, at most zero.
    pub least: T,
    /// Largest value, at least zero.
    pub most: T,
}

impl<T: Float> Interval<T> {
    /// From -`most` to `most`.
    #[must_use]
    pub fn symmetric(most: T) -> Self {
        Self { least: -most, most }
    }
}

impl<const N: usize, const R: usize, T: Float> Transmission<N, R, T> {
    /// Speed of each joint at which a motor reaches a limit, if the other joints rest.
    ///
    /// `motor_speeds` are the limits of the motors (rad/s, m/s). The same function converts small
    /// displacements.
    ///
    /// ```
    /// use overact::transmission::{Interval, Transmission};
    ///
    /// let ankle = Transmission::new(&[[0.8, 0.5], [0.8, -0.5]])?;
    /// let [pitch, roll] = ankle.speed_intervals(&[Interval::symmetric(12.0); 2])?;
    /// assert!((pitch.most - 15.0_f64).abs() < 1e-12 && (roll.most - 24.0_f64).abs() < 1e-12);
    /// # Ok::<(), overact::transmission::Error>(())
    /// ```
    ///
    /// # Errors
    /// [`Error::Setting`] for limits that do not contain zero.
    pub fn speed_intervals(
        &self,
        motor_speeds: &[Interval<T>; N],
    ) -> Result<[Interval<T>; R], Error> {
        check(motor_speeds)?;
        Ok(core::array::from_fn(|joint| {
            along(&self.jacobian.map(|row| row[joint]), motor_speeds)
        }))
    }

    /// Largest factor s by which joint speeds s d are within the limits of all motors.
    ///
    /// # Errors
    /// [`Error::Setting`] for a zero direction or limits that do not contain zero, or
    /// [`Error::NotFinite`].
    pub fn speed_factor(
        &self,
        direction: &[T; R],
        motor_speeds: &[Interval<T>; N],
    ) -> Result<T, Error> {
        check(motor_speeds)?;
        check_direction(direction)?;
        Ok(along(&times(&self.jacobian, direction), motor_speeds).most)
    }

    /// Torque of each joint at which a motor reaches a limit, if the other joints have no torque.
    ///
    /// `motor_torques` are the limits of the motors (N m, N). Redundant motors share the torques
    /// with the least norm, so other shares may reach further.
    ///
    /// # Errors
    /// [`Error::Setting`] for limits that do not contain zero.
    pub fn torque_intervals(
        &self,
        motor_torques: &[Interval<T>; N],
    ) -> Result<[Interval<T>; R], Error> {
        check(motor_torques)?;
        Ok(core::array::from_fn(|joint| {
            along(&self.inverse[joint], motor_torques)
        }))
    }

    /// Largest factor s by which joint torques s d are within the limits of all motors.
    ///
    /// Redundant motors share the torques with the least norm.
    ///
    /// # Errors
    /// [`Error::Setting`] for a zero direction or limits that do not contain zero, or
    /// [`Error::NotFinite`].
    pub fn torque_factor(
        &self,
        direction: &[T; R],
        motor_torques: &[Interval<T>; N],
    ) -> Result<T, Error> {
        check(motor_torques)?;
        check_direction(direction)?;
        Ok(along(&transposed_times(&self.inverse, direction), motor_torques).most)
    }
}

/// Factors by which a vector is within the limits.
fn along<const N: usize, T: Float>(vector: &[T; N], limits: &[Interval<T>; N]) -> Interval<T> {
    let mut all = Interval {
        least: -T::INFINITY,
        most: T::INFINITY,
    };
    for (number, limit) in vector.iter().zip(limits) {
        let (least, most) = if *number > T::ZERO {
            (limit.least / *number, limit.most / *number)
        } else if *number < T::ZERO {
            (limit.most / *number, limit.least / *number)
        } else {
            continue;
        };
        all.least = all.least.max(least);
        all.most = all.most.min(most);
    }
    all
}

fn check<T: Float>(limits: &[Interval<T>]) -> Result<(), Error> {
    // The comparisons fail for NaN too.
    if limits
        .iter()
        .all(|limit| limit.least <= T::ZERO && limit.most >= T::ZERO)
    {
        Ok(())
    } else {
        Err(Error::Setting {
            setting: "limits",
            condition: "intervals that contain zero",
        })
    }
}

fn check_direction<T: Float>(direction: &[T]) -> Result<(), Error> {
    finite("direction", direction)?;
    if direction.iter().any(|entry| entry.abs() > T::ZERO) {
        Ok(())
    } else {
        Err(Error::Setting {
            setting: "direction",
            condition: "different from zero",
        })
    }
}
