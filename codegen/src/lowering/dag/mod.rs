//! The representation between expressions and program: a directed acyclic graph of signed nodes.
//!
//! Each node has a definition, a fingerprint and an origin. The fingerprint, its values at random
//! points of the field (see [`cas`](crate::cas)), is the key for lookups. The origin is the name
//! from the derivation and the heading. Negation is a bit of the edge to a node and costs nothing.
//! The definition of a node may change as long as its fingerprint stays. [`from_arena`] is the last
//! user of the arena.

mod candidate_prefilter;
mod cone;
mod definitions;
pub(crate) mod digits;
mod dominators;
pub(crate) mod from_arena;
mod node;
pub(crate) mod test_states;
mod verify;

pub(crate) use dominators::Dominators;
pub(crate) use node::{Angle, Constant, Definition, Edge};

use super::program::Condition;
use crate::cas::arena::{Fingerprint, negative_name};
use crate::cas::field::{ByValue, Element, canonical};
use crate::cas::hasher::QuickMap;
use crate::cas::{Direction, InputElement};
use definitions::Forms;
use digits::Digits;
use std::sync::Arc;

/// Cost of a root or arc tangent, so that these are saved first.
const EXPENSIVE: i32 = 10;

/// A symbol of the derivation.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Symbol {
    /// The input element that it represents; `None` for an unknown, which no function uses.
    pub(crate) element: Option<InputElement>,
    pub(crate) fingerprint: Fingerprint,
}

/// An angle whose sine or cosine is used.
#[derive(Debug, Clone)]
pub(crate) struct Turn {
    pub(crate) direction: Direction,
    pub(crate) cosine: Fingerprint,
    pub(crate) sine: Fingerprint,
}

/// A condition on a node.
#[derive(Debug, Clone)]
pub(crate) struct GuardedEdge {
    pub(crate) value: Edge,
    pub(crate) condition: Condition,
}

/// Data that do not depend on the forms of nodes.
#[derive(Debug, Default)]
pub(crate) struct Context {
    pub(crate) symbols: Vec<Symbol>,
    pub(crate) turns: Vec<Turn>,
    /// Names of the headings.
    pub(crate) scopes: Vec<String>,
}

/// Name and heading of a node that is added.
#[derive(Debug)]
pub(crate) struct Origin {
    pub(crate) name: Option<Arc<str>>,
    pub(crate) scope: u32,
}

/// The nodes of a function.
#[derive(Debug, Clone, Default)]
pub(crate) struct Dag {
    definitions: Vec<Definition>,
    fingerprints: Vec<Fingerprint>,
    names: Vec<Option<Arc<str>>>,
    /// Heading of each node.
    scopes: Vec<u32>,
    /// Number of uses of each node by used nodes, entries and guards.
    uses: Vec<u32>,
    /// Length of the longest path from an input to each node.
    depths: Vec<u32>,
    /// Node of each value: that of a node or of its negative.
    by_value: ByValue<Edge>,
    /// The derivation's definition of each node; `None` for new ones.
    own_forms: Vec<Option<Definition>>,
    /// Nodes that keep the derivation's form permanently.
    is_kept: Vec<bool>,
    /// The function's numbers, row-major.
    entries: Vec<Edge>,
    /// Guards, which hold their nodes like entries.
    ///
    /// A guard stays as long as its value is a divisor or a radicand. It keeps its own node, which
    /// has a meaning for readers.
    guards: Vec<GuardedEdge>,
    /// Nodes that are computed in succession, such as an angle's cosine and sine.
    ///
    /// Each belongs to one group at most.
    together: Vec<Vec<usize>>,
    /// Accuracy data by which replacements are judged.
    digits: Digits,
    /// Cache of the search for single replacements.
    forms: Forms,
    /// Number of pieces of the search for pairs, if headings were too large for a search as a
    /// whole.
    pieces: usize,
    context: Arc<Context>,
}

impl Dag {
    pub(crate) fn new(context: Context) -> Self {
        Self {
            context: Arc::new(context),
            ..Self::default()
        }
    }

