//! Physically consistent estimates of all projections.

use overact::Info;
use rayon::prelude::*;

use super::prepare::PreparedSystem;
use overact_logs::significant;

use crate::{
    consistent::{Consistent, ConsistentParameter},
    prior::Prior,
    regression::projection::ModelKind,
    result::{Estimate, Stage},
};

/// Consistent estimate of each projection, with its number, and models without one.
pub(super) fn consistent_all(
    info: &Info<'_>,
    prepared: &PreparedSystem,
    estimates: &[(usize, Estimate)],
    prior: &Prior,
) -> (Vec<(usize, Consistent)>, Vec<ModelKind>) {
    let base = estimates
        .par_iter()
        .filter(|(_, one)| one.stage == Stage::Base);
    let of_projection = |(number, estimate): &(usize, Estimate)| {
        let found = prepared.consistent(*number, estimate, prior);
        let found = found.map(|own| own.with_held(info, prior));
        found.map(|found| (*number, found)).ok_or(estimate.model)
    };
    let sought: Vec<_> = base.map(of_projection).collect();
    let (mut found, mut missing) = (Vec::new(), Vec::new());
    for one in sought {
        match one {
            Ok(one) => found.push(one),
            Err(model) => missing.push(model),
        }
    }
    (found, missing)
}

/// Ratio of the residual of consistent parameters to that of the base parameters above which
/// bounds contradict the data.
const CONTRADICTION: f64 = 1.5;

/// Distance from a bound, relative to it, below which a parameter is at the bound.
const AT_BOUND: f64 = 1e-2;

/// Warning about bounds of the prior that contradict the data.
pub(super) fn contradicted_bounds(consistent: &Consistent, prior: &Prior) -> Option<String> {
    let (with, without) = (
        consistent.relative_error_percent,
        consistent.base_relative_error_percent,
    );
    if with < CONTRADICTION * without {
        return None;
    }
    let is_at_bound = |one: &&ConsistentParameter| {
        let bounds = prior.bounds.get(&one.name);
        bounds.is_some_and(|[low, high]| {
            let near = |bound: &f64| (one.value - bound).abs() <= AT_BOUND * bound.abs();
            near(low) || near(high)
        })
    };
    let all = consistent.parameters.iter().filter(is_at_bound);
    let names: Vec<String> = all.map(|one| format!("`{}`", one.name)).collect();
    if names.is_empty() {
        return None;
    }
    Some(format!(
        "the bounds of {} in `[prior.bounds]` contradict the data: with them {} % of the torques stay unexplained ({}), without consistency {} %; correct the bounds",
        names.join(", "),
        significant(with, 3),
        consistent.model.label(),
        significant(without, 3)
    ))
}
