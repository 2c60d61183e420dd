//! Entries whose errors have grown too much get forms of the derivation back.
//!
//! A form is taken if it keeps the digits of its own node. What is computed from several such nodes can lose
//! more than each of them: where their errors were the same in the derivation's form, they cancelled. So in
//! the end the entries themselves are looked at, and what makes one of them worse is undone for good.

use crate::lowering::SearchLimits;
use crate::lowering::dag::Dag;

/// How much larger than in the derivation's form an entry's error may be.
const LOSS: f64 = 10.0;

/// From this on an operand is to blame.
const BLAME: f64 = 1.5;

/// Undoes what makes entries worse.
pub(super) fn run(dag: &mut Dag, limits: &SearchLimits) {
    if limits.replaces {
        improve(dag);
    }
}

/// Whatever the limits are.
pub(super) fn improve(dag: &mut Dag) {
    loop {
        dag.refresh_all();
        let entries = dag.entry_nodes().into_iter();
        let losses = entries.map(|entry| (entry, loss(dag, entry)));
        let worst = losses.max_by(|a, b| a.1.total_cmp(&b.1));
        let worst = worst.filter(|(_, loss)| *loss > LOSS);
        let Some(culprit) = worst.and_then(|(entry, _)| culprit(dag, entry)) else {
            return;
        };
        keep(dag, culprit);
    }
}

/// How much larger than in the derivation's form a node's error is.
fn loss(dag: &Dag, node: usize) -> f64 {
    let definition = dag.definition(node);
    if definition.is_leaf() {
        1.0
    } else {
        dag.loss(definition, node)
    }
}

/// The last node that is written in another way, going from operand to worst operand.
fn culprit(dag: &Dag, entry: usize) -> Option<usize> {
    let mut found = None;
    let mut node = entry;
    loop {
        if dag.own_form(node).is_some() {
            found = Some(node);
        }
        let operands = dag.definition(node).operands();
        let losses = operands.map(|operand| (operand, loss(dag, operand)));
        let worst = losses.max_by(|a, b| a.1.total_cmp(&b.1));
        match worst {
            Some((operand, loss)) if loss > BLAME || found.is_none() => node = operand,
            _ => return found,
        }
    }
}

/// Writes a node as the derivation has it, for good.
pub(super) fn keep(dag: &mut Dag, node: usize) {
    dag.keep_own_form(node);
    let Some(own) = dag.own_form(node) else {
        return;
    };
    for operand in own.operands() {
        free(dag, operand, node);
    }
    dag.replace(node, own);
}

/// Writes what a node is computed from as the derivation has it, as long as another one is part of it.
fn free(dag: &mut Dag, node: usize, from: usize) {
    if !dag.depend([node].into_iter(), from) {
        return;
    }
    keep(dag, node);
    for operand in dag.definition(node).operands() {
        free(dag, operand, from);
    }
}
