//! The nodes that a function needs, with what they cost and who uses them.

use super::digits::Digits;
use super::rays::{self, States};
use crate::cas::arena::{Fingerprint, Handle, Op};
use crate::cas::field::Element;
use crate::cas::{Arena, Expr};
use std::collections::{BTreeMap, HashMap};
use std::hash::{BuildHasherDefault, Hasher};

/// A node with a sign: twice the node's number, plus one for its negative.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash, PartialOrd, Ord)]
pub(super) struct Signed(u32);

impl Signed {
    pub(super) const fn new(node: usize, negative: bool) -> Self {
        Self((node as u32) << 1 | negative as u32)
    }

    pub(super) const fn node(self) -> usize {
        (self.0 >> 1) as usize
    }

    pub(super) const fn is_negative(self) -> bool {
        self.0 & 1 == 1
    }

    pub(super) const fn times(self, negative: bool) -> Self {
        Self(self.0 ^ negative as u32)
    }
}

/// How a node is computed.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash, PartialOrd, Ord)]
pub(super) enum Definition {
    /// An input, a constant, a sine or cosine.
    Leaf,
    /// a + b.
    Sum(Signed, Signed),
    /// a × b.
    Product(Signed, Signed),
    /// a / b.
    Quotient(Signed, Signed),
    /// √a, never written in another way, as the following.
    Root(Signed),
    /// The sign of a.
    Sign(Signed),
    /// The angle whose sine and cosine have the ratio a / b.
    ArcTangent(Signed, Signed),
}

impl Definition {
    pub(super) fn operands(self) -> impl Iterator<Item = usize> {
        let (first, second) = match self {
            Self::Leaf => (None, None),
            Self::Root(a) | Self::Sign(a) => (Some(a), None),
            Self::Sum(a, b)
            | Self::Product(a, b)
            | Self::Quotient(a, b)
            | Self::ArcTangent(a, b) => (Some(a), Some(b)),
        };
        first.into_iter().chain(second).map(Signed::node)
    }

    /// Whether it may be written in another way.
    pub(super) const fn is_open(self) -> bool {
        matches!(self, Self::Sum(..) | Self::Product(..) | Self::Quotient(..))
    }
}

/// What a root and an arc tangent count, so that they are saved first.
const EXPENSIVE: i32 = 10;

/// The value by which nodes are looked up: that of a node or of its negative.
pub(super) type Key = Element;

/// Field elements are random already.
#[derive(Default)]
pub(super) struct FieldHasher(u64);

impl Hasher for FieldHasher {
    fn finish(&self) -> u64 {
        self.0
    }
    fn write(&mut self, bytes: &[u8]) {
        for byte in bytes {
            self.write_u64(u64::from(*byte));
        }
    }
    fn write_u64(&mut self, value: u64) {
        self.0 = (self.0.rotate_left(23) ^ value).wrapping_mul(0x9e37_79b9_7f4a_7c15);
    }
}

pub(super) type ByValue<T> = HashMap<Key, T, BuildHasherDefault<FieldHasher>>;

/// The nodes of a function.
#[derive(Clone)]
pub(super) struct Graph {
    pub(super) definitions: Vec<Definition>,
    pub(super) fingerprints: Vec<Fingerprint>,
    /// Heading of each node.
    pub(super) scopes: Vec<u32>,
    /// How often each node is used, by other nodes that are used and by the entries.
    pub(super) uses: Vec<u32>,
    /// Longest way from an input to each node.
    pub(super) depths: Vec<u32>,
    /// Node of each value.
    by_value: ByValue<Signed>,
    /// What the nodes are looked up by: the first point of their fingerprints.
    values: Vec<Element>,
    inverses: Vec<Element>,
    /// The arena's index of each node; new ones have none.
    arena_index: Vec<Option<usize>>,
    /// The derivation's definition of each node; new ones have none.
    own_forms: Vec<Option<Definition>>,
    /// Nodes that are written as the derivation has them for good.
    pub(super) is_kept: Vec<bool>,
    /// The nodes of the entries.
    pub(super) entries: Vec<usize>,
    /// What replacements are held against.
    digits: Digits,
}

