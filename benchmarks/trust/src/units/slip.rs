//! Unit errors.

use overact::Info;
use overact_simulation::Record;
use std::f64::consts::{PI, TAU};

/// Signal in another unit.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord, serde::Serialize)]
#[serde(rename_all = "lowercase")]
pub enum Signal {
    /// Time.
    Time,
    /// Positions of revolute drives.
    Angles,
    /// Positions of prismatic drives.
    Lengths,
    /// Torques and forces.
    Torques,
}

impl Signal {
    /// Name in checks: `time`, `positions` or `torques`.
    #[must_use]
    pub const fn name(self) -> &'static str {
        match self {
            Self::Time => "time",
            Self::Angles | Self::Lengths => "positions",
            Self::Torques => "torques",
        }
    }
}

/// Drives with the unit error.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord, serde::Serialize)]
#[serde(rename_all = "lowercase")]
pub enum Drives {
    /// All drives with the signal.
    All,
    /// The first drive with the signal.
    One,
}

/// A unit error.
#[derive(Debug, Clone, Copy, serde::Serialize)]
pub struct Slip {
    /// The signal.
    pub signal: Signal,
    /// The unit.
    pub unit: &'static str,
    /// Numbers in this unit relative to SI units.
    pub factor: f64,
    /// The drives.
    pub drives: Drives,
}

/// Possible unit errors of a robot's logs.
#[must_use]
pub fn slips(info: &Info<'_>) -> Vec<Slip> {
    let units = [
        (Signal::Time, "ms", 1e3),
        (Signal::Time, "µs", 1e6),
        (Signal::Time, "ns", 1e9),
        (Signal::Time, "min", 1.0 / 60.0),
        (Signal::Angles, "deg", 180.0 / PI),
        (Signal::Angles, "mrad", 1e3),
        (Signal::Angles, "turns", 1.0 / TAU),
        (Signal::Lengths, "mm", 1e3),
        (Signal::Torques, "mN m", 1e3),
        (Signal::Torques, "kN m", 1e-3),
        (Signal::Torques, "N cm", 1e2),
    ];
    let has = |signal: Signal| match signal {
        Signal::Angles => info.actuator_is_revolute.contains(&true),
        Signal::Lengths => info.actuator_is_revolute.contains(&false),
        Signal::Time | Signal::Torques => true,
    };
    let several = info.actuators.len() > 1;
    let of_unit = |(signal, unit, factor): (Signal, &'static str, f64)| {
        let drives = match signal {
            Signal::Time => vec![Drives::All],
            _ if several => vec![Drives::All, Drives::One],
            _ => vec![Drives::All],
        };
        let slip = move |drives| Slip {
            signal,
            unit,
            factor,
            drives,
        };
        drives.into_iter().map(slip)
    };
    let all = units.into_iter().filter(|(signal, ..)| has(*signal));
    all.flat_map(of_unit).collect()
}

impl Slip {
    /// Converts the signal of a record to the unit.
    pub fn apply(&self, info: &Info<'_>, record: &mut Record) {
        let n = record.actuators.len();
        let has = |turns: bool| -> Vec<usize> {
            (0..n)
                .filter(|i| info.actuator_is_revolute[*i] == turns)
                .collect()
        };
        let (values, drives) = match self.signal {
            Signal::Time => {
                record.sampling_hz /= self.factor;
                return;
            }
            Signal::Angles => (&mut record.positions, has(true)),
            Signal::Lengths => (&mut record.positions, has(false)),
            Signal::Torques => (&mut record.torques, (0..n).collect()),
        };
        let count = match self.drives {
            Drives::All => drives.len(),
            Drives::One => 1,
        };
        for row in values.chunks_exact_mut(n) {
            for &drive in drives.iter().take(count) {
                row[drive] *= self.factor;
            }
        }
    }
}
