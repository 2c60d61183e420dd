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
pub(crate) struct Slip {
    pub(crate) signal: Signal,
    /// The assumed unit.
    pub(crate) unit: &'static str,
    /// Numbers in this unit divided by those in SI.
    pub(crate) factor: f64,
    /// Spelling of the unit in a description; empty for time.
    pub(crate) scale: &'static str,
}

const fn slip(signal: Signal, unit: &'static str, factor: f64, scale: &'static str) -> Slip {
    Slip {
        signal,
        unit,
        factor,
        scale,
    }
}

/// Common unit errors, the most common ones of each signal first.
pub(crate) const SLIPS: [Slip; 16] = [
    slip(Signal::Time, "milliseconds", 1e3, ""),
    slip(Signal::Time, "microseconds", 1e6, ""),
    slip(Signal::Time, "nanoseconds", 1e9, ""),
    slip(Signal::Time, "minutes", 1.0 / 60.0, ""),
    slip(Signal::Time, "hours", 1.0 / 3600.0, ""),
    slip(Signal::Angles, "degrees", 180.0 / PI, "1 deg"),
    slip(Signal::Angles, "mrad", 1e3, "0.001 rad"),
    slip(Signal::Angles, "turns", 1.0 / TAU, "6.283185307179586 rad"),
    slip(Signal::Lengths, "mm", 1e3, "1 mm"),
    slip(Signal::Lengths, "µm", 1e6, "0.001 mm"),
    slip(Signal::Lengths, "cm", 1e2, "10 mm"),
    slip(Signal::Torques, "mN m (or mN, mA)", 1e3, "0.001"),
    slip(Signal::Torques, "kN m (or kN)", 1e-3, "1000"),
    slip(Signal::Torques, "N cm", 1e2, "0.01"),
    slip(Signal::Torques, "N mm", 1e3, "0.001"),
    slip(Signal::Torques, "µN m (or µA)", 1e6, "0.000001"),
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

impl Slip {
    /// Factor by which the unit error multiplies a quantity.
    fn on(&self, quantity: &Quantity) -> f64 {
        let powers = quantity.powers;
        self.factor.powi(match self.signal {
            Signal::Time => powers.time,
            Signal::Angles | Signal::Lengths => powers.positions,
            Signal::Torques => powers.torques,
        })
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
) -> Option<&'static Slip> {
    let unusual = |slip: Option<&Slip>| -> f64 {
        let of = |one: &Quantity| one.unusual(one.value / slip.map_or(1.0, |slip| slip.on(one)));
        quantities.iter().map(of).sum()
    };
    let resolves = |slip: &Slip| {
        let after = |one: &Quantity| Quantity {
            value: one.value / slip.on(one),
            ..one.clone()
        };
        quantities.iter().all(|one| after(one).is_possible())
    };
    let all = SLIPS.iter().enumerate().filter(|(_, slip)| {
        slip.fits(kinds) && !(is_single && slip.signal == Signal::Time) && resolves(slip)
    });
    let judged = all.map(|(rank, slip)| (unusual(Some(slip)) + LESS_USUAL * rank as f64, slip));
    let (left, best) = judged.min_by(|a, b| a.0.total_cmp(&b.0))?;
    (left + NEARER < unusual(None)).then_some(best)
}

/// Usual sampling frequencies, Hz.
const USUAL_SAMPLING: std::ops::RangeInclusive<f64> = 100.0..=2e5;

/// Unit of time in which a run of this sampling frequency could pass a filter of this cutoff (Hz).
pub(crate) fn time_of_sampling(frequency: f64, cutoff: f64) -> Option<&'static Slip> {
    let times = SLIPS.iter().filter(|slip| slip.signal == Signal::Time);
    let mut longer = times.filter(|slip| slip.factor > 1.0);
    longer.find(|slip| {
        let own = frequency * slip.factor;
        USUAL_SAMPLING.contains(&own) && cutoff < 0.5 * own
    })
}

impl Slip {
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
