//! Every robot of `robots/` agrees with the numeric reference at random regular states, compiled (the
//! modules of `generated/`) and evaluated: joints, rates, Jacobians, both identification models, case 2
//! for every choice of kept actuators, inverse dynamics, mass matrix, internal torques.
//!
//! 1e-9 of each entry is the rounding of states whose legs and inverse Jacobian have condition numbers
//! of up to 60, with room for squared ones: pseudo-inverses come from normal equations.

use overact::Function;
use overact::Model;
use overact_tests::support::library::described;
use overact_tests::support::sample::samples;
use overact_tests::support::served::partitions;
use overact_tests::support::{Comparison, Evaluated, Failure, Served};
use overact_tier::by_tier;

const TOLERANCE: f64 = 1e-9;
/// States of each robot in the default tier and in the full one.
const STATES: [usize; 2] = [6, 200];

overact_tests::library!(compare);

fn compare(stem: &str, compiled: &dyn Model) -> Result<(), Failure> {
    let (model, expected) = described(stem)?;
    let parameters = expected.parameters();
    let states = by_tier(STATES);
    let all = samples(&expected.mechanism, &parameters, states, 7, false)?;
    let truths = all.iter().map(|sample| expected.at(sample));
    let truths = truths.collect::<Result<Vec<_>, Failure>>()?;
    let mut comparison = Comparison::new(TOLERANCE);
    // The closure error is what Newton's method drives to zero, not a quantity of its own; of rows that legs block
    // any multiples and sums would serve, and `parasitic` looks at what they mean.
    let is_compared =
        |f: &Function| !matches!(f, Function::ClosureError | Function::BlockedJacobian);
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
