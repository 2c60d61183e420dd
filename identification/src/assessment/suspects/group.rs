//! Columns that are tested together.

use super::scores::Scores;

/// Columns that are tested together: those of a suspect, or of the payload in one run.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) struct Group {
    /// The block of their columns.
    pub(super) block: usize,
    /// The run to which they are confined.
    pub(super) run: Option<usize>,
}

impl Group {
    /// One suspect, by its number.
    pub(crate) fn suspect(number: usize) -> Self {
        Self {
            block: number,
            run: None,
        }
    }

    /// The payload's parameters in one run.
    pub(crate) fn payload(scores: &Scores, run: usize) -> Self {
        Self {
            block: scores.suspects.len(),
            run: Some(run),
        }
    }
}
