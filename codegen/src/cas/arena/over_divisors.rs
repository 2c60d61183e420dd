//! Sums of quotients that equal a known expression over their divisors.

use super::super::field::Element;
use super::expr::Expr;
use super::{Arena, Handle, Op};

/// Depth below a sum to which divisors are searched.
const DEPTH: usize = 4;

impl Arena {
    /// Enables rewriting of sums of quotients as a known expression over their divisors.
    pub(crate) fn find_over_divisors(&self) {
        self.tables.borrow_mut().finds_over_divisors = true;
    }

    /// A sum as t / d, with d one divisor of its terms or the product of all.
    ///
    /// It exists if t, the sum times d, is a known expression or a multiple of one. For instance,
    /// (t₂ c - t₁ s) c/s + (t₁ c + t₂ s) becomes t₂ / s.
    pub(in super::super) fn over_divisors(&self, sum: &Op) -> Option<Expr<'_>> {
        let tables = self.tables.borrow();
        if !tables.finds_over_divisors || tables.by_shape.contains_key(sum) {
            return None;
        }
        let own = tables.fingerprint(sum);
        drop(tables);
        let divisors = self.divisors_under(sum);
        if divisors.is_empty() || own.image.contains(&Element::ZERO) {
            return None;
        }
        let singles = divisors.iter().map(std::slice::from_ref);
        let all = (divisors.len() > 1).then_some(&divisors[..]);
        singles.chain(all).find_map(|by| {
            let factors = by.iter().map(|by| self.fingerprint_at(by.index()));
            let times = factors.fold(own, |times, factor| times * factor);
            let known = self.same(&times).or_else(|| self.multiple(&times))?;
            let quotient = |t, by: &Handle| t / self.expr(*by);
            self.fits(sum, known)
                .then(|| by.iter().fold(self.expr(known), quotient))
        })
    }

    /// Divisors in the terms of a sum, each once.
    fn divisors_under(&self, sum: &Op) -> Vec<Handle> {
        let mut divisors = Vec::new();
        let mut parts: Vec<(Handle, usize)> = sum.operands().map(|part| (part, 1)).collect();
        while let Some((part, depth)) = parts.pop() {
            let op = self.op(part.index());
            let inner = match op {
                Op::Div(a, by) => {
                    if !divisors.contains(&by) {
                        divisors.push(by);
                    }
                    [Some(a), None]
                }
                Op::Mul(a, b) | Op::Add(a, b) | Op::Sub(a, b) => [Some(a), Some(b)],
                _ => [None, None],
            };
            if depth < DEPTH {
                parts.extend(inner.into_iter().flatten().map(|own| (own, depth + 1)));
            }
        }
        divisors
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::cas::CosineSine;

    /// With t₁' = t₁ c + t₂ s and t₂' = t₂ c - t₁ s, k (t₂' c/s + t₁') is k t₂ / s where t₂ is known.
    #[test]
    fn a_rotated_direction_over_the_sine_is_recognised() {
        let solved = |finds: bool| {
            let arena = Arena::new();
            if finds {
                arena.find_over_divisors();
            }
            let CosineSine { cosine: c, sine: s } =
                arena.cosine_and_sine(&arena.input_angle("joints", 0));
            let [t1, t2, d] = [0, 1, 2].map(|i| arena.input("pose", i));
            let [own1, own2] = [t1 * c + t2 * s, t2 * c - t1 * s];
            let k = arena.integer(5) / d;
            let sum = own2 * (c / s * k) + own1 * k;
            let is_quotient = matches!(arena.op(sum.handle().index()), Op::Div(_, _));
            (is_quotient, sum == (arena.integer(5) * t2) / s / d)
        };
        assert_eq!(solved(true), (true, true));
        assert_eq!(solved(false), (false, true));
    }

    /// A sum that matches no known expression over its divisors stays unchanged.
    #[test]
    fn unrelated_quotient_sums_are_unchanged() {
        let arena = Arena::new();
        arena.find_over_divisors();
        let [a, b, c, d] = [0, 1, 2, 3].map(|i| arena.input("pose", i));
        let sum = a / c + b / d;
        assert!(matches!(arena.op(sum.handle().index()), Op::Add(_, _)));
    }
}
