//! The expression graph: nodes, their fingerprints, and the tables by which equal nodes are shared.

pub mod expr;
mod fingerprint;
mod multiples;
mod over_divisors;
mod placeholders;
mod symbols;

pub(crate) use fingerprint::Fingerprint;
pub use symbols::InputElement;
use symbols::Symbol;

use super::direction::{Direction, SymbolId};
use super::field::{ByValue, Element, canonical};
use super::hasher::QuickMap;
use super::sample::Sample;
use expr::Expr;
use overact_exact::Number;
use overact_exact::Ratio;
use std::cell::RefCell;
use std::collections::{BTreeSet, HashMap};

/// A node and a sign: twice the node's index, plus one for its negative.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash, PartialOrd, Ord)]
pub struct Handle(u32);

impl Handle {
    pub(crate) const fn new(index: usize, negative: bool) -> Self {
        Self((index as u32) << 1 | negative as u32)
    }

    /// Index of the node.
    #[must_use]
    pub const fn index(self) -> usize {
        (self.0 >> 1) as usize
    }

    /// Whether the handle is the negative of its node.
    #[must_use]
    pub const fn is_negative(self) -> bool {
        self.0 & 1 == 1
    }

    pub(crate) const fn negated(self) -> Self {
        Self(self.0 ^ 1)
    }

    pub(crate) const fn with_sign_of(self, negative: bool) -> Self {
        Self(self.0 ^ negative as u32)
    }

    pub(crate) const fn positive(self) -> Self {
        Self(self.0 & !1)
    }
}

/// Operation of a node. Operands of products and quotients are positive: signs move outwards.
#[derive(Debug, Clone, PartialEq, Eq, Hash)]
pub enum Op {
    Constant(u32),
    Symbol(SymbolId),
    Cosine(u32),
    Sine(u32),
    Add(Handle, Handle),
    Sub(Handle, Handle),
    Mul(Handle, Handle),
    Div(Handle, Handle),
    Sqrt(Handle),
    Sign(Handle),
    Atan2(Handle, Handle),
}

impl Op {
    /// The operation's operands.
    pub(crate) fn operands(&self) -> impl Iterator<Item = Handle> + use<> {
        let (first, second) = match *self {
            Self::Constant(_) | Self::Symbol(_) | Self::Cosine(_) | Self::Sine(_) => (None, None),
            Self::Sqrt(a) | Self::Sign(a) => (Some(a), None),
            Self::Add(a, b)
            | Self::Sub(a, b)
            | Self::Mul(a, b)
            | Self::Div(a, b)
            | Self::Atan2(a, b) => (Some(a), Some(b)),
        };
        first.into_iter().chain(second)
    }
}

/// Number of random points of the field at which every node is evaluated.
const POINTS: usize = 2;

#[derive(Debug)]
struct Node {
    op: Op,
    fingerprint: Fingerprint,
    scope: u32,
    /// Set of placeholders that occur in the node's expression.
    placeholders: u32,
}

#[derive(Debug, Default)]
struct Tables {
    nodes: Vec<Node>,
    constants: Vec<Number>,
    /// Indices of the constants with a field value; they differ in their floats.
    constant_ids: ByValue<Vec<u32>>,
    symbols: Vec<Symbol>,
    symbol_ids: HashMap<String, SymbolId>,
    /// Symbols that represent constants, by the constant's value, and whether they represent its
    /// negative.
    stands: ByValue<(SymbolId, bool)>,
    directions: Vec<Direction>,
    direction_ids: QuickMap<Direction, u32>,
    sets: placeholders::Sets,
    by_shape: QuickMap<Op, Handle>,
    by_fingerprint: QuickMap<[Element; POINTS], Handle>,
    by_ratio: ByValue<u32>,
    names: HashMap<usize, String>,
    /// Nodes that are known never to be zero.
    never_zero: BTreeSet<usize>,
    scopes: Vec<String>,
    scope: u32,
    /// Whether multiples of nodes by irrational constants are searched.
    finds_irrational: bool,
    /// Whether sums are searched as a known expression over a divisor.
    finds_over_divisors: bool,
}

/// An expression graph.
#[derive(Debug)]
pub struct Arena {
    tables: RefCell<Tables>,
}

impl Default for Arena {
    fn default() -> Self {
        Self::new()
    }
}

impl Arena {
    /// An empty graph.
    #[must_use]
    pub fn new() -> Self {
        let tables = Tables {
            scopes: vec![String::new()],
            ..Tables::default()
        };
        Self {
            tables: RefCell::new(tables),
        }
    }

    /// Number of nodes built so far.
    #[must_use]
    pub fn len(&self) -> usize {
        self.tables.borrow().nodes.len()
    }

