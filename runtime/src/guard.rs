//! Checks in generated functions.
//!
//! At the start, all inputs have to be finite and a pose's quaternion nonzero. Later, the
//! configuration has to be reachable and regular. Each failure is an error that names the input or
//! the leg, not a NaN.

use crate::float::Float;
use crate::{ActuatorGroup, Error};

/// An input with its name for errors.
pub type NamedInput<'a, T> = (&'static str, &'a [T]);

/// An input with its name for errors and the largest magnitude of its numbers.
pub type Bounded<'a, T> = (&'static str, &'a [T], T);

/// Checks that all numbers of all inputs are finite and in range, so that values computed from them
/// do not overflow.
///
/// # Errors
/// [`Error::NotFinite`] or [`Error::OutOfRange`] for the first invalid input.
#[inline(always)]
pub fn within<T: Float>(inputs: &[Bounded<'_, T>]) -> Result<(), Error> {
    // One comparison for all: an early exit would save nothing, and without it the loops are
    // vectorised.
    let mut good = true;
    for (_, values, most) in inputs {
        for value in *values {
            good &= value.abs() <= *most;
        }
    }
    if good {
        return Ok(());
    }
    // The inputs are passed one by one, as in `finite`.
    let mut error = Error::Overflow;
    for (input, values, most) in inputs.iter().rev() {
        error = out_of_range(input, values, *most).unwrap_or(error);
    }
    Err(error)
}

/// The error of an input, kept out of line.
#[cold]
#[inline(never)]
fn out_of_range<T: Float>(input: &'static str, values: &[T], most: T) -> Option<Error> {
    if has_other(values) {
        return Some(Error::NotFinite { input });
    }
    let is_large = values.iter().any(|value| value.abs() > most);
    is_large.then_some(Error::OutOfRange { input })
}

/// Checks that all numbers of all inputs are finite.
///
/// # Errors
/// [`Error::NotFinite`] for the first invalid input.
#[inline(always)]
pub fn finite<T: Float>(inputs: &[NamedInput<'_, T>]) -> Result<(), Error> {
    // x - x is zero except for NaN and infinities. One comparison for all: an early exit would save
    // nothing, and without it the loops are vectorised.
    let mut bits = 0;
    for (_, values) in inputs {
        for value in *values {
            #[expect(clippy::eq_op, reason = "zero for finite numbers only")]
            let zero = *value - *value;
            bits |= zero.bits();
        }
    }
    if bits == 0 {
        return Ok(());
    }
    // The inputs are passed one by one: a reference to all of them would keep a table on the stack,
    // which every call would fill.
    let mut input = "";
    for (name, values) in inputs.iter().rev() {
        if has_other(values) {
            input = name;
        }
    }
    Err(Error::NotFinite { input })
}

/// Whether an input has a number that is not finite, kept out of line.
#[cold]
#[inline(never)]
fn has_other<T: Float>(values: &[T]) -> bool {
    values.iter().any(|value| !value.is_finite())
}

/// A pose that ends with a quaternion (w, x, y, z), with the quaternion normalised.
///
/// # Errors
/// [`Error::ZeroQuaternion`]. The numbers have to be finite.
#[inline(always)]
pub fn unit_quaternion<T: Float, const N: usize>(
    pose: &[T; N],
    input: &'static str,
) -> Result<[T; N], Error> {
    let mut unit = *pose;
    normalise(&mut unit, input)?;
    Ok(unit)
}

/// Normalises the quaternion at the end of a pose.
///
/// # Errors
/// [`Error::ZeroQuaternion`].
#[inline(always)]
pub fn normalise<T: Float>(pose: &mut [T], input: &'static str) -> Result<(), Error> {
    let Some(quaternion) = pose.last_chunk_mut::<4>() else {
        return Ok(());
    };
    let [w, x, y, z] = *quaternion;
    let square = w * w + x * x + y * y + z * z;
    // Usually the length is 1 up to rounding; then 1/√s is (3 - s)/2 to the last digit.
    if (square - T::of(1.0)).abs() > T::of(T::LIMITS.quaternion) {
        return normalise_others(quaternion, input);
    }
    let scale = T::of(1.5) - T::of(0.5) * square;
    *quaternion = quaternion.map(|q| q * scale);
    Ok(())
}

/// Normalises quaternions of any length.
///
/// The largest number is scaled to 1 first, so that squares neither overflow nor underflow.
#[cold]
#[inline(never)]
fn normalise_others<T: Float>(quaternion: &mut [T; 4], input: &'static str) -> Result<(), Error> {
    let largest = quaternion.iter().fold(T::ZERO, |m, q| m.max(q.abs()));
    if largest == T::ZERO {
        return Err(Error::ZeroQuaternion { input });
    }
    let scaled = quaternion.map(|q| q / largest);
    let norm = scaled.iter().map(|q| *q * *q).sum::<T>().sqrt();
    *quaternion = scaled.map(|q| q / norm);
    Ok(())
}

/// Checks that the radicand of a leg's inverse kinematics is neither negative nor dominated by
/// rounding.
///
/// `home` is its value at home; zero if only the sign matters.
///
/// # Errors
/// [`Error::OutOfReach`], also for NaN; [`Error::SingularLeg`] near the limit of the leg's reach.
#[inline]
pub fn reach<T: Float>(radicand: T, home: T, leg: &'static str) -> Result<(), Error> {
    if radicand >= T::of(T::LIMITS.radicand) * home {
        Ok(())
    } else {
        Err(not_reached(radicand, home, leg))
    }
}

/// The error of a radicand. A leg's determinant is proportional to its root.
#[cold]
fn not_reached<T: Float>(radicand: T, home: T, leg: &'static str) -> Error {
    if radicand >= T::ZERO {
        let condition = (home / radicand).sqrt().into();
        Error::SingularLeg { leg, condition }
    } else {
        Error::OutOfReach { leg }
    }
}

/// Checks that a value is at most `most`, so that values computed from it do not overflow.
///
/// # Errors
/// [`Error::Overflow`]; also for NaN.
#[inline]
pub fn size<T: Float>(value: T, most: T) -> Result<(), Error> {
    if value.abs() <= most {
        Ok(())
    } else {
        Err(Error::Overflow)
    }
}

/// Checks that a leg's determinant does not vanish; `home` is its magnitude at home.
///
/// # Errors
/// [`Error::SingularLeg`]; also for NaN.
#[inline]
pub fn leg<T: Float>(determinant: T, home: T, leg: &'static str) -> Result<(), Error> {
    if determinant.abs() > T::of(T::LIMITS.singular) * home {
        Ok(())
    } else {
        Err(Error::SingularLeg {
            leg,
            condition: (home / determinant.abs()).into(),
        })
    }
}

/// Checks that the determinant of the (kept) actuators' Jacobian does not vanish.
///
/// # Errors
/// [`Error::SingularPlatform`]; also for NaN.
#[inline]
pub fn platform<T: Float>(determinant: T, home: T, actuators: ActuatorGroup) -> Result<(), Error> {
    if determinant.abs() > T::of(T::LIMITS.singular) * home {
        Ok(())
    } else {
        Err(Error::SingularPlatform {
            actuators,
            condition: (home / determinant.abs()).into(),
        })
    }
}

/// Checks that the closure error of a pose is at most `within` (m, rad).
///
/// # Errors
/// [`Error::NotClosed`]; also for NaN.
#[inline]
pub fn closed<T: Float>(gap: T, within: T, leg: &'static str) -> Result<(), Error> {
    if gap.abs() <= within {
        Ok(())
    } else {
        let gap = gap.abs().into();
        Err(Error::NotClosed { leg, gap })
    }
}

/// Checks the determinant of the dependent coordinates of a platform with parasitic motion.
///
/// It must not vanish; `home` is its magnitude at home.
///
/// # Errors
/// [`Error::SingularCoordinates`]; also for NaN.
#[inline]
pub fn coordinates<T: Float>(determinant: T, home: T) -> Result<(), Error> {
    if determinant.abs() > T::of(T::LIMITS.singular) * home {
        Ok(())
    } else {
        let condition = (home / determinant.abs()).into();
        Err(Error::SingularCoordinates { condition })
    }
}

/// Checks that a pivot of the mass matrix is positive.
///
/// # Errors
/// [`Error::MassMatrix`]; also for NaN.
#[inline]
pub fn mass<T: Float>(pivot: T) -> Result<(), Error> {
    if pivot > T::ZERO {
        Ok(())
    } else {
        Err(Error::MassMatrix)
    }
}

#[cfg(test)]
mod tests {
    use super::{finite, leg, reach, size, unit_quaternion, within};
    use crate::Error;

    #[test]
    fn the_first_non_finite_input_is_reported() {
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
    fn the_first_input_beyond_its_range_is_reported() {
        let (pose, twist) = ([1e3, -1e3], [0.5, 2.0]);
        let check =
            |pose: &[f64], twist: &[f64]| within(&[("pose", pose, 1e3), ("twist", twist, 2.0)]);
        assert_eq!(check(&pose, &twist), Ok(()));
        let too_large = Err(Error::OutOfRange { input: "twist" });
        assert_eq!(check(&pose, &[-2.1, 0.0]), too_large);
        let not_finite = Err(Error::NotFinite { input: "pose" });
        assert_eq!(check(&[f64::NAN, 0.0], &[-2.1, 0.0]), not_finite);
        assert_eq!(check(&[1e4, f64::INFINITY], &twist), not_finite);
    }

    #[test]
    fn radicands_of_rounding_size_are_singular() {
        assert_eq!(reach(1e-12, 1.0, "a"), Ok(()));
        assert_eq!(reach(0.0, 0.0, "a"), Ok(()));
        let near = reach(1e-16, 1.0, "a");
        assert!(
            matches!(near, Err(Error::SingularLeg { leg: "a", condition }) if (condition / 1e8 - 1.0).abs() < 1e-9),
            "{near:?}"
        );
        let zero = reach(0.0, 1.0, "a");
        assert!(matches!(zero, Err(Error::SingularLeg { .. })), "{zero:?}");
        for beyond in [-1e-16, f64::NAN] {
            assert_eq!(reach(beyond, 1.0, "a"), Err(Error::OutOfReach { leg: "a" }));
        }
        assert!(matches!(
            reach(1e-6_f32, 1.0, "a"),
            Err(Error::SingularLeg { .. })
        ));
    }

    #[test]
    fn too_large_values_are_overflows() {
        assert_eq!(size(-1e100, 1e100), Ok(()));
        for bad in [1.1e100, f64::INFINITY, f64::NAN] {
            assert_eq!(size(bad, 1e100), Err(Error::Overflow));
        }
    }

    #[test]
    fn single_precision_numbers_are_checked_alike() {
        let bad = finite(&[("pose", &[1.0_f32, f32::MAX]), ("twist", &[f32::NAN])]);
        assert_eq!(bad, Err(Error::NotFinite { input: "twist" }));
        assert_eq!(finite(&[("pose", &[f32::MIN_POSITIVE, -0.0])]), Ok(()));
        for length in [1e-30_f32, 0.3, 1.0, 1.000_09, 1e30] {
            let unit = unit_quaternion(&[length, 0.0, -length, 2.0 * length], "pose");
            let sum: f32 = unit.expect("a rotation").iter().map(|q| q * q).sum();
            assert!((sum - 1.0).abs() < 3e-7, "{length:e}: {sum}");
        }
        assert_eq!(leg(1.1e-5_f32, 1.0, "a"), Ok(()));
        assert!(leg(0.9e-5_f32, 1.0, "a").is_err());
    }

    #[test]
    fn quaternions_are_normalised_and_zero_is_rejected() {
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
