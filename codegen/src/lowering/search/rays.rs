//! States at which forms are compared.
//!
//! Some are given: regular ones whose joints close the legs. The others are on rays that go from the home
//! configuration in random directions of the inputs. Where a guard refuses the first state of a ray, a leg
//! is singular; the state just before it is taken.

use super::digits::{NOISE, State, evaluate};
use super::graph::{Definition, Graph, Signed};
use crate::cas::arena::Op;
use crate::cas::calculus::angle_of;
use crate::cas::{Arena, Stream, SymbolId};
use std::collections::HashMap;

/// Rays from the home configuration.
const RAYS: usize = 24;

/// The distance of a state from where its ray ends, relative to the ray's length.
const DISTANCE: f64 = 1e-8;

/// The first step of a ray, m and rad.
const STEP: f64 = 1e-3;

/// How much longer than the last one each step is.
const GROWTH: f64 = 1.4;

/// Steps of a ray at most: it is then some thirty metres long.
const STEPS: usize = 28;

/// Bisections of the last step, down to the last digit.
const BISECTIONS: usize = 52;

/// Where the values of a function's inputs are known, by symbol.
pub struct States<'s> {
    /// In the home configuration; `None` for rates.
    pub home: &'s dyn Fn(&str) -> Option<f64>,
    /// How many regular states each group of them has.
    pub groups: &'s [usize],
    /// In one of them, by group and number.
    pub regular: &'s dyn Fn(usize, usize, &str) -> Option<f64>,
}

/// All nodes at the states, of a graph that has no new nodes yet. Guards that no entry needs are left out.
pub(super) fn states(
    graph: &Graph,
    arena: &Arena,
    guards: &[Signed],
    known: &States<'_>,
) -> Vec<State> {
    let needed = graph.needed(guards.iter().map(|guard| guard.node()));
    let constant = |node| match graph.op(arena, node) {
        Some(Op::Constant(id)) => arena.constant_at(id).value(),
        _ => f64::NAN,
    };
    let constants: Vec<f64> = (0..graph.len()).map(constant).collect();
    let mut stream = Stream::new(0);
    let mut states: Vec<State> = Vec::new();
    for (group, &count) in known.groups.iter().enumerate() {
        for number in 0..count {
            let value = |symbol: &str| (known.regular)(group, number, symbol);
            let at = |symbol: &str, any: f64| (value(symbol).unwrap_or(any), 0.0);
            let ray = Ray::new(graph, arena, &constants, &at, &mut stream);
            states.push(ray.state(group, 0.0, &mut stream));
        }
    }
    for _ in 0..RAYS {
        let from = |symbol: &str, any: f64| match (known.home)(symbol) {
            Some(value) => (value, any),
            None => (any, 0.0),
        };
        let ray = Ray::new(graph, arena, &constants, &from, &mut stream);
        if let Some((distance, guard)) = ray.end(&needed, guards) {
            let distance = distance * (1.0 - DISTANCE);
            let group = known.groups.len() + guard;
            states.push(ray.state(group, distance, &mut stream));
        }
    }
    states
}

/// A way through the states.
struct Ray<'g> {
    graph: &'g Graph,
    arena: &'g Arena,
    /// Of the nodes that are constants.
    constants: &'g [f64],
    /// Start and direction of every symbol.
    symbols: HashMap<SymbolId, (f64, f64)>,
}

impl<'g> Ray<'g> {
    /// `from` gives a symbol's start and direction, for a random number.
    fn new(
        graph: &'g Graph,
        arena: &'g Arena,
        constants: &'g [f64],
        from: &dyn Fn(&str, f64) -> (f64, f64),
        stream: &mut Stream,
    ) -> Self {
        let mut of = |symbol: SymbolId| {
            let number = stream.number();
            (symbol, from(&arena.symbol_name(symbol), number))
        };
        Self {
            graph,
            arena,
            constants,
            symbols: arena.symbols().map(&mut of).collect(),
        }
    }

    /// The values of nodes at a distance from home, each times its factor; zero for those that are not
    /// `needed`.
    fn at(
        &self,
        distance: f64,
        needed: Option<&[bool]>,
        factor: &dyn Fn(usize) -> f64,
    ) -> Vec<f64> {
        let mut values = Vec::with_capacity(self.graph.len());
        for (node, &definition) in self.graph.definitions.iter().enumerate() {
            let value = match definition {
                _ if needed.is_some_and(|needed| !needed[node]) => 0.0,
                Definition::Leaf => self.leaf(node, distance),
                _ => evaluate(definition, &values),
            };
            values.push(value * factor(node));
        }
        values
    }

    /// The value of an input, a constant, a sine or a cosine.
    fn leaf(&self, node: usize, distance: f64) -> f64 {
        let symbol = |symbol: SymbolId| {
            let known = self.symbols.get(&symbol);
            known.map_or(f64::NAN, |(start, direction)| start + distance * direction)
        };
        let angle = |direction| angle_of(&self.arena.direction_at(direction), &symbol);
        match self.graph.op(self.arena, node) {
            Some(Op::Symbol(id)) => symbol(id),
            Some(Op::Constant(_)) => self.constants[node],
            Some(Op::Cosine(id)) => angle(id).cos(),
            Some(Op::Sine(id)) => angle(id).sin(),
            _ => f64::NAN,
        }
    }

    /// Where the first guard fails on the way, and which.
    fn end(&self, needed: &[bool], guards: &[Signed]) -> Option<(f64, usize)> {
        let signs = |distance: f64| -> Vec<f64> {
            let values = self.at(distance, Some(needed), &|_| 1.0);
            let signs = guards.iter().map(|guard| values[guard.node()].signum());
            signs.collect()
        };
        if guards.is_empty() {
            return None;
        }
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
        Some((low, fails(high)?))
    }

    /// The state at a distance from home. Inputs and constants have no errors.
    fn state(&self, group: usize, distance: f64, stream: &mut Stream) -> State {
        let mut factor = |node| {
            let op = self.graph.op(self.arena, node);
            let is_given = matches!(op, Some(Op::Symbol(_) | Op::Constant(_)));
            let error = NOISE * stream.number();
            if is_given { 1.0 } else { 1.0 + error }
        };
        let factors: Vec<f64> = (0..self.graph.len()).map(&mut factor).collect();
        State {
            group,
            values: self.at(distance, None, &|_| 1.0),
            noisy: self.at(distance, None, &|node| factors[node]),
            factors,
            squares: Vec::new(),
        }
    }
}
