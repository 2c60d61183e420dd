//! What generated functions check: at their boundary that all inputs are finite and a pose's quaternion
//! has a direction, and on the way that a configuration can be reached and is regular. Each is an error
//! that names the input or the leg, not a NaN.

use crate::math::sqrt;
use crate::{ActuatorGroup, Error, SINGULAR};

/// How far from 1 the square of a quaternion's length may be for its inverse root to be linear: the error
/// is 3/8 of the square of this.
const NEAR: f64 = 1e-8;

/// An input with the name that errors call it by.
pub type Named<'a> = (&'static str, &'a [f64]);

/// All numbers of all inputs must be finite.
///
/// # Errors
/// [`Error::NotFinite`] of the first input that has another one.
#[inline(always)]
pub fn finite(inputs: &[Named<'_>]) -> Result<(), Error> {
    // x - x is zero but for NaN and infinities. One comparison for all: there is nothing to gain from an
    // early end, and without one the loops become vectors.
    let mut bits = 0;
    for (_, values) in inputs {
        for value in *values {
            #[expect(clippy::eq_op, reason = "zero for finite numbers only")]
            let zero = value - value;
            bits |= zero.to_bits();
        }
    }
    if bits == 0 {
        return Ok(());
    }
    // The inputs are handed out one by one: a reference to all of them would keep a table of them on the
    // stack, which is then filled at every call.
    let mut input = "";
    for (name, values) in inputs.iter().rev() {
        if has_other(values) {
            input = name;
        }
    }
    Err(Error::NotFinite { input })
}

/// Whether an input has a number that is not finite, out of the way of what is usual.
#[cold]
#[inline(never)]
fn has_other(values: &[f64]) -> bool {
    values.iter().any(|value| !value.is_finite())
}

/// A pose that ends with a quaternion (w, x, y, z), with the quaternion scaled to length 1.
///
/// # Errors
/// [`Error::ZeroQuaternion`]. The numbers must be finite.
#[inline(always)]
pub fn unit_quaternion<const N: usize>(
    pose: &[f64; N],
    input: &'static str,
) -> Result<[f64; N], Error> {
    let mut unit = *pose;
    normalise(&mut unit, input)?;
    Ok(unit)
}

/// Scales the quaternion at the end of a pose to length 1.
///
/// # Errors
/// [`Error::ZeroQuaternion`].
#[inline(always)]
pub fn normalise(pose: &mut [f64], input: &'static str) -> Result<(), Error> {
    let Some(quaternion) = pose.last_chunk_mut::<4>() else {
        return Ok(());
    };
    let [w, x, y, z] = *quaternion;
    let square = w * w + x * x + y * y + z * z;
    // Mostly the length is 1 but for rounding; 1/√s is (3 - s)/2 then, to the last digit.
    if (square - 1.0).abs() > NEAR {
        return normalise_others(quaternion, input);
    }
    let scale = 1.5 - 0.5 * square;
    *quaternion = quaternion.map(|q| q * scale);
    Ok(())
}

/// Quaternions of any length; the largest number is scaled to 1 first, so that squares are neither too
/// small nor too large for a number.
#[cold]
#[inline(never)]
fn normalise_others(quaternion: &mut [f64; 4], input: &'static str) -> Result<(), Error> {
    let largest = quaternion.iter().fold(0.0_f64, |m, q| m.max(q.abs()));
    if largest == 0.0 {
        return Err(Error::ZeroQuaternion { input });
    }
    let scaled = quaternion.map(|q| q / largest);
    let norm = sqrt(scaled.iter().map(|q| q * q).sum());
    *quaternion = scaled.map(|q| q / norm);
    Ok(())
}

/// The radicand of a leg's inverse kinematics must not be negative.
///
/// # Errors
/// [`Error::OutOfReach`]; also for NaN.
#[inline]
pub fn reach(radicand: f64, leg: &'static str) -> Result<(), Error> {
    if radicand >= 0.0 {
        Ok(())
    } else {
        Err(Error::OutOfReach { leg })
    }
}

/// A leg's determinant must not vanish; `home` is its magnitude at home.
///
/// # Errors
/// [`Error::SingularLeg`]; also for NaN.
#[inline]
pub fn leg(determinant: f64, home: f64, leg: &'static str) -> Result<(), Error> {
    if determinant.abs() > SINGULAR * home {
        Ok(())
    } else {
        Err(Error::SingularLeg {
            leg,
            condition: home / determinant.abs(),
        })
    }
}

/// The determinant of the (kept) actuators' Jacobian must not vanish.
///
/// # Errors
/// [`Error::SingularPlatform`]; also for NaN.
#[inline]
pub fn platform(determinant: f64, home: f64, actuators: ActuatorGroup) -> Result<(), Error> {
    if determinant.abs() > SINGULAR * home {
        Ok(())
    } else {
        Err(Error::SingularPlatform {
            actuators,
            condition: home / determinant.abs(),
        })
    }
}

/// What a pose misses of what a leg allows must be small: at most `within` (m, rad).
///
/// # Errors
/// [`Error::NotClosed`]; also for NaN.
#[inline]
pub fn closed(gap: f64, within: f64, leg: &'static str) -> Result<(), Error> {
    if gap.abs() <= within {
        Ok(())
    } else {
        let gap = gap.abs();
        Err(Error::NotClosed { leg, gap })
    }
}

/// The determinant by which the independent coordinates of a platform that moves aside give the others must
/// not vanish; `home` is its magnitude at home.
///
/// # Errors
/// [`Error::SingularCoordinates`]; also for NaN.
#[inline]
pub fn coordinates(determinant: f64, home: f64) -> Result<(), Error> {
    if determinant.abs() > SINGULAR * home {
        Ok(())
    } else {
        let condition = home / determinant.abs();
        Err(Error::SingularCoordinates { condition })
    }
}

/// A pivot of the mass matrix must be positive.
///
/// # Errors
/// [`Error::MassMatrix`]; also for NaN.
#[inline]
pub fn mass(pivot: f64) -> Result<(), Error> {
    if pivot > 0.0 {
        Ok(())
    } else {
        Err(Error::MassMatrix)
    }
}

#[cfg(test)]
mod tests {
    use super::{finite, unit_quaternion};
    use crate::Error;

    #[test]
    fn the_first_input_that_is_not_finite_is_named() {
        let large = [f64::MAX, -f64::MAX, f64::MIN_POSITIVE, -0.0];
        for bad in [f64::NAN, f64::INFINITY, f64::NEG_INFINITY] {
            for at in 0..5 {
                let mut twist = [1.0; 5];
                twist[at] = bad;
                let found = finite(&[("pose", &large), ("twist", &twist), ("torques", &[bad])]);
                assert_eq!(found, Err(Error::NotFinite { input: "twist" }));
            }
        }
        assert_eq!(finite(&[("pose", &large), ("twist", &large)]), Ok(()));
    }

    #[test]
    fn quaternions_of_any_length_are_scaled() {
        for length in [1e-300, 1e-150, 0.3, 1.0, 7.0, 1e150, 1e300] {
            let pose = [5.0, length, 0.0, -length, 2.0 * length];
            let unit = unit_quaternion(&pose, "pose").expect("a rotation");
            let sixth = 1.0 / 6.0_f64.sqrt();
            let expected = [5.0, sixth, 0.0, -sixth, 2.0 * sixth];
            for (found, expected) in unit.iter().zip(expected) {
                assert!((found - expected).abs() < 1e-15, "{length:e}: {unit:?}");
            }
        }
        let zero = unit_quaternion(&[1.0, 0.0, 0.0, -0.0, 0.0], "start");
        assert_eq!(zero, Err(Error::ZeroQuaternion { input: "start" }));
    }
}
