//! Places of a program's values in an output that is written number by number.

use crate::lowering::{Entry, Operand, Program};
use std::ops::Range;

/// Adjacent numbers in a row of an output.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Place {
    /// The row.
    pub row: usize,
    /// The columns.
    pub columns: Range<usize>,
}

/// The numbers of an output with their places.
#[derive(Debug)]
pub struct Places {
    /// Numbers that are known before the first step.
    known: Vec<(Place, Entry)>,
    /// Numbers that each step computes.
    of_steps: Vec<Vec<(Place, Entry)>>,
}

impl Places {
    /// The places of a program's output.
    #[must_use]
    pub fn new(program: &Program) -> Self {
        let mut places = Self {
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
                let place = Place {
                    row,
                    columns: first..end,
                };
                match step(same[0]) {
                    Some(at) => places.of_steps[at].push((place, same[0])),
                    None => places.known.push((place, same[0])),
                }
                first = end;
            }
        }
        places
    }

    /// Numbers that are known before the first step.
    #[must_use]
    pub fn known(&mut self) -> Vec<(Place, Entry)> {
        std::mem::take(&mut self.known)
    }

    /// Numbers that a step computes.
    #[must_use]
    pub fn of(&mut self, step: usize) -> Vec<(Place, Entry)> {
        self.of_steps
            .get_mut(step)
            .map(std::mem::take)
            .unwrap_or_default()
    }
}

/// The step that computes a number.
fn step(entry: Entry) -> Option<usize> {
    match entry.operand {
        Operand::Step(at) => Some(at),
        _ => None,
    }
}