impl Graph {
    pub(super) fn new<'a>(
        arena: &'a Arena,
        entries: &[Expr<'a>],
        guards: &[Expr<'a>],
        states: &States<'_>,
    ) -> Self {
        let mut graph = Self {
            definitions: Vec::new(),
            fingerprints: Vec::new(),
            scopes: Vec::new(),
            uses: Vec::new(),
            depths: Vec::new(),
            by_value: ByValue::default(),
            values: Vec::new(),
            inverses: Vec::new(),
            arena_index: Vec::new(),
            own_forms: Vec::new(),
            is_kept: Vec::new(),
            entries: Vec::new(),
            digits: Digits::default(),
        };
        let mut numbers = HashMap::new();
        for entry in entries {
            let node = graph.reach(arena, entry.handle().index(), &mut numbers);
            graph.uses[node] += 1;
            graph.entries.push(node);
        }
        graph.entries.sort_unstable();
        graph.entries.dedup();
        let guards = guards.iter().filter_map(|guard| {
            let node = *numbers.get(&guard.handle().index())?;
            Some(Signed::new(node, guard.handle().is_negative()))
        });
        let guards: Vec<Signed> = guards.collect();
        // A guard's value stays as long as something is divided by it or its root is taken; held, it
        // keeps its own node and so its meaning for the reader.
        for guard in &guards {
            graph.uses[guard.node()] += 1;
        }
        graph.digits = Digits::new(rays::states(&graph, arena, &guards, states));
        graph
    }

    /// The arena's operation of a node that is not new.
    pub(super) fn op(&self, arena: &Arena, node: usize) -> Option<Op> {
        self.arena_index[node].map(|index| arena.op(index))
    }

    /// Some nodes and all that they are computed from.
    pub(super) fn needed(&self, nodes: impl Iterator<Item = usize>) -> Vec<bool> {
        let mut needed = vec![false; self.len()];
        let mut stack: Vec<usize> = nodes.collect();
        while let Some(node) = stack.pop() {
            if !std::mem::replace(&mut needed[node], true) {
                stack.extend(self.definitions[node].operands());
            }
        }
        needed
    }

    /// The number of an arena's node; operands come first.
    fn reach(&mut self, arena: &Arena, index: usize, numbers: &mut HashMap<usize, usize>) -> usize {
        if let Some(&known) = numbers.get(&index) {
            return known;
        }
        let op = arena.op(index);
        let mut operand = |handle: Handle| {
            let node = self.reach(arena, handle.index(), numbers);
            self.uses[node] += 1;
            Signed::new(node, handle.is_negative())
        };
        let definition = match op {
            Op::Constant(_) | Op::Symbol(_) | Op::Cosine(_) | Op::Sine(_) => Definition::Leaf,
            Op::Add(a, b) => Definition::Sum(operand(a), operand(b)),
            Op::Sub(a, b) => Definition::Sum(operand(a), operand(b).times(true)),
            Op::Mul(a, b) => Definition::Product(operand(a), operand(b)),
            Op::Div(a, b) => Definition::Quotient(operand(a), operand(b)),
            Op::Sqrt(a) => Definition::Root(operand(a)),
            Op::Sign(a) => Definition::Sign(operand(a)),
            Op::Atan2(a, b) => Definition::ArcTangent(operand(a), operand(b)),
        };
        let node = self.push(
            definition,
            arena.fingerprint_at(index),
            arena.scope_at(index),
        );
        self.arena_index[node] = Some(index);
        numbers.insert(index, node);
        node
    }

    fn push(&mut self, definition: Definition, fingerprint: Fingerprint, scope: u32) -> usize {
        let node = self.definitions.len();
        self.depths.push(self.depth_of(definition));
        self.definitions.push(definition);
        self.fingerprints.push(fingerprint);
        self.scopes.push(scope);
        self.uses.push(0);
        self.arena_index.push(None);
        self.own_forms.push(Some(definition));
        self.is_kept.push(false);
        self.inverses.push(fingerprint.value().inverse());
        self.values.push(fingerprint.value());
        let (key, negative) = canonical(fingerprint.value());
        let known = self.by_value.get(&key);
        if known.is_none_or(|k| !self.is_live(k.node())) {
            self.by_value.insert(key, Signed::new(node, negative));
        }
        node
    }

    /// Adds a node that nothing uses yet.
    pub(super) fn add(&mut self, definition: Definition, scope: u32) -> usize {
        let fingerprint = self.fingerprint_of(definition);
        let node = self.push(definition, fingerprint, scope);
        self.own_forms[node] = None;
        self.digits.push(definition);
        node
    }

    /// How much larger than a node's own error that of a form is.
    pub(super) fn loss(&self, by: Definition, node: usize) -> f64 {
        self.digits.loss(by, node)
    }

    /// Takes a node's errors from what it is computed from, as that is written by now.
    pub(super) fn refresh(&mut self, node: usize) {
        self.digits.refresh(node, self.definitions[node]);
    }

    pub(super) fn depth_of(&self, definition: Definition) -> u32 {
        let deepest = definition.operands().map(|o| self.depths[o] + 1).max();
        deepest.unwrap_or(0)
    }

    /// Takes the last node away again, which nothing uses.
    pub(super) fn remove_last(&mut self) {
        let last = self.len() - 1;
        let (key, _) = canonical(self.fingerprints[last].value());
        if self
            .by_value
            .get(&key)
            .is_some_and(|known| known.node() == last)
        {
            self.by_value.remove(&key);
        }
        self.definitions.pop();
        self.fingerprints.pop();
        self.values.pop();
        self.inverses.pop();
        self.scopes.pop();
        self.uses.pop();
        self.depths.pop();
        self.arena_index.pop();
        self.own_forms.pop();
        self.is_kept.pop();
        self.digits.pop();
    }

    pub(super) fn len(&self) -> usize {
        self.definitions.len()
    }

    /// Whether the node is needed.
    pub(super) fn is_live(&self, node: usize) -> bool {
        self.uses[node] > 0
    }

    /// Whether the node is needed and may be written in another way.
    pub(super) fn is_open(&self, node: usize) -> bool {
        self.is_live(node) && !self.is_kept[node] && self.definitions[node].is_open()
    }

    /// What all nodes count.
    pub(super) fn total(&self) -> i32 {
        let live = (0..self.len()).filter(|&node| self.is_live(node));
        live.map(|node| self.cost(node)).sum()
    }

    /// The live node, with its sign, of a value.
    pub(super) fn find(&self, value: Element) -> Option<Signed> {
        let (key, negative) = canonical(value);
        let found = self.by_value.get(&key)?.times(negative);
        self.is_live(found.node()).then_some(found)
    }

    pub(super) fn value(&self, of: Signed) -> Element {
        let value = self.values[of.node()];
        if of.is_negative() { -value } else { value }
    }

    /// One over the node's value.
    pub(super) fn inverse(&self, node: usize) -> Element {
        self.inverses[node]
    }

    fn fingerprint(&self, of: Signed) -> Fingerprint {
        let fingerprint = self.fingerprints[of.node()];
        if of.is_negative() {
            -fingerprint
        } else {
            fingerprint
        }
    }

    /// What a definition evaluates to.
    pub(super) fn fingerprint_of(&self, definition: Definition) -> Fingerprint {
        match definition {
            Definition::Sum(a, b) => self.fingerprint(a) + self.fingerprint(b),
            Definition::Product(a, b) => self.fingerprint(a) * self.fingerprint(b),
            Definition::Quotient(a, b) => self.fingerprint(a).over(self.fingerprint(b)),
            Definition::Leaf
            | Definition::Root(_)
            | Definition::Sign(_)
            | Definition::ArcTangent(..) => Fingerprint::NONE,
        }
    }

    /// What the node's own operation counts.
    pub(super) fn cost(&self, node: usize) -> i32 {
        self.cost_of(self.definitions[node])
    }

    /// What an operation counts: one, and nothing for a product with a sign, which is a selection.
    pub(super) fn cost_of(&self, definition: Definition) -> i32 {
        let is_sign = |of: Signed| matches!(self.definitions[of.node()], Definition::Sign(_));
        match definition {
            Definition::Leaf | Definition::Sign(_) => 0,
            Definition::Root(_) | Definition::ArcTangent(..) => EXPENSIVE,
            Definition::Product(a, b) => i32::from(!is_sign(a) && !is_sign(b)),
            Definition::Sum(..) | Definition::Quotient(..) => 1,
        }
    }

    /// Gives a node another definition of the same value; uses are the caller's business.
    pub(super) fn redefine(&mut self, node: usize, definition: Definition) {
        self.definitions[node] = definition;
    }

    /// The derivation's form of a node that is written in another way.
    pub(super) fn own_form(&self, node: usize) -> Option<Definition> {
        let own = self.own_forms[node]?;
        (own != self.definitions[node]).then_some(own)
    }

    /// The errors of all nodes, as they are written by now.
    pub(super) fn refresh_all(&mut self) {
        let mut order: Vec<usize> = (0..self.len()).filter(|&node| self.is_live(node)).collect();
        order.sort_by_key(|&node| self.depths[node]);
        for node in order {
            self.refresh(node);
        }
    }
    /// The definitions that differ from the arena's.
    pub(super) fn overlay(&self) -> Overlay {
        let mut overlay = Overlay::default();
        for node in 0..self.len() {
            if self.own_forms[node] == Some(self.definitions[node]) || !self.is_live(node) {
                continue;
            }
            let name = |of: Signed| {
                let at = match self.arena_index[of.node()] {
                    Some(index) => Place::Arena(index),
                    None => Place::New(of.node()),
                };
                (at, of.is_negative())
            };
            let rewritten = match self.definitions[node] {
                Definition::Sum(a, b) => Rewritten::Sum(name(a), name(b)),
                Definition::Product(a, b) => Rewritten::Product(name(a), name(b)),
                Definition::Quotient(a, b) => Rewritten::Quotient(name(a), name(b)),
                _ => continue,
            };
            let (place, _) = name(Signed::new(node, false));
            overlay
                .definitions
                .insert(place, (rewritten, self.scopes[node]));
        }
        overlay
    }
}

/// The smaller of a value and its negative, and whether it is the negative.
pub(super) fn canonical(value: Element) -> (Key, bool) {
    let negative = -value;
    if negative < value {
        (negative, true)
    } else {
        (value, false)
    }
}

/// A node of the arena, or one that the search has added.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash, PartialOrd, Ord)]
pub enum Place {
    /// Index in the arena.
    Arena(usize),
    /// A number of the search's own.
    New(usize),
}

/// Another way to compute a node; each operand with whether its negative is meant.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
#[expect(missing_docs, reason = "the variants say it")]
pub enum Rewritten {
    Sum((Place, bool), (Place, bool)),
    Product((Place, bool), (Place, bool)),
    Quotient((Place, bool), (Place, bool)),
}

/// Definitions that replace the arena's, with the heading of each.
#[derive(Debug, Clone, Default)]
pub struct Overlay {
    /// By node.
    pub definitions: BTreeMap<Place, (Rewritten, u32)>,
}
