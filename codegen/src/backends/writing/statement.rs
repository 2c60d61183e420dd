//! Statements and expressions common to all languages.

use crate::lowering::Condition;
use std::ops::Range;

/// Precedence of an expression, lowest first.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord)]
pub enum Binding {
    /// a + b, a - b.
    Sum,
    /// a b, a / b, -a.
    Product,
    /// Needs no parentheses.
    Atom,
}

/// An operator between two operands.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Operator {
    /// a + b.
    Add,
    /// a - b.
    Sub,
    /// a b.
    Mul,
    /// a / b.
    Div,
}

/// A function that each backend provides.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Call {
    /// Square root.
    Sqrt,
    /// Sign: -1, 0 or 1.
    Sign,
    /// The first operand times the sign of the second.
    Signed,
    /// atan2(y, x).
    Atan2,
    /// Sine of an angle whose cosine is not needed.
    Sine,
    /// Cosine of an angle whose sine is not needed.
    Cosine,
}

/// An expression.
#[derive(Debug, Clone, PartialEq)]
pub enum Expression {
    /// A number.
    Number(f64),
    /// A named constant, or its negative.
    Constant {
        /// The constant's name.
        name: String,
        /// Whether it is the negative of the constant.
        negative: bool,
    },
    /// Element of an input array.
    Input {
        /// Index of the input.
        array: usize,
        /// Index of the element.
        index: usize,
    },
    /// An assigned value.
    Value(String),
    /// The negative.
    Negative(Box<Self>),
    /// Two operands.
    Binary(Operator, Box<[Self; 2]>),
    /// A function of operands.
    Call(Call, Vec<Self>),
    /// A violated invariant of lowering; the generated code does not compile.
    Broken(&'static str),
}

impl Operator {
    /// Precedence of the operator, and the lowest one of a right operand without parentheses.
    ///
    /// The right operand of + may be a sum: a + (b + c) is written as a + b + c, which languages
    /// evaluate from the left.
    #[must_use]
    pub const fn binding(self) -> (Binding, Binding) {
        match self {
            Self::Add => (Binding::Sum, Binding::Sum),
            Self::Sub => (Binding::Sum, Binding::Product),
            Self::Mul | Self::Div => (Binding::Product, Binding::Atom),
        }
    }
}

impl Expression {
    /// Precedence of the expression.
    #[must_use]
    pub fn binding(&self) -> Binding {
        match self {
            Self::Number(value) if *value < 0.0 => Binding::Product,
            Self::Constant { negative: true, .. } | Self::Negative(_) => Binding::Product,
            Self::Binary(operator, _) => operator.binding().0,
            _ => Binding::Atom,
        }
    }
}

/// Sine and cosine of one angle; a value that is not needed has no name.
#[derive(Debug, Clone, PartialEq)]
pub struct SineCosinePair {
    /// The angle.
    pub angle: Expression,
    /// Name of the sine.
    pub sine: Option<String>,
    /// Name of the cosine.
    pub cosine: Option<String>,
}

/// One statement.
#[derive(Debug, Clone, PartialEq)]
pub enum Statement {
    /// An assignment.
    Assign {
        /// The name.
        name: String,
        /// The value.
        value: Expression,
    },
    /// Sines and cosines of several independent angles.
    Pairs(Vec<SineCosinePair>),
    /// Sine and cosine of one angle.
    Pair(SineCosinePair),
    /// A condition on a value.
    Guard {
        /// The value.
        value: Expression,
        /// The condition.
        condition: Condition,
    },
    /// Writes one value to adjacent elements of an output row.
    Output {
        /// The row.
        row: usize,
        /// The columns.
        columns: Range<usize>,
        /// The value.
        value: Expression,
    },
}
