//! Derivative, substitution and numeric evaluation of expressions.

use super::arena::expr::Expr;
use super::arena::{Arena, Handle, Op};
use super::direction::{Direction, SymbolId};
use super::hasher::{QuickMap, QuickSet};
use overact_exact::Number;
use std::collections::BTreeSet;

impl<'a> Expr<'a> {
    /// Derivative with respect to a symbol, as a number or an angle. Sign functions count as
    /// constants.
    #[must_use]
    pub fn derivative(self, symbol: SymbolId) -> Expr<'a> {
        let mut known = QuickMap::default();
        let derivative = differentiate(self.arena(), self.handle().index(), symbol, &mut known);
        if self.handle().is_negative() {
            -derivative
        } else {
            derivative
        }
    }

    /// Symbols that occur as numbers in the expression, in ascending order. Symbols that occur only
    /// as angles are not included.
    #[must_use]
    pub fn symbols(self) -> Vec<SymbolId> {
        let symbol = |index: usize| match self.arena().op(index) {
            Op::Symbol(id) => Some(id),
            _ => None,
        };
        let symbols: BTreeSet<SymbolId> = self.nodes().into_iter().filter_map(symbol).collect();
        symbols.into_iter().collect()
    }

    /// Number of nodes in the expression without constants and symbols.
    #[must_use]
    pub fn size(self) -> usize {
        let is_work =
            |index: &usize| !matches!(self.arena().op(*index), Op::Constant(_) | Op::Symbol(_));
        self.nodes().into_iter().filter(is_work).count()
    }

    /// Indices of all nodes in the expression.
    fn nodes(self) -> QuickSet<usize> {
        let mut seen = QuickSet::default();
        let mut open = vec![self.handle().index()];
        while let Some(index) = open.pop() {
            if !seen.insert(index) {
                continue;
            }
            open.extend(self.arena().op(index).operands().map(Handle::index));
        }
        seen
    }

    /// The value for given values of the symbols (angles in radians).
    #[must_use]
    pub fn evaluate(self, values: &dyn Fn(SymbolId) -> f64) -> f64 {
        let mut known = QuickMap::default();
        number_of(self.arena(), self.handle(), values, &mut known)
    }
}

fn differentiate<'a>(
    arena: &'a Arena,
    index: usize,
    symbol: SymbolId,
    known: &mut QuickMap<usize, Expr<'a>>,
) -> Expr<'a> {
    if let Some(&derivative) = known.get(&index) {
        return derivative;
    }
    let mut d = |handle: Handle| {
        let derivative = differentiate(arena, handle.index(), symbol, known);
        if handle.is_negative() {
            -derivative
        } else {
            derivative
        }
    };
    let e = |handle: Handle| arena.expr(handle);
    let factor = |direction: u32| {
        let direction = arena.direction_at(direction);
        let term = direction.terms().iter().find(|t| t.0 == symbol);
        arena.number(term.map_or(Number::ZERO, |t| Number::ratio(t.1)))
    };
    let this = arena.expr(Handle::new(index, false));
    let derivative = match arena.op(index) {
        Op::Constant(_) | Op::Sign(_) => arena.zero(),
        Op::Symbol(id) => arena.integer(i64::from(id == symbol)),
        Op::Cosine(id) => -(arena.cosine_and_sine(&arena.direction_at(id)).sine * factor(id)),
        Op::Sine(id) => arena.cosine_and_sine(&arena.direction_at(id)).cosine * factor(id),
        Op::Add(a, b) => d(a) + d(b),
        Op::Sub(a, b) => d(a) - d(b),
        Op::Mul(a, b) => d(a) * e(b) + e(a) * d(b),
        Op::Div(a, b) => (d(a) - this * d(b)) / e(b),
        Op::Sqrt(a) => d(a) / (this * arena.integer(2)),
        Op::Atan2(y, x) => {
            let square = e(x).squared() + e(y).squared();
            (e(x) * d(y) - e(y) * d(x)) / square
        }
    };
    known.insert(index, derivative);
    derivative
}

fn number_of(
    arena: &Arena,
    handle: Handle,
    values: &dyn Fn(SymbolId) -> f64,
    known: &mut QuickMap<usize, f64>,
) -> f64 {
    let sign = if handle.is_negative() { -1.0 } else { 1.0 };
    if let Some(&value) = known.get(&handle.index()) {
        return sign * value;
    }
    let angle = |id: u32| angle_of(&arena.direction_at(id), values);
    let mut n = |handle: Handle| number_of(arena, handle, values, known);
    let value = match arena.op(handle.index()) {
        Op::Constant(id) => arena.constant_at(id).value(),
        Op::Symbol(id) => values(id),
        Op::Cosine(id) => angle(id).cos(),
        Op::Sine(id) => angle(id).sin(),
        Op::Add(a, b) => n(a) + n(b),
        Op::Sub(a, b) => n(a) - n(b),
        Op::Mul(a, b) => n(a) * n(b),
        Op::Div(a, b) => n(a) / n(b),
        Op::Sqrt(a) => n(a).sqrt(),
        Op::Sign(a) => sign_of(n(a)),
        Op::Atan2(y, x) => n(y).atan2(n(x)),
    };
    known.insert(handle.index(), value);
    sign * value
}

/// The sign of a value, ±1; 0 for 0.
pub(crate) fn sign_of(value: f64) -> f64 {
    if value == 0.0 { 0.0 } else { value.signum() }
}

