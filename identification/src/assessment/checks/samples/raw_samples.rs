//! Implausible raw numbers: clipped and frozen torques, stuck encoders, lost samples, standstill, degrees.

use overact::{Model, StandardParameter};

use super::rotation;
use crate::{
    assessment::{
        check::{About, Check, CheckKind, Grade},
        checks::Context,
    },
    kinematics::conditioning::couples,
};
use overact_logs::{
    Error,
    monitor::{DataFault, Monitor, Suspicion},
};

/// Checks all runs.
pub(crate) fn check(context: &Context<'_>) -> Result<Vec<Check>, Error> {
    let of_run = |(log, watched): (&overact_logs::Log, &crate::assessment::checks::RunMonitor)| {
        suspicions(context.model, log.name(), watched.monitor.clone())
    };
    let mut checks: Vec<Check> = context.runs().flat_map(of_run).collect();
    checks.extend(rotation::checks(context)?);
    checks.extend(unmoved(context));
    let stands = |run: &overact_logs::Log| {
        let mut own = checks
            .iter()
            .filter(|one| one.kind == CheckKind::Standstill);
        own.any(|one| one.run.as_deref() == Some(run.name()))
    };
    let all = context.dataset.runs.iter().all(stands);
    // The sign of a velocity that is only noise is random.
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
            "no torque is clipped or frozen, no encoder is stuck, and no sample is lost",
        ));
    }
    Ok(checks)
}

/// Actuators of a robot without loops that stand still in all training runs while others move.
///
/// Nothing in the data distinguishes a locked joint from a dead encoder, with which all estimates
/// may be wrong.
fn unmoved(context: &Context<'_>) -> Vec<Check> {
    let moving = context.moving_actuators();
    // The check of standstill reports a robot that does not move at all.
    if couples(context.model) || !moving.contains(&true) {
        return Vec::new();
    }
    let names = context.model.info().actuators.iter().zip(moving);
    let unmoved = names.filter(|(_, moves)| !moves);
    let check = |(name, _): (&&str, bool)| {
        let message = format!(
            "the position of `{name}` does not change in any training run: the joint is locked, or its encoder is dead. Repair the encoder, or move the joint; describe a locked joint as `type = \"fixed\"`"
        );
        Check::new(CheckKind::StuckEncoder, About::Data, message)
            .of_actuator(name)
            .found()
            .with_grade(Grade::DoNotUse)
    };
    unmoved.map(check).collect()
}

/// Names of base parameters of dry friction and offsets, which a standstill does not separate.
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

/// Findings in the raw numbers of a run, without those that need a fit.
pub(crate) fn suspicious(model: &dyn Model, run: &str, monitor: Monitor) -> Vec<Check> {
    let degrees =
        rotation::degrees(model, run, &monitor).filter(|_| !rotation::rotates(model, &monitor));
    let mut checks = suspicions(model, run, monitor);
    checks.extend(degrees);
    checks
}

/// Findings in the raw numbers of a run, except for angles of many turns.
fn suspicions(model: &dyn Model, run: &str, monitor: Monitor) -> Vec<Check> {
    let suspicions = monitor.suspicions(model.info().actuators, couples(model));
    suspicions
        .into_iter()
        .map(|one| suspicion_check(run, one))
        .collect()
}

/// A suspicion as a check.
fn suspicion_check(run: &str, suspicion: Suspicion) -> Check {
    let (kind, grade, origin) = match suspicion.fault {
        DataFault::Clipped => (
            CheckKind::ClippedTorque,
            Grade::DoNotUse,
            "a smooth peak is not so flat",
        ),
        DataFault::Stuck => (
            CheckKind::StuckEncoder,
            Grade::DoNotUse,
            "a joint needs time to stop",
        ),
        DataFault::Dropped => (
            CheckKind::DroppedSamples,
            Grade::DoNotUse,
            "the steps of the run itself",
        ),
        DataFault::Late => (
            CheckKind::DroppedSamples,
            Grade::Use,
            "the steps of the run itself",
        ),
        DataFault::Duplicate => (
            CheckKind::DuplicateColumns,
            Grade::DoNotUse,
            "two measured signals are never equal throughout",
        ),
        DataFault::Zero => (
            CheckKind::ZeroTorque,
            Grade::DoNotUse,
            "the torque of a moving drive is not zero",
        ),
        DataFault::FrozenTorque => (
            CheckKind::FrozenTorque,
            Grade::DoNotUse,
            "ten times the usual length of equal torques",
        ),
        DataFault::Standstill => (
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
        .with_grade(grade);
    match suspicion.actuator {
        Some(actuator) => check.of_actuator(&actuator),
        None => check,
    }
}
