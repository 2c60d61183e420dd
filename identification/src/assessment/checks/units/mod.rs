//! Whether time, positions and torques can be in SI units: a log in milliseconds, millimetres or mN m gives
//! parameters with small deviations and a small residual, and only physical scales contradict it.
//!
//! **Bounds.** Motion: a tip is slower than sound and accelerates by less than 200 g; a run that is sampled slower
//! than 20 Hz accelerates by more than 1 mm/s² or it shows no inertia. Drives: torques stay within ten times their
//! described limit, travels within thirty times the described one. Bodies: the density of a robot, its masses over
//! L³, first moments over L⁴, inertias over L⁵, lies between 0.01 and 20 000 kg/m³.
//!
//! **Length L.** The reach of the description: the largest sum of lengths along a leg, the distance between bases of
//! legs or between their ends, 0.1 m at least. A robot without lengths is a linear axis. Its travel is no size of its
//! body, since a table of 100 kg may move by 0.2 m: its masses are compared with the travel or 1 m, whichever is
//! longer, and, to find masses that are too small, with the travel up to 5 m.
//!
//! **Regrouped parameters.** A base parameter is χ_k + Σ c_d χ_d, so its bound is that of χ_k plus Σ |c_d| times those
//! of χ_d: a robot of possible bodies keeps it, however large the c_d are. Estimates within five deviations of zero
//! are left out.
//!
//! **The slip.** A value that is `factor` times too large in a signal multiplies each measured quantity by a known
//! power of it. Of the usual slips the one is named that brings all quantities back to usual values.
//!
//! - `motion`: quantities of a run's raw numbers; `bodies`: those of the estimates;
//! - `words`: what is reported.

mod bodies;
mod motion;
mod words;

use std::collections::BTreeMap;

use overact::Model;

use self::motion::RunMotion;
use super::Context;
use crate::{
    assessment::check::{Check, Grade},
    data::Scales,
    error::Error,
    monitor::Monitor,
    units::{Quantity, Slip, explanation},
};

/// Looks at all runs and at the estimates.
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

/// A hint to the unit of the raw numbers of a run, where they contradict physical scales.
pub(crate) fn hint(model: &dyn Model, run: &str, monitor: &Monitor) -> Option<String> {
    let run = RunMotion::new(model, &Scales::default(), run, monitor);
    let drive = run.single_drives().into_iter().next();
    let found = drive.or_else(|| Finding::of_run(&run, &[]))?;
    Some(words::hint(&found))
}

/// Quantities out of their bounds, and the slip that explains them.
pub(super) struct Finding {
    run: String,
    /// The drive that it is about; none for all.
    actuator: Option<String>,
    /// The quantities out of their bounds, the farthest one first.
    contradictions: Vec<Quantity>,
    /// The slip that brings them back, if one does.
    slip: Option<&'static Slip>,
}

impl Finding {
    /// What contradicts a run and the estimates.
    fn of_run(run: &RunMotion, bodies: &[Quantity]) -> Option<Self> {
        let quantities: Vec<Quantity> = run.quantities().chain(bodies).cloned().collect();
        Self::of(run, None, &quantities)
    }

    /// What contradicts quantities of a run or of one of its drives.
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
            slip: explanation(quantities, run.kinds(), actuator.is_some()),
            contradictions,
        })
    }

    /// As a check.
    fn check(&self) -> Check {
        let check = words::check(self).allowing(Grade::DoNotUse);
        match &self.actuator {
            Some(actuator) => check.of_actuator(actuator),
            None => check,
        }
    }
}

/// The findings as checks: one for all runs that have the same slip in the same drive.
fn merged(found: Vec<Finding>, runs: usize) -> Vec<Check> {
    let mut groups: BTreeMap<(Option<String>, Option<&str>), Vec<Finding>> = BTreeMap::new();
    for finding in found {
        let slip = finding.slip.map(|slip| slip.unit);
        let group = groups.entry((finding.actuator.clone(), slip)).or_default();
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
