//! What a replacement costs in digits.
//!
//! Forms that are equal may differ in their digits: a sum of large terms that gives a small value has
//! lost the digits in which its terms agree. That matters most where a leg is nearly stretched and many
//! values are small; the derivation's own forms do well there, as products of small factors do. So all
//! nodes are evaluated at some states ([`test_states`](super::test_states)), exactly and with a random error after each
//! operation (Monte Carlo arithmetic: D. S. Parker, 1997), which grows along the graph as rounding errors
//! do. The error of a node as it would be written, with what it is computed from as that is written by
//! now, may not be far larger than its error in the derivation's own form.

use super::{Angle, Definition, Edge};
use crate::cas::calculus::sign_of;

/// The relative error after each operation: far more than a rounding, and small where it has grown by
/// one over the distance.
pub(super) const NOISE: f64 = 1e-13;

/// A state with the values of all nodes.
#[derive(Debug, Clone, Default)]
pub(super) struct State {
    /// What it has in common with others: regular, or nearly refused by the same guard.
    pub(super) group: usize,
    /// Without errors.
    pub(super) values: Vec<f64>,
    /// With errors, as the nodes are written.
    pub(super) noisy: Vec<f64>,
    /// One and the error of each node's operation.
    pub(super) factors: Vec<f64>,
    /// Squares of the errors of the derivation's own forms.
    pub(super) squares: Vec<f64>,
}

/// The states by which forms are compared.
#[derive(Debug, Clone, Default)]
pub(super) struct Digits {
    /// By group.
    states: Vec<State>,
}

/// What a definition evaluates to.
pub(crate) fn evaluate(definition: Definition, values: &[f64]) -> f64 {
    let value = |of: Edge| {
        let value = values[of.node()];
        if of.is_negative() { -value } else { value }
    };
    match definition {
        Definition::Sum(a, b) => value(a) + value(b),
        Definition::Product(a, b) => value(a) * value(b),
        Definition::Quotient(a, b) => value(a) / value(b),
        Definition::Root(a) => value(a).sqrt(),
        Definition::Sign(a) => sign_of(value(a)),
        Definition::ArcTangent(a, b) => value(a).atan2(value(b)),
        Definition::Selection(a, b) => value(a) * sign_of(value(b)),
        Definition::Cosine(Angle::Value(a)) => value(a).cos(),
        Definition::Sine(Angle::Value(a)) => value(a).sin(),
        // What a leaf is depends on the state.
        Definition::Constant(_)
        | Definition::Symbol(_)
        | Definition::Cosine(Angle::Unplanned(_))
        | Definition::Sine(Angle::Unplanned(_)) => f64::NAN,
    }
}

impl State {
    /// The square of the error of a node's value, of a rounding at least; nothing if it is no number.
    fn square(&self, node: usize, noisy: f64) -> f64 {
        let value = self.values[node];
        let error = (noisy - value).powi(2) + (NOISE * value).powi(2);
        if error.is_finite() { error } else { 0.0 }
    }

    /// One more node.
    fn push(&mut self, definition: Definition) {
        let node = self.values.len();
        self.values.push(evaluate(definition, &self.values));
        self.factors.push(1.0 + NOISE);
        self.noisy
            .push(evaluate(definition, &self.noisy) * (1.0 + NOISE));
        self.squares.push(self.square(node, self.noisy[node]));
    }

    fn pop(&mut self) {
        self.values.pop();
        self.noisy.pop();
        self.factors.pop();
        self.squares.pop();
    }
}

impl Digits {
    /// Forms are compared at these states, whose errors are not known yet.
    pub(super) fn new(mut states: Vec<State>) -> Self {
        for state in &mut states {
            let nodes = 0..state.values.len();
            let squares = nodes.map(|node| state.square(node, state.noisy[node]));
            state.squares = squares.collect();
        }
        states.sort_by_key(|state| state.group);
        Self { states }
    }

    /// How much larger than a node's own error that of a form is, in root mean square over the states of
    /// the group where that is worst.
    pub(super) fn loss(&self, by: Definition, node: usize) -> f64 {
        let groups = self.states.chunk_by(|a, b| a.group == b.group);
        let loss = |states: &[State]| {
            let own: f64 = states.iter().map(|state| state.squares[node]).sum();
            let other = |state: &State| {
                let noisy = evaluate(by, &state.noisy) * state.factors[node];
                state.square(node, noisy)
            };
            let other: f64 = states.iter().map(other).sum();
            // Where nothing is known, nothing is lost.
            if own > 0.0 { (other / own).sqrt() } else { 1.0 }
        };
        groups.map(loss).fold(0.0, f64::max)
    }

    /// Takes a node's errors from what it is computed from, as that is written by now.
    pub(super) fn refresh(&mut self, node: usize, definition: Definition) {
        if definition.is_leaf() {
            return;
        }
        for state in &mut self.states {
            state.noisy[node] = evaluate(definition, &state.noisy) * state.factors[node];
        }
    }

    /// A new node.
    pub(super) fn push(&mut self, definition: Definition) {
        for state in &mut self.states {
            state.push(definition);
        }
    }

    /// The last node is taken away.
    pub(super) fn pop(&mut self) {
        for state in &mut self.states {
            state.pop();
        }
    }
}
