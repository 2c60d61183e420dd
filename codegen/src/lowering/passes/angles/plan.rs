//! Which sines and cosines are evaluated, and which follow by the addition theorem.
//!
//! A sine and cosine of an input costs tens of multiplications; a sum of two known angles costs six
//! operations. So angles with few terms are evaluated, and every angle that is the sum or difference
//! of two known ones is composed of them.

use crate::cas::{Direction, Ratio, SymbolId};

/// How an angle's sine and cosine are had.
#[derive(Debug, Clone, PartialEq)]
pub(super) enum Plan {
    /// By evaluation.
    Direct,
    /// As first + sign × second + constant, where first and second are places in the order of the plan.
    Sum {
        /// First angle.
        first: usize,
        /// Second angle with the sign with which it enters; `None` if only a constant is added.
        second: Option<(usize, i64)>,
        /// Sign with which the first angle enters.
        sign: i64,
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

/// A known angle and a constant are preferred to two known ones, which take an addition theorem more.
fn composed(angle: &Direction, known: &[&Direction]) -> Option<Plan> {
    turned(angle, known).or_else(|| sum_of_two(angle, known))
}

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

/// The angle as ± a known one and a constant.
fn turned(angle: &Direction, known: &[&Direction]) -> Option<Plan> {
    let mut found = rests(angle, known).filter(|(_, _, rest)| rest.is_constant());
    found.next().map(|(first, sign, rest)| Plan::Sum {
        first,
        second: None,
        sign,
        rest,
    })
}

/// The angle as ± a known one ± another and a constant.
fn sum_of_two(angle: &Direction, known: &[&Direction]) -> Option<Plan> {
    rests(angle, known).find_map(|(first, sign, rest)| {
        let mut found = rests(&rest, known).filter(|(_, _, last)| last.is_constant());
        found.next().map(|(second, other_sign, rest)| Plan::Sum {
            first,
            second: Some((second, other_sign)),
            sign,
            rest,
        })
    })
}
