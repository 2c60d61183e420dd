//! The one form of a function between its expressions and its program: a directed acyclic graph of signed
//! nodes.
//!
//! Each node has a definition, a fingerprint (its values at random points of the field, see
//! [`cas`](crate::cas)) by which it is found, and an origin: the name that the derivation gave it and the
//! heading under which it stands. Negation costs nothing and is a bit of the edge to a node. How a node is
//! computed may change as long as its fingerprint stays. The arena, in which expressions are built, ends
//! in [`from_arena`]: nothing after it sees it.

mod candidate_prefilter;
mod cone;
pub(crate) mod digits;
mod dominators;
mod forms;
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
use digits::Digits;
use forms::Forms;
use std::sync::Arc;

/// What a root and an arc tangent count, so that they are saved first.
const EXPENSIVE: i32 = 10;

/// A symbol of the derivation.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Symbol {
    /// What it stands for; none for an unknown, which no function is computed from.
    pub(crate) element: Option<InputElement>,
    pub(crate) fingerprint: Fingerprint,
}

/// An angle of which sine or cosine is taken.
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

/// What stays as it is, however nodes are written.
#[derive(Debug, Default)]
pub(crate) struct Context {
    pub(crate) symbols: Vec<Symbol>,
    pub(crate) turns: Vec<Turn>,
    /// Names of the headings.
    pub(crate) scopes: Vec<String>,
}

