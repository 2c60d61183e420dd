//! How hard a function's operations are searched, as a description, an attribute or a user asks for it.

/// How much work fewer operations are worth, in a whole model.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default, PartialOrd, Ord)]
pub enum Effort {
    /// None: the derivation's own form stays.
    None,
    /// Within a few in a hundred of the thorough search, in a small part of its time.
    #[default]
    Quick,
    /// As long as something is found.
    Thorough,
}

impl Effort {
    /// All, the least first.
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

    /// The effort with a name.
    #[must_use]
    pub fn named(name: &str) -> Option<Self> {
        Self::ALL.into_iter().find(|effort| effort.name() == name)
    }
}
