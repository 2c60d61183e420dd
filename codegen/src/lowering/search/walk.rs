//! A walk among forms of equal cost.
//!
//! Where no replacement saves anything any more, many cost nothing, and from the form that one of them
//! leads to others may save something again (plateau moves: B. Selman, H. Kautz, B. Cohen, 1994). So
//! every node that could be written in another way at the same cost is, at random but always the same,
//! and the search goes on from there, as long as that pays. What differs in the end without
//! need is written as the derivation has it.

use super::graph::Graph;
use super::singles::{self, Known};
use super::{Reach, repair, settle};
use crate::cas::Stream;

/// How much larger than a node's own error that of a form of equal cost may be.
const LOSS: f64 = 2.0;

/// Improves a graph in which nothing can be saved by replacements one after the other.
pub(super) fn improve(graph: &mut Graph, known: &mut Known, reach: Reach) {
    let mut stream = Stream::new(1);
    let mut best = graph.total();
    let mut fruitless = 0;
    for _ in 0..reach.steps(graph.len()) {
        let before = graph.clone();
        step(graph, known, &mut stream);
        settle(graph, known, reach, reach.rounds_after_a_step());
        repair::improve(graph);
        let total = graph.total();
        fruitless = if total < best { 0 } else { fruitless + 1 };
        if total > best {
            if graph.len() > before.len() {
                *known = Known::new(&before);
            }
            *graph = before;
        }
        best = best.min(total);
        if fruitless == reach.patience() {
            return;
        }
    }
}

/// Writes every node in a way drawn from those that cost nothing, its own among them.
fn step(graph: &mut Graph, known: &mut Known, stream: &mut Stream) {
    let mut divisors = graph.divisors();
    for node in 0..graph.len() {
        graph.refresh(node);
        if !graph.is_open(node) {
            continue;
        }
        let mut forms = singles::forms(graph, node, known, &divisors);
        forms.retain(|&by| graph.saving(node, by) >= 0 && singles::fits(graph, by, node, LOSS));
        let drawn = stream.below(forms.len() + 1);
        if let Some(&by) = forms.get(drawn) {
            graph.replace(node, by);
            divisors = graph.divisors();
        }
    }
}

/// Gives nodes the derivation's own form again where that costs nothing.
pub(super) fn come_home(graph: &mut Graph) {
    loop {
        let mut count = 0;
        for node in 0..graph.len() {
            let Some(own) = graph.own_form(node).filter(|_| graph.is_live(node)) else {
                continue;
            };
            let is_there = own.operands().all(|operand| graph.is_live(operand));
            if is_there && graph.saving(node, own) >= 0 && !graph.depend(own.operands(), node) {
                graph.replace(node, own);
                count += 1;
            }
        }
        if count == 0 {
            return;
        }
    }
}
