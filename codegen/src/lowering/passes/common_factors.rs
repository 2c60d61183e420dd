//! Common factors across the terms of a sum: a x + b + c x becomes (a + c) x + b.
//!
//! The searches for single nodes and pairs keep the derivation's association of sums. Here a sum is
//! split into terms that have other users or are not sums. A factor of two products among them is
//! multiplied once, and often several sums then need the same a + c.

use super::single_replacements::{LOSS, fits};
use super::{conditions, repair, replacements, walk};
use crate::lowering::SearchLimits;
use crate::lowering::dag::{Dag, Definition, Edge};

/// Largest number of terms of a sum that is examined.
const TERMS: usize = 12;

/// A product as a factor and the rest, which has the sign.
#[derive(Debug, Clone, Copy)]
struct Split {
    factor: usize,
    rest: Edge,
}

/// Largest number of walks after factors were collected.
const WALKS: usize = 2;

/// Collects factors as long as that saves operations, after all other searches.
///
/// So no function gets more operations than without it. A walk may then find further savings.
pub(super) fn run(dag: &mut Dag, limits: &SearchLimits) {
    if limits.pair_rounds == 0 {
        return;
    }
    for _ in 0..WALKS {
        if !pays(dag, limits) {
            return;
        }
        let (total, before) = (dag.total(), dag.snapshot());
        walk::run(dag, limits);
        conditions::improve(dag);
        if dag.total() > total {
            dag.restore(before);
            return;
        }
    }
}

/// Collects factors as long as that saves operations; returns whether it did.
fn pays(dag: &mut Dag, limits: &SearchLimits) -> bool {
    let first = dag.total();
    loop {
        let total = dag.total();
        let before = dag.snapshot();
        if improve(dag) == 0 {
            return total < first;
        }
        dag.forget_forms();
        replacements::settle(dag, limits, limits.walk_pair_rounds);
        repair::improve(dag);
        conditions::improve(dag);
        if dag.total() >= total {
            dag.restore(before);
            return total < first;
        }
    }
}

/// Collects factors in all sums; returns the operations saved.
fn improve(dag: &mut Dag) -> i32 {
    let mut saved = 0;
    for node in 0..dag.len() {
        if is_open_sum(dag, node) {
            dag.refresh(node);
            while let Some(saving) = collect(dag, node) {
                saved += saving;
            }
        }
    }
    saved
}

fn is_open_sum(dag: &Dag, node: usize) -> bool {
    dag.is_open(node) && matches!(dag.definition(node), Definition::Sum(..))
}

/// The terms of a sum; empty if they are too few or too many.
fn terms(dag: &Dag, sum: usize) -> Vec<Edge> {
    let mut terms = Vec::new();
    let mut open = vec![Edge::to(sum)];
    while let Some(edge) = open.pop() {
        let node = edge.node();
        let is_inner = node == sum || (dag.uses(node) == 1 && is_open_sum(dag, node));
        match dag.definition(node) {
            Definition::Sum(a, b) if is_inner => {
                open.extend([b, a].map(|part| part.times(edge.is_negative())));
            }
            _ => terms.push(edge),
        }
    }
    if terms.len() > TERMS {
        terms.clear();
    }
    terms
}

/// All factorisations of a product that has no other user.
fn splits(dag: &Dag, term: Edge) -> Vec<Split> {
    let node = term.node();
    match dag.definition(node) {
        Definition::Product(a, b) if dag.uses(node) == 1 && dag.is_open(node) => {
            let negative = term.is_negative() != (a.is_negative() != b.is_negative());
            let split = |factor: Edge, rest: Edge| Split {
                factor: factor.node(),
                rest: rest.positive().times(negative),
            };
            vec![split(a, b), split(b, a)]
        }
        _ => Vec::new(),
    }
}

/// Collects the factor that saves most in a sum; returns the operations saved.
fn collect(dag: &mut Dag, sum: usize) -> Option<i32> {
    let terms = terms(dag, sum);
    let all: Vec<Vec<Split>> = terms.iter().map(|&term| splits(dag, term)).collect();
    let mut best: Option<(i32, CommonFactor)> = None;
    for second in 0..terms.len() {
        for first in 0..second {
            for &a in &all[first] {
                for &b in all[second].iter().filter(|b| b.factor == a.factor) {
                    let candidate = CommonFactor {
                        places: [first, second],
                        factor: a.factor,
                        rests: [a.rest, b.rest],
                    };
                    let saving = tried(dag, sum, &terms, &candidate, false);
                    if saving > best.map_or(0, |(saving, _)| saving) {
                        best = Some((saving, candidate));
                    }
                }
            }
        }
    }
    let (_, candidate) = best?;
    let saving = tried(dag, sum, &terms, &candidate, true);
    (saving > 0).then_some(saving)
}

/// A factor that two terms of a sum share.
#[derive(Clone, Copy)]
struct CommonFactor {
    /// The two terms, by their position in the sum.
    places: [usize; 2],
    /// The factor's node.
    factor: usize,
    /// The terms without the factor.
    rests: [Edge; 2],
}

/// Operations saved by factoring two terms of a sum; the change is kept if it `stays`.
fn tried(dag: &mut Dag, sum: usize, terms: &[Edge], common: &CommonFactor, stays: bool) -> i32 {
    let known = dag.len();
    let scope = dag.scope(sum);
    let [first, second] = common.rests;
    let inner = node_of(dag, Definition::Sum(first, second), scope);
    let product = Definition::Product(Edge::to(common.factor), inner);
    let others = (0..terms.len()).filter(|at| !common.places.contains(at));
    let others: Vec<Edge> = others.map(|at| terms[at]).collect();
    let by = match others.split_first() {
        None => product,
        Some((&first, more)) => {
            let product = node_of(dag, product, scope);
            let rest = more.iter().fold(first, |rest, &term| {
                node_of(dag, Definition::Sum(rest, term), scope)
            });
            Definition::Sum(rest, product)
        }
    };
    let saving = dag.saving(sum, by);
    if stays && saving > 0 && fits(dag, by, sum, LOSS) {
        dag.replace(sum, by);
        return saving;
    }
    for _ in known..dag.len() {
        dag.remove_last();
    }
    if stays { 0 } else { saving }
}

/// An existing node of a definition's value, or a new node.
fn node_of(dag: &mut Dag, definition: Definition, scope: u32) -> Edge {
    let value = dag.fingerprint_of(definition).value();
    match dag.find(value) {
        Some(edge) => edge,
        None => Edge::to(dag.add(definition, scope)),
    }
}
