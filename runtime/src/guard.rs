//! What generated functions check: at their boundary that all inputs are finite and a pose's quaternion
//! has a direction, and on the way that a configuration can be reached and is regular. Each is an error
//! that names the input or the leg, not a NaN.

use crate::math::sqrt;
use crate::{Error, SINGULAR};

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
        Ok(())
    } else {
        Err(not_finite(inputs))
    }
}

/// The error of the first input that is not finite, out of the way of what is usual.
#[cold]
#[inline(never)]
fn not_finite(inputs: &[Named<'_>]) -> Error {
    let is_bad = |(_, values): &&Named<'_>| values.iter().any(|value| !value.is_finite());
    let input = inputs.iter().find(is_bad).map_or("", |(name, _)| name);
    Error::NotFinite { input }
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
    if !(1e-200..1e200).contains(&square) {
        return normalise_extreme(quaternion, input);
    }
    let scale = 1.0 / sqrt(square);
    *quaternion = quaternion.map(|q| q * scale);
    Ok(())
}

/// Quaternions whose squares are too small or too large for a number.
#[cold]
#[inline(never)]
fn normalise_extreme(quaternion: &mut [f64; 4], input: &'static str) -> Result<(), Error> {
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
pub fn platform(determinant: f64, home: f64, actuators: &'static str) -> Result<(), Error> {
    if determinant.abs() > SINGULAR * home {
        Ok(())
    } else {
        Err(Error::SingularPlatform {
            actuators,
            condition: home / determinant.abs(),
        })
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
