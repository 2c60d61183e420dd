//! From the arena to the DAG: the nodes that a function needs, operands first.

use super::{Angle, Constant, Context, Dag, Definition, Edge, GuardedEdge, Origin, Symbol, Turn};
use crate::cas::arena::{Handle, Op};
use crate::cas::hasher::QuickMap;
use crate::cas::{Arena, Expr};
use crate::lowering::GuardedExpr;

/// The DAG of some entries, without guards whose value no entry needs; guards on the pose are kept.
pub(crate) fn from_arena<'a>(
    arena: &'a Arena,
    entries: &[Expr<'a>],
    guards: &[GuardedExpr<'a>],
) -> Dag {
    let mut copy = Copy::new(arena);
    for entry in entries {
        let edge = copy.edge(entry.handle());
        copy.dag.push_entry(edge);
    }
    for guard in guards {
        let handle = guard.value.handle();
        if guard.condition.is_of_pose() {
            let _ = copy.edge(handle);
        }
        if let Some(&node) = copy.numbers.get(&handle.index()) {
            copy.dag.push_guard(GuardedEdge {
                value: Edge::new(node, handle.is_negative()),
                condition: guard.condition.clone(),
            });
        }
    }
    copy.dag
}

/// A DAG under construction from an arena.
pub(crate) struct Copy<'a> {
    arena: &'a Arena,
    pub(crate) dag: Dag,
    /// The DAG node of each arena node.
    numbers: QuickMap<usize, usize>,
}

impl<'a> Copy<'a> {
    /// An empty copy with the arena's symbols and angles.
    pub(crate) fn new(arena: &'a Arena) -> Self {
        let symbol = |id| Symbol {
            element: arena.input_element(id),
            fingerprint: arena.symbol_fingerprint(id),
        };
        let turn = |id: u32| {
            let (cosine, sine) = arena.turn_fingerprints(id);
            Turn {
                direction: arena.direction_at(id),
                cosine,
                sine,
            }
        };
        Self {
            arena,
            dag: Dag::new(Context {
                symbols: arena.symbols().map(symbol).collect(),
                turns: (0..arena.direction_count()).map(turn).collect(),
                scopes: arena.scope_names(),
            }),
            numbers: QuickMap::default(),
        }
    }

    /// The edge of an arena handle.
    pub(crate) fn edge(&mut self, handle: Handle) -> Edge {
        Edge::new(self.node(handle.index()), handle.is_negative())
    }

    fn node(&mut self, index: usize) -> usize {
        if let Some(&known) = self.numbers.get(&index) {
            return known;
        }
        let definition = match self.arena.op(index) {
            Op::Constant(id) => {
                Definition::Constant(Constant::new(self.arena.constant_at(id).value()))
            }
            Op::Symbol(id) => Definition::Symbol(id.number() as u32),
            Op::Cosine(id) => Definition::Cosine(Angle::Unplanned(id)),
            Op::Sine(id) => Definition::Sine(Angle::Unplanned(id)),
            Op::Add(a, b) => Definition::Sum(self.edge(a), self.edge(b)),
            Op::Sub(a, b) => Definition::Sum(self.edge(a), self.edge(b).times(true)),
            Op::Mul(a, b) => Definition::Product(self.edge(a), self.edge(b)),
            Op::Div(a, b) => Definition::Quotient(self.edge(a), self.edge(b)),
            Op::Sqrt(a) => Definition::Root(self.edge(a)),
            Op::Sign(a) => Definition::Sign(self.edge(a)),
            Op::Atan2(y, x) => Definition::ArcTangent(self.edge(y), self.edge(x)),
        };
        let origin = Origin {
            name: self.arena.name_of(index).map(Into::into),
            scope: self.arena.scope_at(index),
        };
        let fingerprint = self.arena.fingerprint_at(index);
        let node = self.dag.push(definition, fingerprint, origin);
        self.numbers.insert(index, node);
        node
    }
}