    /// Whether no node has been built.
    #[must_use]
    pub fn is_empty(&self) -> bool {
        self.len() == 0
    }

    /// Sets the heading under which new nodes are listed, for instance a leg's name.
    pub fn enter(&self, scope: &str) {
        let mut tables = self.tables.borrow_mut();
        let at = tables
            .scopes
            .iter()
            .position(|s| s == scope)
            .unwrap_or_else(|| {
                tables.scopes.push(scope.to_owned());
                tables.scopes.len() - 1
            });
        tables.scope = at as u32;
    }

    /// Names a node that has no name yet; constants and inputs stay unnamed.
    pub fn name(&self, expr: Expr<'_>, name: &str) {
        let mut tables = self.tables.borrow_mut();
        let index = expr.handle().index();
        if !matches!(tables.nodes[index].op, Op::Constant(_) | Op::Symbol(_)) {
            tables.names.entry(index).or_insert_with(|| name.to_owned());
        }
    }

    /// The name of a node.
    #[must_use]
    pub fn name_of(&self, index: usize) -> Option<String> {
        self.tables.borrow().names.get(&index).cloned()
    }

    /// Name of the node with this fingerprint; `minus_…` if only its negative has a name.
    pub(crate) fn name_of_value(&self, fingerprint: &Fingerprint) -> Option<String> {
        let handle = self.same(fingerprint)?;
        let name = self.name_of(handle.index())?;
        Some(if handle.is_negative() {
            negative_name(&name)
        } else {
            name
        })
    }

    /// Declares that an expression is never zero, such as a square plus one, so divisions by it
    /// need no guard.
    pub fn assert_never_zero(&self, expr: Expr<'_>) {
        let index = expr.handle().index();
        self.tables.borrow_mut().never_zero.insert(index);
    }

    pub(crate) fn is_never_zero(&self, index: usize) -> bool {
        self.tables.borrow().never_zero.contains(&index)
    }

    /// Fingerprints of the nodes that are never zero.
    pub(crate) fn never_zero(&self) -> Vec<Fingerprint> {
        let tables = self.tables.borrow();
        let nodes = tables.never_zero.iter();
        nodes.map(|&node| tables.nodes[node].fingerprint).collect()
    }

    /// Operation of a node.
    #[must_use]
    pub fn op(&self, index: usize) -> Op {
        self.tables.borrow().nodes[index].op.clone()
    }

    /// Fingerprint of a node.
    pub(crate) fn fingerprint_at(&self, index: usize) -> Fingerprint {
        self.tables.borrow().nodes[index].fingerprint
    }

    /// The number of a node's heading.
    pub(crate) fn scope_at(&self, index: usize) -> u32 {
        self.tables.borrow().nodes[index].scope
    }

    /// Number of angles of the graph.
    pub(crate) fn direction_count(&self) -> u32 {
        self.tables.borrow().directions.len() as u32
    }

    /// Fingerprints of the cosine and sine of an angle.
    pub(crate) fn turn_fingerprints(&self, id: u32) -> (Fingerprint, Fingerprint) {
        self.tables.borrow().cosine_and_sine(id)
    }

    /// The names of all headings.
    pub(crate) fn scope_names(&self) -> Vec<String> {
        self.tables.borrow().scopes.clone()
    }

    /// A constant of the graph.
    #[must_use]
    pub fn constant_at(&self, id: u32) -> Number {
        self.tables.borrow().constants[id as usize]
    }

    /// An angle of the graph.
    #[must_use]
    pub fn direction_at(&self, id: u32) -> Direction {
        self.tables.borrow().directions[id as usize].clone()
    }

