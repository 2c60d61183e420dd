//! Raw numbers that can't be right, as a monitor has watched them: clipped torques, stuck encoders, lost
//! samples, a robot that stands still, degrees.

use std::f64::consts::TAU;

use overact::{Model, StandardParameter};

use super::Context;
use crate::{
    assessment::{
        check::{About, Check, CheckKind, Grade},
        positions::Fault,
    },
    error::Error,
    kinematics::conditioning::couples,
    monitor::{Monitor, Suspicion, Trouble},
};

/// Joints of serial robots do not turn farther than this (rad) from zero.
const LARGEST_ANGLE: f64 = 2.0 * TAU;

/// Looks at all runs.
pub(super) fn check(context: &Context<'_>) -> Result<Vec<Check>, Error> {
    let of_run = |(log, watched): (&crate::data::Log, &super::Watched)| {
        suspicious(context.model, log.name(), watched.monitor.clone())
    };
    let mut checks: Vec<Check> = context.runs().flat_map(of_run).collect();
    let stands = |run: &crate::data::Log| {
        let mut own = checks
            .iter()
            .filter(|one| one.kind == CheckKind::Standstill);
        own.any(|one| one.run.as_deref() == Some(run.name()))
    };
    let all = context.dataset.runs.iter().all(stands);
    // The sign of a velocity that is noise is noise, too.
    let spoiled: Vec<String> = match context.settings.velocity_dead_band {
        0.0 => dry_friction(context),
        _ => Vec::new(),
    };
    for check in &mut checks {
        if check.kind != CheckKind::Standstill {
            continue;
        }
        if all {
            check.grade = Grade::DoNotUse;
        } else if !spoiled.is_empty() {
            check.grade = Grade::UseListed;
            check.spoiled.clone_from(&spoiled);
        }
    }
    if checks.is_empty() {
        checks.push(Check::new(
            CheckKind::DroppedSamples,
            About::Data,
            "no torque is clipped, no encoder is stuck, no sample is lost",
        ));
    }
    Ok(checks)
}

/// Names of the base parameters that are dry friction or an offset, which stand beside each other at a
/// standstill.
fn dry_friction(context: &Context<'_>) -> Vec<String> {
    let columns = context.columns.as_slice();
    let base = context.base.columns.iter().zip(&context.base.names);
    let is_dry = |column: usize| {
        let symbol = columns.get(column).map(|column| column.symbol);
        symbol.is_some_and(|symbol| symbol.has_sign() || symbol == StandardParameter::Off)
    };
    base.filter(|(column, _)| is_dry(**column))
        .map(|(_, name)| name.clone())
        .collect()
}

/// What is suspicious in the raw numbers of a run that a monitor has watched.
pub(crate) fn suspicious(model: &dyn Model, run: &str, monitor: Monitor) -> Vec<Check> {
    let info = model.info();
    let coupled = couples(model);
    let revolute = monitor
        .magnitudes()
        .into_iter()
        .zip(info.actuator_is_revolute);
    let angles = revolute.filter(|(_, revolute)| **revolute);
    let largest = angles.map(|(magnitude, _)| magnitude).fold(0.0, f64::max);
    let suspicions = monitor.suspicions(info.actuators, coupled);
    let mut checks: Vec<Check> = suspicions.into_iter().map(|one| told(run, one)).collect();
    // With loops, the closure tells.
    if !coupled && largest > LARGEST_ANGLE {
        let so = format!(
            "an angle of {largest:.0} rad would be {:.1} turns",
            largest / TAU
        );
        let check = Fault::Degrees
            .check(model, run, &so)
            .measured(largest, "rad")
            .against(LARGEST_ANGLE, "no joint of a serial robot turns farther");
        checks.push(check);
    }
    checks
}

/// A suspicion as a check.
fn told(run: &str, suspicion: Suspicion) -> Check {
    let (kind, grade, origin) = match suspicion.trouble {
        Trouble::Clipped => (
            CheckKind::ClippedTorque,
            Grade::DoNotUse,
            "a smooth peak is not so flat",
        ),
        Trouble::Stuck => (
            CheckKind::StuckEncoder,
            Grade::DoNotUse,
            "a joint needs time to stop",
        ),
        Trouble::Dropped => (
            CheckKind::DroppedSamples,
            Grade::DoNotUse,
            "the steps of the run itself",
        ),
        Trouble::Duplicate => (
            CheckKind::DuplicateColumns,
            Grade::DoNotUse,
            "two measured signals are never equal throughout",
        ),
        Trouble::Zero => (
            CheckKind::ZeroTorque,
            Grade::DoNotUse,
            "a measured torque is never zero throughout",
        ),
        Trouble::Standstill => (
            CheckKind::Standstill,
            Grade::Use,
            "the range of noise by its steps",
        ),
    };
    let check = Check::new(kind, About::Data, suspicion.message)
        .in_run(run)
        .measured(suspicion.statistic, suspicion.unit)
        .against(suspicion.threshold, origin)
        .found()
        .allowing(grade);
    match suspicion.actuator {
        Some(actuator) => check.of_actuator(&actuator),
        None => check,
    }
}
