//! Output elements that become known with each step of a program.
//!
//! A function that writes into a caller's matrix stores each value as soon as it is computed.

use crate::lowering::{Entry, Operand, Program};
use std::ops::Range;

/// Adjacent elements of one row of an output.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct OutputRange {
    /// The row.
    pub row: usize,
    /// The columns.
    pub columns: Range<usize>,
}

/// Elements of an output, grouped by the step that computes them.
#[derive(Debug)]
pub struct OutputRanges {
    /// Constants and inputs, which no step computes.
    known: Vec<(OutputRange, Entry)>,
    /// Elements that each step computes.
    of_steps: Vec<Vec<(OutputRange, Entry)>>,
}

impl OutputRanges {
    /// Groups the output of a program by steps.
    #[must_use]
    pub fn new(program: &Program) -> Self {
        let mut ranges = Self {
            known: Vec::new(),
            of_steps: vec![Vec::new(); program.steps.len()],
        };
        let columns = match program.output.shape[..] {
            [_, columns] => columns.max(1),
            _ => program.output.len().max(1),
        };
        for (row, entries) in program.entries.chunks(columns).enumerate() {
            let mut first = 0;
            // Adjacent equal constants, such as zeros, are written at once.
            for same in entries.chunk_by(|a, b| a == b && step(*a).is_none()) {
                let end = first + same.len();
                let range = OutputRange {
                    row,
                    columns: first..end,
                };
                match step(same[0]) {
                    Some(at) => ranges.of_steps[at].push((range, same[0])),
                    None => ranges.known.push((range, same[0])),
                }
                first = end;
            }
        }
        ranges
    }

    /// Removes and returns the constants and inputs.
    #[must_use]
    pub fn take_known(&mut self) -> Vec<(OutputRange, Entry)> {
        std::mem::take(&mut self.known)
    }

    /// Removes and returns the elements that a step computes.
    #[must_use]
    pub fn take_of_step(&mut self, step: usize) -> Vec<(OutputRange, Entry)> {
        self.of_steps
            .get_mut(step)
            .map(std::mem::take)
            .unwrap_or_default()
    }
}

/// Step that computes an entry; `None` for constants and inputs.
fn step(entry: Entry) -> Option<usize> {
    match entry.operand {
        Operand::Step(at) => Some(at),
        _ => None,
    }
}