    pub(crate) fn context(&self) -> Arc<Context> {
        Arc::clone(&self.context)
    }

    /// Adds a node of the derivation, which has no use yet.
    pub(crate) fn push(
        &mut self,
        definition: Definition,
        fingerprint: Fingerprint,
        origin: Origin,
    ) -> usize {
        let node = self.definitions.len();
        self.depths.push(self.depth_of(definition));
        self.definitions.push(definition);
        self.fingerprints.push(fingerprint);
        self.names.push(origin.name);
        self.scopes.push(origin.scope);
        self.uses.push(0);
        self.own_forms.push(Some(definition));
        self.is_kept.push(false);
        let ([key], negative) = canonical([fingerprint.value()]);
        self.by_value
            .entry(key)
            .or_insert(Edge::new(node, negative));
        node
    }

    /// Adds a node of the optimiser, which has no use yet.
    pub(crate) fn add(&mut self, definition: Definition, scope: u32) -> usize {
        let fingerprint = self.fingerprint_of(definition);
        let node = self.push(definition, fingerprint, Origin { name: None, scope });
        self.own_forms[node] = None;
        self.digits.push(definition);
        let ([key], negative) = canonical([fingerprint.value()]);
        let known = self.by_value.get(&key);
        if known.is_none_or(|known| !self.is_live(known.node())) {
            self.by_value.insert(key, Edge::new(node, negative));
        }
        node
    }

    /// Removes the last node, which has no use.
    pub(crate) fn remove_last(&mut self) {
        let last = self.len() - 1;
        let ([key], _) = canonical([self.fingerprints[last].value()]);
        let known = self.by_value.get(&key);
        if known.is_some_and(|known| known.node() == last) {
            self.by_value.remove(&key);
        }
        self.definitions.pop();
        self.fingerprints.pop();
        self.names.pop();
        self.scopes.pop();
        self.uses.pop();
        self.depths.pop();
        self.own_forms.pop();
        self.is_kept.pop();
        self.digits.pop();
    }

    /// Appends a node to the function's output.
    pub(crate) fn push_entry(&mut self, entry: Edge) {
        self.hold(entry.node());
        self.entries.push(entry);
    }

    /// Adds a guard on a node.
    pub(crate) fn push_guard(&mut self, guard: GuardedEdge) {
        self.hold(guard.value.node());
        self.guards.push(guard);
    }

    /// Inserts a guard before an existing one; errors are reported in the order of the guards.
    pub(crate) fn insert_guard(&mut self, at: usize, guard: GuardedEdge) {
        self.hold(guard.value.node());
        self.guards.insert(at, guard);
    }

    /// Removes guards.
    pub(crate) fn retain_guards(&mut self, is_kept: impl Fn(&GuardedEdge) -> bool) {
        let guards = std::mem::take(&mut self.guards);
        let (kept, gone): (Vec<_>, Vec<_>) = guards.into_iter().partition(is_kept);
        self.guards = kept;
        for guard in gone {
            self.release(guard.value.node());
        }
    }

    /// Groups nodes that are computed in succession, except for nodes of an earlier group.
    ///
    /// A node in two groups would be computed with the second while the first is unfinished.
    pub(crate) fn compute_together(&mut self, nodes: &[usize]) {
        let is_new = |node: &usize| !self.together.iter().flatten().any(|known| known == node);
        let group = nodes.iter().copied().filter(is_new).collect();
        self.together.push(group);
    }

    /// The groups of nodes that are computed in succession.
    pub(crate) fn groups(&self) -> &[Vec<usize>] {
        &self.together
    }

    pub(crate) fn len(&self) -> usize {
        self.definitions.len()
    }

    pub(crate) fn definition(&self, node: usize) -> Definition {
        self.definitions[node]
    }

    pub(crate) fn name(&self, node: usize) -> Option<&str> {
        self.names[node].as_deref()
    }

    pub(crate) fn scope(&self, node: usize) -> u32 {
        self.scopes[node]
    }

    pub(crate) fn uses(&self, node: usize) -> u32 {
        self.uses[node]
    }