    /// A constant as an expression.
    pub fn number(&self, number: Number) -> Expr<'_> {
        self.expr(self.constant(number))
    }

    /// An integer as an expression.
    pub fn integer(&self, value: i64) -> Expr<'_> {
        self.number(Number::integer(value))
    }

    /// Zero.
    pub fn zero(&self) -> Expr<'_> {
        self.integer(0)
    }

    /// One.
    pub fn one(&self) -> Expr<'_> {
        self.integer(1)
    }

    pub(crate) fn expr(&self, handle: Handle) -> Expr<'_> {
        Expr::new(self, handle)
    }

    pub(crate) fn constant(&self, number: Number) -> Handle {
        let standing = self.tables.borrow().stands.get(&number.image()).copied();
        if let Some((symbol, negative)) = standing {
            return self.intern(Op::Symbol(symbol)).with_sign_of(negative);
        }
        let negative = number.value() < 0.0;
        let number = if negative { -number } else { number };
        let id = {
            let mut tables = self.tables.borrow_mut();
            let Tables {
                constants,
                constant_ids,
                ..
            } = &mut *tables;
            let alike = constant_ids.entry(number.image()).or_default();
            let found = alike.iter().find(|id| constants[**id as usize] == number);
            found.copied().unwrap_or_else(|| {
                let id = constants.len() as u32;
                constants.push(number);
                alike.push(id);
                id
            })
        };
        self.intern(Op::Constant(id)).with_sign_of(negative)
    }

    pub(crate) fn as_constant(&self, handle: Handle) -> Option<Number> {
        let tables = self.tables.borrow();
        match tables.nodes[handle.index()].op {
            Op::Constant(id) => {
                let number = tables.constants[id as usize];
                Some(if handle.is_negative() {
                    -number
                } else {
                    number
                })
            }
            _ => None,
        }
    }

    pub(crate) fn direction(&self, direction: &Direction) -> u32 {
        let mut tables = self.tables.borrow_mut();
        if let Some(&id) = tables.direction_ids.get(direction) {
            return id;
        }
        let id = tables.directions.len() as u32;
        tables.directions.push(direction.clone());
        tables.direction_ids.insert(direction.clone(), id);
        id
    }

    /// The node that computes `op`, or an existing node of equal meaning.
    pub(crate) fn intern(&self, op: Op) -> Handle {
        if let Some(&handle) = self.tables.borrow().by_shape.get(&op) {
            return handle;
        }
        let fingerprint = self.tables.borrow().fingerprint(&op);
        let known = match &op {
            Op::Constant(_) | Op::Symbol(_) => None,
            _ => {
                let same = || self.same(&fingerprint).filter(|h| self.fits(&op, *h));
                self.folded(&op, &fingerprint).or_else(same)
            }
        };
        let handle = known.unwrap_or_else(|| self.multiple_or_new(op.clone(), fingerprint));
        self.tables.borrow_mut().by_shape.insert(op, handle);
        handle
    }

    /// The constant that equals the node, if its value is the same fraction at every point.
    fn folded(&self, op: &Op, fingerprint: &Fingerprint) -> Option<Handle> {
        if fingerprint.image[0] != fingerprint.image[1] {
            return None;
        }
        let (n, d) = fingerprint.image[0].to_rational()?;
        let value = n as f64 / d as f64;
        let size = self.tables.borrow().operand_size(op);
        if (Sample::real(value) - fingerprint.sample).size() > 1e-9 * (1.0 + size) {
            return None;
        }
        Some(self.constant(Number::ratio(Ratio::new(n.into(), d.into())?)))
    }

    /// The node that has this value or its negative.
    fn same(&self, fingerprint: &Fingerprint) -> Option<Handle> {
        let (key, negative) = canonical(fingerprint.image);
        let tables = self.tables.borrow();
        let found = tables.by_fingerprint.get(&key)?.with_sign_of(negative);
        tables
            .sample(found)
            .agrees(fingerprint.sample)
            .then_some(found)
    }

    /// Whether an existing node of equal meaning may replace an operation.
    fn fits(&self, op: &Op, handle: Handle) -> bool {
        let mut tables = self.tables.borrow_mut();
        let placeholders = tables.placeholders(op);
        tables.may_stand(handle.index(), placeholders)
    }

    pub(crate) fn is_constant(&self, handle: Handle) -> bool {
        matches!(
            self.tables.borrow().nodes[handle.index()].op,
            Op::Constant(_)
        )
    }

    /// Adds a node, and indexes it by its ratio key if it has one.
    fn push(&self, op: Op, fingerprint: Fingerprint, ratio: Option<Element>) -> Handle {
        let mut tables = self.tables.borrow_mut();
        let index = tables.nodes.len();
        let (scope, placeholders) = (tables.scope, tables.placeholders(&op));
        tables.nodes.push(Node {
            op,
            fingerprint,
            scope,
            placeholders,
        });
        // The first node with a fingerprint represents it, unless a later one has fewer
        // placeholders.
        let stands = |tables: &Tables, index: usize| tables.may_stand(index, placeholders);
        let (key, negative) = canonical(fingerprint.image);
        let known = tables.by_fingerprint.get(&key).copied();
        if !known.is_some_and(|k| stands(&tables, k.index())) {
            tables
                .by_fingerprint
                .insert(key, Handle::new(index, negative));
        }
        if let Some(ratio) = ratio {
            let known = tables.by_ratio.get(&ratio).copied();
            if !known.is_some_and(|k| stands(&tables, k as usize)) {
                tables.by_ratio.insert(ratio, index as u32);
            }
        }
        Handle::new(index, false)
    }
}

/// Name of the negative of a named node.
#[must_use]
pub fn negative_name(name: &str) -> String {
    match name.strip_prefix("minus_") {
        Some(positive) => positive.to_owned(),
        None => format!("minus_{name}"),
    }
}
