//! Requests of nodes: the values from which one more operation gives them.

use crate::cas::field::{ByValue, Element, canonical};
use crate::lowering::dag::{Dag, Dominators, Edge};

/// How a target follows from an existing node and the requested value.
#[derive(Debug, Clone, Copy)]
pub(super) enum Form {
    Plus,
    Times,
    Over,
}

/// A target that requests a value.
#[derive(Debug, Clone, Copy)]
pub(super) struct Request {
    pub(super) target: u32,
    pub(super) with: Edge,
    pub(super) form: Form,
    /// Whether the negative of the value is requested.
    pub(super) negative: bool,
    /// The previous request for the same value.
    pub(super) next: Option<u32>,
}

/// Requests of the targets, without those that cannot save anything.
pub(super) fn requests(
    dag: &Dag,
    tree: &Dominators,
    targets: &[usize],
    all: &[usize],
) -> (Vec<Request>, ByValue<u32>) {
    let divisors = dag.divisors();
    let inverse = |&node: &usize| dag.value(Edge::to(node)).inverse();
    let inverses: Vec<Element> = all.iter().map(inverse).collect();
    let mut requests: Vec<Request> = Vec::new();
    let mut heads: ByValue<u32> = ByValue::default();
    for &target in targets {
        let value = dag.value(Edge::to(target));
        let mut ask = |wanted, with, form| {
            let ([key], negative) = canonical([wanted]);
            let number = requests.len() as u32;
            let next = heads.insert(key, number);
            requests.push(Request {
                target: target as u32,
                with,
                form,
                negative,
                next,
            });
        };
        let others = all.iter().zip(&inverses);
        for (&node, &inverse) in others.filter(|(n, _)| **n != target && dag.is_live(**n)) {
            if tree.cone(target) - tree.shared(target, node) <= 1 {
                continue;
            }
            let with = Edge::to(node);
            let of = dag.value(with);
            ask(value + -of, with, Form::Plus);
            ask(value + of, with.times(true), Form::Plus);
            ask(value * inverse, with, Form::Times);
            if divisors.binary_search(&node).is_ok() {
                ask(value * of, with, Form::Over);
            }
        }
    }
    (requests, heads)
}
