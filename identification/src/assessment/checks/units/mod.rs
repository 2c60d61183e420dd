//! Tests whether time, positions and torques can be in SI units.
//!
//! A log in milliseconds, millimetres or mN m has parameters with small standard deviations and a
//! small residual. Only physical scales contradict it.
//!
//! **Bounds**
//!
//! | quantity | bound |
//! |---|---|
//! | speed of the tip | at most that of sound |
//! | acceleration of the tip | at most 200 g |
//! | the same, for sampling below 20 Hz | at least 1 mm/s², else no inertia shows |
//! | torque by its described limit | at most 10 |
//! | travel by the described one | at most 30 |
//! | density of the robot | 0.01 to 20 000 kg/m³ |
//!
//! Densities are masses by L³, first moments by L⁴ and inertias by L⁵.
//!
//! **Length L.** The reach of the description: the largest sum of lengths along a leg, or the
//! distance between the legs' bases or ends, but at least 0.1 m. A robot without lengths is a
//! linear axis. Its travel is not its size: a table of 100 kg may move by 0.2 m. Densities that are
//! too large are computed with the travel, at least 1 m. Those that are too small are computed with
//! the travel, at most 5 m.
//!
//! **Regrouped parameters.** A base parameter is χ_k + Σ c_d χ_d. Its bound is that of χ_k plus Σ
//! |c_d| times those of χ_d, so possible bodies satisfy it for any c_d. Estimates within five
//! standard deviations of zero are ignored.
//!
//! **Unit error.** A signal that is `factor` times too large multiplies each quantity by a known
//! power of `factor`. The common unit error that brings all quantities back to usual values is
//! named.
//!
//! - `motion`: quantities of a run's raw numbers; `bodies`: those of the estimates;
//! - `words`: the messages.

mod bodies;
mod motion;
mod words;

use std::collections::BTreeMap;

use overact::Model;

use self::motion::RunMotion;
use super::Context;
use crate::{
    assessment::check::{Check, Grade},
    units::{Quantity, UnitError, explanation},
};
use overact_logs::{Error, Scales, monitor::Monitor};

/// Checks all runs and the estimates.
///
/// # Errors
/// None.
pub(super) fn check(context: &Context<'_>) -> Result<Vec<Check>, Error> {
    let none = Scales::default();
    let scales = context.dataset.scales.unwrap_or(&none);
    let runs: Vec<RunMotion> = { context.runs() }
        .map(|(log, watched)| RunMotion::new(context.model, scales, log.name(), &watched.monitor))
        .collect();
    let identified = &runs[..context.dataset.runs.len().min(runs.len())];
    let bodies = bodies::quantities(context, scales, identified);
    let mut found: Vec<Finding> = Vec::new();
    for run in &runs {
        let drives = run.single_drives();
        if drives.is_empty() {
            found.extend(Finding::of_run(run, &bodies));
        }
        found.extend(drives);
    }
    Ok(merged(found, runs.len()))
}

/// A hint at a unit error in the raw numbers of a run.
pub(crate) fn hint(model: &dyn Model, run: &str, monitor: &Monitor) -> Option<String> {
    let run = RunMotion::new(model, &Scales::default(), run, monitor);
    let drive = run.single_drives().into_iter().next();
    let found = drive.or_else(|| Finding::of_run(&run, &[]))?;
    Some(words::hint(&found))
}

/// Quantities out of their bounds, and the unit error that explains them.
pub(super) struct Finding {
    run: String,
    /// The drive; `None` for all drives.
    actuator: Option<String>,
    /// Quantities out of their bounds, the farthest first.
    contradictions: Vec<Quantity>,
    /// The unit error that brings them back, if there is one.
    unit_error: Option<&'static UnitError>,
}

impl Finding {
    /// The finding from a run and the estimates.
    fn of_run(run: &RunMotion, bodies: &[Quantity]) -> Option<Self> {
        let quantities: Vec<Quantity> = run.quantities().chain(bodies).cloned().collect();
        Self::of(run, None, &quantities)
    }

    /// The finding from quantities of a run or of one drive.
    fn of(run: &RunMotion, actuator: Option<&str>, quantities: &[Quantity]) -> Option<Self> {
        let mut contradictions: Vec<Quantity> = quantities
            .iter()
            .filter(|one| !one.is_possible())
            .cloned()
            .collect();
        contradictions.sort_by(|a, b| b.excess().total_cmp(&a.excess()));
        (!contradictions.is_empty()).then(|| Self {
            run: run.name.clone(),
            actuator: actuator.map(str::to_owned),
            unit_error: explanation(quantities, run.kinds(), actuator.is_some()),
            contradictions,
        })
    }

    /// The finding as a check.
    fn check(&self) -> Check {
        let check = words::check(self).with_grade(Grade::DoNotUse);
        match &self.actuator {
            Some(actuator) => check.of_actuator(actuator),
            None => check,
        }
    }
}

/// The findings as checks, merged if all runs have the same unit error in the same drive.
fn merged(found: Vec<Finding>, runs: usize) -> Vec<Check> {
    let mut groups: BTreeMap<(Option<String>, Option<&str>), Vec<Finding>> = BTreeMap::new();
    for finding in found {
        let unit_error = finding.unit_error.map(|unit_error| unit_error.unit);
        let group = groups
            .entry((finding.actuator.clone(), unit_error))
            .or_default();
        group.push(finding);
    }
    let of_group = |group: Vec<Finding>| -> Vec<Check> {
        if group.len() == runs {
            return group.first().map(Finding::check).into_iter().collect();
        }
        let each = group.iter();
        each.map(|one| one.check().in_run(&one.run)).collect()
    };
    groups.into_values().flat_map(of_group).collect()
}
