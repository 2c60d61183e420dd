//! Derivatives of expressions along some directions, by elimination on the linearised graph.
//!
//! Each node is a vertex, and an edge from an operand has the partial derivative as its label.
//! Eliminating a vertex multiplies the labels of its incoming edges with those of its outgoing
//! ones. The edges that remain are the derivatives of the outputs along the directions (Griewank
//! and Walther, *Evaluating Derivatives*, 2008, chapter 9). Forward mode eliminates in the order of
//! evaluation, reverse mode in the opposite one. [`Order`] says which vertices go first here.
//!
//! Labels are expressions of the same graph, so equal ones are shared by value. The derivative of a
//! rotated vector, for instance, is often a vector that the graph already contains.

mod elimination;

use super::arena::expr::Expr;
use super::arena::{Arena, Handle, Op};
use super::cosine_sine::CosineSine;
use super::direction::{Direction, SymbolId};
use super::hasher::{QuickMap, QuickSet};
pub use elimination::Order;
use overact_exact::Number;
use std::collections::{BTreeMap, BTreeSet};

/// A vertex of the linearised graph.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord, Hash)]
pub(crate) struct VertexId(usize);

/// Edges from other vertices, with their labels.
pub(crate) type Edges<'a> = Vec<(VertexId, Expr<'a>)>;

#[derive(Debug, Default)]
struct Vertex<'a> {
    inputs: BTreeMap<VertexId, Expr<'a>>,
    outputs: BTreeSet<VertexId>,
}

/// The linearised graph of some outputs.
#[derive(Debug)]
pub(crate) struct LinearisedGraph<'a> {
    arena: &'a Arena,
    /// Number of directions, which are the first vertices.
    directions: usize,
    vertices: Vec<Vertex<'a>>,
    /// Vertices of nodes; `None` if a node is constant along all directions.
    of_node: QuickMap<usize, Option<VertexId>>,
    of_symbol: QuickMap<SymbolId, VertexId>,
    outputs: Vec<VertexId>,
}

impl<'a> LinearisedGraph<'a> {
    /// A graph without outputs. Symbols are constant along all directions so far.
    pub(crate) fn new(arena: &'a Arena, directions: usize) -> Self {
        Self {
            arena,
            directions,
            vertices: (0..directions).map(|_| Vertex::default()).collect(),
            of_node: QuickMap::default(),
            of_symbol: QuickMap::default(),
            outputs: Vec::new(),
        }
    }

    /// The vertex of a direction.
    pub(crate) const fn direction(index: usize) -> VertexId {
        VertexId(index)
    }

    /// Adds a quantity with given derivatives. `None` if all are zero.
    pub(crate) fn add(&mut self, edges: Edges<'a>) -> Option<VertexId> {
        let id = VertexId(self.vertices.len());
        let mut vertex = Vertex::default();
        for (from, label) in edges {
            let sum = match vertex.inputs.get(&from) {
                Some(&known) => known + label,
                None => label,
            };
            vertex.inputs.insert(from, sum);
        }
        vertex.inputs.retain(|_, label| !label.is_zero());
        if vertex.inputs.is_empty() {
            return None;
        }
        for from in vertex.inputs.keys() {
            self.vertices[from.0].outputs.insert(id);
        }
        self.vertices.push(vertex);
        Some(id)
    }

    /// Sets the quantity that a symbol represents, as a number or an angle.
    pub(crate) fn set_symbol(&mut self, symbol: SymbolId, quantity: VertexId) {
        self.of_symbol.insert(symbol, quantity);
    }

    /// The quantity that a symbol represents; `None` if it is constant.
    pub(crate) fn of_symbol(&self, symbol: SymbolId) -> Option<VertexId> {
        self.of_symbol.get(&symbol).copied()
    }

