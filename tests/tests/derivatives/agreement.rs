//! Agreement with differences of the numeric reference.

use super::{Failure, Robot, all_robots, each};
use nalgebra::DMatrix;
use overact::Function;
use overact_tests::support::agreement::Agreement;
use overact_tests::support::sample::samples;
use overact_tests::support::{Backend, Evaluated};
use overact_tier::by_tier;
use std::collections::{BTreeMap, btree_map::Entry};

/// Largest difference, relative to the largest entry of a matrix.
const TOLERANCE: f64 = 1e-9;
/// States of each robot that are compared, in the default tier and in the full one.
const STATES: [usize; 2] = [1, 5];
/// States that are drawn for each compared one; next to a change of sign there are no differences.
const DRAWN: usize = 4;

all_robots!(agree);

fn agree(robot: &Robot) -> Result<(), Failure> {
    compare(robot, |_| true)
}

/// Compares the derivatives that `is_compared`.
pub(super) fn compare(robot: &Robot, is_compared: fn(Function) -> bool) -> Result<(), Failure> {
    let parameters = robot.expected.parameters();
    let mechanism = &robot.expected.mechanism;
    let states = by_tier(STATES);
    let all = samples(mechanism, &parameters, DRAWN * states, 37, false)?;
    let backend = Evaluated(&robot.model);
    let own = || {
        robot
            .model
            .functions
            .iter()
            .filter(|own| own.computes.is_derivative())
    };
    assert_eq!(own().count(), 8, "{}", robot.stem);
    // Standard and base parameters have the same derivatives.
    let mut known: BTreeMap<(&str, usize), Option<DMatrix<f64>>> = BTreeMap::new();
    for function in own().filter(|own| is_compared(own.computes)) {
        let mut agreement = Agreement::new();
        let mut compared = 0;
        for (number, sample) in all.iter().enumerate() {
            if compared == states {
                break;
            }
            let of = (function.computes.name(), number);
            let wanted = match known.entry(of) {
                Entry::Occupied(known) => known.into_mut(),
                Entry::Vacant(unknown) => {
                    let truth = robot.expected.at(sample)?;
                    let wanted = truth.output(function.computes, function.from).ok();
                    unknown.insert(wanted)
                }
            };
            if let Some(wanted) = wanted {
                agreement.compare(&backend.call(&function.name, sample)?, wanted);
                compared += 1;
            }
        }
        let worst = agreement.matrix();
        if compared == 0 || worst > TOLERANCE {
            return Err(format!("`{}`: {agreement}", function.name).into());
        }
    }
    Ok(())
}
