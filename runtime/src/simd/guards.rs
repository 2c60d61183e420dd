//! The checks of [`guard`] in every lane.
//!
//! If several legs fail, the first leg is reported, as in code that computes legs one after the
//! other. Another leg may have failed in an earlier condition.

use super::{OfLegs, Turn, Vector, row};
use crate::{Error, guard};

/// The first failing leg, with its error.
#[derive(Debug, Default)]
pub struct Failed(Option<(usize, Error)>);

impl Failed {
    /// No failure.
    #[inline(always)]
    #[must_use]
    pub const fn none() -> Self {
        Self(None)
    }

    /// Returns the error of the leg that failed.
    ///
    /// # Errors
    /// The error of that leg.
    #[inline(always)]
    pub fn result(self) -> Result<(), Error> {
        self.0.map_or(Ok(()), |(_, error)| Err(error))
    }

    /// Records the first lane that fails, unless an earlier leg has failed.
    #[cold]
    #[inline(never)]
    fn note<V: Vector, const LEGS: usize>(
        &mut self,
        legs: &[&'static str; LEGS],
        at: Turn<V, LEGS>,
        check: &dyn Fn(usize, &'static str) -> Result<(), Error>,
    ) {
        for lane in 0..V::WIDTH {
            let leg = at.leg(lane);
            let name = legs.get(leg).copied().unwrap_or_default();
            if self.0.as_ref().is_some_and(|(known, _)| *known <= leg) {
                return;
            }
            if let Err(error) = check(lane, name) {
                self.0 = Some((leg, error));
                return;
            }
        }
    }
}

/// Checks that the radicands of the legs' inverse kinematics are neither negative nor dominated by
/// rounding.
///
/// `home` are their values at home. Otherwise, and for NaN, [`Error::OutOfReach`] or
/// [`Error::SingularLeg`].
#[inline(always)]
pub fn reach<V: Vector, const LEGS: usize>(
    failed: &mut Failed,
    radicand: impl OfLegs<V>,
    home: &[f64; LEGS],
    legs: &[&'static str; LEGS],
    at: Turn<V, LEGS>,
) {
    let (radicands, homes) = (radicand.of_legs(at.1), row(home, at).0);
    let mut lane = 0..;
    let is_reached = |radicand: f64| {
        let home = homes.lane(lane.next().unwrap_or_default());
        radicand >= overact_core::limits::DOUBLE.radicand * home
    };
    if !radicands.every(is_reached) {
        failed.note(legs, at, &move |lane, leg| {
            guard::reach(radicands.lane(lane), homes.lane(lane), leg)
        });
    }
}

/// Checks that values of the legs are at most `most`. Otherwise, and for NaN, [`Error::Overflow`].
#[inline(always)]
pub fn size<V: Vector, const LEGS: usize>(
    failed: &mut Failed,
    value: impl OfLegs<V>,
    most: f64,
    legs: &[&'static str; LEGS],
    at: Turn<V, LEGS>,
) {
    let values = value.of_legs(at.1);
    if !values.every(|value| value.abs() <= most) {
        failed.note(legs, at, &move |lane, _| {
            guard::size(values.lane(lane), most)
        });
    }
}

/// Checks that the legs' determinants do not vanish; `home` are their magnitudes at home.
///
/// Otherwise, and for NaN, [`Error::SingularLeg`].
#[inline(always)]
pub fn leg<V: Vector, const LEGS: usize>(
    failed: &mut Failed,
    determinant: impl OfLegs<V>,
    home: &[f64; LEGS],
    legs: &[&'static str; LEGS],
    at: Turn<V, LEGS>,
) {
    let (determinants, homes) = (determinant.of_legs(at.1), row(home, at).0);
    let mut lane = 0..;
    let is_regular = |determinant: f64| {
        let home = homes.lane(lane.next().unwrap_or_default());
        determinant.abs() > overact_core::SINGULAR * home
    };
    if !determinants.every(is_regular) {
        failed.note(legs, at, &move |lane, leg| {
            guard::leg(determinants.lane(lane), homes.lane(lane), leg)
        });
    }
}

/// Checks that the closure errors of a pose are at most `within` (m, rad).
///
/// Otherwise, and for NaN, [`Error::NotClosed`].
#[inline(always)]
pub fn closed<V: Vector, const LEGS: usize>(
    failed: &mut Failed,
    gap: impl OfLegs<V>,
    within: f64,
    legs: &[&'static str; LEGS],
    at: Turn<V, LEGS>,
) {
    let gaps = gap.of_legs(at.1);
    if !gaps.every(|gap| gap.abs() <= within) {
        failed.note(legs, at, &move |lane, leg| {
            guard::closed(gaps.lane(lane), within, leg)
        });
    }
}
