//! What a program costs, by one rule.

use super::{Operand, Operation, Program};
use std::fmt;

/// Operation counts by the rule: a sum of n terms counts n - 1, a product of n factors n - 1, a
/// square 1, a division 1; square roots, trigonometric pairs, signs and negations stand apart.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default, serde::Serialize)]
pub struct Cost {
    /// Additions and subtractions.
    pub additions: usize,
    /// Multiplications, those by constants included.
    pub multiplications: usize,
    /// Divisions.
    pub divisions: usize,
    /// Square roots.
    pub square_roots: usize,
    /// Angles of which sine or cosine is taken.
    pub trigonometric_pairs: usize,
    /// Arc tangents.
    pub arc_tangents: usize,
    /// Signs of velocities, as numbers or as selections.
    pub signs: usize,
    /// Sign changes.
    pub negations: usize,
    /// Values that are computed and are no output themselves.
    pub intermediates: usize,
}

impl Cost {
    /// Additions, multiplications and divisions together.
    #[must_use]
    pub const fn operations(&self) -> usize {
        self.additions + self.multiplications + self.divisions
    }
}

impl fmt::Display for Cost {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(
            f,
            "{} operations ({} additions, {} multiplications, {} divisions), {} square roots, {} trigonometric pairs, {} signs, {} intermediates",
            self.operations(),
            self.additions,
            self.multiplications,
            self.divisions,
            self.square_roots,
            self.trigonometric_pairs,
            self.signs,
            self.intermediates
        )
    }
}

impl Program {
    /// Counts the program's operations.
    #[must_use]
    pub fn cost(&self) -> Cost {
        let mut cost = Cost::default();
        let mut angles: Vec<Operand> = Vec::new();
        for step in &self.steps {
            match step.operation {
                Operation::Add(..) | Operation::Sub(..) => cost.additions += 1,
                Operation::Mul(..) => cost.multiplications += 1,
                Operation::Div(..) => cost.divisions += 1,
                Operation::Neg(_) => cost.negations += 1,
                Operation::Sqrt(_) => cost.square_roots += 1,
                Operation::Sign(_) | Operation::Signed(..) => cost.signs += 1,
                Operation::Atan2(..) => cost.arc_tangents += 1,
                Operation::Sine(angle) | Operation::Cosine(angle) => {
                    if !angles.contains(&angle) {
                        angles.push(angle);
                    }
                }
            }
        }
        cost.trigonometric_pairs = angles.len();
        cost.negations += self.entries.iter().filter(|e| e.negative).count();
        let mut is_output = vec![false; self.steps.len()];
        for entry in &self.entries {
            if let Operand::Step(at) = entry.operand {
                is_output[at] = true;
            }
        }
        cost.intermediates = is_output.iter().filter(|o| !**o).count();
        cost
    }
}
