//! Where the values of a program stand in an output that is written number by number.

use crate::lowering::{Entry, Operand, Program};
use std::ops::Range;

/// Numbers of an output side by side in a row.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Place {
    /// The row.
    pub row: usize,
    /// The columns.
    pub columns: Range<usize>,
}

/// The numbers of an output, each beside its place.
#[derive(Debug)]
pub struct Places {
    /// Those that are known before the first step.
    known: Vec<(Place, Entry)>,
    /// Those that each step computes.
    of_steps: Vec<Vec<(Place, Entry)>>,
}

impl Places {
    /// Those of a program's output.
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
            // Zeros and other known numbers that stand side by side are written at once.
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

    /// Those that are known before the first step.
    #[must_use]
    pub fn known(&mut self) -> Vec<(Place, Entry)> {
        std::mem::take(&mut self.known)
    }

    /// Those that a step computes.
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
