//! Nodes of the DAG and the edges to them.

/// An edge to a node or its negative: twice the node's index, plus one for the negative.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash, PartialOrd, Ord)]
pub(crate) struct Edge(u32);

impl Edge {
    pub(crate) const fn new(node: usize, negative: bool) -> Self {
        Self((node as u32) << 1 | negative as u32)
    }

    /// The edge to a node itself.
    pub(crate) const fn to(node: usize) -> Self {
        Self::new(node, false)
    }

    pub(crate) const fn node(self) -> usize {
        (self.0 >> 1) as usize
    }

    pub(crate) const fn is_negative(self) -> bool {
        self.0 & 1 == 1
    }

    pub(crate) const fn times(self, negative: bool) -> Self {
        Self(self.0 ^ negative as u32)
    }

    /// The edge without its sign.
    pub(crate) const fn positive(self) -> Self {
        Self(self.0 & !1)
    }
}

/// A constant by its bits, so that equal constants have equal keys.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash, PartialOrd, Ord)]
pub(crate) struct Constant(u64);

impl Constant {
    pub(crate) const fn new(value: f64) -> Self {
        Self(value.to_bits())
    }

    pub(crate) const fn value(self) -> f64 {
        f64::from_bits(self.0)
    }
}

/// Argument of a sine or cosine.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash, PartialOrd, Ord)]
pub(crate) enum Angle {
    /// The direction of this index, whose evaluation is not planned yet.
    Unplanned(u32),
    /// A node's value, in radians.
    Value(Edge),
}

/// Definition of a node: how it is computed.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash, PartialOrd, Ord)]
pub(crate) enum Definition {
    /// A number.
    Constant(Constant),
    /// The symbol of this index, an element of an input array.
    Symbol(u32),
    /// Cosine of an angle.
    Cosine(Angle),
    /// Sine of an angle.
    Sine(Angle),
    /// a + b.
    Sum(Edge, Edge),
    /// a × b.
    Product(Edge, Edge),
    /// a / b.
    Quotient(Edge, Edge),
    /// √a. This and the following variants never get another form.
    Root(Edge),
    /// The sign of a.
    Sign(Edge),
    /// The angle of the direction (b, a).
    ArcTangent(Edge, Edge),
    /// a × sign(b); the backends call `signed`.
    Selection(Edge, Edge),
}

impl Definition {
    /// The edges to the operands.
    pub(crate) fn edges(self) -> impl Iterator<Item = Edge> {
        let (first, second) = match self {
            Self::Constant(_)
            | Self::Symbol(_)
            | Self::Cosine(Angle::Unplanned(_))
            | Self::Sine(Angle::Unplanned(_)) => (None, None),
            Self::Root(a)
            | Self::Sign(a)
            | Self::Cosine(Angle::Value(a))
            | Self::Sine(Angle::Value(a)) => (Some(a), None),
            Self::Sum(a, b)
            | Self::Product(a, b)
            | Self::Quotient(a, b)
            | Self::ArcTangent(a, b)
            | Self::Selection(a, b) => (Some(a), Some(b)),
        };
        first.into_iter().chain(second)
    }

    /// The operand nodes.
    pub(crate) fn operands(self) -> impl Iterator<Item = usize> {
        self.edges().map(Edge::node)
    }

    /// The definition with other edges.
    pub(crate) fn with_edges(self, mut to: impl FnMut(Edge) -> Edge) -> Self {
        match self {
            Self::Constant(_)
            | Self::Symbol(_)
            | Self::Cosine(Angle::Unplanned(_))
            | Self::Sine(Angle::Unplanned(_)) => self,
            Self::Root(a) => Self::Root(to(a)),
            Self::Sign(a) => Self::Sign(to(a)),
            Self::Cosine(Angle::Value(a)) => Self::Cosine(Angle::Value(to(a))),
            Self::Sine(Angle::Value(a)) => Self::Sine(Angle::Value(to(a))),
            Self::Sum(a, b) => Self::Sum(to(a), to(b)),
            Self::Product(a, b) => Self::Product(to(a), to(b)),
            Self::Quotient(a, b) => Self::Quotient(to(a), to(b)),
            Self::ArcTangent(a, b) => Self::ArcTangent(to(a), to(b)),
            Self::Selection(a, b) => Self::Selection(to(a), to(b)),
        }
    }

    /// Whether it is a leaf: an input, a constant, or a sine or cosine that is not planned yet.
    pub(crate) const fn is_leaf(self) -> bool {
        matches!(
            self,
            Self::Constant(_)
                | Self::Symbol(_)
                | Self::Cosine(Angle::Unplanned(_))
                | Self::Sine(Angle::Unplanned(_))
        )
    }

    /// Whether the node may get another form.
    pub(crate) const fn is_open(self) -> bool {
        matches!(self, Self::Sum(..) | Self::Product(..) | Self::Quotient(..))
    }
}
