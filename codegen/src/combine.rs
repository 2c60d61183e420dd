//! Dependent columns that are cheaper as combinations of others.
//!
//! A regrouping says not only which parameters cannot be told apart, but also that a column is a
//! constant combination of other columns. For a planar leg, the first moment of the distal link is a
//! point mass on the platform less two moments of inertia, all of which are there already. Columns that
//! differ by the leg only are tried together, and what lowers the operation count is kept.

use crate::assemble::program;
use crate::base::{BaseParameter, nearby_ratio};
use crate::cas::Number;
use crate::derivation::{
    BodyParameter, Columns, Combination, Family, From, JointsBy, Selection, Underivable,
};
use crate::mechanism::Mechanism;

/// The combinations that make the standard regressor from joint angles cheaper.
///
/// # Errors
/// See [`Underivable`].
pub fn cheaper_columns(
    mechanism: &Mechanism,
    selection: &Selection,
    base: &[BaseParameter],
) -> Result<Vec<Combination>, Underivable> {
    let operations = |combined: &[Combination]| {
        let trial = Selection {
            combined: combined.to_vec(),
            ..selection.clone()
        };
        let family = Family::IdmRedPlatform(Columns::Standard);
        program(mechanism, &trial, family, From::Joints, JointsBy::Rule)
            .map(|p| p.cost().operations())
    };
    let mut chosen: Vec<Combination> = Vec::new();
    let mut best = operations(&chosen)?;
    for group in groups(mechanism, &candidates(base)) {
        let trial: Vec<Combination> = chosen.iter().chain(&group).cloned().collect();
        let cost = operations(&trial)?;
        if cost < best {
            (chosen, best) = (trial, cost);
        }
    }
    Ok(chosen)
}

/// Dependent columns whose coefficients are all fractions. Multiples of a single column are shared
/// anyway.
fn candidates(base: &[BaseParameter]) -> Vec<Combination> {
    let mut all: Vec<Combination> = Vec::new();
    let mut inexact: Vec<BodyParameter> = Vec::new();
    for kept in base {
        for &(parameter, coefficient) in &kept.regrouped {
            let Some(ratio) = nearby_ratio(coefficient) else {
                inexact.push(parameter);
                continue;
            };
            let term = (kept.parameter, Number::ratio(ratio));
            match all.iter_mut().find(|c| c.parameter == parameter) {
                Some(combination) => combination.of.push(term),
                None => all.push(Combination {
                    parameter,
                    of: vec![term],
                }),
            }
        }
    }
    all.retain(|c| c.of.len() > 1 && !inexact.contains(&c.parameter));
    all
}

/// Combinations of the same parameter of legs of one shape.
fn groups(mechanism: &Mechanism, candidates: &[Combination]) -> Vec<Vec<Combination>> {
    let key = |c: &Combination| match c.parameter {
        BodyParameter::Leg { leg, joint, symbol } => (0, mechanism.legs[leg].shape, joint, symbol),
        BodyParameter::Platform(symbol) => (1, 0, 0, symbol),
        BodyParameter::Payload(symbol) => (2, 0, 0, symbol),
    };
    let mut sorted: Vec<&Combination> = candidates.iter().collect();
    sorted.sort_by_key(|c| (key(c), c.parameter));
    let groups = sorted.chunk_by(|a, b| key(a) == key(b));
    groups
        .map(|group| group.iter().map(|c| (*c).clone()).collect())
        .collect()
}
