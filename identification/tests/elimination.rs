//! The elimination's tests stop before important parameters are removed, unlike r_σ alone.

mod common;
#[path = "common/dualv.rs"]
mod dualv;

use dualv::{DualV, experiment, logs, records, settings, truth};
use overact_identification::{Dataset, Estimate, Identification, Stage, identify};
use overact_tier::by_tier;

fn identified(robot: &DualV, rotation: f64) -> Identification {
    let truth = truth();
    let runs = logs(records(robot, &experiment(robot, rotation, 1)));
    let dataset = Dataset {
        runs: &runs,
        validation: &[],
        true_values: Some(&truth),
        variants: &[],
        scales: None,
    };
    identify(robot, &dataset, &settings(robot), &|_| {}).unwrap_or_else(|error| panic!("{error}"))
}

/// Essential estimates of both projections.
fn essential(result: &Identification) -> impl Iterator<Item = &Estimate> {
    let estimates = result.estimates.iter();
    estimates.filter(|estimate| estimate.stage == Stage::Essential)
}

const PARAMETERS_OF_TABLE_2: [&str; 9] = [
    "zz_platform",
    "m_platform",
    "ia_1_leg1",
    "ia_1_leg2",
    "ia_1_leg3",
    "ia_1_leg4",
    "zz_payload",
    "mx_payload",
    "m_payload",
];

#[test]
fn elimination_keeps_the_nine_parameters_of_table_2() {
    let robot = DualV::new();
    // Errors grow with weaker rotation; with r_sigma alone they would exceed 50 %.
    let [weak, full] = [(0.15, 6.0), (1.0, 2.0)];
    for &(rotation, largest) in by_tier([&[weak][..], &[full, weak]]) {
        let result = identified(&robot, rotation);
        for estimate in essential(&result) {
            println!("{estimate:#?}");
            let names: Vec<&str> = estimate
                .parameters
                .iter()
                .map(|p| p.name.as_str())
                .collect();
            assert_eq!(
                names, PARAMETERS_OF_TABLE_2,
                "{} {rotation}",
                estimate.model
            );
            for parameter in &estimate.parameters {
                let error = parameter.error_percent.expect("known").abs();
                assert!(error < largest, "{} {rotation}: {error} %", parameter.name);
            }
            let steps = &estimate.removals;
            let taken = steps.iter().filter(|step| step.accepted).count();
            assert!(steps.iter().all(|step| !step.reason.is_empty()));
            assert!(steps[..taken].iter().all(|step| step.accepted));
            let stop = estimate.stop.as_deref().expect("a stop");
            if rotation == 1.0 {
                assert_eq!(taken, steps.len());
                assert!(stop.contains("less than r_σ = 10"), "{stop}");
            }
        }
        // With weak rotation, r_sigma alone continues in the actuator projection.
        let case_2 = essential(&result).last().expect("case 2");
        if rotation < 1.0 {
            let refused = case_2
                .removals
                .iter()
                .find(|step| !step.accepted)
                .expect("a refusal");
            assert!(refused.significant && refused.drift.is_some());
            assert!(refused.held_out_after_percent > refused.held_out_before_percent);
            let left = 20 - case_2.removals.len();
            assert!(left < 9);
            let stop = case_2.stop.as_deref().expect("a stop");
            assert!(
                stop.contains(&format!("alone would have kept {left} parameters")),
                "{stop}"
            );
        }
    }
}
