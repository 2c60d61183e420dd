//! Loss of accuracy by a replacement.
//!
//! Equivalent forms may differ in accuracy: a small sum of large terms has lost the digits in which
//! the terms cancel. This matters most where a leg is nearly stretched and many values are small.
//! The derivation's own forms are accurate there, as products of small factors are. So all nodes
//! are evaluated at some states ([`test_states`](super::test_states)), exactly and with a random
//! error after each operation (Monte Carlo arithmetic: D. S. Parker, 1997). The errors propagate
//! through the graph as rounding errors do. The error of a node in a new form, with its operands in
//! their current forms, must not be far larger than in the derivation's own form.

use super::{Angle, Definition, Edge};
use crate::cas::calculus::sign_of;

/// Relative error after each operation.
///
/// It is far larger than a rounding error, and still small when it has grown by one over the
/// distance.
pub(super) const NOISE: f64 = 1e-13;

/// A state with the values of all nodes.
#[derive(Debug, Clone, Default)]
pub(super) struct State {
    /// Group of the state: regular, or nearly refused by the same guard.
    pub(super) group: usize,
    /// Exact values.
    pub(super) values: Vec<f64>,
    /// Values with errors, in the nodes' current forms.
    pub(super) noisy: Vec<f64>,
    /// One plus the error of each node's operation.
    pub(super) factors: Vec<f64>,
    /// Squared errors of the derivation's own forms.
    pub(super) squares: Vec<f64>,
}

/// The states at which forms are compared.
#[derive(Debug, Clone, Default)]
pub(super) struct Digits {
    /// The states, sorted by group.
    states: Vec<State>,
}

/// Value of a definition.
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
        // The value of a leaf depends on the state.
        Definition::Constant(_)
        | Definition::Symbol(_)
        | Definition::Cosine(Angle::Unplanned(_))
        | Definition::Sine(Angle::Unplanned(_)) => f64::NAN,
    }
}

impl State {
    /// Squared error of a node's value, at least that of a rounding; zero for NaN.
    fn square(&self, node: usize, noisy: f64) -> f64 {
        let value = self.values[node];
        let error = (noisy - value).powi(2) + (NOISE * value).powi(2);
        if error.is_finite() { error } else { 0.0 }
    }

    /// Appends a node.
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
    /// States for the comparison of forms, whose errors are not known yet.
    pub(super) fn new(mut states: Vec<State>) -> Self {
        for state in &mut states {
            let nodes = 0..state.values.len();
            let squares = nodes.map(|node| state.square(node, state.noisy[node]));
            state.squares = squares.collect();
        }
        states.sort_by_key(|state| state.group);
        Self { states }
    }

    /// Ratio of a form's error to a node's own, in root mean square over the worst group of states.
    pub(super) fn loss(&self, by: Definition, node: usize) -> f64 {
        let groups = self.states.chunk_by(|a, b| a.group == b.group);
        let loss = |states: &[State]| {
            let own: f64 = states.iter().map(|state| state.squares[node]).sum();
            let other = |state: &State| {
                let noisy = evaluate(by, &state.noisy) * state.factors[node];
                state.square(node, noisy)
            };
            let other: f64 = states.iter().map(other).sum();
            // Without known errors the loss is one.
            if own > 0.0 { (other / own).sqrt() } else { 1.0 }
        };
        groups.map(loss).fold(0.0, f64::max)
    }

    /// Updates a node's errors from the current forms of its operands.
    pub(super) fn refresh(&mut self, node: usize, definition: Definition) {
        if definition.is_leaf() {
            return;
        }
        for state in &mut self.states {
            state.noisy[node] = evaluate(definition, &state.noisy) * state.factors[node];
        }
    }

    /// Appends a node.
    pub(super) fn push(&mut self, definition: Definition) {
        for state in &mut self.states {
            state.push(definition);
        }
    }

    /// Removes the last node.
    pub(super) fn pop(&mut self) {
        for state in &mut self.states {
            state.pop();
        }
    }
}
