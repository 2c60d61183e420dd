//! Replaces nodes that are two operations from others, by operations that may serve several nodes.
//!
//! A target t requests every value m from which one more operation gives it: t = c + m, t = c m,
//! t = m / c. All sums, differences and products of two nodes are then compared with the requests.
//! This is done heading by heading, each with the operands of its nodes, because nodes of different
//! legs have little in common. A small function is searched as a whole. A heading with many nodes
//! is searched in pieces, each a run of nodes in the order of the derivation.

use super::requests::{Candidates, Form, Requests};
use super::single_replacements::{LOSS, fits};
use crate::cas::field::{Element, canonical};
use crate::lowering::SearchLimits;
use crate::lowering::dag::{Dag, Definition, Dominators, Edge};
use std::collections::BTreeSet;

/// A new node and an upper bound of its saving.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord)]
struct Hit {
    bound: i32,
    definition: Definition,
    head: u32,
    negative: bool,
}

/// The pass for tests: one round.
#[cfg(test)]
pub(super) fn run(dag: &mut Dag, limits: &SearchLimits) {
    if limits.pair_rounds > 0 {
        improve(dag, limits);
    }
}

/// Replaces nodes group by group, or together if they are few; returns the operations saved.
pub(super) fn improve(dag: &mut Dag, limits: &SearchLimits) -> i32 {
    let groups = groups(dag, limits);
    let saved = groups.iter().map(|group| improve_group(dag, group)).sum();
    if saved > 0 {
        // There are new nodes.
        dag.forget_forms();
    }
    saved
}

/// Nodes that are searched together.
#[derive(Clone)]
struct Group {
    /// Nodes of one scope or part of it, which are improved.
    own: Vec<usize>,
    /// These nodes and their operands, whose pairs are tried.
    all: Vec<usize>,
}

/// The groups to search, in order.
fn groups(dag: &mut Dag, limits: &SearchLimits) -> Vec<Group> {
    let live: Vec<usize> = (0..dag.len()).filter(|&n| dag.is_live(n)).collect();
    if live.len() <= limits.whole_nodes {
        return vec![Group {
            own: live.clone(),
            all: live,
        }];
    }
    let most = limits.piece(dag.len());
    let mut scopes: Vec<u32> = live.iter().map(|&n| dag.scope(n)).collect();
    scopes.sort_unstable();
    scopes.dedup();
    let mut groups = Vec::new();
    for scope in &scopes {
        let is_own = |n: &usize| dag.scope(*n) == *scope;
        let own: Vec<usize> = live.iter().copied().filter(is_own).collect();
        groups.extend(pieces(dag, &own, most));
    }
    if groups.len() > scopes.len() {
        dag.note_pieces(groups.len());
    }
    groups
}

/// Runs of a heading's nodes, each with at most `most` nodes including their operands.
fn pieces(dag: &Dag, own: &[usize], most: usize) -> Vec<Group> {
    let mut pieces: Vec<Group> = Vec::new();
    let (mut run, mut all) = (Vec::new(), BTreeSet::new());
    for &node in own {
        let operands = dag.definition(node).operands();
        let with: Vec<usize> = operands.chain([node]).collect();
        let more = with.iter().filter(|n| !all.contains(*n)).count();
        if !run.is_empty() && all.len() + more > most {
            let full = std::mem::take(&mut all);
            pieces.push(Group {
                own: std::mem::take(&mut run),
                all: full.into_iter().collect(),
            });
        }
        run.push(node);
        all.extend(with);
    }
    pieces.push(Group {
        own: run,
        all: all.into_iter().collect(),
    });
    pieces
}

fn improve_group(dag: &mut Dag, group: &Group) -> i32 {
    let tree = Dominators::new(dag);
    let (requests, hits) = hits(dag, &tree, group);
    hits.iter()
        .map(|hit| apply(dag, &requests, hit).unwrap_or(0))
        .sum()
}

