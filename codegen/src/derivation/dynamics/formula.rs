//! Formulas of a joint's position, or of a spring's length and its rate, as expressions.

use crate::cas::{Angle, Arena, CosineSine, Expr, Number, Ratio};
use crate::mechanism::Formula;

/// The variable of a formula.
pub(super) trait Variable<'a> {
    /// The variable q; `None` if the configuration does not determine it.
    fn number(&self) -> Option<Expr<'a>>;

    /// Its rate; `None` if formulas of it have none.
    fn rate(&self) -> Option<Expr<'a>> {
        None
    }

    /// Cosine and sine of `offset` + `factor` q; `None` if the configuration does not determine
    /// them.
    fn unit(&self, _offset: Angle, _factor: Ratio) -> Option<CosineSine<'a>> {
        None
    }
}

/// A formula of a variable; `None` if the configuration does not determine it, or an angle exceeds
/// the range of numbers.
///
/// Radicands are added to `radicands`.
pub(super) fn expression<'a>(
    arena: &'a Arena,
    variable: &impl Variable<'a>,
    formula: &Formula,
    radicands: &mut Vec<Expr<'a>>,
) -> Option<Expr<'a>> {
    let mut of = |part: &Formula| expression(arena, variable, part, radicands);
    Some(match formula {
        Formula::Linear { offset, factor } if factor.is_zero() => arena.number(*offset),
        Formula::Linear { offset, factor } => {
            variable.number()? * Number::ratio(*factor) + arena.number(*offset)
        }
        Formula::Rate { factor } => variable.rate()? * Number::ratio(*factor),
        Formula::Cosine { offset, factor } => variable.unit(*offset, *factor)?.cosine,
        Formula::Sine { offset, factor } => variable.unit(*offset, *factor)?.sine,
        Formula::Sum(a, b) => of(a)? + of(b)?,
        Formula::Product(a, b) => of(a)? * of(b)?,
        Formula::Quotient(a, b) => of(a)? * of(b)?.reciprocal(),
        Formula::SquareRoot(a) => {
            let radicand = of(a)?;
            radicands.push(radicand);
            radicand.sqrt()
        }
    })
}
