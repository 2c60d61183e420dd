//! Single faults that explain torques contradicting the model.
//!
//! Faults of a drive or label are a wrong sign or gain, swapped drives, and a wrong payload label.
//! Faults of the whole robot are swapped joints, and reversed or absent gravity.
//!
//! - `drive_columns`: dry friction that the description lacks, and drifting load cells;
//! - `fault_residual`: the residual after correcting a fault, from one pass over the runs.

mod drive_columns;
mod fault_residual;

use overact::Model;
use rayon::prelude::*;

use super::{
    check::{About, Check, CheckKind, Grade},
    positions,
    run_level_faults::RunLevelFault,
};
use crate::settings::Settings;
use fault_residual::{Columns, EquationOptions, Fault, FaultResidual};
use overact_logs::{Error, Log};

/// A fault explains the torques if at most this fraction of the error remains.
const EXPLAINED: f64 = 0.5;

/// Friction or drift explains the torques if at most this fraction of the error remains: half of its
/// square.
const PARTLY_EXPLAINED: f64 = 0.7;

/// It must also remove this fraction of the inputs.
///
/// For a fault of a drive, the inputs are those of one line.
const WORTHWHILE: f64 = 0.03;

/// A fault is equally good if its error is at most this multiple of the best one's.
const AS_GOOD: f64 = 1.2;

/// Gains by which a drive may be wrong; -1 is the wrong sign.
const GAINS: [f64; 11] = [
    -1.0, 1e-3, 0.01, 0.1, 0.2, 0.5, 2.0, 5.0, 10.0, 100.0, 1000.0,
];

/// The single fault that explains the torques of runs, if there is one.
///
/// # Errors
/// As [`Motions::next`]; the runs have been read before.
pub(crate) fn explanation(
    model: &dyn Model,
    runs: &[Log],
    settings: &Settings,
) -> Result<Option<Check>, Error> {
    let columns = Columns::new(model, settings)?;
    let fault_residual =
        columns.fault_residual(model, runs, settings, EquationOptions::ONE_BY_ONE)?;
    let before = fault_residual.error(None);
    let of_one = of_one(model, runs, &fault_residual, before);
    Ok(of_one.or_else(|| of_all(model, &columns, runs, settings, &fault_residual)))
}

/// The check of dry friction that the model lacks, or of a load cell that drifts, if that explains
/// the torques of whole runs.
///
/// # Errors
/// As [`Motions::next`]; the runs have been read before.
pub(crate) fn missing_torques(
    model: &dyn Model,
    runs: &[Log],
    settings: &Settings,
) -> Result<Option<Check>, Error> {
    let info = model.info();
    let lacks_friction = !info.parameters.iter().any(|one| one.symbol.has_sign());
    let pulls = model.pulls();
    if !lacks_friction && pulls.is_empty() {
        return Ok(None);
    }
    let found = drive_columns::residuals(model, runs, settings)?;
    let cells = found.with_drift.iter().zip(pulls).zip(info.actuators);
    let cells = cells.filter(|((_, pulls), _)| **pulls);
    let cells = cells.map(|((after, _), name)| (*after, Some(*name)));
    let friction = lacks_friction.then_some((found.with_friction, None));
    let best = cells.chain(friction).min_by(|a, b| a.0.total_cmp(&b.0));
    let best = best.filter(|(after, _)| *after < PARTLY_EXPLAINED * found.before);
    Ok(best.map(|(after, cell)| {
        let so = so(found.before, after);
        let (kind, words) = match cell {
            Some(name) => (
                CheckKind::WrongGain,
                format!(
                    "the load cell of the cable `{name}` seems to drift: its tension changes with the time of the run; {so}. Warm the cells up and tare them before each run, or record shorter runs"
                ),
            ),
            None => (
                CheckKind::MissingParameter,
                format!(
                    "the drives have dry friction that the model lacks; {so}. Add \"fs\" to the `parameters` of the actuated joints or cables"
                ),
            ),
        };
        let check = Check::new(kind, About::Model, words).with_grade(Grade::DoNotUse);
        let check = match cell {
            Some(name) => check.of_actuator(name),
            None => check,
        };
        measured(check, found.before, after, PARTLY_EXPLAINED)
    }))
}

/// Relative residuals with the positions as they are, and after correcting a position fault.
///
/// `None` if the correction leaves the workspace, inflates the inputs, or a log cannot be read.
pub(super) fn errors_with(
    fault: positions::Fault,
    model: &dyn Model,
    runs: &[Log],
    settings: &Settings,
) -> Option<(f64, f64)> {
    let columns = Columns::new(model, settings).ok()?;
    let repaired = runs
        .iter()
        .map(|log| RunLevelFault::Positions(fault).repaired(model, log));
    let repaired: Vec<Log> = repaired.collect::<Result<_, _>>().ok()?;
    let residual = |runs: &[Log]| {
        let options = EquationOptions::TOGETHER;
        columns.fault_residual(model, runs, settings, options).ok()
    };
    let (logged, repaired) = (residual(runs)?, residual(&repaired)?);
    (!repaired.is_inflated(&logged)).then(|| (logged.error(None), repaired.error(None)))
}

/// States the evidence for a fault.
fn so(before: f64, after: f64) -> String {
    format!(
        "with the correction the relative residual is {:.1} % instead of {:.1} %",
        100.0 * after,
        100.0 * before
    )
}

