//! Agreement with the numeric reference.

use super::{Failure, Robot, all_robots, each};
use overact_tests::support::sample::samples;
use overact_tests::support::{Comparison, Evaluated};
use overact_tier::by_tiers;

/// States of each robot in the default, full and nightly tier.
const STATES: [usize; 3] = [5, 15, 100];

all_robots!(agree);

fn agree(robot: &Robot) -> Result<(), Failure> {
    let Robot {
        stem,
        model,
        expected,
    } = robot;
    let parameters = expected.parameters();
    let all = samples(
        &expected.mechanism,
        &parameters,
        by_tiers(STATES),
        23,
        false,
    )?;
    let truths = all.iter().map(|sample| expected.at(sample));
    let truths = truths.collect::<Result<Vec<_>, Failure>>()?;
    let mut comparison = Comparison::new(expected.tolerance());
    let mut count = 0;
    for function in &model.functions {
        comparison.function(function, &Evaluated(model), &all, &truths)?;
        count += 1;
    }
    assert!(
        count >= 5 * model.mechanism.frames.len() + 2,
        "{stem}: {count}"
    );
    if comparison.failures.is_empty() {
        return Ok(());
    }
    Err(comparison.failures.join("\n").into())
}
