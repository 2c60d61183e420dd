//! Expression handles with operators. Construction simplifies: zeros, ones and double negations
//! vanish.

use super::super::direction::SymbolId;
use super::{Arena, Handle, Op, negative_name};
use overact_exact::Number;
use std::ops::{Add, Div, Mul, Neg, Sub};

/// An expression: a `Copy` handle to a node of an [`Arena`].
#[derive(Debug, Clone, Copy)]
pub struct Expr<'a> {
    arena: &'a Arena,
    handle: Handle,
}

impl PartialEq for Expr<'_> {
    /// Semantic equality: two expressions are equal if they are the same node.
    fn eq(&self, other: &Self) -> bool {
        std::ptr::eq(self.arena, other.arena) && self.handle == other.handle
    }
}

impl<'a> Expr<'a> {
    pub(crate) const fn new(arena: &'a Arena, handle: Handle) -> Self {
        Self { arena, handle }
    }

    /// The graph that the expression belongs to.
    #[must_use]
    pub const fn arena(self) -> &'a Arena {
        self.arena
    }

    /// The node and its sign.
    #[must_use]
    pub const fn handle(self) -> Handle {
        self.handle
    }

    /// Whether the expression is zero for all values of its symbols.
    #[must_use]
    pub fn is_zero(self) -> bool {
        self.as_number().is_some_and(Number::is_zero)
    }

    /// Whether the expression is one.
    #[must_use]
    pub fn is_one(self) -> bool {
        self.as_number().is_some_and(Number::is_one)
    }

    /// The constant that equals the expression, if any.
    #[must_use]
    pub fn as_number(self) -> Option<Number> {
        self.arena.as_constant(self.handle)
    }

    /// The symbol that the expression is as a number, if it is one.
    #[must_use]
    pub fn symbol(self) -> Option<SymbolId> {
        match self.arena.op(self.handle.index()) {
            Op::Symbol(symbol) if !self.is_negative() => Some(symbol),
            _ => None,
        }
    }

    /// The expression, with a name for readers of generated code.
    ///
    /// The name belongs to the node, so the node of a negative expression is called `minus_…`.
    #[must_use]
    pub fn named(self, name: &str) -> Self {
        if self.is_negative() {
            self.arena.name(self, &negative_name(name));
        } else {
            self.arena.name(self, name);
        }
        self
    }

    /// The square.
    #[must_use]
    pub fn squared(self) -> Self {
        self * self
    }

    /// Square root of an expression that is not negative.
    #[must_use]
    pub fn sqrt(self) -> Self {
        if let Some(root) = self.as_number().and_then(Number::square_root) {
            return self.arena.number(root);
        }
        self.with(self.arena.intern(Op::Sqrt(self.handle)))
    }

    /// Sign: -1, 0 or 1.
    #[must_use]
    pub fn sign(self) -> Self {
        if let Some(number) = self.as_number() {
            let sign = if number.is_zero() {
                0
            } else {
                number.value().signum() as i64
            };
            return self.arena.integer(sign);
        }
        let (factor, base) = self.factor_and_base();
        let sign = base.with(self.arena.intern(Op::Sign(base.handle.positive())));
        let negative = base.handle.is_negative() != (factor.value() < 0.0);
        if negative { -sign } else { sign }
    }

    /// The angle of the direction (x, self), in (-π, π].
    #[must_use]
    pub fn atan2(self, x: Self) -> Self {
        self.with(self.arena.intern(Op::Atan2(self.handle, x.handle)))
    }

    /// The reciprocal.
    #[must_use]
    pub fn reciprocal(self) -> Self {
        self.arena.one() / self
    }

    fn with(self, handle: Handle) -> Self {
        Self {
            arena: self.arena,
            handle,
        }
    }

    fn is_negative(self) -> bool {
        self.handle.is_negative()
    }

    fn abs_node(self) -> Self {
        self.with(self.handle.positive())
    }

    /// The expression as constant × base; the base has no constant factor.
    #[must_use]
    pub fn factor_and_base(self) -> (Number, Self) {
        let sign = if self.is_negative() {
            Number::integer(-1)
        } else {
            Number::ONE
        };
        let node = self.abs_node();
        if let Op::Mul(a, b) = self.arena.op(node.handle.index()) {
            if let Some(factor) = self.arena.as_constant(a) {
                return (sign * factor, self.with(b));
            }
            if let Some(factor) = self.arena.as_constant(b) {
                return (sign * factor, self.with(a));
            }
        }
        (sign, node)
    }

    /// The square root w of an expression c + w or c - w with a constant c.
    #[must_use]
    pub fn root(self) -> Option<Self> {
        match self.arena.op(self.handle.index()) {
            Op::Sqrt(_) => Some(self.abs_node()),
            Op::Add(a, b) | Op::Sub(a, b) => {
                let variable = match (self.arena.as_constant(a), self.arena.as_constant(b)) {
                    (Some(_), None) => b,
                    (None, Some(_)) => a,
                    _ => return None,
                };
                self.with(variable).root()
            }
            _ => None,
        }
    }

    /// The sum of two expressions, neither of them negated; `negative` subtracts the second.
    fn sum(self, other: Self, negative: bool) -> Self {
        let (fa, a) = self.factor_and_base();
        let (fb, b) = other.factor_and_base();
        let fb = if negative { -fb } else { fb };
        if a == b {
            return self.arena.number(fa + fb) * a;
        }
        // Factor out a common constant: c x + c y = c (x + y).
        if !fa.is_one() && (fa == fb || fa == -fb) {
            let inner = if fa == fb { a + b } else { a - b };
            return self.arena.number(fa) * inner;
        }
        let op = if negative {
            Op::Sub(self.handle, other.handle)
        } else {
            Op::Add(self.handle, other.handle)
        };
        let known = self.arena.over_divisors(&op);
        known.unwrap_or_else(|| self.with(self.arena.intern(op)))
    }

    fn scale(self, factor: Number) -> Self {
        if factor.is_zero() {
            return self.arena.zero();
        }
        let (own, base) = self.factor_and_base();
        let factor = own * factor;
        if factor.value() < 0.0 {
            return -base.scale(-factor);
        }
        if factor.is_one() {
            return base;
        }
        let constant = self.arena.constant(factor);
        self.with(self.arena.intern(Op::Mul(constant, base.handle)))
    }
}

