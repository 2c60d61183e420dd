//! The floating-point type of generated code.

use overact_core::{Limits, limits};

/// A floating-point type. Descriptions and the search always use 64 bits.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub enum Float {
    /// 64 bits, for identification and simulation.
    #[default]
    F64,
    /// 32 bits, for controllers in single precision. Such code does not implement `overact::Model`.
    F32,
}

impl Float {
    /// All types.
    pub const ALL: [Self; 2] = [Self::F64, Self::F32];

    /// The name in Rust, in attributes and on the command line.
    #[must_use]
    pub const fn name(self) -> &'static str {
        match self {
            Self::F64 => "f64",
            Self::F32 => "f32",
        }
    }

    /// The type of this name.
    #[must_use]
    pub fn named(name: &str) -> Option<Self> {
        Self::ALL.into_iter().find(|float| float.name() == name)
    }

    /// Numerical limits of the type.
    #[must_use]
    pub const fn limits(self) -> Limits {
        match self {
            Self::F64 => limits::DOUBLE,
            Self::F32 => limits::SINGLE,
        }
    }

    /// Whether the type represents a number as finite and, unless it is zero, as nonzero.
    #[must_use]
    pub(crate) fn holds(self, value: f64) -> bool {
        let short = value as f32;
        match self {
            Self::F64 => value.is_finite(),
            Self::F32 => short.is_finite() && (short.is_normal() || value == 0.0),
        }
    }
}
