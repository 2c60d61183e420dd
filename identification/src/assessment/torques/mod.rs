//! Torques that contradict the model, and which single fault would explain them: a drive of the wrong
//! sign or gain, two that are swapped, a run that is labelled with the wrong payload; or two joints that are
//! swapped as a whole, gravity that points the other way or does not act.
//!
//! - `doubt`: what a fault leaves unexplained, from one pass over the runs.

mod doubt;

use overact::Model;
use rayon::prelude::*;

use super::{
    check::{About, Check, CheckKind, Grade},
    positions,
    whole::Whole,
};
use crate::{data::Log, error::Error, settings::Settings};
use doubt::{Columns, Doubt, Fault, Way};

/// A fault that explains the torques leaves this part of the error, at most, ...
const EXPLAINED: f64 = 0.5;

/// ... and takes away this part of the inputs, at least; of those of one line, where it is one of a drive.
const WORTHWHILE: f64 = 0.03;

/// One that leaves no more than so many times as much explains them as well.
const AS_GOOD: f64 = 1.2;

/// Gains by which a drive may be wrong; the first is the wrong sign.
const GAINS: [f64; 11] = [
    -1.0, 1e-3, 0.01, 0.1, 0.2, 0.5, 2.0, 5.0, 10.0, 100.0, 1000.0,
];

/// What would explain the torques of runs, if one fault does.
///
/// # Errors
/// As [`Motions::next`]; the runs have been gone through before.
pub(crate) fn explanation(
    model: &dyn Model,
    runs: &[Log],
    settings: &Settings,
) -> Result<Option<Check>, Error> {
    let columns = Columns::new(model, settings)?;
    let doubt = columns.doubt((model, runs), settings, Way::ONE_BY_ONE)?;
    let before = doubt.error(None);
    let of_one = of_one(model, runs, &doubt, before);
    Ok(of_one.or_else(|| of_all((model, &columns), runs, settings, before)))
}

/// The part of the inputs that is left unexplained with the positions as they are, and after a fault of them is
/// repaired; none where that leads out of the workspace or a log can't be read.
pub(super) fn errors_with(
    fault: positions::Fault,
    model: &dyn Model,
    runs: &[Log],
    settings: &Settings,
) -> Option<(f64, f64)> {
    let columns = Columns::new(model, settings).ok()?;
    let repaired = runs
        .iter()
        .map(|log| Whole::Positions(fault).repaired(model, log));
    let repaired: Vec<Log> = repaired.collect::<Result<_, _>>().ok()?;
    let error = |runs: &[Log]| {
        let doubt = columns.doubt((model, runs), settings, Way::TOGETHER);
        Some(doubt.ok()?.error(None))
    };
    Some((error(runs)?, error(&repaired)?))
}

/// What speaks for a fault.
fn so(before: f64, after: f64) -> String {
    format!(
        "then {:.1} % of the inputs are left unexplained, instead of {:.1} %",
        100.0 * after,
        100.0 * before
    )
}

/// The fault of one drive or label that explains the torques, of which so much is unexplained `before`.
fn of_one(model: &dyn Model, runs: &[Log], doubt: &Doubt<'_>, before: f64) -> Option<Check> {
    let info = model.info();
    let n = info.sizes.actuators;
    let mut faults: Vec<Fault> = Vec::new();
    faults.extend((0..n).flat_map(|i| GAINS.map(|gain| Fault::Gain(i, gain))));
    faults.extend((0..n).flat_map(|i| (i + 1..n).map(move |j| Fault::Swapped(i, j))));
    if !info.payload_parameters.is_empty() && runs.len() > 1 {
        faults.extend((0..runs.len()).map(Fault::Label));
    }
    let errors = faults
        .into_par_iter()
        .map(|fault| (fault, doubt.error(Some(fault))));
    let errors: Vec<(Fault, f64)> = errors.collect();
    // The error is a mean over lines: a drive of a serial robot shows in its own line alone.
    let lines = info.sizes.dof as f64;
    let explains = |(fault, after): &(Fault, f64)| {
        let taken = match fault {
            Fault::Label(_) => before - after,
            Fault::Gain(..) | Fault::Swapped(..) => {
                (lines * (before.powi(2) - after.powi(2)).max(0.0)).sqrt()
            }
        };
        *after < EXPLAINED * before && taken > WORTHWHILE
    };
    let best = errors.iter().copied().min_by(|a, b| a.1.total_cmp(&b.1));
    let (mut fault, after) = best.filter(explains)?;
    if let Fault::Label(_) = fault {
        // Of two runs that differ by a payload either may be the one with it: a mass that is positive tells which.
        let as_good = errors
            .iter()
            .filter(|(other, error)| matches!(other, Fault::Label(_)) && *error <= AS_GOOD * after);
        let heavy = as_good.map(|(other, _)| *other);
        let mut heavy = heavy.filter(|other| doubt.mass(*other).is_some_and(|mass| mass > 0.0));
        fault = heavy.next().unwrap_or(fault);
    }
    let told = told(model, runs, fault, &so(before, after));
    Some(measured(told, (before, after), EXPLAINED))
}