    pub(crate) fn entries(&self) -> &[Edge] {
        &self.entries
    }

    pub(crate) fn guards(&self) -> &[GuardedEdge] {
        &self.guards
    }

    /// The nodes of the entries, each once.
    pub(crate) fn entry_nodes(&self) -> Vec<usize> {
        let mut nodes: Vec<usize> = self.entries.iter().map(|entry| entry.node()).collect();
        nodes.sort_unstable();
        nodes.dedup();
        nodes
    }

    /// Some nodes and all their operands, transitively.
    pub(crate) fn needed(&self, nodes: impl Iterator<Item = usize>) -> Vec<bool> {
        let mut needed = vec![false; self.len()];
        let mut stack: Vec<usize> = nodes.collect();
        while let Some(node) = stack.pop() {
            if !std::mem::replace(&mut needed[node], true) {
                stack.extend(self.definitions[node].operands());
            }
        }
        needed
    }

    /// Records the number of pieces in which pairs were searched.
    pub(crate) fn note_pieces(&mut self, pieces: usize) {
        self.pieces = self.pieces.max(pieces);
    }

    /// Number of pieces in which pairs were searched; zero if as a whole or heading by heading.
    pub(crate) const fn pieces(&self) -> usize {
        self.pieces
    }

    /// Whether the node is needed.
    pub(crate) fn is_live(&self, node: usize) -> bool {
        self.uses[node] > 0
    }

    /// Whether the node is needed and may get another form.
    pub(crate) fn is_open(&self, node: usize) -> bool {
        self.is_live(node) && !self.is_kept[node] && self.definitions[node].is_open()
    }

    /// Makes the node keep the derivation's form permanently.
    pub(crate) fn keep_own_form(&mut self, node: usize) {
        self.is_kept[node] = true;
    }

    /// Total cost of all nodes.
    pub(crate) fn total(&self) -> i32 {
        let live = (0..self.len()).filter(|&node| self.is_live(node));
        live.map(|node| self.cost(node)).sum()
    }

    /// The live node of a value, with its sign.
    pub(crate) fn find(&self, value: Element) -> Option<Edge> {
        let ([key], negative) = canonical([value]);
        let found = self.by_value.get(&key)?.times(negative);
        self.is_live(found.node()).then_some(found)
    }

    /// The key by which nodes are looked up.
    pub(crate) fn value(&self, of: Edge) -> Element {
        let value = self.fingerprints[of.node()].value();
        if of.is_negative() { -value } else { value }
    }

    pub(crate) fn fingerprint(&self, of: Edge) -> Fingerprint {
        let fingerprint = self.fingerprints[of.node()];
        if of.is_negative() {
            -fingerprint
        } else {
            fingerprint
        }
    }

    /// Whether an edge leads to the constant one.
    pub(crate) fn is_one(&self, edge: Edge) -> bool {
        let definition = self.definitions[edge.node()];
        !edge.is_negative() && definition == Definition::Constant(Constant::new(1.0))
    }

    /// All nodes that are needed, operands first.
    pub(crate) fn operands_first(&self) -> Vec<usize> {
        let mut order: Vec<usize> = (0..self.len()).filter(|&node| self.is_live(node)).collect();
        order.sort_by_key(|&node| self.depths[node]);
        order
    }

    /// Values of a definition at the points of the field.
    pub(crate) fn fingerprint_of(&self, definition: Definition) -> Fingerprint {
        let of = |edge| self.fingerprint(edge);
        match definition {
            Definition::Constant(constant) => {
                Fingerprint::number(crate::cas::Number::float(constant.value()))
            }
            Definition::Symbol(symbol) => self.context.symbols[symbol as usize].fingerprint,
            Definition::Cosine(Angle::Unplanned(turn)) => self.context.turns[turn as usize].cosine,
            Definition::Sine(Angle::Unplanned(turn)) => self.context.turns[turn as usize].sine,
            // An angle's representation in the field does not follow from that of its value.
            Definition::Cosine(Angle::Value(angle)) => of(angle).cosine(),
            Definition::Sine(Angle::Value(angle)) => of(angle).sine(),
            Definition::Sum(a, b) => of(a) + of(b),
            Definition::Product(a, b) => of(a) * of(b),
            Definition::Quotient(a, b) => of(a).over(of(b)),
            Definition::Root(a) => of(a).square_root(),
            Definition::Sign(a) => of(a).sign(),
            Definition::ArcTangent(y, x) => of(y).arc_tangent(of(x)),
            Definition::Selection(a, b) => of(a) * of(b).sign(),
        }
    }

