//! Data that can't be right, found where the data allow it and named.
//!
//! - `positions`: positions that contradict the loops, and what would make them close;
//! - `torques`: torques that contradict the model, and which fault would explain them.

mod positions;
pub(crate) mod torques;

use std::f64::consts::TAU;

use overact::Model;

use crate::{
    data::Log,
    error::Error,
    finding::{Finding, FindingKind, Thresholds},
    kinematics::conditioning::couples,
    monitor::Monitor,
};

use positions::Fault;

/// Joints of serial robots do not turn farther than this (rad) from zero.
const LARGEST_ANGLE: f64 = 2.0 * TAU;

/// What is suspicious in a run that has been gone through: its raw numbers and the closure of its
/// loops.
///
/// # Errors
/// A file that can't be read any more.
pub(crate) fn of_run(
    model: &dyn Model,
    log: &Log,
    monitor: Monitor,
    closure_residual: f64,
) -> Result<Vec<Finding>, Error> {
    let mut findings = of_numbers(model, log, monitor);
    if closure_residual > Thresholds::default().closure_residual {
        findings.push(Finding {
            kind: FindingKind::Closure,
            run: Some(log.name().to_owned()),
            actuator: None,
            message: format!(
                "the actuator positions miss the closure of the loops by up to {closure_residual:.3} m or rad; check the geometry and the offsets of the encoders"
            ),
        });
        findings.extend(positions::explanation(model, log)?);
    }
    Ok(findings)
}

/// An error of a run together with what is suspicious in its numbers: each finding is a way out.
pub(crate) fn explained(model: &dyn Model, log: &Log, error: Error) -> Error {
    let mut hints: Vec<String> = Vec::new();
    hints.extend(
        positions::explanation(model, log)
            .ok()
            .flatten()
            .map(|one| one.message),
    );
    hints.extend(monitored(model, log).into_iter().map(|one| one.message));
    let mut problems = error.problems;
    if let (Some(problem), false) = (problems.first_mut(), hints.is_empty()) {
        problem.help = Some(hints.join("; "));
    }
    Error { problems }
}

/// What is suspicious in the raw numbers of a whole run.
fn monitored(model: &dyn Model, log: &Log) -> Vec<Finding> {
    let mut monitor = Monitor::new(log.actuators(), log.sampling_frequency());
    let Ok(mut reader) = log.reader() else {
        return Vec::new();
    };
    while let Ok(Some(block)) = reader.next() {
        monitor.take(&block);
    }
    of_numbers(model, log, monitor)
}

/// What is suspicious in raw numbers that a monitor has watched.
fn of_numbers(model: &dyn Model, log: &Log, monitor: Monitor) -> Vec<Finding> {
    let info = model.info();
    let coupled = couples(model);
    let revolute = monitor
        .magnitudes()
        .into_iter()
        .zip(info.actuator_is_revolute);
    let angles = revolute.filter(|(_, revolute)| **revolute);
    let largest = angles.map(|(magnitude, _)| magnitude).fold(0.0, f64::max);
    let mut findings = monitor.findings(log.name(), info.actuators, coupled);
    // With loops, the closure tells.
    if !coupled && largest > LARGEST_ANGLE {
        let so = format!(
            "an angle of {largest:.0} rad would be {:.1} turns",
            largest / TAU
        );
        findings.push(Fault::Degrees.finding(model, log.name(), &so));
    }
    findings
}