/// The fault of a drive or label that explains the torques; `before` is the relative residual.
fn of_one(
    model: &dyn Model,
    runs: &[Log],
    fault_residual: &FaultResidual<'_>,
    before: f64,
) -> Option<Check> {
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
        .map(|fault| (fault, fault_residual.error(Some(fault))));
    let errors: Vec<(Fault, f64)> = errors.collect();
    // The error is a mean over lines; in a serial robot a drive affects its own line most.
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
    let is_redundant = n > info.sizes.dof;
    let inflates = |(fault, _): &(Fault, f64)| {
        let is_gain = matches!(fault, Fault::Gain(..));
        is_redundant
            && is_gain
            && fault_residual.error_by_logged_inputs(*fault) > EXPLAINED * before
    };
    let real = errors.iter().copied().filter(|one| !inflates(one));
    let best = real.min_by(|a, b| a.1.total_cmp(&b.1));
    let (mut fault, after) = best.filter(explains)?;
    if let Fault::Label(_) = fault {
        // If runs differ by a payload, either of them may carry it. The one with a positive payload
        // mass is chosen.
        let as_good = errors
            .iter()
            .filter(|(other, error)| matches!(other, Fault::Label(_)) && *error <= AS_GOOD * after);
        let heavy = as_good.map(|(other, _)| *other);
        let mut heavy =
            heavy.filter(|other| fault_residual.mass(*other).is_some_and(|mass| mass > 0.0));
        fault = heavy.next().unwrap_or(fault);
    }
    // Two drives differ by a factor or a sign, which may be a fault of either.
    let as_good = errors.iter().filter(|(other, error)| {
        let is_alike = match (fault, other) {
            (Fault::Gain(_, own), Fault::Gain(_, gain)) => (own < 0.0) == (*gain < 0.0),
            _ => false,
        };
        *other != fault && is_alike && *error <= AS_GOOD * after
    });
    let mut others: Vec<Fault> = as_good.map(|(other, _)| *other).collect();
    if matches!(fault, Fault::Gain(_, gain) if gain < 0.0) {
        // Friction against the motion tells which of two signs is wrong.
        let mut signs = [fault].into_iter().chain(others.drain(..));
        let is_passive = |one: &Fault| fault_residual.has_positive_friction(*one);
        fault = signs.find(is_passive).unwrap_or(fault);
    }
    let fault_check = fault_check(model, runs, fault, &others, &so(before, after));
    Some(measured(fault_check, before, after, EXPLAINED))
}

/// The fault of all positions or of gravity that explains the torques, in all runs alike.
fn of_all(
    model: &dyn Model,
    columns: &Columns,
    runs: &[Log],
    settings: &Settings,
    logged: &FaultResidual<'_>,
) -> Option<Check> {
    let before = logged.error(None);
    let faults = RunLevelFault::all(model)
        .into_par_iter()
        .filter_map(|fault| {
            let repaired = |log: &Log| fault.repaired(model, log);
            let runs: Result<Vec<Log>, Error> = runs.iter().map(repaired).collect();
            // A correction that leaves the workspace explains nothing.
            let options = match fault {
                RunLevelFault::Gravity => EquationOptions::TOGETHER.without_gravity(2.0),
                RunLevelFault::Weightless => EquationOptions::TOGETHER.without_gravity(1.0),
                _ => EquationOptions::TOGETHER,
            };
            let repaired = columns.fault_residual(model, &runs.ok()?, settings, options);
            let repaired = repaired.ok()?;
            (!repaired.is_inflated(logged)).then(|| (fault, repaired.error(None)))
        });
    let faults: Vec<(RunLevelFault, f64)> = faults.collect();
    let explains = |(fault, after): &(RunLevelFault, f64)| {
        *after < fault.explained(model, EXPLAINED) * before && before - after > WORTHWHILE
    };
    let best = faults.into_iter().filter(explains);
    let (fault, after) = best.min_by(|a, b| a.1.total_cmp(&b.1))?;
    let part = fault.explained(model, EXPLAINED);
    let fault_check = fault.check(model, &so(before, after));
    Some(measured(fault_check, before, after, part))
}

/// A check with the residual after the correction, and the fraction allowed as threshold.
fn measured(mut check: Check, before: f64, after: f64, part: f64) -> Check {
    let origin = format!("{:.0} % of the residual with the fault", 100.0 * part);
    check.explained = Some(1.0 - (after / before).powi(2));
    check
        .measured(100.0 * after, "%")
        .against(100.0 * part * before, origin)
}

/// The failed check of a fault, with faults that explain the data as well; `so` is the evidence.
fn fault_check(model: &dyn Model, runs: &[Log], fault: Fault, others: &[Fault], so: &str) -> Check {
    let info = model.info();
    let name = |index: usize| info.actuators.get(index).copied().unwrap_or_default();
    let or = |other: &Fault| match other {
        Fault::Gain(j, gain) => format!(", or that of `{}` {gain} times", name(*j)),
        Fault::Swapped(..) | Fault::Label(_) => String::new(),
    };
    let (kind, run, actuator, message) = match fault {
        Fault::Gain(i, gain) if gain < 0.0 => (
            CheckKind::WrongSign,
            None,
            Some(i),
            format!(
                "the torque of `{}` looks reversed: check the sign of its drive (a negative `torque_gain` in the table [data] reverses it)",
                name(i)
            ),
        ),
        Fault::Gain(i, gain) => (
            CheckKind::WrongGain,
            None,
            Some(i),
            format!(
                "the torque of `{}` looks wrong by a factor, it should be about {gain} times as large{}: check its gain and unit",
                name(i),
                others.iter().map(or).collect::<String>()
            ),
        ),
        Fault::Swapped(i, j) => (
            CheckKind::SwappedColumns,
            None,
            Some(i),
            format!(
                "the torques of `{}` and `{}` look swapped, or their positions: check the columns of the log",
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
        ..Check::new(kind, About::Model, format!("{message}; {so}")).with_grade(Grade::DoNotUse)
    }
}
