//! Standard or base columns of the identification models.

use crate::size::Extent;

/// Columns of an identification model.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash, PartialOrd, Ord)]
pub enum Columns {
    /// All standard parameters whose column is not identically zero.
    Standard,
    /// The base parameters: independent columns only.
    Base,
}

impl Columns {
    /// `standard` or `base`.
    #[must_use]
    pub const fn name(self) -> &'static str {
        match self {
            Self::Standard => "standard",
            Self::Base => "base",
        }
    }

    /// The columns of this name.
    #[must_use]
    pub fn named(name: &str) -> Option<Self> {
        let all = [Self::Standard, Self::Base];
        all.into_iter().find(|columns| columns.name() == name)
    }

    pub(crate) const fn extent(self) -> Extent {
        match self {
            Self::Standard => Extent::Parameters,
            Self::Base => Extent::BaseParameters,
        }
    }
}
