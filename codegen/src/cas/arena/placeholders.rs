//! The placeholders that occur in each node.
//!
//! If a placeholder cancels, a node equals one that does not contain it. Such a node may replace
//! only operations that already contain its placeholders. Otherwise a placeholder would enter an
//! unrelated expression.

use super::super::direction::SymbolId;
use super::{Handle, Op, Tables};
use std::collections::HashMap;

/// Sets of placeholders by number; 0 is the empty set.
#[derive(Debug)]
pub(super) struct Sets {
    sets: Vec<Vec<SymbolId>>,
    numbers: HashMap<Vec<SymbolId>, u32>,
}

impl Default for Sets {
    fn default() -> Self {
        Self {
            sets: vec![Vec::new()],
            numbers: HashMap::from([(Vec::new(), 0)]),
        }
    }
}

impl Sets {
    fn number(&mut self, set: Vec<SymbolId>) -> u32 {
        let next = self.sets.len() as u32;
        let number = *self.numbers.entry(set.clone()).or_insert(next);
        if number == next {
            self.sets.push(set);
        }
        number
    }

    fn union(&mut self, a: u32, b: u32) -> u32 {
        if a == b || b == 0 {
            return a;
        }
        if a == 0 {
            return b;
        }
        let mut both = [&self.sets[a as usize][..], &self.sets[b as usize]].concat();
        both.sort_unstable();
        both.dedup();
        self.number(both)
    }

    fn contains(&self, whole: u32, part: u32) -> bool {
        let [whole, part] = [whole, part].map(|set| &self.sets[set as usize]);
        part.iter()
            .all(|symbol| whole.binary_search(symbol).is_ok())
    }
}

impl Tables {
    /// Set of placeholders that occur in an operation.
    pub(super) fn placeholders(&mut self, op: &Op) -> u32 {
        let of = |handle: &Handle| self.nodes[handle.index()].placeholders;
        match op {
            Op::Constant(_) | Op::Cosine(_) | Op::Sine(_) => 0,
            Op::Symbol(id) if self.symbols[id.0 as usize].is_placeholder() => {
                self.sets.number(vec![*id])
            }
            Op::Symbol(_) => 0,
            Op::Sqrt(a) | Op::Sign(a) => of(a),
            Op::Add(a, b) | Op::Sub(a, b) | Op::Mul(a, b) | Op::Div(a, b) | Op::Atan2(a, b) => {
                let (a, b) = (of(a), of(b));
                self.sets.union(a, b)
            }
        }
    }

    /// Whether a node may replace an expression with this set of placeholders.
    pub(super) fn may_stand(&self, node: usize, placeholders: u32) -> bool {
        self.sets
            .contains(placeholders, self.nodes[node].placeholders)
    }
}
