//! States at which forms of nodes are compared.
//!
//! Some are given: regular states whose joints close the legs. The others are on rays from the home
//! configuration in random directions of the inputs. If a guard refuses the first state of a ray, a
//! leg is singular; the state just before it is used.

use super::digits::{NOISE, State, evaluate};
use super::{Angle, Dag, Definition, Edge};
use crate::cas::calculus::angle_of;
use crate::cas::direction::Direction;
use crate::cas::{InputElement, Stream, SymbolId};

/// Number of rays from the home configuration.
const RAYS: usize = 24;

/// Distance of a state from the end of its ray, relative to the ray's length.
const DISTANCE: f64 = 1e-8;

/// The first step of a ray, m and rad.
const STEP: f64 = 1e-3;

/// Ratio of successive steps.
const GROWTH: f64 = 1.4;

/// Largest number of steps of a ray, which is then about thirty metres long.
const STEPS: usize = 28;

/// Bisections of the last step, to machine precision.
const BISECTIONS: usize = 52;

/// Known values of a function's inputs, by element.
pub struct States<'s> {
    /// Values in the home configuration; `None` for rates.
    pub home: &'s dyn Fn(InputElement) -> Option<f64>,
    /// Number of regular states in each group.
    pub groups: &'s [usize],
    /// Value in a regular state, by group and number.
    pub regular: &'s dyn Fn(usize, usize, InputElement) -> Option<f64>,
}

/// Values of all nodes at the states, for a graph without nodes of the optimiser.
pub(super) fn states(dag: &Dag, known: &States<'_>) -> Vec<State> {
    // Values that vanish at every pose of the robot have no sign.
    let guards = dag
        .guards()
        .iter()
        .filter(|guard| !guard.condition.is_of_pose());
    let guards: Vec<Edge> = guards.map(|guard| guard.value).collect();
    let needed = dag.needed(guards.iter().map(|guard| guard.node()));
    let needed: Vec<usize> = (0..dag.len()).filter(|&node| needed[node]).collect();
    let mut stream = Stream::new(0);
    let mut states: Vec<State> = Vec::new();
    for (group, &count) in known.groups.iter().enumerate() {
        for number in 0..count {
            let value = |element: Option<_>| (known.regular)(group, number, element?);
            let at = |element, any: f64| (value(element).unwrap_or(any), 0.0);
            let ray = Ray::new(dag, &at, &mut stream);
            states.push(ray.state(group, 0.0, &mut stream));
        }
    }
    for _ in 0..RAYS {
        let home = |element: Option<_>| (known.home)(element?);
        let from = |element, any: f64| match home(element) {
            Some(value) => (value, any),
            None => (any, 0.0),
        };
        let ray = Ray::new(dag, &from, &mut stream);
        if let Some((distance, guard)) = ray.end(&needed, &guards) {
            let distance = distance * (1.0 - DISTANCE);
            let group = known.groups.len() + guard;
            states.push(ray.state(group, distance, &mut stream));
        }
    }
    states
}

/// A ray of states.
struct Ray<'d> {
    dag: &'d Dag,
    /// All nodes; those that are not leaves are evaluated.
    leaves: Vec<Leaf>,
}

/// A node without operands on a ray.
enum Leaf {
    /// An input, a constant.
    Number(Line),
    Cosine(Line),
    Sine(Line),
    /// Another node.
    None,
}

/// A number that is linear in the distance.
struct Line {
    start: f64,
    slope: f64,
}

impl Line {
    fn at(&self, distance: f64) -> f64 {
        self.start + distance * self.slope
    }
}

impl<'d> Ray<'d> {
    /// A ray; `from` gives a symbol's start and slope from a random number.
    fn new(
        dag: &'d Dag,
        from: &dyn Fn(Option<InputElement>, f64) -> (f64, f64),
        stream: &mut Stream,
    ) -> Self {
        let context = dag.context();
        let symbols = context.symbols.iter();
        let lines = symbols.map(|symbol| from(symbol.element, stream.number()));
        let lines: Vec<(f64, f64)> = lines.collect();
        let start = |symbol: SymbolId| lines[symbol.number()].0;
        let slope = |symbol: SymbolId| lines[symbol.number()].1;
        let angle = |turn: u32| {
            let direction = &context.turns[turn as usize].direction;
            let (start, slope) = (angle_of(direction, &start), slope_of(direction, &slope));
            Line { start, slope }
        };
        let number = |start, slope| Leaf::Number(Line { start, slope });
        let leaf = |node: usize| match dag.definition(node) {
            Definition::Symbol(at) => number(lines[at as usize].0, lines[at as usize].1),
            Definition::Constant(constant) => number(constant.value(), 0.0),
            Definition::Cosine(Angle::Unplanned(turn)) => Leaf::Cosine(angle(turn)),
            Definition::Sine(Angle::Unplanned(turn)) => Leaf::Sine(angle(turn)),
            _ => Leaf::None,
        };
        Self {
            dag,
            leaves: (0..dag.len()).map(leaf).collect(),
        }
    }

    /// Value of a node at a distance from home, from those of earlier nodes.
    fn value(&self, node: usize, distance: f64, values: &[f64]) -> f64 {
        match &self.leaves[node] {
            Leaf::Number(line) => line.at(distance),
            Leaf::Cosine(line) => line.at(distance).cos(),
            Leaf::Sine(line) => line.at(distance).sin(),
            Leaf::None => evaluate(self.dag.definition(node), values),
        }
    }

    /// Distance at which the first guard fails, and its index. `needed` are the nodes that guards
    /// need.
    fn end(&self, needed: &[usize], guards: &[Edge]) -> Option<(f64, usize)> {
        let mut values = vec![0.0; self.dag.len()];
        let mut signs = |distance: f64| -> Vec<f64> {
            for &node in needed {
                values[node] = self.value(node, distance, &values);
            }
            let signs = guards.iter().map(|guard| values[guard.node()].signum());
            signs.collect()
        };
        if guards.is_empty() {
            return None;
        }
        let home = signs(0.0);
        // NaN counts as a failure, too.
        let mut fails = |distance: f64| {
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
        let mut factor = |leaf: &Leaf| {
            let error = NOISE * stream.number();
            match leaf {
                Leaf::Number(_) => 1.0,
                _ => 1.0 + error,
            }
        };
        let factors: Vec<f64> = self.leaves.iter().map(&mut factor).collect();
        let (mut values, mut noisy) = (Vec::new(), Vec::new());
        for (node, factor) in factors.iter().enumerate() {
            values.push(self.value(node, distance, &values));
            noisy.push(self.value(node, distance, &noisy) * factor);
        }
        State {
            group,
            values,
            noisy,
            factors,
            squares: Vec::new(),
        }
    }
}

/// Slope of an angle along a ray, from those of its symbols.
fn slope_of(direction: &Direction, slope: &dyn Fn(SymbolId) -> f64) -> f64 {
    let terms = direction.terms().iter();
    terms.fold(0.0, |sum, (symbol, factor)| {
        sum + slope(*symbol) * factor.value()
    })
}
