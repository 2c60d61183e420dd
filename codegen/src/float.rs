//! The numbers that generated code computes with.

use overact_core::{Limits, limits};

/// A type of numbers. Descriptions and the search of a program have 64 bits in any case.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub enum Float {
    /// Of 64 bits, as identification and simulation want them.
    #[default]
    F64,
    /// Of 32 bits, for controllers whose processors compute with no longer ones. Such code is no
    /// `overact::Model`.
    F32,
}

impl Float {
    /// All.
    pub const ALL: [Self; 2] = [Self::F64, Self::F32];

    /// The name in Rust, in attributes and on the command line.
    #[must_use]
    pub const fn name(self) -> &'static str {
        match self {
            Self::F64 => "f64",
            Self::F32 => "f32",
        }
    }

    /// The numbers with this name.
    #[must_use]
    pub fn named(name: &str) -> Option<Self> {
        Self::ALL.into_iter().find(|float| float.name() == name)
    }

    /// From where on numbers count as zero.
    #[must_use]
    pub const fn limits(self) -> Limits {
        match self {
            Self::F64 => limits::DOUBLE,
            Self::F32 => limits::SINGLE,
        }
    }

    /// Whether a number stays one, and stays other than zero.
    #[must_use]
    pub(crate) fn holds(self, value: f64) -> bool {
        let short = value as f32;
        match self {
            Self::F64 => value.is_finite(),
            Self::F32 => short.is_finite() && (short.is_normal() || value == 0.0),
        }
    }
}
