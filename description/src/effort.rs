//! Effort of the search for fewer operations, as requested by a description, an attribute or a
//! user.

/// Effort of the search for fewer operations in a whole model.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default, PartialOrd, Ord)]
pub enum Effort {
    /// No search: the forms of the derivation are kept.
    None,
    /// Within a few percent of the thorough search, in a fraction of its time.
    #[default]
    Quick,
    /// As long as savings are found.
    Thorough,
}

impl Effort {
    /// All, in ascending order.
    pub const ALL: [Self; 3] = [Self::None, Self::Quick, Self::Thorough];

    /// The name in descriptions, attributes and on the command line.
    #[must_use]
    pub const fn name(self) -> &'static str {
        match self {
            Self::None => "none",
            Self::Quick => "quick",
            Self::Thorough => "thorough",
        }
    }

    /// The effort of this name.
    #[must_use]
    pub fn named(name: &str) -> Option<Self> {
        Self::ALL.into_iter().find(|effort| effort.name() == name)
    }
}
