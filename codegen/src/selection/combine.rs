//! Dependent columns that are cheaper as combinations of others.
//!
//! Regrouping finds columns that are constant combinations of others. Such a column can be computed
//! as this combination if that takes fewer operations. An example is the first moment of the distal
//! link of a planar leg. Its column equals that of a point mass on the platform minus those of two
//! moments of inertia. The same parameter of equal legs is tried for all legs together.

use super::assemble::Assembler;
use super::base::{BaseParameter, nearby_ratio};
use super::regressor::{FAMILY, Regressor};
use super::search::Search;
use crate::cas::Number;
use crate::derivation::{BodyParameter, Combination, DerivationError, MotionInput, Selection};
use crate::mechanism::Mechanism;

/// Chooses combinations that save operations in the standard regressor from joint angles.
///
/// # Errors
/// See [`DerivationError`].
pub(super) fn cheaper_columns(
    mechanism: &Mechanism,
    selection: &Selection,
    regressor: &Regressor,
    exact: &[Combination],
) -> Result<Vec<Combination>, DerivationError> {
    let operations = |combined: &[Combination]| -> Result<usize, DerivationError> {
        let trial = Assembler {
            mechanism,
            selection: &Selection {
                combined: combined.to_vec(),
                ..selection.clone()
            },
            search: &Search::none(),
        };
        let program = trial.program(FAMILY, MotionInput::Joints)?;
        Ok(program.cost().operations())
    };
    let mut chosen: Vec<Combination> = Vec::new();
    let mut best = regressor.operations();
    // The lowering already shares a column that is a multiple of another one.
    let candidates: Vec<Combination> = exact.iter().filter(|c| c.of.len() > 1).cloned().collect();
    for group in groups(mechanism, &candidates) {
        let trial: Vec<Combination> = chosen.iter().chain(&group).cloned().collect();
        let cost = operations(&trial)?;
        if cost < best {
            (chosen, best) = (trial, cost);
        }
    }
    Ok(chosen)
}

/// Finds exact fractions for the coefficients of regroupings.
///
/// A combination is returned if it equals the dependent column as an expression. Its coefficients in
/// `base` become exact; all others keep their computed values.
pub(super) fn exact_combinations(
    regressor: &Regressor,
    base: &mut [BaseParameter],
) -> Vec<Combination> {
    let is_exact = |guess: &Combination| {
        let column = regressor.column(guess.parameter);
        column.is_some() && column == regressor.combination(&guess.of)
    };
    let mut guesses = guesses(base);
    guesses.retain(is_exact);
    for combination in &guesses {
        for (kept, coefficient) in &combination.of {
            let of_kept = base.iter_mut().filter(|b| b.parameter == *kept);
            let entries = of_kept.flat_map(|b| &mut b.regrouped);
            for (_, value) in entries.filter(|(p, _)| *p == combination.parameter) {
                *value = coefficient.value();
            }
        }
    }
    guesses
}

/// Combinations whose coefficients are all close to simple fractions.
fn guesses(base: &[BaseParameter]) -> Vec<Combination> {
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
    all.retain(|c| !inexact.contains(&c.parameter));
    all
}

/// Groups combinations by parameter and leg shape, and merges groups of equal combinations.
fn groups(mechanism: &Mechanism, candidates: &[Combination]) -> Vec<Vec<Combination>> {
    let key = |c: &Combination| match c.parameter {
        BodyParameter::Leg { leg, joint, symbol } => (0, mechanism.legs[leg].shape, joint, symbol),
        BodyParameter::Platform(symbol) => (1, 0, 0, symbol),
        BodyParameter::Payload(symbol) => (2, 0, 0, symbol),
        BodyParameter::Load { payload, symbol } => (2, payload + 1, 0, symbol),
        BodyParameter::Spring(index) => (3, 0, index, c.parameter.symbol()),
        BodyParameter::Motor { motor, symbol } => (4, 0, motor, symbol),
    };
    let mut sorted: Vec<&Combination> = candidates.iter().collect();
    sorted.sort_by_key(|c| (key(c), c.parameter));
    let groups = sorted.chunk_by(|a, b| key(a) == key(b));
    let mut merged: Vec<Vec<Combination>> = Vec::new();
    for group in groups {
        let group = group.iter().map(|c| (*c).clone());
        // If one of several proportional columns had no combination, the others would share its
        // expression and save nothing. They are therefore tried together.
        let first = group.clone().next();
        let same = |other: &Vec<Combination>| {
            let pair = first.as_ref().zip(other.first());
            pair.is_some_and(|(a, b)| is_multiple(&a.of, &b.of))
        };
        match merged.iter_mut().find(|other| same(other)) {
            Some(other) => other.extend(group),
            None => merged.push(group.collect()),
        }
    }
    merged
}

/// Whether two combinations differ by a constant factor.
fn is_multiple(a: &[(BodyParameter, Number)], b: &[(BodyParameter, Number)]) -> bool {
    let mut ratios = a.iter().zip(b).map(|((_, x), (_, y))| *x / *y);
    let first = ratios.next();
    a.len() == b.len()
        && a.iter().zip(b).all(|((p, _), (q, _))| p == q)
        && ratios.all(|ratio| Some(ratio) == first)
}