impl<'a> Neg for Expr<'a> {
    type Output = Self;
    fn neg(self) -> Self {
        if self.is_zero() {
            self
        } else {
            self.with(self.handle.negated())
        }
    }
}

impl<'a> Add for Expr<'a> {
    type Output = Self;
    fn add(self, other: Self) -> Self {
        if let (Some(a), Some(b)) = (self.as_number(), other.as_number()) {
            return self.arena.number(a + b);
        }
        if self.is_zero() {
            return other;
        }
        if other.is_zero() {
            return self;
        }
        match (self.is_negative(), other.is_negative()) {
            (false, false) => self.sum(other, false),
            (false, true) => self.sum(-other, true),
            (true, false) => other.sum(-self, true),
            (true, true) => -((-self).sum(-other, false)),
        }
    }
}

impl<'a> Sub for Expr<'a> {
    type Output = Self;
    fn sub(self, other: Self) -> Self {
        self + -other
    }
}

impl<'a> Mul for Expr<'a> {
    type Output = Self;
    fn mul(self, other: Self) -> Self {
        match (self.as_number(), other.as_number()) {
            (Some(a), Some(b)) => return self.arena.number(a * b),
            (Some(a), None) => return other.scale(a),
            (None, Some(b)) => return self.scale(b),
            (None, None) => {}
        }
        let negative = self.is_negative() != other.is_negative();
        let (fa, a) = self.abs_node().factor_and_base();
        let (fb, b) = other.abs_node().factor_and_base();
        // Two constants are merged; a single one keeps its place in the product.
        let product = if !fa.is_one() && !fb.is_one() {
            (a * b).scale(fa * fb)
        } else {
            let (x, y) = (self.handle.positive(), other.handle.positive());
            self.with(self.arena.intern(Op::Mul(x.min(y), x.max(y))))
        };
        if negative { -product } else { product }
    }
}

impl<'a> Mul<Number> for Expr<'a> {
    type Output = Self;
    fn mul(self, factor: Number) -> Self {
        self.scale(factor)
    }
}

impl<'a> Div for Expr<'a> {
    type Output = Self;
    /// The quotient. A divisor that is identically zero is an error of the caller; the quotient
    /// then evaluates to infinity or NaN.
    fn div(self, other: Self) -> Self {
        if let Some(divisor) = other.as_number().filter(|d| !d.is_zero()) {
            return self.scale(Number::ONE / divisor);
        }
        if self.is_zero() {
            return self;
        }
        let negative = self.is_negative() != other.is_negative();
        let op = Op::Div(self.handle.positive(), other.handle.positive());
        let quotient = self.with(self.arena.intern(op));
        if negative { -quotient } else { quotient }
    }
}

impl<'a> std::iter::Sum for Expr<'a> {
    /// The sum of at least one expression.
    ///
    /// # Panics
    /// Without any expression, because an empty sum has no arena.
    fn sum<I: Iterator<Item = Self>>(mut iter: I) -> Self {
        let first = iter
            .next()
            .expect("a sum of expressions has at least one term");
        iter.fold(first, |sum, term| sum + term)
    }
}
