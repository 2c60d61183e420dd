//! Distinguishes continuous rotation from degrees read as radians.
//!
//! The closure decides in closed loops. Otherwise the torques are fitted with both units: gravity
//! and centrifugal torques suit one of them. If both fit equally well, the course of the motion
//! decides, since a continuously rotating joint does not return.

use std::f64::consts::TAU;

use overact::Model;

use crate::{
    assessment::{check::Check, checks::Context, positions::Fault, torques},
    kinematics::conditioning::couples,
};
use overact_logs::{Error, monitor::Monitor};

/// Largest angle (rad) that is not tested.
const LARGEST_ANGLE: f64 = 2.0 * TAU;

/// A unit is right if its residual is at most this fraction of the other's.
const EXPLAINED: f64 = 0.5;

/// A joint rotates continuously if its net travel is at least this fraction of its range.
const ROTATES: f64 = 0.5;

/// The checks for degrees in all runs.
///
/// # Errors
/// A log cannot be read any more.
pub(crate) fn checks(context: &Context<'_>) -> Result<Vec<Check>, Error> {
    let model = context.model;
    let runs = context.runs().filter(|(log, _)| !log.is_unwrapped());
    let found = runs.filter_map(|(log, watched)| {
        let check = degrees(model, log.name(), &watched.monitor)?;
        Some((check, rotates(model, &watched.monitor)))
    });
    let found: Vec<(Check, bool)> = found.collect();
    if found.is_empty() {
        return Ok(Vec::new());
    }
    let errors = torques::errors_with(
        Fault::Degrees,
        model,
        context.dataset.runs,
        context.settings,
    );
    let (as_logged, as_degrees) = errors.unwrap_or((1.0, 1.0));
    let are_radians = as_logged <= EXPLAINED * as_degrees;
    let are_degrees = as_degrees <= EXPLAINED * as_logged;
    let is_reported = |rotates: bool| are_degrees || !(are_radians || rotates);
    let reported = found
        .into_iter()
        .filter(|(_, rotates)| is_reported(*rotates));
    Ok(reported.map(|(check, _)| check).collect())
}

/// The check for degrees in a run, if its angles are large enough.
pub(crate) fn degrees(model: &dyn Model, run: &str, monitor: &Monitor) -> Option<Check> {
    if couples(model) {
        return None;
    }
    let info = model.info();
    let kinds = info.actuators.iter().zip(info.actuator_is_revolute);
    let angles = monitor.magnitudes().into_iter().zip(kinds);
    let angles = angles.filter(|(_, (_, revolute))| **revolute);
    let (largest, (name, _)) = angles.max_by(|a, b| a.0.total_cmp(&b.0))?;
    let so = format!(
        "an angle of {largest:.0} rad of `{name}` would be {:.1} turns",
        largest / TAU
    );
    let check = || {
        Fault::Degrees
            .check(model, run, &so)
            .measured(largest, "rad")
            .against(
                LARGEST_ANGLE,
                "joints that turn further rotate continuously",
            )
    };
    (largest > LARGEST_ANGLE).then(check)
}

/// Whether every joint with large angles rotates in one direction.
pub(crate) fn rotates(model: &dyn Model, monitor: &Monitor) -> bool {
    let revolute = model.info().actuator_is_revolute.iter();
    let ranges = monitor.ranges().into_iter().zip(monitor.travels());
    let all = monitor.magnitudes().into_iter().zip(ranges).zip(revolute);
    let mut large = all.filter(|((angle, _), revolute)| **revolute && *angle > LARGEST_ANGLE);
    large.all(|((_, (range, travel)), _)| travel >= ROTATES * range)
}
