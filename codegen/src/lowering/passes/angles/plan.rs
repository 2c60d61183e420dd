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

fn composed(angle: &Direction, known: &[&Direction]) -> Option<Plan> {
    let less = |a: &Direction, b: &Direction, sign: i64| {
        let part = b.times(Ratio::integer(sign))?;
        a.plus(&part.negative())
    };
    for (first, direction) in known.iter().enumerate() {
        for sign in [1, -1] {
            let Some(rest) = less(angle, direction, sign) else {
                continue;
            };
            if rest.is_constant() {
                return Some(Plan::Sum {
                    first,
                    second: None,
                    sign,
                    rest,
                });
            }
            for (second, other) in known.iter().enumerate() {
                for other_sign in [1, -1] {
                    let Some(last) = less(&rest, other, other_sign) else {
                        continue;
                    };
                    if last.is_constant() {
                        let second = Some((second, other_sign));
                        return Some(Plan::Sum {
                            first,
                            second,
                            sign,
                            rest: last,
                        });
                    }
                }
            }
        }
    }
    None
}
