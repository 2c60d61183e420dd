//! Columns that are tested together.

use super::{columns::FaultHypothesis, scores::Scores};

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

    /// All hypotheses that are `wanted`, in their order.
    pub(crate) fn hypotheses(
        scores: &Scores,
        wanted: impl Fn(FaultHypothesis) -> bool,
    ) -> impl Iterator<Item = Self> {
        let all = scores.hypotheses.iter().enumerate();
        let wanted = all.filter(move |(_, hypothesis)| wanted(**hypothesis));
        wanted.map(|(number, _)| Self::hypothesis(number))
    }

    /// The payload parameters in one run.
    pub(crate) fn payload(scores: &Scores, run: usize) -> Self {
        Self {
            block: scores.hypotheses.len(),
            run: Some(run),
        }
    }

    /// The hypothesis of the columns; not for a payload.
    pub(crate) fn fault_hypothesis(&self, scores: &Scores) -> FaultHypothesis {
        scores.hypotheses[self.block]
    }
}
