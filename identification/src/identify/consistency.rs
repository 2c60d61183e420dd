//! Physically consistent estimates of all projections.

use rayon::prelude::*;

use super::prepare::PreparedSystem;
use crate::{
    consistent::Consistent,
    prior::Prior,
    regression::projection::ModelKind,
    result::{Estimate, Stage},
};

/// Consistent estimate of each projection, with its number, and models without one.
pub(super) fn consistent_all(
    prepared: &PreparedSystem,
    estimates: &[(usize, Estimate)],
    prior: &Prior,
) -> (Vec<(usize, Consistent)>, Vec<ModelKind>) {
    let base = estimates
        .par_iter()
        .filter(|(_, one)| one.stage == Stage::Base);
    let of_projection = |(number, estimate): &(usize, Estimate)| {
        let found = prepared.consistent(*number, estimate, prior);
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