/// The fault of all positions or of gravity that explains the torques: what happened to positions happened in all runs.
fn of_all(
    (model, columns): (&dyn Model, &Columns),
    runs: &[Log],
    settings: &Settings,
    before: f64,
) -> Option<Check> {
    let whole = Whole::all(model).into_par_iter().filter_map(|fault| {
        let repaired = |log: &Log| fault.repaired(model, log);
        let runs: Result<Vec<Log>, Error> = runs.iter().map(repaired).collect();
        // A change that leads out of the workspace explains nothing.
        let way = match fault {
            Whole::Gravity => Way::TOGETHER.without_gravity(2.0),
            Whole::Weightless => Way::TOGETHER.without_gravity(1.0),
            _ => Way::TOGETHER,
        };
        let doubt = columns.doubt((model, &runs.ok()?), settings, way);
        Some((fault, doubt.ok()?.error(None)))
    });
    let whole: Vec<(Whole, f64)> = whole.collect();
    let explains = |(fault, after): &(Whole, f64)| {
        *after < fault.explained(model, EXPLAINED) * before && before - after > WORTHWHILE
    };
    let best = whole.into_iter().filter(explains);
    let (fault, after) = best.min_by(|a, b| a.1.total_cmp(&b.1))?;
    let part = fault.explained(model, EXPLAINED);
    let told = fault.check(model, &so(before, after));
    Some(measured(told, (before, after), part))
}

/// A check with the part of the inputs that is left unexplained without the fault, of which it may leave a part.
fn measured(check: Check, (before, after): (f64, f64), part: f64) -> Check {
    let origin = format!(
        "{:.0} % of what is left unexplained with the fault",
        100.0 * part
    );
    check
        .measured(100.0 * after, "%")
        .against(100.0 * part * before, origin)
}

/// What is told of a fault; `so` says what speaks for it.
fn told(model: &dyn Model, runs: &[Log], fault: Fault, so: &str) -> Check {
    let info = model.info();
    let name = |index: usize| info.actuators.get(index).copied().unwrap_or_default();
    let (kind, run, actuator, message) = match fault {
        Fault::Gain(i, gain) if gain < 0.0 => (
            CheckKind::WrongSign,
            None,
            Some(i),
            format!(
                "the torque of `{}` looks reversed: check the sign of its drive (a negative `torque_gain` in the table [data] turns it round)",
                name(i)
            ),
        ),
        Fault::Gain(i, gain) => (
            CheckKind::WrongGain,
            None,
            Some(i),
            format!(
                "the torque of `{}` looks wrong by a factor, it should be about {gain} times as large: check its gain and unit",
                name(i)
            ),
        ),
        Fault::Swapped(i, j) => (
            CheckKind::SwappedColumns,
            None,
            Some(i),
            format!(
                "the torques of `{}` and `{}` look swapped: check the columns of the log",
                name(i),
                name(j)
            ),
        ),
        Fault::Label(run) => {
            let log = &runs[run];
            let (is, label) = if log.payload() {
                ("without", "with")
            } else {
                ("with", "without")
            };
            (
                CheckKind::PayloadLabel,
                Some(log.name().to_owned()),
                None,
                format!(
                    "the run looks like one {is} the payload, but is labelled as one {label} it"
                ),
            )
        }
    };
    Check {
        run,
        actuator: actuator.map(|index| name(index).to_owned()),
        ..Check::new(kind, About::Model, format!("{message}; {so}")).allowing(Grade::DoNotUse)
    }
}
