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
/// `base` become exact, and further ones, which are rounding errors, are removed; those of all other
/// columns keep their computed values.
pub(super) fn exact_combinations(
    regressor: &Regressor,
    base: &mut [BaseParameter],
) -> Vec<Combination> {
    let is_exact = |guess: &Combination| {
        let column = regressor.column(guess.parameter);
        column.is_some() && column == regressor.combination(&guess.of)
    };
    let mut proved: Vec<Combination> = Vec::new();
    for precision in [Precision::COMPUTED, Precision::ILL_CONDITIONED] {
        let mut guesses = guesses(base, precision);
        guesses.retain(|guess| {
            let is_new = proved
                .iter()
                .all(|known| known.parameter != guess.parameter);
            is_new && is_exact(guess)
        });
        proved.extend(guesses);
    }
    for combination in &proved {
        for kept in &mut *base {
            let exact = combination.of.iter().find(|(p, _)| *p == kept.parameter);
            match exact {
                Some((_, coefficient)) => {
                    let own = kept.regrouped.iter_mut();
                    own.filter(|(p, _)| *p == combination.parameter)
                        .for_each(|(_, value)| *value = coefficient.value());
                }
                None => kept.regrouped.retain(|(p, _)| *p != combination.parameter),
            }
        }
    }
    proved
}

/// How precisely coefficients are known before they are proved.
#[derive(Debug, Clone, Copy)]
struct Precision {
    /// Coefficients below this are taken for zero.
    zero: f64,
    /// Largest relative difference from a fraction.
    relative: f64,
}

impl Precision {
    /// Of columns that differ clearly.
    const COMPUTED: Self = Self {
        zero: 0.0,
        relative: 1e-10,
    };
    /// Of columns that nearly depend on each other, as those of mechanisms with a symmetric home.
    const ILL_CONDITIONED: Self = Self {
        zero: 1e-6,
        relative: 1e-6,
    };
}

/// Combinations whose coefficients are all close to simple fractions.
fn guesses(base: &[BaseParameter], precision: Precision) -> Vec<Combination> {
    let mut all: Vec<Combination> = Vec::new();
    let mut inexact: Vec<BodyParameter> = Vec::new();
    for kept in base {
        for &(parameter, coefficient) in &kept.regrouped {
            if coefficient.abs() < precision.zero {
                continue;
            }
            let Some(ratio) = nearby_ratio(coefficient, precision.relative) else {
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
