//! Divisors of expressions.

use super::arena::expr::Expr;
use super::arena::{Arena, Handle, Op};
use std::collections::BTreeSet;

impl Arena {
    /// All divisors in some expressions, each once and in order of construction.
    ///
    /// Constants and expressions that are never zero are left out.
    #[must_use]
    pub fn divisors(&self, expressions: &[Expr<'_>]) -> Vec<Expr<'_>> {
        let mut stack: Vec<usize> = expressions.iter().map(|e| e.handle().index()).collect();
        let (mut seen, mut divisors) = (vec![false; self.len()], BTreeSet::new());
        while let Some(index) = stack.pop() {
            if std::mem::replace(&mut seen[index], true) {
                continue;
            }
            let op = self.op(index);
            if let Op::Div(_, by) = op
                && !self.is_constant(by)
                && !self.is_never_zero(by.index())
            {
                divisors.insert(by.positive());
            }
            stack.extend(op.operands().map(Handle::index));
        }
        divisors.into_iter().map(|by| self.expr(by)).collect()
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn divisors_are_found_at_every_depth() {
        let arena = Arena::new();
        let [a, b, c, d] = ["a", "b", "c", "d"].map(|name| arena.input(name, 0));
        let inner = a / (b + c);
        let all = [(inner + d).sqrt() / c, inner * arena.integer(2) / d, a * b];
        let found: Vec<usize> = all
            .iter()
            .flat_map(|e| arena.divisors(&[*e]))
            .map(|e| e.handle().index())
            .collect();
        let expected = [c, b + c, d, b + c].map(|e| e.handle().index());
        assert_eq!(found, expected);
        assert_eq!(arena.divisors(&all).len(), 3);
        assert_eq!(arena.divisors(&all[2..]), []);
    }
}
