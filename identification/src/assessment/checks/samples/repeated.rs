//! Finds samples that occur in two runs: overlapping cuts, or a log that was given twice.
//!
//! Repeated samples make intervals too narrow, and validation on training data tests nothing.

use crate::assessment::{
    check::{About, Check, CheckKind, Grade},
    checks::{Context, RunMonitor},
};
use overact_logs::{Error, Log, significant};

/// Harmless overlap, as a fraction of the shorter run.
///
/// It makes intervals narrower by a fortieth.
const HARMLESS: f64 = 0.05;

/// Checks all pairs of runs with at least one training run.
pub(crate) fn check(context: &Context<'_>) -> Result<Vec<Check>, Error> {
    let runs: Vec<(&Log, &RunMonitor)> = context.runs().collect();
    let identified = context.dataset.runs.len();
    let mut found = Vec::new();
    for (number, (log, watched)) in runs.iter().enumerate() {
        for (first, other) in runs.iter().take(identified.min(number)) {
            let Some(shared) = other.monitor.shared(&watched.monitor) else {
                continue;
            };
            let seconds = shared.samples as f64 / log.sampling_frequency();
            let of = format!(
                "about {} s of this run are samples of `{}`",
                significant(seconds, 2),
                first.name()
            );
            let (about, words) = if number < identified {
                (
                    About::Data,
                    format!(
                        "{of}: they count twice, and all intervals are too narrow. Give each sample once: remove the overlap from one of the runs"
                    ),
                )
            } else {
                (
                    About::Extrapolation,
                    format!(
                        "{of}, so this validation run does not test new motions. Choose another validation run"
                    ),
                )
            };
            let grade = if shared.part > HARMLESS {
                Grade::DoNotUse
            } else {
                Grade::Use
            };
            let check = Check::new(CheckKind::RepeatedSamples, about, words)
                .in_run(log.name())
                .measured(100.0 * shared.part, "% of the shorter run")
                .against(100.0 * HARMLESS, "intervals too narrow by a fortieth");
            found.push(check.found().with_grade(grade));
        }
    }
    Ok(found)
}
