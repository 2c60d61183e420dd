//! Nodes that are one operation away from two others.

use super::graph::{Definition, Graph, Signed};

/// Replaces nodes as long as something is saved; the operations saved.
pub(super) fn improve(graph: &mut Graph) -> i32 {
    let mut saved = 0;
    for node in 0..graph.len() {
        if graph.is_live(node)
            && graph.cone(node) > 1
            && let Some((by, saving)) = best(graph, node)
        {
            graph.replace(node, by);
            saved += saving;
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
            let b = graph.find(target + -graph.value(a));
            let b = b.filter(|b| b.node() >= other && b.node() != node);
            found.extend(b.map(|b| Definition::Sum(a, b)));
        }
        let a = Signed::new(other, false);
        let b = graph.find(target * graph.inverse(other));
        let b = b.filter(|b| b.node() >= other && b.node() != node);
        found.extend(b.map(|b| Definition::Product(a, b)));
    }
    for divisor in graph.divisors().into_iter().filter(|&d| d != node) {
        let by = Signed::new(divisor, false);
        let a = graph
            .find(target * graph.value(by))
            .filter(|a| a.node() != node);
        found.extend(a.map(|a| Definition::Quotient(a, by)));
    }
    found
}
