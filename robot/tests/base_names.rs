//! Base parameter names: estimate and functions choose columns separately, but a common name means
//! the same sum.

use overact_identification::{Identification, Log, Stage};
use overact_robot::{Identifier, Robot};
use std::collections::BTreeMap;

/// Robots whose functions keep other columns than the estimate.
const ROBOTS: [(&str, &str); 3] = [
    ("rx90", include_str!("../../robots/rx90.toml")),
    ("stanford", include_str!("../../robots/stanford.toml")),
    ("tx40", include_str!("../../robots/tx40.toml")),
];

/// Identification from the beginnings of the virtual runs.
fn identified(name: &str, text: &str) -> Identification {
    let robot = Robot::from_text(name, text).expect("a description");
    let mut experiment = robot.experiment().expect("an experiment");
    let plan = experiment.plan_mut();
    plan.duration_s = plan.duration_s.min(5.0);
    for duration in plan.runs.iter_mut().flat_map(|run| &mut run.duration_s) {
        *duration = duration.min(5.0);
    }
    let runs = experiment
        .runs(&robot.held_out(), &|_, _| {})
        .expect("runs");
    let logs: &[Log] = &runs.identified;
    Identifier::new(&robot).runs(logs).run().expect("a result")
}

#[test]
fn a_name_of_both_lists_has_one_sum_and_one_value() {
    for (name, text) in ROBOTS {
        let result = identified(name, text);
        let base = result.estimates.iter().find(|one| one.stage == Stage::Base);
        let values: BTreeMap<&str, f64> = { base.expect("an estimate").parameters.iter() }
            .map(|one| (one.name.as_str(), one.value))
            .collect();
        let mut renamed = 0;
        for own in &result.functions_base {
            renamed += usize::from(own.name.ends_with('F'));
            let Some(value) = values.get(own.name.as_str()) else {
                continue;
            };
            let largest = value.abs().max(1e-3);
            assert!(
                (own.value - value).abs() < 1e-6 * largest,
                "{name}: {own:?} {value}"
            );
        }
        assert!(renamed > 0, "{name}");
        let mut names: Vec<&str> = result
            .functions_base
            .iter()
            .map(|one| one.name.as_str())
            .collect();
        names.sort_unstable();
        names.dedup();
        assert_eq!(names.len(), result.functions_base.len(), "{name}");
    }
}
