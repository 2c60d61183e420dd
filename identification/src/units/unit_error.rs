//! Common unit errors, and which one explains quantities out of their ranges.

use std::f64::consts::{PI, TAU};

use super::quantity::Quantity;

/// A signal of a log.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) enum Signal {
    Time,
    Angles,
    Lengths,
    Torques,
}

impl Signal {
    /// `time`, `positions` or `torques`.
    pub(crate) const fn name(self) -> &'static str {
        match self {
            Self::Time => "time",
            Self::Angles | Self::Lengths => "positions",
            Self::Torques => "torques",
        }
    }
}

/// A unit error: a signal in a unit other than SI.
#[derive(Debug, PartialEq)]
pub(crate) struct UnitError {
    pub(crate) signal: Signal,
    /// The assumed unit.
    pub(crate) unit: &'static str,
    /// Numbers in this unit divided by those in SI.
    pub(crate) factor: f64,
    /// Spelling of the unit in a description; empty for time.
    pub(crate) scale: &'static str,
}

const fn unit_error(
    signal: Signal,
    unit: &'static str,
    factor: f64,
    scale: &'static str,
) -> UnitError {
    UnitError {
        signal,
        unit,
        factor,
        scale,
    }
}

/// Common unit errors, the most common ones of each signal first.
pub(crate) const UNIT_ERRORS: [UnitError; 16] = [
    unit_error(Signal::Time, "milliseconds", 1e3, ""),
    unit_error(Signal::Time, "microseconds", 1e6, ""),
    unit_error(Signal::Time, "nanoseconds", 1e9, ""),
    unit_error(Signal::Time, "minutes", 1.0 / 60.0, ""),
    unit_error(Signal::Time, "hours", 1.0 / 3600.0, ""),
    unit_error(Signal::Angles, "degrees", 180.0 / PI, "1 deg"),
    unit_error(Signal::Angles, "mrad", 1e3, "0.001 rad"),
    unit_error(Signal::Angles, "turns", 1.0 / TAU, "6.283185307179586 rad"),
    unit_error(Signal::Lengths, "mm", 1e3, "1 mm"),
    unit_error(Signal::Lengths, "µm", 1e6, "0.001 mm"),
    unit_error(Signal::Lengths, "cm", 1e2, "10 mm"),
    unit_error(Signal::Torques, "mN m (or mN, mA)", 1e3, "0.001"),
    unit_error(Signal::Torques, "kN m (or kN)", 1e-3, "1000"),
    unit_error(Signal::Torques, "N cm", 1e2, "0.01"),
    unit_error(Signal::Torques, "N mm", 1e3, "0.001"),
    unit_error(Signal::Torques, "µN m (or µA)", 1e6, "0.000001"),
];

/// Kinds of drives.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Kinds {
    pub(crate) revolute: bool,
    pub(crate) prismatic: bool,
}

/// Smallest improvement towards usual values, in decades.
const NEARER: f64 = 0.5;

/// Improvement required of a less common unit error, in decades.
const LESS_USUAL: f64 = 0.01;

impl UnitError {
    /// Factor by which the unit error multiplies a quantity.
    fn on(&self, quantity: &Quantity) -> f64 {
        let powers = quantity.powers;
        self.factor.powi(match self.signal {
            Signal::Time => powers.time,
            Signal::Angles | Signal::Lengths => powers.positions,
            Signal::Torques => powers.torques,
        })
    }

    /// Values that a quantity may have without the unit error.
    fn corrected(&self, quantity: &Quantity) -> impl Iterator<Item = f64> {
        let by_weight = quantity.is_by_weight && self.signal == Signal::Time;
        let by_weight = by_weight.then_some(quantity.value);
        std::iter::once(quantity.value / self.on(quantity)).chain(by_weight)
    }

    /// Whether it is possible for a robot with such drives.
    const fn fits(&self, kinds: Kinds) -> bool {
        match self.signal {
            Signal::Angles => kinds.revolute,
            Signal::Lengths => kinds.prismatic,
            Signal::Time | Signal::Torques => true,
        }
    }
}

/// The unit error that makes quantities possible and most usual.
///
/// For a single drive, time is excluded, since all drives share it.
pub(crate) fn explanation(
    quantities: &[Quantity],
    kinds: Kinds,
    is_single: bool,
) -> Option<&'static UnitError> {
    let unusual = |unit_error: &UnitError| -> f64 {
        let of = |one: &Quantity| {
            let values = unit_error.corrected(one).map(|value| one.unusual(value));
            values.fold(f64::INFINITY, f64::min)
        };
        quantities.iter().map(of).sum()
    };
    let resolves = |unit_error: &UnitError| {
        let is_possible = |one: &Quantity| unit_error.corrected(one).any(|value| one.may_be(value));
        quantities.iter().all(is_possible)
    };
    let all = UNIT_ERRORS.iter().enumerate().filter(|(_, unit_error)| {
        unit_error.fits(kinds)
            && !(is_single && unit_error.signal == Signal::Time)
            && resolves(unit_error)
    });
    let judged =
        all.map(|(rank, unit_error)| (unusual(unit_error) + LESS_USUAL * rank as f64, unit_error));
    let (left, best) = judged.min_by(|a, b| a.0.total_cmp(&b.0))?;
    let logged: f64 = quantities.iter().map(|one| one.unusual(one.value)).sum();
    (left + NEARER < logged).then_some(best)
}

/// Usual sampling frequencies, Hz.
const USUAL_SAMPLING: std::ops::RangeInclusive<f64> = 100.0..=2e5;

/// Unit of time in which a run of this sampling frequency could pass a filter of this cutoff (Hz).
pub(crate) fn time_of_sampling(frequency: f64, cutoff: f64) -> Option<&'static UnitError> {
    let times = UNIT_ERRORS
        .iter()
        .filter(|unit_error| unit_error.signal == Signal::Time);
    let mut longer = times.filter(|unit_error| unit_error.factor > 1.0);
    longer.find(|unit_error| {
        let own = frequency * unit_error.factor;
        USUAL_SAMPLING.contains(&own) && cutoff < 0.5 * own
    })
}

impl UnitError {
    /// The unit error as a question, with its remedy.
    pub(crate) fn advice(&self) -> String {
        let unit = self.unit;
        match self.signal {
            Signal::Time => format!(
                "is the time in {unit}? It must be in seconds: {} the column by {}",
                if self.factor > 1.0 {
                    "divide"
                } else {
                    "multiply"
                },
                self.factor.max(1.0 / self.factor).round()
            ),
            Signal::Angles | Signal::Lengths => format!(
                "are the positions in {unit}? Give `position_scale = \"{}\"` in the table [data]",
                self.scale
            ),
            Signal::Torques => format!(
                "are the torques in {unit}? Give `torque_gain = {}` in the table [data]",
                self.scale
            ),
        }
    }
}