    /// Cost of the node's own operation.
    pub(crate) fn cost(&self, node: usize) -> i32 {
        self.cost_of(self.definitions[node])
    }

    /// Cost of an operation: one, also for a product with a sign.
    pub(crate) const fn cost_of(&self, definition: Definition) -> i32 {
        match definition {
            Definition::Root(_) | Definition::ArcTangent(..) => EXPENSIVE,
            Definition::Sum(..)
            | Definition::Product(..)
            | Definition::Quotient(..)
            | Definition::Selection(..) => 1,
            _ => 0,
        }
    }

    /// The derivation's form of a node that has another form.
    pub(crate) fn own_form(&self, node: usize) -> Option<Definition> {
        let own = self.own_forms[node]?;
        (own != self.definitions[node]).then_some(own)
    }

    /// Valid divisors of quotients: guarded or never zero.
    pub(crate) fn divisors(&self) -> Vec<usize> {
        let mut divisors: Vec<usize> = (0..self.len())
            .filter(|&n| self.is_live(n))
            .filter_map(|n| match self.definitions[n] {
                Definition::Quotient(_, by) => Some(by.node()),
                _ => None,
            })
            .collect();
        divisors.sort_unstable();
        divisors.dedup();
        divisors
    }

    /// A node of a definition: an existing one among `known`, or a new one.
    pub(crate) fn node_of(
        &mut self,
        definition: Definition,
        known: &mut QuickMap<Definition, usize>,
    ) -> usize {
        *known
            .entry(definition)
            .or_insert_with(|| self.add(definition, 0))
    }

    /// Names nodes without a name by their value.
    pub(crate) fn name_values(&mut self, name_of: impl Fn(&Fingerprint) -> Option<String>) {
        for (name, fingerprint) in self.names.iter_mut().zip(&self.fingerprints) {
            if name.is_none() {
                *name = name_of(fingerprint).map(Into::into);
            }
        }
    }

    /// Negates every node for which `is_flipped` holds, and its uses. The caller changes
    /// definitions.
    pub(crate) fn flip(&mut self, is_flipped: &[bool]) {
        for (node, _) in is_flipped
            .iter()
            .enumerate()
            .filter(|(_, flipped)| **flipped)
        {
            self.fingerprints[node] = -self.fingerprints[node];
            if let Some(name) = &self.names[node] {
                self.names[node] = Some(negative_name(name).into());
            }
        }
        let flip = |edge: &mut Edge| *edge = edge.times(is_flipped[edge.node()]);
        self.entries.iter_mut().for_each(flip);
        self.guards
            .iter_mut()
            .for_each(|guard| flip(&mut guard.value));
    }

    /// Sets the states at which the accuracy of forms is compared.
    pub(crate) fn measure_digits(&mut self, states: &test_states::States<'_>) {
        self.digits = Digits::new(test_states::states(self, states));
    }

    /// Ends the comparison of accuracy.
    pub(crate) fn forget_digits(&mut self) {
        self.digits = Digits::default();
    }

    /// Ratio of a form's error to a node's own.
    pub(crate) fn loss(&self, by: Definition, node: usize) -> f64 {
        self.digits.loss(by, node)
    }

    /// Updates a node's errors from the current forms of its operands.
    pub(crate) fn refresh(&mut self, node: usize) {
        self.digits.refresh(node, self.definitions[node]);
    }

    /// Updates the errors of all nodes in their current forms.
    pub(crate) fn refresh_all(&mut self) {
        for node in self.operands_first() {
            self.refresh(node);
        }
    }
}
