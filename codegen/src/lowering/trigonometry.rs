//! Which sines and cosines are evaluated, and which follow by the addition theorem.
//!
//! A sine and cosine of an input costs tens of multiplications; a sum of two known angles costs six
//! operations. So angles with few terms are evaluated, and every angle that is the sum or difference
//! of two known ones is composed of them.

use crate::cas::{Direction, Ratio};

/// How an angle's sine and cosine are had.
#[derive(Debug, Clone, PartialEq)]
pub enum Plan {
    /// By evaluation.
    Direct,
    /// As first + sign × second + constant, where first and second are indices of planned angles.
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

/// Plans all angles of a program: the order in which they are had, and how.
#[must_use]
pub fn plan(angles: &[Direction]) -> Vec<(Direction, Plan)> {
    let mut sorted: Vec<Direction> = angles.to_vec();
    sorted.sort_by(|a, b| {
        let key = |d: &Direction| (d.terms().len(), !d.offset().is_zero());
        let symbols = |d: &Direction| d.terms().iter().map(|t| t.0).collect::<Vec<_>>();
        key(a)
            .cmp(&key(b))
            .then_with(|| symbols(a).cmp(&symbols(b)))
    });
    let mut planned: Vec<(Direction, Plan)> = Vec::new();
    for angle in sorted {
        let how = composed(&angle, &planned).unwrap_or(Plan::Direct);
        planned.push((angle, how));
    }
    planned
}

fn composed(angle: &Direction, known: &[(Direction, Plan)]) -> Option<Plan> {
    let less = |a: &Direction, b: &Direction, sign: i64| {
        let part = b.times(Ratio::integer(sign))?;
        a.plus(&part.negative())
    };
    for (first, (direction, _)) in known.iter().enumerate() {
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
            for (second, (other, _)) in known.iter().enumerate() {
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