/// The angle of a direction for given values of the symbols, rad.
pub(crate) fn angle_of(direction: &Direction, values: &dyn Fn(SymbolId) -> f64) -> f64 {
    direction
        .terms()
        .iter()
        .fold(direction.offset().value(), |sum, (symbol, factor)| {
            sum + values(*symbol) * factor.value()
        })
}

/// Replaces symbols by expressions, possibly of another graph: a number by an expression, an angle
/// by another angle.
#[derive(Debug)]
pub struct Substitution<'b> {
    arena: &'b Arena,
    values: QuickMap<SymbolId, Expr<'b>>,
}

impl<'b> Substitution<'b> {
    /// A substitution into the graph `arena`. Symbols that are not replaced keep their names.
    #[must_use]
    pub fn new(arena: &'b Arena) -> Self {
        Self {
            arena,
            values: QuickMap::default(),
        }
    }

    /// Replaces the value of a symbol.
    #[must_use]
    pub fn value(mut self, symbol: SymbolId, by: Expr<'b>) -> Self {
        self.values.insert(symbol, by);
        self
    }

    /// The expression with all replacements made.
    #[must_use]
    pub fn apply(&self, expr: Expr<'_>) -> Expr<'b> {
        self.replace(expr.arena(), expr.handle(), &mut QuickMap::default())
    }

    /// Expressions of one graph with all replacements made; shared nodes are replaced once.
    #[must_use]
    pub(crate) fn apply_all(&self, all: &[Expr<'_>]) -> Vec<Expr<'b>> {
        let mut known = QuickMap::default();
        let mut replaced = |expr: &Expr<'_>| self.replace(expr.arena(), expr.handle(), &mut known);
        all.iter().map(&mut replaced).collect()
    }

    fn replace(
        &self,
        from: &Arena,
        handle: Handle,
        known: &mut QuickMap<usize, Expr<'b>>,
    ) -> Expr<'b> {
        let sign = |e: Expr<'b>| if handle.is_negative() { -e } else { e };
        if let Some(&expr) = known.get(&handle.index()) {
            return sign(expr);
        }
        let mut r = |handle: Handle| self.replace(from, handle, known);
        let expr = match from.op(handle.index()) {
            Op::Constant(id) => self.arena.number(from.constant_at(id)),
            Op::Symbol(id) => match self.values.get(&id) {
                Some(&by) => by,
                None => self.arena.value_of(self.arena.symbol_like(from, id)),
            },
            Op::Cosine(id) => self.arena.cosine_and_sine(&self.turn(from, id)).cosine,
            Op::Sine(id) => self.arena.cosine_and_sine(&self.turn(from, id)).sine,
            Op::Add(a, b) => r(a) + r(b),
            Op::Sub(a, b) => r(a) - r(b),
            Op::Mul(a, b) => r(a) * r(b),
            Op::Div(a, b) => r(a) / r(b),
            Op::Sqrt(a) => r(a).sqrt(),
            Op::Sign(a) => r(a).sign(),
            Op::Atan2(y, x) => r(y).atan2(r(x)),
        };
        known.insert(handle.index(), expr);
        sign(expr)
    }

    fn turn(&self, from: &Arena, id: u32) -> Direction {
        let direction = from.direction_at(id);
        let start = Direction::constant(direction.offset());
        direction
            .terms()
            .iter()
            .fold(start, |sum, &(symbol, factor)| {
                let angle = Direction::symbol(self.arena.symbol_like(from, symbol));
                let part = angle.times(factor).and_then(|angle| sum.plus(&angle));
                part.unwrap_or(sum)
            })
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::cas::CosineSine;

    #[test]
    fn derivative_agrees_with_finite_differences() {
        let arena = Arena::new();
        let (x, q) = (arena.variable("x"), arena.angle("q"));
        let CosineSine { cosine: c, sine: s } = arena.cosine_and_sine(&q);
        let f = (x * c + s.squared()).sqrt() / (x + s) + s.atan2(x);
        for name in ["x", "q"] {
            let symbol = arena.symbol(name);
            let at = |h: f64| f.evaluate(&|id| if id == symbol { 0.7 + h } else { 0.7 });
            let h = 1e-5;
            let difference = (at(h) - at(-h)) / (2.0 * h);
            let exact = f.derivative(symbol).evaluate(&|_| 0.7);
            assert!(
                (difference - exact).abs() < 1e-9,
                "{name}: {difference} {exact}"
            );
        }
    }

    #[test]
    fn substitution_replaces_values_and_keeps_angles() {
        let (from, to) = (Arena::new(), Arena::new());
        let c = from.cosine_and_sine(&from.angle("q")).cosine;
        let f = from.variable("x") * c;
        let g = Substitution::new(&to)
            .value(from.symbol("x"), to.integer(3))
            .apply(f);
        assert!((g.evaluate(&|_| 0.25) - 3.0 * 0.25_f64.cos()).abs() < 1e-15);
    }

    #[test]
    fn cancelled_placeholders_vanish_from_expressions() {
        let arena = Arena::new();
        let (q, a) = (arena.placeholder("q"), arena.variable("a"));
        let hidden = (q + a).squared() - q.squared() - q * a * arena.integer(2);
        assert_eq!(hidden.symbols().len(), 2);
        assert_eq!(a.squared().symbols(), [arena.symbol("a")]);
        // In an expression that contains the placeholder anyway, the plain form is shared.
        assert_eq!(hidden + q, a.squared() + q);
    }
}
