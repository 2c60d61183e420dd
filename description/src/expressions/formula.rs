//! Formulas of a joint's position, and springs.

use crate::expressions::dimension::Dimension;
use overact_exact::{Angle, Number, Ratio};

/// A formula of a joint's variable q, rad or m.
#[derive(Debug, Clone, PartialEq)]
pub enum Formula {
    /// offset + factor q.
    Linear {
        /// The value at q = 0.
        offset: Number,
        /// The slope.
        factor: Ratio,
    },
    /// cos(offset + factor q).
    Cosine {
        /// The angle at q = 0.
        offset: Angle,
        /// Cycles per cycle of q.
        factor: Ratio,
    },
    /// sin(offset + factor q).
    Sine {
        /// The angle at q = 0.
        offset: Angle,
        /// Cycles per cycle of q.
        factor: Ratio,
    },
    /// A sum.
    Sum(Box<Self>, Box<Self>),
    /// A product.
    Product(Box<Self>, Box<Self>),
    /// A quotient.
    Quotient(Box<Self>, Box<Self>),
    /// A square root.
    SquareRoot(Box<Self>),
}

impl Formula {
    /// A constant.
    #[must_use]
    pub const fn constant(offset: Number) -> Self {
        Self::Linear {
            offset,
            factor: Ratio::ZERO,
        }
    }

    /// Number of nodes of the formula.
    pub(crate) fn size(&self) -> usize {
        match self {
            Self::Linear { .. } | Self::Cosine { .. } | Self::Sine { .. } => 1,
            Self::SquareRoot(a) => 1 + a.size(),
            Self::Sum(a, b) | Self::Product(a, b) | Self::Quotient(a, b) => 1 + a.size() + b.size(),
        }
    }

    /// The value at a position q, rad or m.
    #[must_use]
    pub fn value(&self, q: f64) -> f64 {
        match self {
            Self::Linear { offset, factor } => offset.value() + factor.value() * q,
            Self::Cosine { offset, factor } => (offset.value() + factor.value() * q).cos(),
            Self::Sine { offset, factor } => (offset.value() + factor.value() * q).sin(),
            Self::Sum(a, b) => a.value(q) + b.value(q),
            Self::Product(a, b) => a.value(q) * b.value(q),
            Self::Quotient(a, b) => a.value(q) / b.value(q),
            Self::SquareRoot(a) => a.value(q).sqrt(),
        }
    }
}

/// The spring of a joint.
#[derive(Debug, Clone, PartialEq)]
pub struct Spring {
    /// Torque of the joint per unit of the coefficient.
    pub formula: Formula,
    /// SI unit of the coefficient.
    pub unit: String,
    /// Dimension of the coefficient.
    pub(crate) dimension: Dimension,
}
