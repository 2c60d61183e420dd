//! Entries whose errors have grown too much get forms of the derivation back.
//!
//! A form is taken if it keeps the digits of its own node. What is computed from several such nodes can lose
//! more than each of them: where their errors were the same in the derivation's form, they cancelled. So in
//! the end the entries themselves are looked at, and what makes one of them worse is undone for good.

use super::graph::{Definition, Graph};

/// How much larger than in the derivation's form an entry's error may be.
const LOSS: f64 = 10.0;

/// From this on an operand is to blame.
const BLAME: f64 = 1.5;

/// Undoes what makes entries worse.
pub(super) fn improve(graph: &mut Graph) {
    loop {
        graph.refresh_all();
        let losses = graph
            .entries
            .iter()
            .map(|&entry| (entry, loss(graph, entry)));
        let worst = losses.max_by(|a, b| a.1.total_cmp(&b.1));
        let worst = worst.filter(|(_, loss)| *loss > LOSS);
        let Some(culprit) = worst.and_then(|(entry, _)| culprit(graph, entry)) else {
            return;
        };
        graph.keep(culprit);
    }
}

/// How much larger than in the derivation's form a node's error is.
fn loss(graph: &Graph, node: usize) -> f64 {
    match graph.definitions[node] {
        Definition::Leaf => 1.0,
        definition => graph.loss(definition, node),
    }
}

/// The last node that is written in another way, going from operand to worst operand.
fn culprit(graph: &Graph, entry: usize) -> Option<usize> {
    let mut found = None;
    let mut node = entry;
    loop {
        if graph.own_form(node).is_some() {
            found = Some(node);
        }
        let operands = graph.definitions[node].operands();
        let losses = operands.map(|operand| (operand, loss(graph, operand)));
        let worst = losses.max_by(|a, b| a.1.total_cmp(&b.1));
        match worst {
            Some((operand, loss)) if loss > BLAME || found.is_none() => node = operand,
            _ => return found,
        }
    }
}

impl Graph {
    /// Writes a node as the derivation has it, for good.
    fn keep(&mut self, node: usize) {
        self.is_kept[node] = true;
        let Some(own) = self.own_form(node) else {
            return;
        };
        for operand in own.operands() {
            self.free(operand, node);
        }
        if self.is_live(node) {
            self.replace(node, own);
        } else {
            self.redefine(node, own);
            self.measure_depths();
        }
    }

    /// Writes what a node is computed from as the derivation has it, as long as another one is part of it.
    fn free(&mut self, node: usize, from: usize) {
        if !self.depend([node].into_iter(), from) {
            return;
        }
        self.keep(node);
        for operand in self.definitions[node].operands() {
            self.free(operand, from);
        }
    }
}
