//! Conditions that generated functions check on the way: a singular or unreachable configuration is
//! an error that names the leg, not a NaN.

use crate::Error;

/// A determinant below this fraction of its magnitude at home counts as zero.
pub const SINGULAR: f64 = 1e-9;

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
