//! Replaces nodes that are two operations from others, by operations that may serve several nodes.
//!
//! A target t requests every value m from which one more operation gives it: t = c + m, t = c m,
//! t = m / c. All sums, differences and products of two nodes are then compared with the requests.
//! This is done heading by heading, each with the operands of its nodes, because nodes of different
//! legs have little in common. A small function is searched as a whole. A heading with many nodes
//! is searched in pieces, each a run of nodes in the order of the derivation.

use super::requests::{Form, Request, requests};
use super::self_cancelling_pairs::{PairOperation, SelfCancellingPairs};
use super::single_replacements::{LOSS, fits};
use crate::cas::field::{Element, canonical};
use crate::cas::filter::Filter;
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
    let Group { own, all } = group;
    let tree = Dominators::new(dag);
    let is_target = |node: &usize| dag.is_open(*node) && tree.cone(*node) > 1;
    let targets: Vec<usize> = own.iter().copied().filter(is_target).collect();
    let (requests, heads) = requests(dag, &tree, &targets, all);
    let filter = Filter::new(heads.keys(), heads.len());
    let self_cancelling_pairs = SelfCancellingPairs::new(all, &requests, heads.values().copied());
    let mut hits = Vec::new();
    for_each_pair(dag, all, &self_cancelling_pairs, |definition, value| {
        let ([key], negative) = canonical([value]);
        if !filter.may_hold(&key) {
            return;
        }
        let Some(&head) = heads.get(&key) else { return };
        let bound = bound(&requests, head, &tree, definition);
        // Existing values belong to the search for single operations.
        if bound > 0 && dag.find(value).is_none() {
            hits.push(Hit {
                bound,
                definition,
                head,
                negative,
            });
        }
    });
    hits.sort_by(|a, b| b.bound.cmp(&a.bound).then_with(|| a.cmp(b)));
    hits.iter()
        .map(|hit| apply(dag, &requests, hit).unwrap_or(0))
        .sum()
}

/// Upper bound of the saving of a value.
///
/// It is the sum over the targets of their cones without the nodes of the new form and without one
/// operation, minus the value's own operation.
fn bound(requests: &[Request], head: u32, tree: &Dominators, definition: Definition) -> i32 {
    let mut bound = -1;
    // Requests of one target are adjacent.
    let mut last = (u32::MAX, 0);
    let mut at = Some(head);
    while let Some(number) = at {
        let request = requests[number as usize];
        at = request.next;
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

/// Calls a function for all pairs of nodes and operations, without values that only these two
/// request.
fn for_each_pair(
    dag: &Dag,
    all: &[usize],
    own: &SelfCancellingPairs,
    mut visit: impl FnMut(Definition, Element),
) {
    for (place, &first) in all.iter().enumerate().filter(|(_, n)| dag.is_live(**n)) {
        let a = Edge::to(first);
        let left = dag.value(a);
        let others = all[place..].iter().zip(own.with_later(place));
        for (&second, &own) in others.filter(|(n, _)| dag.is_live(**n)) {
            let b = Edge::to(second);
            let right = dag.value(b);
            if own & PairOperation::Sum as u8 == 0 {
                visit(Definition::Sum(a, b), left + right);
            }
            if own & PairOperation::Product as u8 == 0 {
                visit(Definition::Product(a, b), left * right);
            }
            if own & PairOperation::Difference as u8 == 0 && first != second {
                visit(Definition::Sum(a, b.times(true)), left + -right);
            }
        }
    }
}

/// Adds the node of a hit and replaces all targets for which it saves operations.
///
/// The change is reverted if it saves nothing in total.
fn apply(dag: &mut Dag, requests: &[Request], hit: &Hit) -> Option<i32> {
    let definition = hit.definition;
    if definition.operands().any(|o| !dag.is_live(o)) {
        return None;
    }
    let value = dag.fingerprint_of(definition).value();
    if dag.find(value).is_some() {
        return None;
    }
    let scope = dag.scope(requests[hit.head as usize].target as usize);
    let node = dag.add(definition, scope);
    let saved = give(dag, requests, hit, Edge::to(node));
    if saved.is_none() {
        dag.remove_last();
    }
    saved
}

/// Uses a new node in the targets of a hit.
fn give(dag: &mut Dag, requests: &[Request], hit: &Hit, node: Edge) -> Option<i32> {
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
    requests: &[Request],
    hit: &Hit,
    node: Edge,
) -> Vec<(usize, Definition, i32)> {
    let mut wanted: Vec<(usize, Definition, i32)> = Vec::new();
    let mut at = Some(hit.head);
    while let Some(number) = at {
        let request = requests[number as usize];
        at = request.next;
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
