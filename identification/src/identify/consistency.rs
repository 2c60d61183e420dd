//! The physically consistent estimates of all projections.

use rayon::prelude::*;

use super::prepare::Prepared;
use crate::{
    consistent::Consistent,
    prior::Prior,
    regression::projection::ModelKind,
    result::{Estimate, Stage},
};

/// The consistent estimate of each projection, with its number. That there is none is told among the
/// warnings.
pub(super) fn consistent_all(
    prepared: &Prepared,
    estimates: &[(usize, Estimate)],
    prior: &Prior,
    warnings: &mut Vec<String>,
) -> Vec<(usize, Consistent)> {
    let base = estimates
        .par_iter()
        .filter(|(_, one)| one.stage == Stage::Base);
    let of_projection = |(number, estimate): &(usize, Estimate)| {
        let found = prepared.consistent(*number, estimate, prior);
        found
            .map(|found| (*number, found))
            .ok_or_else(|| missing(estimate.model))
    };
    let sought: Vec<_> = base.map(of_projection).collect();
    let mut found = Vec::new();
    for one in sought {
        match one {
            Ok(one) => found.push(one),
            Err(warning) => warnings.push(warning),
        }
    }
    found
}

/// What is said of a projection without a consistent estimate.
fn missing(model: ModelKind) -> String {
    format!(
        "{}: there are no physically consistent parameters, the search for them did not end; other bounds or values in the table `prior` may help",
        model.case()
    )
}
