//! Stages of the estimation.

use serde::Serialize;

/// Stage of an identification, by the estimated parameters.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize)]
#[serde(rename_all = "lowercase")]
pub enum Stage {
    /// Base parameters.
    Base,
    /// Recommended parameters: the fewest that the data do not refute.
    Recommended,
    /// Essential parameters, by the paper's rule.
    Essential,
    /// Physically consistent standard parameters.
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
