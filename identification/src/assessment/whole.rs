//! Faults of a whole run or of the model, each of which needs a pass of its own: what happened to positions, two
//! actuators that are exchanged, gravity that points the other way.

use overact::Model;

use super::{
    check::{About, Check, CheckKind, Grade},
    positions,
};
use crate::{data::Log, error::Error, kinematics::conditioning::couples};

/// The part of the error that gravity of the other sign, or none, leaves, at most: it has no size that could be fitted
/// to something else.
const EXPLAINED_BY_GRAVITY: f64 = 0.75;

/// The part of the error that exchanged actuators leave, at most, where loops couple them: the wrong motion passes
/// singular poses, where the generalised forces are so large that little of them is left in any case.
const EXPLAINED_BEHIND_LOOPS: f64 = 0.1;

/// What may have happened to positions in all runs, or to the model.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) enum Whole {
    /// Positions alone.
    Positions(positions::Fault),
    /// Two actuators are exchanged, positions and torques.
    Exchanged(usize, usize),
    /// Gravity points the other way.
    Gravity,
    /// The torques are without those of gravity.
    Weightless,
}

impl Whole {
    /// All of a robot's.
    pub(super) fn all(model: &dyn Model) -> Vec<Self> {
        let n = model.info().sizes.actuators;
        let mut all: Vec<Self> = { positions::Fault::all(model).into_iter() }
            .map(Self::Positions)
            .collect();
        all.extend((0..n).flat_map(|i| (i + 1..n).map(move |j| Self::Exchanged(i, j))));
        all.extend([Self::Gravity, Self::Weightless]);
        all
    }

    /// The part of the error that it may leave, `of_one` where it is a fault of columns.
    pub(super) fn explained(self, model: &dyn Model, of_one: f64) -> f64 {
        match self {
            Self::Exchanged(..) if couples(model) => EXPLAINED_BEHIND_LOOPS,
            // A robot with a symmetry is nearly the same when actuators are exchanged: anything else that is wrong
            // may then be a little smaller.
            Self::Positions(_) | Self::Exchanged(..) => of_one,
            Self::Gravity | Self::Weightless => EXPLAINED_BY_GRAVITY,
        }
    }

    /// A run without it.
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

    /// What is told of it; `so` says what speaks for it.
    pub(super) fn check(self, model: &dyn Model, so: &str) -> Check {
        let names = model.info().actuators;
        let name = |index: usize| names.get(index).copied().unwrap_or_default();
        let told = |kind, message: String| {
            Check::new(kind, About::Model, format!("{message}; {so}")).allowing(Grade::DoNotUse)
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
                told(CheckKind::SwappedColumns, message).of_actuator(name(i))
            }
            Self::Weightless => told(
                CheckKind::WrongSign,
                String::from(
                    "the torques look as if gravity did not act: log them with what the drive adds as a compensation of gravity, or describe `gravity` as it is, zero for a robot that moves in a horizontal plane",
                ),
            ),
            Self::Gravity => told(
                CheckKind::WrongSign,
                String::from(
                    "gravity looks as if it pointed the other way: check the sign of `gravity` in the description, and how the base stands",
                ),
            ),
        }
    }
}
