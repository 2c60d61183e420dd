//! Payload of a run, for the columns of a model.

/// A payload, or none.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Load<'a> {
    /// No payload.
    Nothing,
    /// Any payload: for random states, or robots with one payload.
    Any,
    /// The payload with this name.
    Named(&'a str),
}

impl Load<'_> {
    /// Whether there is a payload.
    #[must_use]
    pub fn is_some(self) -> bool {
        self != Self::Nothing
    }
}

impl From<bool> for Load<'_> {
    fn from(loaded: bool) -> Self {
        if loaded { Self::Any } else { Self::Nothing }
    }
}
