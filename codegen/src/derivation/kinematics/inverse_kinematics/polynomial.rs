//! A scalar equation as a polynomial in one unknown.
//!
//! An equation E = 0 in the cosine c and sine s of a turn, as symbols, has the form E = a c + b s +
//! e + k (c² + s²); one in a slide q has the form E = a q² + b q + e. The coefficients are
//! derivatives at zero, and the form is confirmed by comparison of the two expressions.

use super::super::configuration::Unknown;
use crate::cas::{Arena, CosineSine, Expr, Number, Ratio, Substitution, SymbolId};

/// a c + b s = d, from an equation that is linear in a turn's cosine and sine.
#[derive(Debug, Clone, Copy)]
pub(super) struct Linear<'a> {
    pub(super) a: Expr<'a>,
    pub(super) b: Expr<'a>,
    pub(super) d: Expr<'a>,
}

/// a q² + b q + e = 0.
#[derive(Debug, Clone, Copy)]
pub(super) struct Quadratic<'a> {
    pub(super) a: Expr<'a>,
    pub(super) b: Expr<'a>,
    pub(super) e: Expr<'a>,
}

/// Reads an equation in an unknown turn; `None` if it has another form or does not contain the
/// turn.
pub(super) fn linear<'a>(
    arena: &'a Arena,
    equation: Expr<'a>,
    turn: &Unknown,
) -> Option<Linear<'a>> {
    let CosineSine { cosine: c, sine: s } = turn.unit(arena);
    let symbols = [symbol_of(c)?, symbol_of(s)?];
    let at_zero = |expr: Expr<'a>| at_zero(arena, expr, &symbols);
    let [by_c, by_s] = symbols.map(|symbol| equation.derivative(symbol));
    let (a, b, e) = (at_zero(by_c), at_zero(by_s), at_zero(equation));
    let k = at_zero(by_c.derivative(symbols[0])) * half();
    let form = a * c + b * s + e + k * (c * c + s * s);
    let holds = (equation - form).is_zero();
    let has_turn = !(a.is_zero() && b.is_zero());
    (holds && has_turn).then(|| Linear { a, b, d: -(e + k) })
}

/// Reads an equation in an unknown slide; `None` if it has another form or does not contain the
/// slide.
pub(super) fn quadratic<'a>(
    arena: &'a Arena,
    equation: Expr<'a>,
    slide: &Unknown,
) -> Option<Quadratic<'a>> {
    let q = slide.slide(arena);
    let symbols = [symbol_of(q)?];
    let at_zero = |expr: Expr<'a>| at_zero(arena, expr, &symbols);
    let by_q = equation.derivative(symbols[0]);
    let (b, e) = (at_zero(by_q), at_zero(equation));
    let a = at_zero(by_q.derivative(symbols[0])) * half();
    let form = a * q * q + b * q + e;
    let holds = (equation - form).is_zero();
    let has_slide = !(a.is_zero() && b.is_zero());
    (holds && has_slide).then_some(Quadratic { a, b, e })
}

/// The expression with these symbols set to zero.
pub(in crate::derivation) fn at_zero<'a>(
    arena: &'a Arena,
    expr: Expr<'a>,
    symbols: &[SymbolId],
) -> Expr<'a> {
    let start = Substitution::new(arena);
    let substitution = symbols
        .iter()
        .fold(start, |s, &symbol| s.value(symbol, arena.zero()));
    substitution.apply(expr)
}

fn symbol_of(expr: Expr<'_>) -> Option<SymbolId> {
    expr.symbols().first().copied()
}

fn half() -> Number {
    Number::ratio(Ratio::new(1, 2).unwrap_or(Ratio::ONE))
}