/// A node as it is added.
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
    /// How often each node is used: by other nodes that are used, by the entries and by guards.
    uses: Vec<u32>,
    /// Longest way from an input to each node.
    depths: Vec<u32>,
    /// Node of each value: that of a node or of its negative.
    by_value: ByValue<Edge>,
    /// The derivation's definition of each node; new ones have none.
    own_forms: Vec<Option<Definition>>,
    /// Nodes that are written as the derivation has them for good.
    is_kept: Vec<bool>,
    /// The function's numbers, row-major.
    entries: Vec<Edge>,
    /// Held like entries: a guard's value stays as long as something is divided by it or its root is
    /// taken, and keeps its own node, which means something to the reader.
    guards: Vec<GuardedEdge>,
    /// Nodes that are computed one after the other, such as an angle's cosine and sine; each stands in one
    /// group at most.
    together: Vec<Vec<usize>>,
    /// What replacements are held against.
    digits: Digits,
    /// What the search of single replacements knows of the nodes.
    forms: Forms,
    /// In how many pieces pairs have been searched, if headings were too large to be searched as a whole.
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

    /// Adds a node of the derivation, which nothing uses yet.
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

    /// Adds a node of the optimiser's own, which nothing uses yet.
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

    /// Takes the last node away again, which nothing uses.
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

    /// Makes a node one of the function's numbers.
    pub(crate) fn push_entry(&mut self, entry: Edge) {
        self.hold(entry.node());
        self.entries.push(entry);
    }

    /// Puts a condition on a node.
    pub(crate) fn push_guard(&mut self, guard: GuardedEdge) {
        self.hold(guard.value.node());
        self.guards.push(guard);
    }

    /// Puts a condition on a node before a guard that is there, as errors are told in the guards' order.
    pub(crate) fn insert_guard(&mut self, at: usize, guard: GuardedEdge) {
        self.hold(guard.value.node());
        self.guards.insert(at, guard);
    }

    /// Lets guards go.
    pub(crate) fn retain_guards(&mut self, is_kept: impl Fn(&GuardedEdge) -> bool) {
        let guards = std::mem::take(&mut self.guards);
        let (kept, gone): (Vec<_>, Vec<_>) = guards.into_iter().partition(is_kept);
        self.guards = kept;
        for guard in gone {
            self.release(guard.value.node());
        }
    }

    /// Lets nodes be computed one after the other, but those that belong to an earlier group: in two groups
    /// they would be computed with the second while the first is not done.
    pub(crate) fn compute_together(&mut self, nodes: &[usize]) {
        let is_new = |node: &usize| !self.together.iter().flatten().any(|known| known == node);
        let group = nodes.iter().copied().filter(is_new).collect();
        self.together.push(group);
    }

    /// The groups of nodes that are computed one after the other.
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

    /// Some nodes and all that they are computed from.
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

    /// Pairs have been searched in so many pieces.
    pub(crate) fn note_pieces(&mut self, pieces: usize) {
        self.pieces = self.pieces.max(pieces);
    }

    /// In how many pieces pairs have been searched; none if as a whole, or heading by heading.
    pub(crate) const fn pieces(&self) -> usize {
        self.pieces
    }

    /// Whether the node is needed.
    pub(crate) fn is_live(&self, node: usize) -> bool {
        self.uses[node] > 0
    }

    /// Whether the node is needed and may be written in another way.
    pub(crate) fn is_open(&self, node: usize) -> bool {
        self.is_live(node) && !self.is_kept[node] && self.definitions[node].is_open()
    }

    /// Whether the node is written as the derivation has it for good.
    pub(crate) fn keep_own_form(&mut self, node: usize) {
        self.is_kept[node] = true;
    }

    /// What all nodes count.
    pub(crate) fn total(&self) -> i32 {
        let live = (0..self.len()).filter(|&node| self.is_live(node));
        live.map(|node| self.cost(node)).sum()
    }

    /// The live node, with its sign, of a value.
    pub(crate) fn find(&self, value: Element) -> Option<Edge> {
        let ([key], negative) = canonical([value]);
        let found = self.by_value.get(&key)?.times(negative);
        self.is_live(found.node()).then_some(found)
    }

    /// What nodes are looked up by.
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

    /// What a definition evaluates to at the points of the field.
    pub(crate) fn fingerprint_of(&self, definition: Definition) -> Fingerprint {
        let of = |edge| self.fingerprint(edge);
        match definition {
            Definition::Constant(constant) => {
                Fingerprint::number(crate::cas::Number::float(constant.value()))
            }
            Definition::Symbol(symbol) => self.context.symbols[symbol as usize].fingerprint,
            Definition::Cosine(Angle::Unplanned(turn)) => self.context.turns[turn as usize].cosine,
            Definition::Sine(Angle::Unplanned(turn)) => self.context.turns[turn as usize].sine,
            // How the field sees an angle does not follow from how it sees the angle's value.
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

    /// What the node's own operation counts.
    pub(crate) fn cost(&self, node: usize) -> i32 {
        self.cost_of(self.definitions[node])
    }

    /// What an operation counts: one, also for a product with a sign.
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

    /// The derivation's form of a node that is written in another way.
    pub(crate) fn own_form(&self, node: usize) -> Option<Definition> {
        let own = self.own_forms[node]?;
        (own != self.definitions[node]).then_some(own)
    }

    /// The nodes that quotients are divided by: each is guarded, or never zero.
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

    /// A node that computes a definition: one that is there among `known`, or a new one.
    pub(crate) fn node_of(
        &mut self,
        definition: Definition,
        known: &mut QuickMap<Definition, usize>,
    ) -> usize {
        *known
            .entry(definition)
            .or_insert_with(|| self.add(definition, 0))
    }

    /// Names those nodes that have no name after their value.
    pub(crate) fn name_values(&mut self, name_of: impl Fn(&Fingerprint) -> Option<String>) {
        for (name, fingerprint) in self.names.iter_mut().zip(&self.fingerprints) {
            if name.is_none() {
                *name = name_of(fingerprint).map(Into::into);
            }
        }
    }

    /// Lets every node be its own negative where `is_flipped` says so, whoever uses it. Definitions are the
    /// caller's business.
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

    /// States at which the digits of forms are compared.
    pub(crate) fn measure_digits(&mut self, states: &test_states::States<'_>) {
        self.digits = Digits::new(test_states::states(self, states));
    }

    /// From here on digits are compared no more.
    pub(crate) fn forget_digits(&mut self) {
        self.digits = Digits::default();
    }

    /// How much larger than a node's own error that of a form is.
    pub(crate) fn loss(&self, by: Definition, node: usize) -> f64 {
        self.digits.loss(by, node)
    }

    /// Takes a node's errors from what it is computed from, as that is written by now.
    pub(crate) fn refresh(&mut self, node: usize) {
        self.digits.refresh(node, self.definitions[node]);
    }

    /// The errors of all nodes, as they are written by now.
    pub(crate) fn refresh_all(&mut self) {
        for node in self.operands_first() {
            self.refresh(node);
        }
    }
}
