//! Plan of the sines and cosines: evaluated, or composed by the addition theorem.
//!
//! Sine and cosine of an input cost tens of multiplications; those of a sum of two known angles cost
//! six operations. So angles with few terms are evaluated. Every angle that is the sum or
//! difference of two or three known ones is composed of them.

use crate::cas::{Direction, Ratio, SymbolId};

/// How an angle's sine and cosine are obtained.
#[derive(Debug, Clone, PartialEq)]
pub(super) enum Plan {
    /// By evaluation.
    Direct,
    /// As the sum of other angles and a constant.
    Sum {
        /// The angles as indices in the order of the plan, with their signs; at least one.
        of: Vec<(usize, i64)>,
        /// The remaining constant.
        rest: Direction,
    },
}

/// Plans all angles of a program: their order, as indices, and how each is obtained.
pub(super) fn plan(angles: &[Direction]) -> Vec<(usize, Plan)> {
    let key = |&at: &usize| {
        let angle = &angles[at];
        let symbols: Vec<SymbolId> = angle.terms().iter().map(|term| term.0).collect();
        (symbols.len(), !angle.offset().is_zero(), symbols)
    };
    let mut order: Vec<usize> = (0..angles.len()).collect();
    order.sort_by_key(key);
    let mut known: Vec<&Direction> = Vec::new();
    let mut planned = Vec::new();
    for at in order {
        let how = composed(&angles[at], &known).unwrap_or(Plan::Direct);
        known.push(&angles[at]);
        planned.push((at, how));
    }
    planned
}

/// The composition of the fewest known angles and a constant; each takes one more addition theorem.
fn composed(angle: &Direction, known: &[&Direction]) -> Option<Plan> {
    (1..=MOST).find_map(|count| sum_of(angle, known, count))
}

/// Largest number of known angles: two addition theorems cost less than a sine and cosine.
const MOST: usize = 3;

/// Remainder of an angle after subtraction of ± a part.
fn less(angle: &Direction, part: &Direction, sign: i64) -> Option<Direction> {
    let part = part.times(Ratio::integer(sign))?;
    angle.plus(&part.negative())
}

/// Remainders of an angle after subtraction of each known one: its index, sign and the remainder.
fn rests(angle: &Direction, known: &[&Direction]) -> impl Iterator<Item = (usize, i64, Direction)> {
    let signed = known.iter().enumerate();
    let signed = signed.flat_map(|(at, part)| [1, -1].map(|sign| (at, sign, *part)));
    signed.filter_map(|(at, sign, part)| Some((at, sign, less(angle, part, sign)?)))
}

/// The angle as the sum of `count` known ones with signs and a constant.
fn sum_of(angle: &Direction, known: &[&Direction], count: usize) -> Option<Plan> {
    if count == 0 {
        return angle.is_constant().then(|| Plan::Sum {
            of: Vec::new(),
            rest: angle.clone(),
        });
    }
    rests(angle, known).find_map(|(first, sign, rest)| {
        // Of three angles the first has to leave fewer terms: there are many others, and they lead
        // nowhere.
        if count > 2 && rest.terms().len() >= angle.terms().len() {
            return None;
        }
        let Plan::Sum { mut of, rest } = sum_of(&rest, known, count - 1)? else {
            return None;
        };
        of.insert(0, (first, sign));
        Some(Plan::Sum { of, rest })
    })
}
