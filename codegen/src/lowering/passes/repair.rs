//! Restores the derivation's forms for entries whose errors have grown too much.
//!
//! A replacement keeps the accuracy of its own node. Dependents of several such nodes can lose more
//! than each of them, if errors that were equal in the derivation's form cancelled. So finally the
//! entries themselves are examined, and replacements that make one of them worse are reverted
//! permanently.

use crate::lowering::SearchLimits;
use crate::lowering::dag::Dag;

/// Largest error of an entry, relative to the derivation's form.
const LOSS: f64 = 10.0;

/// Relative error above which an operand is the cause.
const BLAME: f64 = 1.5;

/// Reverts replacements that make entries worse.
pub(super) fn run(dag: &mut Dag, limits: &SearchLimits) {
    if limits.replaces {
        improve(dag);
    }
}

/// The pass regardless of the limits.
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

/// Error of a node, relative to the derivation's form.
fn loss(dag: &Dag, node: usize) -> f64 {
    let definition = dag.definition(node);
    if definition.is_leaf() {
        1.0
    } else {
        dag.loss(definition, node)
    }
}

/// The last replaced node on the path from operand to worst operand.
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

/// Restores the derivation's form of a node permanently.
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

/// Restores forms of a node's operands as long as they depend on another node.
fn free(dag: &mut Dag, node: usize, from: usize) {
    if !dag.depend([node].into_iter(), from) {
        return;
    }
    keep(dag, node);
    for operand in dag.definition(node).operands() {
        free(dag, operand, from);
    }
}
