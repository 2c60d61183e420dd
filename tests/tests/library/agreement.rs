//! Every robot of `robots/` agrees with the numeric reference at random regular states.
//!
//! Robots are compiled and evaluated. Tests cover joints, rates, Jacobians, both projections, every
//! partition, inverse dynamics, mass matrix and internal torques.
//!
//! The usual tolerance of 1e-9 for each entry corresponds to condition numbers up to 60 of legs and
//! inverse Jacobian. It has a margin for squared ones, because pseudo-inverses use normal
//! equations.

use overact::Function;
use overact::Model;
use overact_tests::support::library::described;
use overact_tests::support::sample::samples;
use overact_tests::support::served::partitions;
use overact_tests::support::{Comparison, Evaluated, Failure, Served};
use overact_tier::by_tiers;

/// States of each robot in the default, full and nightly tier.
const STATES: [usize; 3] = [6, 40, 200];

overact_tests::library!(compare);

fn compare(stem: &str, compiled: &dyn Model) -> Result<(), Failure> {
    let (model, expected) = described(stem)?;
    let parameters = expected.parameters();
    let states = by_tiers(STATES);
    let all = samples(&expected.mechanism, &parameters, states, 7, false)?;
    let truths = all.iter().map(|sample| expected.at(sample));
    let truths = truths.collect::<Result<Vec<_>, Failure>>()?;
    let mut comparison = Comparison::new(expected.tolerance());
    // The closure error only has to vanish; rows of blocked directions are unique up to
    // combinations, and `parasitic` tests them.
    let is_compared = |f: &Function| {
        !matches!(
            f,
            Function::ClosureError | Function::BlockedJacobian | Function::PoseErrorJacobian
        )
    };
    let evaluated = Evaluated(model);
    for function in &model.functions {
        if is_compared(&function.computes) {
            comparison.function(function, &evaluated, &all, &truths)?;
        }
    }
    let served = Served(compiled);
    for function in Function::ALL.into_iter().filter(is_compared) {
        if let Some(function) = model.served(function) {
            comparison.function(function, &served, &all, &truths)?;
        }
    }
    if !model.is_tree() {
        for kept in partitions(model.mechanism.actuated().len(), model.mechanism.dof()) {
            comparison.partition((&kept, true), model, &served, &all, &truths)?;
        }
    }
    println!("{}", comparison.lines.join("\n"));
    let failures = comparison.failures;
    assert!(failures.is_empty(), "{stem}:\n{}", failures.join("\n"));
    Ok(())
}
