//! Faults of a whole run or of the model, each tested with its own pass over the data.
//!
//! They are faults of all positions, two swapped actuators, and wrong or absent gravity.

use overact::Model;

use super::{
    check::{About, Check, CheckKind, Grade},
    positions,
};
use crate::kinematics::conditioning::couples;
use overact_logs::{Error, Log};

/// Largest fraction of the error that may remain after a correction of gravity.
///
/// The correction has no free size, so it cannot fit anything else.
const EXPLAINED_BY_GRAVITY: f64 = 0.75;

/// Largest fraction of the error that may remain with swapped actuators in closed loops.
///
/// The wrong motion passes singular poses with large generalised forces, which makes the relative
/// residual small in any case.
const EXPLAINED_BEHIND_LOOPS: f64 = 0.1;

/// Largest fraction of the error that may remain with one drive in another unit.
///
/// Another unit also scales the drive's motion, which may explain a part of any error.
const EXPLAINED_BY_UNIT: f64 = 0.1;

/// Possible faults of positions in all runs, or of the model.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) enum RunLevelFault {
    /// Positions alone.
    Positions(positions::Fault),
    /// Two actuators are swapped, positions and torques.
    Exchanged(usize, usize),
    /// Gravity has the opposite sign.
    Gravity,
    /// The torques do not contain gravity.
    Weightless,
}

impl RunLevelFault {
    /// All such faults of a robot.
    pub(super) fn all(model: &dyn Model) -> Vec<Self> {
        let n = model.info().sizes.actuators;
        let units = positions::Fault::single_units(model);
        let mut all: Vec<Self> = { positions::Fault::all(model).into_iter() }
            .chain(units)
            .map(Self::Positions)
            .collect();
        all.extend((0..n).flat_map(|i| (i + 1..n).map(move |j| Self::Exchanged(i, j))));
        all.extend([Self::Gravity, Self::Weightless]);
        all
    }

    /// Largest fraction of the error that may remain; `of_one` is that for faults of columns.
    pub(super) fn explained(self, model: &dyn Model, of_one: f64) -> f64 {
        match self {
            Self::Exchanged(..) if couples(model) => EXPLAINED_BEHIND_LOOPS,
            Self::Positions(positions::Fault::Unit(..)) => EXPLAINED_BY_UNIT,
            // In a symmetric robot, swapping actuators changes little. Another fault may then
            // become slightly smaller.
            Self::Positions(_) | Self::Exchanged(..) => of_one,
            Self::Gravity | Self::Weightless => EXPLAINED_BY_GRAVITY,
        }
    }

    /// The run with this fault corrected.
    pub(super) fn repaired(self, model: &dyn Model, log: &Log) -> Result<Log, Error> {
        let n = model.info().sizes.actuators;
        let (mut positions, mut torques) = log.load()?;
        match self {
            Self::Positions(fault) => fault.repair(model, &mut positions),
            Self::Exchanged(i, j) => {
                let both = [&mut positions, &mut torques];
                let rows = both.into_iter().flat_map(|all| all.chunks_exact_mut(n));
                rows.for_each(|row| row.swap(i, j));
            }
            Self::Gravity | Self::Weightless => return Ok(log.clone()),
        }
        let (name, frequency) = (log.name(), log.sampling_frequency());
        Log::new(name, frequency, n, positions, torques, log.payload())
    }

    /// The failed check of this fault; `so` is the reason.
    pub(super) fn check(self, model: &dyn Model, so: &str) -> Check {
        let names = model.info().actuators;
        let name = |index: usize| names.get(index).copied().unwrap_or_default();
        let failed_check = |kind, message: String| {
            Check::new(kind, About::Model, format!("{message}; {so}")).with_grade(Grade::DoNotUse)
        };
        match self {
            Self::Positions(fault) => Check {
                run: None,
                ..fault.check(model, "", so)
            },
            Self::Exchanged(i, j) => {
                let message = format!(
                    "`{}` and `{}` look swapped, positions and torques alike: check the columns of the log, or the order of the joints in the description",
                    name(i),
                    name(j)
                );
                failed_check(CheckKind::SwappedColumns, message).of_actuator(name(i))
            }
            Self::Weightless => failed_check(
                CheckKind::WrongSign,
                String::from(
                    "the torques look as if gravity did not act: log them including the gravity compensation of the drive, or correct `gravity` in the description (zero for motion in a horizontal plane)",
                ),
            ),
            Self::Gravity => failed_check(
                CheckKind::WrongSign,
                String::from(
                    "gravity looks reversed: check the sign of `gravity` in the description and the mounting of the base",
                ),
            ),
        }
    }
}
