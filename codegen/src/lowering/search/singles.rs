//! Nodes that are one operation away from two others.

use super::graph::{Definition, Graph, Signed};
use super::sieve::Sieve;
use std::collections::HashMap;

/// How much larger than a node's own error that of a cheaper form may be.
pub(super) const LOSS: f64 = 10.0;

/// The sums and products of two nodes that have the value of a node, of the nodes that were looked at.
///
/// Single replacements add no node and bring none back, so what was found once is all there is: only
/// less of it may be alive later.
pub(super) struct Known {
    pairs: HashMap<usize, Vec<Definition>>,
    sieve: Sieve,
}

impl Known {
    /// Nothing is known of the graph's nodes yet.
    pub(super) fn new(graph: &Graph) -> Self {
        Self {
            pairs: HashMap::new(),
            sieve: Sieve::new(graph),
        }
    }
}

/// Replaces every node for which that saves something; the operations saved.
pub(super) fn improve(graph: &mut Graph, known: &mut Known) -> i32 {
    let mut saved = 0;
    let mut divisors = graph.divisors();
    for node in 0..graph.len() {
        graph.refresh(node);
        if graph.is_open(node)
            && graph.cone(node) > 1
            && let Some((by, saving)) = best(graph, node, known, &divisors)
        {
            graph.replace(node, by);
            divisors = graph.divisors();
            saved += saving;
        }
    }
    saved
}

/// The replacement of a node that saves most, if one saves anything.
fn best(
    graph: &mut Graph,
    node: usize,
    known: &mut Known,
    divisors: &[usize],
) -> Option<(Definition, i32)> {
    let mut best: Option<(Definition, i32)> = None;
    for by in forms(graph, node, known, divisors) {
        let saving = graph.saving(node, by);
        if saving > best.map_or(0, |(_, saving)| saving) && fits(graph, by, node, LOSS) {
            best = Some((by, saving));
        }
    }
    best
}

/// All sums, products and quotients of live nodes that seem to have a node's value, of two others.
pub(super) fn forms(
    graph: &Graph,
    node: usize,
    known: &mut Known,
    divisors: &[usize],
) -> Vec<Definition> {
    let sieve = &known.sieve;
    let entry = known.pairs.entry(node);
    let pairs = entry.or_insert_with(|| pairs(graph, node, sieve));
    let quotients = quotients(graph, node, divisors);
    let all = pairs.iter().copied().chain(quotients);
    let is_there = |by: &Definition| by.operands().all(|operand| graph.is_live(operand));
    all.filter(is_there).collect()
}

/// Whether a form can stand for a node: it is not computed from it, has its value indeed, and an error no
/// larger than `loss` times its own.
pub(super) fn fits(graph: &Graph, by: Definition, node: usize, loss: f64) -> bool {
    !graph.depend(by.operands(), node) && graph.means(by, node) && graph.loss(by, node) <= loss
}

/// All sums and products of two live nodes that have the node's value.
fn pairs(graph: &Graph, node: usize, sieve: &Sieve) -> Vec<Definition> {
    let target = graph.value(Signed::new(node, false));
    let mut found = Vec::new();
    for other in (0..graph.len()).filter(|&n| n != node && graph.is_live(n)) {
        for negative in [false, true] {
            if !sieve.may_be_sum(node, other, negative) {
                continue;
            }
            let a = Signed::new(other, negative);
            let b = graph.find(target + -graph.value(a));
            let b = b.filter(|b| b.node() >= other && b.node() != node);
            found.extend(b.map(|b| Definition::Sum(a, b)));
        }
        if !sieve.may_be_product(node, other) {
            continue;
        }
        let a = Signed::new(other, false);
        let b = graph.find(target * graph.inverse(other));
        let b = b.filter(|b| b.node() >= other && b.node() != node);
        found.extend(b.map(|b| Definition::Product(a, b)));
    }
    found
}

/// All quotients of a live node by a divisor that have the node's value.
fn quotients(graph: &Graph, node: usize, divisors: &[usize]) -> Vec<Definition> {
    let target = graph.value(Signed::new(node, false));
    let quotient = |&divisor: &usize| {
        let by = Signed::new(divisor, false);
        let a = graph.find(target * graph.value(by))?;
        (a.node() != node).then_some(Definition::Quotient(a, by))
    };
    let divisors = divisors.iter().filter(|&&d| d != node);
    divisors.filter_map(quotient).collect()
}
