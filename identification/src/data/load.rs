//! What a run carries, as columns of the model are asked for it.

/// A payload, or none.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Load<'a> {
    /// No payload.
    Nothing,
    /// Whatever payload there is: of random states, or of robots with one payload.
    Any,
    /// The payload of this name.
    Named(&'a str),
}

impl Load<'_> {
    /// Whether there is one.
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
