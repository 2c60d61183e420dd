//! Columns that are tested together.

use super::scores::Scores;

/// A group of columns: those of one hypothesis, or of the payload in one run.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) struct Group {
    /// Block of the columns.
    pub(super) block: usize,
    /// Run outside of which the columns are zero; `None` for all runs.
    pub(super) run: Option<usize>,
}

impl Group {
    /// The hypothesis with this number.
    pub(crate) fn hypothesis(number: usize) -> Self {
        Self {
            block: number,
            run: None,
        }
    }

    /// The payload parameters in one run.
    pub(crate) fn payload(scores: &Scores, run: usize) -> Self {
        Self {
            block: scores.hypotheses.len(),
            run: Some(run),
        }
    }
}
