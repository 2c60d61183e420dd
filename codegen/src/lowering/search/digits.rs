//! States near singular configurations, where a replacement must not lose digits.
//!
//! Forms that are equal may differ in their digits: where a leg is nearly stretched, many values are
//! small, and a sum of large terms that gives one of them has lost the digits in which its terms agree.
//! The derivation's own forms do well there, as products of small factors do. So the nodes are
//! evaluated at states just before a guard refuses, on random rays from the home configuration, and once
//! more with a random error after each operation (Monte Carlo arithmetic: D. S. Parker, 1997), which
//! grows along the graph as rounding errors do. A form whose error is far larger than that of the node, at
//! all states of some guard, is not taken.

use super::graph::{Definition, Graph, Signed};
use crate::cas::arena::Op;
use crate::cas::calculus::{angle_of, sign_of};
use crate::cas::{Arena, Stream, SymbolId};
use std::collections::HashMap;

/// Rays from the home configuration.
const RAYS: usize = 24;

/// The distance of a state from where its ray ends, relative to the ray's length.
const DISTANCE: f64 = 1e-8;

/// The relative error after each operation: far more than a rounding, and small where it has grown by
/// one over the distance.
const NOISE: f64 = 1e-13;

/// How much larger than the node's error that of a form may be.
const LOSS: f64 = 100.0;

/// The first step of a ray, m and rad.
const STEP: f64 = 1e-3;

/// How much longer than the last one each step is.
const GROWTH: f64 = 1.4;

/// Steps of a ray at most: it is then some thirty metres long.
const STEPS: usize = 28;

/// Bisections of the last step, down to the last digit.
const BISECTIONS: usize = 52;

/// The values of a function's inputs in the home configuration, by symbol; `None` for rates.
pub type Home<'h> = &'h dyn Fn(&str) -> Option<f64>;

/// The states, with the values of all nodes.
#[derive(Clone, Default)]
pub(super) struct Digits {
    /// By guard.
    states: Vec<State>,
}

/// A state at which a guard's value is nearly zero.
#[derive(Clone, Default)]
struct State {
    guard: usize,
    values: Vec<f64>,
    /// With errors.
    noisy: Vec<f64>,
}

/// The value of a node with its sign.
fn signed(of: Signed, values: &[f64]) -> f64 {
    let value = values[of.node()];
    if of.is_negative() { -value } else { value }
}

/// What a sum, a product or a quotient evaluates to.
fn evaluate(definition: Definition, values: &[f64]) -> f64 {
    let value = |of: Signed| signed(of, values);
    match definition {
        Definition::Sum(a, b) => value(a) + value(b),
        Definition::Product(a, b) => value(a) * value(b),
        Definition::Quotient(a, b) => value(a) / value(b),
        Definition::Leaf | Definition::Fixed(..) => f64::NAN,
    }
}

impl State {
    /// How much larger than a node's error that of a form is; 1 where nothing is known.
    fn loss(&self, by: Definition, node: usize) -> f64 {
        let exact = self.values[node];
        let error = |noisy: f64| ((noisy - exact) / exact).abs();
        let loss = error(evaluate(by, &self.noisy)) / error(self.noisy[node]).max(NOISE);
        if loss.is_finite() { loss } else { 1.0 }
    }
}

impl Digits {
    /// The states of a graph that has no new nodes yet. Guards that no entry needs are left out.
    pub(super) fn new(graph: &Graph, arena: &Arena, guards: &[Signed], home: Home<'_>) -> Self {
        if guards.is_empty() {
            return Self::default();
        }
        let needed = graph.needed(guards.iter().map(|guard| guard.node()));
        let mut stream = Stream::new(0);
        let mut states: Vec<State> = Vec::new();
        for _ in 0..RAYS {
            let ray = Ray::new(graph, arena, home, &mut stream);
            states.extend(ray.state(&needed, guards, &mut stream));
        }
        states.sort_by_key(|state| state.guard);
        Self { states }
    }

    /// Whether a form keeps the digits of a node.
    pub(super) fn keeps(&self, by: Definition, node: usize) -> bool {
        let mut by_guard = self.states.chunk_by(|a, b| a.guard == b.guard);
        by_guard.all(|states| {
            // A value may be small by chance at one of them.
            let losses = states.iter().map(|state| state.loss(by, node));
            losses.fold(f64::INFINITY, f64::min) <= LOSS
        })
    }

