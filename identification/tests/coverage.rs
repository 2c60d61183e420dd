//! Coverage of standard deviations: the truth is within three of them in virtual experiments.

mod common;
#[path = "common/dualv.rs"]
mod dualv;

use dualv::{DualV, experiment, log, records, settings, truth};
use overact_identification::{Dataset, Estimate, Identification, Log, Settings, Stage, identify};
use overact_tier::by_tier;

fn identified(robot: &DualV, runs: &[Log], settings: &Settings) -> Identification {
    let truth = truth();
    let dataset = Dataset {
        runs,
        validation: &[],
        true_values: Some(&truth),
        variants: &[],
        scales: None,
    };
    identify(robot, &dataset, settings, &|_| {}).unwrap_or_else(|error| panic!("{error}"))
}

/// Root mean square, and fraction within 3.
fn spread(misses: &[f64]) -> (f64, f64) {
    let count = misses.len() as f64;
    let squares: f64 = misses.iter().map(|miss| miss * miss).sum();
    let within = misses.iter().filter(|miss| miss.abs() <= 3.0).count() as f64;
    ((squares / count).sqrt(), within / count)
}

#[test]
fn correlated_deviations_cover_the_truth_under_cogging() {
    let robot = DualV::new();
    let (mut white, mut correlated) = (Vec::new(), Vec::new());
    // Drives with a cogging torque that repeats with every tooth of the motor. In the full tier,
    // first only noise.
    let seeds: &[(f64, u64)] =
        by_tier([&[(0.3, 3)][..], &[(0.0, 1), (0.0, 2), (0.3, 3), (0.3, 4)]]);
    for &(cogging, seed) in seeds {
        let mut made = Vec::new();
        let mut experiment = experiment(&robot, 1.0, seed);
        experiment.duration_s = by_tier([4.0, 6.0]);
        for record in records(&robot, &experiment) {
            made.push(log(record, |positions, torques| {
                for (torque, q) in torques.iter_mut().zip(positions) {
                    *torque += cogging * (48.0 * *q).sin();
                }
            }));
        }
        let result = identified(&robot, &made, &settings(&robot));
        let base = |estimate: &&Estimate| estimate.stage == Stage::Base;
        for parameter in result
            .estimates
            .iter()
            .filter(base)
            .flat_map(|e| &e.parameters)
        {
            let error = parameter.value - parameter.true_value.expect("known");
            let own = error / parameter.correlated_standard_deviation;
            println!(
                "cogging {cogging}, seed {seed}: {:12} {own:6.2}",
                parameter.name
            );
            correlated.push(own);
            if cogging > 0.0 {
                white.push(error / parameter.standard_deviation);
            }
        }
    }
    let (white, correlated) = (spread(&white), spread(&correlated));
    println!(
        "root mean square and part within 3: white with cogging {white:.2?}, correlated {correlated:.2?}"
    );
    assert!(
        correlated.1 >= 0.95 && (0.5..1.5).contains(&correlated.0),
        "{correlated:?}"
    );
    // Standard deviations for white residuals are too small then.
    assert!(white.0 > 1.5, "{white:?}");
}