/// Requests of a group's nodes and the pairs with these values, the most promising first.
fn hits(dag: &Dag, tree: &Dominators, group: &Group) -> (Requests, Vec<Hit>) {
    let candidates = Candidates::new(dag, tree, &group.own, &group.all);
    let repeated = candidates.repeated_values();
    let requests = candidates.requests(&repeated);
    let mut hits = Vec::new();
    let mut visit = |definition: Definition, value: Element| {
        let ([key], negative) = canonical([value]);
        let Some(head) = requests.head(&key) else {
            return;
        };
        if requests.are_own(head, definition) {
            return;
        }
        let bound = bound(&requests, head, tree, definition);
        // Existing values belong to the search for single operations.
        if bound > 0 && dag.find(value).is_none() {
            hits.push(Hit {
                bound,
                definition,
                head,
                negative,
            });
        }
    };
    candidates.for_each_pair(|a, b| {
        let (first, second) = (Edge::to(a.node), Edge::to(b.node));
        let of_sum = |negative| Element::projected_difference(a.projection, b.projection, negative);
        if repeated.may_repeat(of_sum(true)) {
            visit(Definition::Sum(first, second), a.value + b.value);
        }
        let product = a.value * b.value;
        if repeated.may_repeat(product.projection()) {
            visit(Definition::Product(first, second), product);
        }
        if a.node != b.node && repeated.may_repeat(of_sum(false)) {
            visit(
                Definition::Sum(first, second.times(true)),
                a.value + -b.value,
            );
        }
    });
    hits.sort_by(|a, b| b.bound.cmp(&a.bound).then_with(|| a.cmp(b)));
    (requests, hits)
}

/// Upper bound of the saving of a value.
///
/// It is the sum over the targets of their cones without the nodes of the new form and without one
/// operation, minus the value's own operation.
fn bound(requests: &Requests, head: u32, tree: &Dominators, definition: Definition) -> i32 {
    let mut bound = -1;
    let mut last = (u32::MAX, 0);
    for request in requests.of(head) {
        let target = request.target as usize;
        let needed = definition.operands().chain([request.with.node()]);
        let shared = needed.map(|node| tree.shared(target, node)).max();
        let saving = tree.cone(target) - 1 - shared.unwrap_or(0);
        if request.target != last.0 {
            last = (request.target, 0);
        }
        // Of several forms the best one counts.
        bound += (saving - last.1).max(0);
        last.1 = last.1.max(saving);
    }
    bound
}

/// Adds the node of a hit and replaces all targets for which it saves operations.
///
/// The change is reverted if it saves nothing in total.
fn apply(dag: &mut Dag, requests: &Requests, hit: &Hit) -> Option<i32> {
    let definition = hit.definition;
    if definition.operands().any(|o| !dag.is_live(o)) {
        return None;
    }
    let value = dag.fingerprint_of(definition).value();
    if dag.find(value).is_some() {
        return None;
    }
    let scope = dag.scope(requests.target(hit.head));
    let node = dag.add(definition, scope);
    let saved = give(dag, requests, hit, Edge::to(node));
    if saved.is_none() {
        dag.remove_last();
    }
    saved
}

/// Uses a new node in the targets of a hit.
fn give(dag: &mut Dag, requests: &Requests, hit: &Hit, node: Edge) -> Option<i32> {
    let wanted = wanted(dag, requests, hit, node);
    // Each target's saving counts the new operation once; all together need it only once.
    let hoped: i32 = wanted.iter().map(|(_, _, saving)| saving + 1).sum();
    if hoped <= 1 {
        return None;
    }
    let mut undo = Vec::new();
    let mut total = 0;
    for (target, by, _) in wanted {
        if !dag.is_live(target) {
            continue;
        }
        let saving = dag.saving(target, by);
        if saving < i32::from(!undo.is_empty()) {
            continue;
        }
        if !fits(dag, by, target, LOSS) {
            continue;
        }
        undo.push((target, dag.definition(target)));
        dag.replace(target, by);
        total += saving;
    }
    if total > 0 {
        return Some(total);
    }
    for (target, definition) in undo.into_iter().rev() {
        dag.replace(target, definition);
    }
    None
}

/// The best replacement of each target by the new node, with its own saving, unless that is
/// negative.
fn wanted(
    dag: &mut Dag,
    requests: &Requests,
    hit: &Hit,
    node: Edge,
) -> Vec<(usize, Definition, i32)> {
    let mut wanted: Vec<(usize, Definition, i32)> = Vec::new();
    for request in requests.of(hit.head) {
        let target = request.target as usize;
        if !dag.is_live(target) || !dag.is_live(request.with.node()) {
            continue;
        }
        let m = node.times(hit.negative != request.negative);
        let by = match request.form {
            Form::Plus => Definition::Sum(request.with, m),
            Form::Times => Definition::Product(request.with, m),
            Form::Over => Definition::Quotient(m, request.with),
        };
        let saving = dag.saving(target, by);
        if saving < 0 {
            continue;
        }
        match wanted.last_mut().filter(|(t, ..)| *t == target) {
            Some(last) if last.2 < saving => *last = (target, by, saving),
            Some(_) => {}
            None => wanted.push((target, by, saving)),
        }
    }
    wanted
}
