//! The guards of a program over a block of samples.

use super::plan::Slot;
use super::{BLOCK, Failed};
use crate::lowering::{Condition, Guard};
use overact_core::limits::DOUBLE;
use pulp::NullaryFnOnce;

/// Checks the guards, with values in `places`, at `count` samples from `start` on.
///
/// Lanes after the last sample repeat it.
pub(super) fn check(
    guards: &[Guard],
    places: &[Slot],
    slots: &[[f64; BLOCK]],
    start: usize,
    count: usize,
) -> Result<(), Failed> {
    let all = All {
        guards,
        places,
        slots,
    };
    if all.hold() {
        return Ok(());
    }
    let mut first: Option<Failed> = None;
    for (index, (guard, slot)) in guards.iter().zip(places).enumerate() {
        let values = &slots[*slot as usize][..count];
        let failed = values.iter().position(|v| !guard.condition.holds(*v));
        let earlier = |lane: &usize| first.as_ref().is_none_or(|f| start + lane < f.sample);
        if let Some(lane) = failed.filter(earlier) {
            first = Some(Failed {
                sample: start + lane,
                guard: index,
                value: values[lane],
            });
        }
    }
    first.map_or(Ok(()), Err)
}

/// All guards at all samples; they usually hold.
struct All<'a> {
    guards: &'a [Guard],
    places: &'a [Slot],
    slots: &'a [[f64; BLOCK]],
}

impl All<'_> {
    fn hold(self) -> bool {
        #[cfg(target_arch = "x86_64")]
        if let Some(simd) = pulp::x86::V3::try_new() {
            return simd.vectorize(self);
        }
        self.call()
    }
}

impl NullaryFnOnce for All<'_> {
    type Output = bool;

    // Loops here and below: closures in iterators are not compiled for wide vectors.
    #[inline(always)]
    fn call(self) -> bool {
        let mut hold = true;
        for (guard, slot) in self.guards.iter().zip(self.places) {
            hold &= guard.condition.holds_for_all(&self.slots[*slot as usize]);
        }
        hold
    }
}

impl Condition {
    /// Whether the condition holds for a value; false for NaN.
    #[must_use]
    pub fn holds(&self, value: f64) -> bool {
        self.holds_for_all(&[value])
    }

    /// Whether the condition holds for all values.
    #[inline(always)]
    fn holds_for_all<const N: usize>(&self, values: &[f64; N]) -> bool {
        // Without an early exit, so that several values are compared at a time.
        let mut hold = true;
        match self {
            Self::Reach { home, .. } => {
                let least = DOUBLE.radicand * home;
                for value in values {
                    hold &= *value >= least;
                }
            }
            Self::Mass => {
                for value in values {
                    hold &= *value > 0.0;
                }
            }
            Self::Closed { within: most, .. } | Self::Size { most } => {
                for value in values {
                    hold &= value.abs() <= *most;
                }
            }
            Self::Leg { home, .. } | Self::Platform { home, .. } | Self::Coordinates { home } => {
                let least = DOUBLE.singular * home;
                for value in values {
                    hold &= value.abs() > least;
                }
            }
        }
        hold
    }
}