    /// Sets the derivatives of an expression, which are then not derived from its operands.
    ///
    /// The first derivatives that are set for a node hold. Constants, symbols, sines and cosines
    /// of symbols keep their own.
    pub(crate) fn set(&mut self, value: Expr<'a>, edges: Edges<'a>) {
        let node = value.handle().index();
        let is_leaf = matches!(
            self.arena.op(node),
            Op::Constant(_) | Op::Symbol(_) | Op::Cosine(_) | Op::Sine(_)
        );
        if is_leaf || self.of_node.contains_key(&node) {
            return;
        }
        let signed = |label: Expr<'a>| {
            if value.handle().is_negative() {
                -label
            } else {
                label
            }
        };
        let edges = edges.into_iter().map(|(from, label)| (from, signed(label)));
        let vertex = self.add(edges.collect());
        self.of_node.insert(node, vertex);
    }

    /// Adds an output Σ w f with constant weights w of expressions f.
    pub(crate) fn output(&mut self, terms: &[(Expr<'a>, Expr<'a>)]) {
        let mut edges = Vec::new();
        for &(value, weight) in terms {
            self.visit(value);
            let handle = value.handle();
            if let Some(Some(vertex)) = self.of_node.get(&handle.index()) {
                let label = if handle.is_negative() {
                    -weight
                } else {
                    weight
                };
                edges.push((*vertex, label));
            }
        }
        let vertex = self.add(edges).unwrap_or_else(|| {
            self.vertices.push(Vertex::default());
            VertexId(self.vertices.len() - 1)
        });
        self.outputs.push(vertex);
    }

    /// Derivatives of the outputs, one row for each, along the directions.
    pub(crate) fn derivatives(mut self, order: Order) -> Vec<Vec<Expr<'a>>> {
        self.eliminate(order);
        let zero = self.arena.zero();
        let row = |output: &VertexId| {
            let inputs = &self.vertices[output.0].inputs;
            let entry = |k| inputs.get(&VertexId(k)).copied().unwrap_or(zero);
            (0..self.directions).map(entry).collect()
        };
        self.outputs.iter().map(row).collect()
    }

    /// Adds the nodes of an expression. Operands have lower indices than operations.
    fn visit(&mut self, value: Expr<'a>) {
        let mut new: QuickSet<usize> = QuickSet::default();
        let mut open = vec![value.handle().index()];
        while let Some(node) = open.pop() {
            if self.of_node.contains_key(&node) || !new.insert(node) {
                continue;
            }
            open.extend(self.arena.op(node).operands().map(Handle::index));
        }
        let mut new: Vec<usize> = new.into_iter().collect();
        new.sort_unstable();
        for node in new {
            let vertex = match self.arena.op(node) {
                Op::Symbol(symbol) => self.of_symbol(symbol),
                _ => {
                    let edges = self.partials(node);
                    self.add(edges)
                }
            };
            self.of_node.insert(node, vertex);
        }
    }

    /// Partial derivatives of a node with respect to its operands.
    fn partials(&self, node: usize) -> Edges<'a> {
        let arena = self.arena;
        let op = arena.op(node);
        if let Op::Cosine(id) | Op::Sine(id) = op {
            let angle = arena.direction_at(id);
            let CosineSine { cosine, sine } = arena.cosine_and_sine(&angle);
            let is_cosine = matches!(op, Op::Cosine(_));
            return self.about(&angle, if is_cosine { -sine } else { cosine });
        }
        let this = arena.expr(Handle::new(node, false));
        let e = |handle: Handle| arena.expr(handle);
        let mut edges = Vec::new();
        let mut edge = |operand: Handle, label: &dyn Fn() -> Expr<'a>| {
            if let Some(Some(vertex)) = self.of_node.get(&operand.index()) {
                let label = label();
                let label = if operand.is_negative() { -label } else { label };
                edges.push((*vertex, label));
            }
        };
        match op {
            Op::Constant(_) | Op::Symbol(_) | Op::Cosine(_) | Op::Sine(_) | Op::Sign(_) => {}
            Op::Add(a, b) => {
                edge(a, &|| arena.one());
                edge(b, &|| arena.one());
            }
            Op::Sub(a, b) => {
                edge(a, &|| arena.one());
                edge(b, &|| -arena.one());
            }
            Op::Mul(a, b) => {
                edge(a, &|| e(b));
                edge(b, &|| e(a));
            }
            Op::Div(a, b) => {
                edge(a, &|| e(b).reciprocal());
                edge(b, &|| -(this * e(b).reciprocal()));
            }
            Op::Sqrt(a) => edge(a, &|| (this * arena.integer(2)).reciprocal()),
            Op::Atan2(y, x) => {
                let square = e(x).squared() + e(y).squared();
                edge(y, &|| e(x) / square);
                edge(x, &|| -(e(y) / square));
            }
        }
        edges
    }

    /// Edges from the symbols of an angle, for a quantity with this derivative with respect to it.
    fn about(&self, angle: &Direction, derivative: Expr<'a>) -> Edges<'a> {
        let edge = |(symbol, factor): &(SymbolId, _)| {
            let vertex = self.of_symbol(*symbol)?;
            Some((vertex, derivative * Number::ratio(*factor)))
        };
        angle.terms().iter().filter_map(edge).collect()
    }
}

#[cfg(test)]
mod tests {
    use super::{LinearisedGraph, Order};
    use crate::cas::{Arena, CosineSine};

    #[test]
    fn every_elimination_order_gives_the_derivatives() {
        for order in Order::ALL {
            let arena = Arena::new();
            let (x, y, q) = (arena.variable("x"), arena.variable("y"), arena.angle("q"));
            let CosineSine { cosine: c, sine: s } = arena.cosine_and_sine(&q);
            let f = (x * c + s.squared() + y).sqrt() / (x + s) + s.atan2(x * y);
            let g = (x * y - c) * (s + y) - f * f;
            let symbols = ["x", "y", "q"].map(|name| arena.symbol(name));
            let mut graph = LinearisedGraph::new(&arena, 3);
            for (k, symbol) in symbols.into_iter().enumerate() {
                graph.set_symbol(symbol, LinearisedGraph::direction(k));
            }
            graph.output(&[(f, arena.one())]);
            graph.output(&[(-g, arena.integer(3)), (f, x)]);
            graph.output(&[(arena.integer(2), arena.one())]);
            let rows = graph.derivatives(order);
            assert!(rows[2].iter().all(|entry| entry.is_zero()));
            let value = |e: crate::cas::Expr<'_>| {
                e.evaluate(&|id| 0.5 + 0.2 * f64::from(u8::from(id == symbols[1])))
            };
            for (k, symbol) in symbols.into_iter().enumerate() {
                let (df, dg) = (f.derivative(symbol), g.derivative(symbol));
                let wanted = [df, x * df - arena.integer(3) * dg];
                for (row, wanted) in rows.iter().zip(wanted) {
                    let (found, wanted) = (value(row[k]), value(wanted));
                    assert!((found - wanted).abs() < 1e-13, "{found} {wanted}");
                }
            }
        }
    }

    #[test]
    fn given_derivatives_replace_those_of_the_operands() {
        let arena = Arena::new();
        let (x, y) = (arena.variable("x"), arena.variable("y"));
        let root = (x * x + y).sqrt();
        let mut graph = LinearisedGraph::new(&arena, 1);
        graph.set_symbol(arena.symbol("x"), LinearisedGraph::direction(0));
        graph.set(-root, vec![(LinearisedGraph::direction(0), y)]);
        graph.output(&[(root * y, arena.one())]);
        let found = graph.derivatives(Order::default())[0][0];
        assert_eq!(found, -(y * y));
    }
}
