//! Which parameters an estimate has.

use serde::Serialize;

/// The stages of an identification, by the parameters that are estimated.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize)]
#[serde(rename_all = "lowercase")]
pub enum Stage {
    /// All base parameters.
    Base,
    /// The fewest that the data do not refute.
    Recommended,
    /// Only parameters that the data determine.
    Essential,
    /// Standard parameters that a robot can have.
    Consistent,
}

impl Stage {
    /// `base`, `recommended`, `essential` or `consistent`.
    #[must_use]
    pub const fn name(self) -> &'static str {
        match self {
            Self::Base => "base",
            Self::Recommended => "recommended",
            Self::Essential => "essential",
            Self::Consistent => "consistent",
        }
    }
}
