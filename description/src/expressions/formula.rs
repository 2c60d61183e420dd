//! Formulas of a joint's position, or of a length and its rate, and springs.

use crate::expressions::dimension::Dimension;
use overact_exact::{Angle, Number, Ratio};

/// A formula of a joint's variable q, rad or m, or of a spring's length q, m, and its rate.
#[derive(Debug, Clone, PartialEq)]
pub enum Formula {
    /// offset + factor q.
    Linear {
        /// The value at q = 0.
        offset: Number,
        /// The slope.
        factor: Ratio,
    },
    /// factor × rate of q, m/s.
    Rate {
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
            Self::Linear { .. } | Self::Rate { .. } => 1,
            Self::Cosine { .. } | Self::Sine { .. } => 1,
            Self::SquareRoot(a) => 1 + a.size(),
            Self::Sum(a, b) | Self::Product(a, b) | Self::Quotient(a, b) => 1 + a.size() + b.size(),
        }
    }

    /// Whether the formula contains the rate.
    #[must_use]
    pub fn has_rate(&self) -> bool {
        match self {
            Self::Rate { .. } => true,
            Self::Linear { .. } | Self::Cosine { .. } | Self::Sine { .. } => false,
            Self::SquareRoot(a) => a.has_rate(),
            Self::Sum(a, b) | Self::Product(a, b) | Self::Quotient(a, b) => {
                a.has_rate() || b.has_rate()
            }
        }
    }

    /// Whether the formula contains a sine or cosine of q.
    pub(crate) fn has_angle(&self) -> bool {
        match self {
            Self::Cosine { .. } | Self::Sine { .. } => true,
            Self::Linear { .. } | Self::Rate { .. } => false,
            Self::SquareRoot(a) => a.has_angle(),
            Self::Sum(a, b) | Self::Product(a, b) | Self::Quotient(a, b) => {
                a.has_angle() || b.has_angle()
            }
        }
    }

    /// The value at a position q, rad or m, at rest.
    #[must_use]
    pub fn value(&self, q: f64) -> f64 {
        self.value_at(q, 0.0)
    }

    /// The value at a position q and a rate, rad and rad/s or m and m/s.
    #[must_use]
    pub fn value_at(&self, q: f64, rate: f64) -> f64 {
        let of = |part: &Self| part.value_at(q, rate);
        match self {
            Self::Linear { offset, factor } => offset.value() + factor.value() * q,
            Self::Rate { factor } => factor.value() * rate,
            Self::Cosine { offset, factor } => (offset.value() + factor.value() * q).cos(),
            Self::Sine { offset, factor } => (offset.value() + factor.value() * q).sin(),
            Self::Sum(a, b) => of(a) + of(b),
            Self::Product(a, b) => of(a) * of(b),
            Self::Quotient(a, b) => of(a) / of(b),
            Self::SquareRoot(a) => of(a).sqrt(),
        }
    }
}

/// The spring of a joint, or between two points.
#[derive(Debug, Clone, PartialEq)]
pub struct Spring {
    /// Torque of the joint, or force, per unit of the coefficient.
    pub formula: Formula,
    /// SI unit of the coefficient.
    pub unit: String,
    /// Dimension of the coefficient.
    pub(crate) dimension: Dimension,
}
