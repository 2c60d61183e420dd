//! Bad data are found and named, and good data cause no alarm.
//!
//! Several faults have variants: the default tier tests one of each, the full tier all.

#[path = "../common/mod.rs"]
mod common;
#[path = "../common/dualv.rs"]
mod dualv;
mod faults;
mod numbers;

use std::sync::LazyLock;

use dualv::{DualV, experiment, log, records, settings};
use overact_identification::{
    Check, CheckKind, Dataset, Error, Grade, Identification, Log, identify,
};
use overact_simulation::Record;
use overact_tier::{by_tier, is_full};

/// Two unloaded and two loaded runs.
static RECORDS: LazyLock<Vec<Record>> = LazyLock::new(|| {
    let robot = DualV::new();
    let mut experiment = experiment(&robot, 1.0, 5);
    experiment.duration_s = by_tier([1.6, 4.0]);
    records(&robot, &experiment)
});

/// Identifies from the runs after `change` of positions and torques of each run, by number.
fn with(change: impl Fn(usize, &mut Vec<f64>, &mut Vec<f64>)) -> Result<Identification, Error> {
    let runs = RECORDS.iter().enumerate().map(|(number, record)| {
        log(record.clone(), |positions, torques| {
            change(number, positions, torques)
        })
    });
    identified(&runs.collect::<Vec<_>>())
}

fn identified(runs: &[Log]) -> Result<Identification, Error> {
    let robot = DualV::new();
    let dataset = Dataset {
        runs,
        validation: &[],
        true_values: None,
        variants: &[],
        scales: None,
    };
    identify(&robot, &dataset, &settings(&robot).trimmed(1000.0), &|_| {})
}

/// Kinds, runs and actuators of the failed checks, whose words must be among the warnings.
fn found(result: &Identification) -> Vec<(CheckKind, Option<&str>, Option<&str>)> {
    let found = failed(result);
    for check in &found {
        println!("{check:?}");
        let mut warnings = result.warnings.iter();
        assert!(warnings.any(|warning| warning.contains(&check.words)));
    }
    found
        .into_iter()
        .map(|one| (one.kind, one.run.as_deref(), one.actuator.as_deref()))
        .collect()
}

/// The failed checks.
fn failed(result: &Identification) -> Vec<&Check> {
    let checks = result.checks.iter();
    checks.filter(|check| !check.passed).collect()
}

fn trusted(result: &Identification, subject: &str) -> bool {
    let mut verdicts = result.verdicts.iter();
    verdicts
        .find(|verdict| verdict.subject == subject)
        .expect("a verdict")
        .trusted
}

/// The first check of a kind.
fn check(result: &Identification, kind: CheckKind) -> &Check {
    let mut checks = result.checks.iter();
    checks.find(|one| one.kind == kind).expect("the check")
}
