//! What [`guard`] checks, in every lane: of several legs that fail in the same the first is told.

use super::{Lanes, Legs as _, Turn, load};
use crate::{Error, guard};

/// The radicand of the legs' inverse kinematics must not be negative.
///
/// # Errors
/// [`Error::OutOfReach`]; also for NaN.
#[inline(always)]
pub fn reach<const LEGS: usize>(
    radicand: impl Into<Lanes>,
    legs: &[&'static str; LEGS],
    at: Turn<LEGS>,
) -> Result<(), Error> {
    let radicands = radicand.into().to_array();
    if radicands.iter().all(|radicand| *radicand >= 0.0) {
        return Ok(());
    }
    each(&radicands, legs, at, &|radicand, _, leg| {
        guard::reach(radicand, leg)
    })
}

/// The legs' determinants must not vanish; `home` are their magnitudes at home.
///
/// # Errors
/// [`Error::SingularLeg`]; also for NaN.
#[inline(always)]
pub fn leg<const LEGS: usize>(
    determinant: impl Into<Lanes>,
    home: &[f64; LEGS],
    legs: &[&'static str; LEGS],
    at: Turn<LEGS>,
) -> Result<(), Error> {
    let determinants = determinant.into().to_array();
    let homes = load(home, at).to_array();
    let mut pairs = determinants.iter().zip(&homes);
    if pairs.all(|(determinant, home)| determinant.abs() > overact_core::SINGULAR * home) {
        return Ok(());
    }
    each(&determinants, legs, at, &|determinant, lane, leg| {
        guard::leg(
            determinant,
            homes.get(lane).copied().unwrap_or_default(),
            leg,
        )
    })
}

/// What a pose misses of what the legs allow must be small: at most `within` (m, rad).
///
/// # Errors
/// [`Error::NotClosed`]; also for NaN.
#[inline(always)]
pub fn closed<const LEGS: usize>(
    gap: impl Into<Lanes>,
    within: f64,
    legs: &[&'static str; LEGS],
    at: Turn<LEGS>,
) -> Result<(), Error> {
    let gaps = gap.into().to_array();
    if gaps.iter().all(|gap| gap.abs() <= within) {
        return Ok(());
    }
    each(&gaps, legs, at, &|gap, _, leg| {
        guard::closed(gap, within, leg)
    })
}

/// The error of the first lane that has one.
#[cold]
#[inline(never)]
fn each<const LEGS: usize>(
    values: &[f64],
    legs: &[&'static str; LEGS],
    at: Turn<LEGS>,
    check: &dyn Fn(f64, usize, &'static str) -> Result<(), Error>,
) -> Result<(), Error> {
    let mut lanes = values.iter().enumerate();
    lanes.try_for_each(|(lane, value)| {
        let leg = legs.get(at.leg(lane)).copied().unwrap_or_default();
        check(*value, lane, leg)
    })
}