    /// A new node.
    pub(super) fn push(&mut self, definition: Definition) {
        for state in &mut self.states {
            state.values.push(evaluate(definition, &state.values));
            let noisy = evaluate(definition, &state.noisy);
            state.noisy.push(noisy * (1.0 + NOISE));
        }
    }

    /// The last node is taken away.
    pub(super) fn pop(&mut self) {
        for state in &mut self.states {
            state.values.pop();
            state.noisy.pop();
        }
    }
}

/// A way from the home configuration, with fixed random rates.
struct Ray<'g> {
    graph: &'g Graph,
    arena: &'g Arena,
    /// Start and direction of every symbol.
    symbols: HashMap<SymbolId, (f64, f64)>,
}

impl<'g> Ray<'g> {
    fn new(graph: &'g Graph, arena: &'g Arena, home: Home<'_>, stream: &mut Stream) -> Self {
        let mut of = |symbol: SymbolId| {
            let number = stream.number();
            match home(&arena.symbol_name(symbol)) {
                Some(value) => (symbol, (value, number)),
                None => (symbol, (number, 0.0)),
            }
        };
        Self {
            graph,
            arena,
            symbols: arena.symbols().map(&mut of).collect(),
        }
    }

    /// The values of nodes at a distance from home, each with an error; zero for those that are not
    /// `needed`.
    fn at(
        &self,
        distance: f64,
        needed: Option<&[bool]>,
        errors: &mut dyn FnMut() -> f64,
    ) -> Vec<f64> {
        let mut values = Vec::with_capacity(self.graph.len());
        for (node, &definition) in self.graph.definitions.iter().enumerate() {
            let value = match definition {
                _ if needed.is_some_and(|needed| !needed[node]) => 0.0,
                Definition::Leaf | Definition::Fixed(..) => self.other(node, distance, &values),
                _ => evaluate(definition, &values),
            };
            values.push(value * (1.0 + errors()));
        }
        values
    }

    /// The value of a node that is no sum, product or quotient.
    fn other(&self, node: usize, distance: f64, values: &[f64]) -> f64 {
        let symbol = |symbol: SymbolId| {
            let known = self.symbols.get(&symbol);
            known.map_or(f64::NAN, |(start, direction)| start + distance * direction)
        };
        let angle = |direction| angle_of(&self.arena.direction_at(direction), &symbol);
        let value = |of: Signed| signed(of, values);
        match (
            self.graph.op(self.arena, node),
            self.graph.definitions[node],
        ) {
            (Some(Op::Symbol(id)), _) => symbol(id),
            (Some(Op::Constant(id)), _) => self.arena.constant_at(id).value(),
            (Some(Op::Cosine(id)), _) => angle(id).cos(),
            (Some(Op::Sine(id)), _) => angle(id).sin(),
            (Some(Op::Sqrt(_)), Definition::Fixed(a, _)) => value(a).sqrt(),
            (Some(Op::Sign(_)), Definition::Fixed(a, _)) => sign_of(value(a)),
            (_, Definition::Fixed(a, Some(b))) => value(a).atan2(value(b)),
            _ => f64::NAN,
        }
    }

    /// The state just before the first guard fails on the way.
    fn state(&self, needed: &[bool], guards: &[Signed], stream: &mut Stream) -> Option<State> {
        let signs = |distance: f64| -> Vec<f64> {
            let values = self.at(distance, Some(needed), &mut || 0.0);
            let signs = guards.iter().map(|guard| values[guard.node()].signum());
            signs.collect()
        };
        let home = signs(0.0);
        // No number is no sign either.
        let fails = |distance: f64| {
            let there = signs(distance);
            (0..guards.len()).find(|&guard| there[guard] != home[guard])
        };
        let (mut low, mut step) = (0.0, STEP);
        let mut high = (0..STEPS).find_map(|_| {
            let next = low + step;
            if fails(next).is_some() {
                return Some(next);
            }
            (low, step) = (next, step * GROWTH);
            None
        })?;
        for _ in 0..BISECTIONS {
            let middle = 0.5 * (low + high);
            match fails(middle) {
                Some(_) => high = middle,
                None => low = middle,
            }
        }
        let distance = low * (1.0 - DISTANCE);
        Some(State {
            guard: fails(high)?,
            values: self.at(distance, None, &mut || 0.0),
            noisy: self.at(distance, None, &mut || NOISE * stream.number()),
        })
    }
}
