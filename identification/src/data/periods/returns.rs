//! Periodic motions: within a run, or equal motions in several runs.

use super::{Log, find, together};
use crate::error::Error;

/// Largest relative difference of the lengths of runs with the same motion.
const LENGTHS: f64 = 0.01;

/// Periodic motion of a run.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) struct PeriodicMotion {
    /// Samples of the period; those of the run if it only repeats in another run.
    pub(crate) samples: usize,
    /// Number of the first run with this motion.
    pub(crate) motion: usize,
}

/// Periodic motions of runs with a given `period` (s), or one to be found.
///
/// Runs with different payloads count as different motions, since their equations differ.
pub(crate) fn returns(runs: &[Log], period: Option<f64>) -> Vec<Option<PeriodicMotion>> {
    let within: Vec<Option<usize>> = runs.iter().map(|log| of_run(log, period)).collect();
    let first = |number: usize| {
        let own = &runs[number];
        let same = |other: &usize| {
            let (a, b) = (within[*other], within[number]);
            a == b
                && runs[*other].payload_name() == own.payload_name()
                && runs[*other].payload() == own.payload()
                && runs[*other].sampling_frequency() == own.sampling_frequency()
                && (a.is_some() || as_long(&runs[*other], own))
                && find::same(&runs[*other], own).unwrap_or(false)
        };
        (0..number).find(same).unwrap_or(number)
    };
    let motions: Vec<usize> = (0..runs.len()).map(first).collect();
    let alone = |number: usize| {
        let own = motions.iter().filter(|motion| **motion == motions[number]);
        own.count() == 1
    };
    (0..runs.len())
        .map(|number| {
            let whole = (!alone(number)).then(|| runs[number].samples());
            let samples = within[number].or(whole)?;
            let motion = motions[number];
            Some(PeriodicMotion { samples, motion })
        })
        .collect()
}

/// Samples of the period of a run; `None` if it is not periodic.
fn of_run(log: &Log, period: Option<f64>) -> Option<usize> {
    let found: Result<Option<usize>, Error> = match period {
        Some(period) => together(log, period).map(Some),
        None => find::period(log),
    };
    found.ok().flatten()
}

/// Whether two runs have nearly equal lengths.
fn as_long(a: &Log, b: &Log) -> bool {
    let (a, b) = (a.samples() as f64, b.samples() as f64);
    (a - b).abs() <= LENGTHS * a.max(b)
}
