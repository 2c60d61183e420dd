//! Payload of a run, for the columns of a model.

/// A payload, or none.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Load<'a> {
    /// No payload.
    Nothing,
    /// Any payload: for random states, or robots with one payload.
    Any,
    /// The payload with this name, or several payloads, whose names are joined by plus signs.
    Named(&'a str),
}

/// Names of the payloads of a run, from its label: one name, or several with plus signs, `A+B`.
///
/// # Examples
/// ```
/// assert!(overact_logs::carried_payloads("box+tool").eq(["box", "tool"]));
/// ```
pub fn carried_payloads(label: &str) -> impl Iterator<Item = &str> {
    label.split('+')
}

impl<'a> Load<'a> {
    /// The payload of a run that carries one or not, with its name if payloads have names.
    #[must_use]
    pub fn new(loaded: bool, name: Option<&'a str>) -> Self {
        name.map_or_else(|| Self::from(loaded), Self::Named)
    }

    /// The name of the payload, if it has one.
    #[must_use]
    pub const fn name(self) -> Option<&'a str> {
        match self {
            Self::Named(label) => Some(label),
            Self::Nothing | Self::Any => None,
        }
    }

    /// The payload for tables: `no`, `yes`, or its names.
    #[must_use]
    pub const fn words(self) -> &'a str {
        match self {
            Self::Nothing => "no",
            Self::Any => "yes",
            Self::Named(label) => label,
        }
    }

    /// Whether there is a payload.
    #[must_use]
    pub fn is_some(self) -> bool {
        self != Self::Nothing
    }

    /// Whether the payload with this name is among those that are carried.
    #[must_use]
    pub fn contains(self, name: &str) -> bool {
        match self {
            Self::Nothing => false,
            Self::Any => true,
            Self::Named(label) => carried_payloads(label).any(|one| one == name),
        }
    }
}

impl From<bool> for Load<'_> {
    fn from(loaded: bool) -> Self {
        if loaded { Self::Any } else { Self::Nothing }
    }
}
