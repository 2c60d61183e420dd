//! Hints at the cause of an error, from the raw numbers of a run.

use overact::Model;

use super::{
    checks::{samples::raw_samples, units},
    positions,
};
use overact_logs::{Error, Log, monitor::Monitor};

/// Tolerance of the loop closure (m, rad) after a hypothetical correction of positions.
const CLOSED: f64 = 0.01;

/// Adds hints from the raw numbers of a run to its error.
pub(crate) fn explained(model: &dyn Model, log: &Log, error: Error) -> Error {
    let mut hints: Vec<String> = Vec::new();
    hints.extend(
        positions::explanation(model, log, CLOSED)
            .ok()
            .flatten()
            .map(|one| one.words),
    );
    let monitor = watched(log);
    hints.extend(
        monitor
            .as_ref()
            .and_then(|monitor| units::hint(model, log.name(), monitor)),
    );
    let suspicious = monitor.map(|monitor| raw_samples::suspicious(model, log.name(), monitor));
    hints.extend(suspicious.into_iter().flatten().map(|one| one.words));
    let mut problems = error.problems;
    if let (Some(problem), false) = (problems.first_mut(), hints.is_empty()) {
        problem.help = Some(hints.join("; "));
    }
    problems.into()
}

/// Statistics of a whole run; `None` if the file cannot be read.
fn watched(log: &Log) -> Option<Monitor> {
    let mut monitor = Monitor::of(log);
    let mut reader = log.reader().ok()?;
    while let Ok(Some(block)) = reader.next() {
        monitor.take(&block);
    }
    Some(monitor)
}
