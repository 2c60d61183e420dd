//! Orders of the elimination of vertices.

use super::{LinearisedGraph, VertexId};
use crate::cas::Expr;
use std::collections::BTreeSet;

/// The order in which vertices are eliminated.
///
/// Which needs the fewest operations depends on the function.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash, Default)]
pub enum Order {
    /// The order of evaluation: forward mode.
    #[default]
    Evaluation,
    /// The smallest Markowitz degree first: the product of the numbers of incoming and outgoing
    /// edges. Of equal degrees, the vertex that is evaluated last.
    SmallestDegree,
    /// The smallest growth of the number of edges first.
    LeastFill,
}

impl Order {
    /// All orders.
    pub const ALL: [Self; 3] = [Self::Evaluation, Self::SmallestDegree, Self::LeastFill];
}

/// Rank of a vertex in the elimination; the lowest goes first.
type Rank = (i64, i64, VertexId);

impl<'a> LinearisedGraph<'a> {
    /// Eliminates all vertices but directions and outputs.
    pub(super) fn eliminate(&mut self, order: Order) {
        let outputs: BTreeSet<VertexId> = self.outputs.iter().copied().collect();
        let inner = (self.directions..self.vertices.len()).map(VertexId);
        let inner: BTreeSet<VertexId> = inner.filter(|v| !outputs.contains(v)).collect();
        let mut ranks = vec![None; self.vertices.len()];
        let mut queue: BTreeSet<Rank> = BTreeSet::new();
        for &vertex in &inner {
            let rank = self.rank(vertex, order);
            ranks[vertex.0] = Some(rank);
            queue.insert(rank);
        }
        while let Some((_, _, vertex)) = queue.pop_first() {
            ranks[vertex.0] = None;
            for neighbour in self.remove(vertex) {
                let Some(known) = ranks[neighbour.0] else {
                    continue;
                };
                let rank = self.rank(neighbour, order);
                if rank != known {
                    queue.remove(&known);
                    queue.insert(rank);
                    ranks[neighbour.0] = Some(rank);
                }
            }
        }
    }

    /// Replaces a vertex by edges between its neighbours, which are returned.
    fn remove(&mut self, vertex: VertexId) -> Vec<VertexId> {
        let inputs = std::mem::take(&mut self.vertices[vertex.0].inputs);
        let outputs = std::mem::take(&mut self.vertices[vertex.0].outputs);
        for &from in inputs.keys() {
            self.vertices[from.0].outputs.remove(&vertex);
        }
        for &to in &outputs {
            let Some(after) = self.vertices[to.0].inputs.remove(&vertex) else {
                continue;
            };
            for (&from, &before) in &inputs {
                self.connect(from, to, after * before);
            }
        }
        inputs.into_keys().chain(outputs).collect()
    }

    /// Adds a label to the edge between two vertices.
    fn connect(&mut self, from: VertexId, to: VertexId, label: Expr<'a>) {
        let inputs = &mut self.vertices[to.0].inputs;
        let sum = match inputs.get(&from) {
            Some(&known) => known + label,
            None => label,
        };
        if sum.is_zero() {
            inputs.remove(&from);
            self.vertices[from.0].outputs.remove(&to);
        } else {
            inputs.insert(from, sum);
            self.vertices[from.0].outputs.insert(to);
        }
    }

    fn rank(&self, id: VertexId, order: Order) -> Rank {
        let vertex = &self.vertices[id.0];
        let (inputs, outputs) = (vertex.inputs.len() as i64, vertex.outputs.len() as i64);
        let place = id.0 as i64;
        let degree = inputs * outputs;
        match order {
            Order::Evaluation => (0, place, id),
            Order::SmallestDegree => (degree, -place, id),
            Order::LeastFill => (degree - inputs - outputs, place, id),
        }
    }
}
