//! Which sines and cosines are evaluated, and which follow by the addition theorem.
//!
//! A sine and cosine of an input costs tens of multiplications; a sum of two known angles costs six
//! operations. So angles with few terms are evaluated, and every angle that is the sum or difference
//! of two known ones, or of three, is composed of them.

use crate::cas::{Direction, Ratio, SymbolId};

/// How an angle's sine and cosine are had.
#[derive(Debug, Clone, PartialEq)]
pub(super) enum Plan {
    /// By evaluation.
    Direct,
    /// As the sum of other angles and a constant.
    Sum {
        /// The angles, places in the order of the plan, with the signs with which they enter; one at least.
        of: Vec<(usize, i64)>,
        /// The constant part that is left.
        rest: Direction,
    },
}

/// Plans all angles of a program: the order in which they are had, by their indices, and how.
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

/// The fewest known angles and a constant: each takes an addition theorem more.
fn composed(angle: &Direction, known: &[&Direction]) -> Option<Plan> {
    (1..=MOST).find_map(|count| sum_of(angle, known, count))
}

/// Most known angles that one is composed of: two addition theorems are fewer operations than a sine and cosine.
const MOST: usize = 3;

/// What is left of an angle without ± a part.
fn less(angle: &Direction, part: &Direction, sign: i64) -> Option<Direction> {
    let part = part.times(Ratio::integer(sign))?;
    angle.plus(&part.negative())
}

/// What is left of an angle without each of the known ones: which one, its sign, and the rest.
fn rests(angle: &Direction, known: &[&Direction]) -> impl Iterator<Item = (usize, i64, Direction)> {
    let signed = known.iter().enumerate();
    let signed = signed.flat_map(|(at, part)| [1, -1].map(|sign| (at, sign, *part)));
    signed.filter_map(|(at, sign, part)| Some((at, sign, less(angle, part, sign)?)))
}

/// The angle as the sum of as many known ones, each with a sign, and a constant.
fn sum_of(angle: &Direction, known: &[&Direction], count: usize) -> Option<Plan> {
    if count == 0 {
        return angle.is_constant().then(|| Plan::Sum {
            of: Vec::new(),
            rest: angle.clone(),
        });
    }
    rests(angle, known).find_map(|(first, sign, rest)| {
        // Of three the first has to leave fewer terms: others lead nowhere, and there are many.
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
