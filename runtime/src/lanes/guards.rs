//! What [`guard`] checks, in every lane: of several legs that fail in the same the first is told.

use super::{Lanes, Turn, Vector, row};
use crate::{Error, guard};

/// The radicand of the legs' inverse kinematics must not be negative.
///
/// # Errors
/// [`Error::OutOfReach`]; also for NaN.
#[inline(always)]
pub fn reach<V: Vector, const LEGS: usize>(
    radicand: impl Into<Lanes<V>>,
    legs: &[&'static str; LEGS],
    at: Turn<V, LEGS>,
) -> Result<(), Error> {
    let radicands = radicand.into().0;
    if radicands.every(|radicand| radicand >= 0.0) {
        return Ok(());
    }
    each(legs, at, &|lane, leg| {
        guard::reach(radicands.lane(lane), leg)
    })
}

/// The legs' determinants must not vanish; `home` are their magnitudes at home.
///
/// # Errors
/// [`Error::SingularLeg`]; also for NaN.
#[inline(always)]
pub fn leg<V: Vector, const LEGS: usize>(
    determinant: impl Into<Lanes<V>>,
    home: &[f64; LEGS],
    legs: &[&'static str; LEGS],
    at: Turn<V, LEGS>,
) -> Result<(), Error> {
    let (determinants, homes) = (determinant.into().0, row(home, at).0);
    let mut lane = 0..;
    let is_regular = |determinant: f64| {
        let home = homes.lane(lane.next().unwrap_or_default());
        determinant.abs() > overact_core::SINGULAR * home
    };
    if determinants.every(is_regular) {
        return Ok(());
    }
    each(legs, at, &|lane, leg| {
        guard::leg(determinants.lane(lane), homes.lane(lane), leg)
    })
}

/// What a pose misses of what the legs allow must be small: at most `within` (m, rad).
///
/// # Errors
/// [`Error::NotClosed`]; also for NaN.
#[inline(always)]
pub fn closed<V: Vector, const LEGS: usize>(
    gap: impl Into<Lanes<V>>,
    within: f64,
    legs: &[&'static str; LEGS],
    at: Turn<V, LEGS>,
) -> Result<(), Error> {
    let gaps = gap.into().0;
    if gaps.every(|gap| gap.abs() <= within) {
        return Ok(());
    }
    each(legs, at, &|lane, leg| {
        guard::closed(gaps.lane(lane), within, leg)
    })
}

/// The error of the first lane that has one.
#[cold]
#[inline(never)]
fn each<V: Vector, const LEGS: usize>(
    legs: &[&'static str; LEGS],
    at: Turn<V, LEGS>,
    check: &dyn Fn(usize, &'static str) -> Result<(), Error>,
) -> Result<(), Error> {
    (0..V::WIDTH).try_for_each(|lane| {
        let leg = legs.get(at.leg(lane)).copied().unwrap_or_default();
        check(lane, leg)
    })
}
