//! Nodes that are one operation away from two others.

use super::graph::{Definition, Graph, Signed};

/// Replaces nodes as long as something is saved; the operations saved.
pub(super) fn improve(graph: &mut Graph) -> i32 {
    let mut saved = 0;
    for node in 0..graph.len() {
        if graph.is_live(node) && graph.cone(node) > 1 {
            if let Some((by, saving)) = best(graph, node) {
                graph.replace(node, by);
                saved += saving;
            }
        }
    }
    saved
}

/// The replacement of a node that saves most, if one saves anything.
fn best(graph: &mut Graph, node: usize) -> Option<(Definition, i32)> {
    if matches!(
        graph.definitions[node],
        Definition::Leaf | Definition::Fixed(..)
    ) {
        return None;
    }
    let candidates = candidates(graph, node);
    let mut best: Option<(Definition, i32)> = None;
    for by in candidates {
        let saving = graph.saving(node, by);
        if saving <= best.map_or(0, |(_, saving)| saving) {
            continue;
        }
        if graph.depend(by.operands(), node) || !graph.means(by, node) {
            continue;
        }
        best = Some((by, saving));
    }
    best
}

/// All sums, products and quotients of two live nodes that have the node's value.
fn candidates(graph: &Graph, node: usize) -> Vec<Definition> {
    let target = graph.value(Signed::new(node, false));
    let mut found = Vec::new();
    for other in (0..graph.len()).filter(|&n| n != node && graph.is_live(n)) {
        for negative in [false, true] {
            let a = Signed::new(other, negative);
            if let Some(b) = graph.find(target + -graph.value(a)) {
                if b.node() >= other && b.node() != node {
                    found.push(Definition::Sum(a, b));
                }
            }
        }
        let a = Signed::new(other, false);
        if let Some(b) = graph.find(target * graph.inverse(other)) {
            if b.node() >= other && b.node() != node {
                found.push(Definition::Product(a, b));
            }
        }
    }
    for divisor in graph.divisors() {
        if let Some(a) = graph.find(target * graph.value(Signed::new(divisor, false))) {
            if a.node() != node && divisor != node {
                found.push(Definition::Quotient(a, Signed::new(divisor, false)));
            }
        }
    }
    found
}
