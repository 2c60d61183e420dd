//! Operation count of a program.

use super::{Operand, Operation, Program};
use std::fmt;
use std::ops::AddAssign;

/// Operation counts of a program.
///
/// A sum of n terms counts n - 1, a product of n factors n - 1, a product with a sign one, a square
/// one, and a division one. All others are counted separately.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default, serde::Serialize)]
pub struct Cost {
    /// Additions and subtractions.
    pub additions: usize,
    /// Multiplications, including those by constants and by signs.
    pub multiplications: usize,
    /// Divisions.
    pub divisions: usize,
    /// Square roots.
    pub square_roots: usize,
    /// Angles whose sine or cosine is computed.
    pub trigonometric_pairs: usize,
    /// Arc tangents.
    pub arc_tangents: usize,
    /// Velocities whose signs are used.
    pub signs: usize,
    /// Guarded values.
    pub guards: usize,
    /// Sign changes.
    pub negations: usize,
    /// Computed values that are not outputs.
    pub intermediates: usize,
}

impl Cost {
    /// Additions, multiplications and divisions together.
    #[must_use]
    pub const fn operations(&self) -> usize {
        self.additions + self.multiplications + self.divisions
    }

    /// Whether the program does nothing.
    #[must_use]
    pub fn is_nothing(&self) -> bool {
        *self == Self::default()
    }

    /// The counts that are not operations, with their names.
    fn others(&self) -> [(usize, &'static str); 7] {
        [
            (self.square_roots, "square root"),
            (self.trigonometric_pairs, "trigonometric pair"),
            (self.arc_tangents, "arc tangent"),
            (self.signs, "sign"),
            (self.guards, "guard"),
            (self.negations, "negation"),
            (self.intermediates, "intermediate"),
        ]
    }
}

impl AddAssign for Cost {
    fn add_assign(&mut self, other: Self) {
        self.additions += other.additions;
        self.multiplications += other.multiplications;
        self.divisions += other.divisions;
        self.square_roots += other.square_roots;
        self.trigonometric_pairs += other.trigonometric_pairs;
        self.arc_tangents += other.arc_tangents;
        self.signs += other.signs;
        self.guards += other.guards;
        self.negations += other.negations;
        self.intermediates += other.intermediates;
    }
}

impl fmt::Display for Cost {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let counted = |(count, name): (usize, &str)| match count {
            1 => format!("1 {name}"),
            _ => format!("{count} {name}s"),
        };
        write!(f, "{}", counted((self.operations(), "operation")))?;
        if self.operations() > 0 {
            write!(
                f,
                " ({}, {}, {})",
                counted((self.additions, "addition")),
                counted((self.multiplications, "multiplication")),
                counted((self.divisions, "division")),
            )?;
        }
        for other in self.others().into_iter().filter(|(count, _)| *count > 0) {
            write!(f, ", {}", counted(other))?;
        }
        Ok(())
    }
}

impl Program {
    /// Counts the program's operations.
    #[must_use]
    pub fn cost(&self) -> Cost {
        let mut cost = Cost {
            guards: self.guards.len(),
            ..Cost::default()
        };
        let (mut angles, mut velocities) = (Distinct::default(), Distinct::default());
        for step in &self.steps {
            match step.operation {
                Operation::Add(..) | Operation::Sub(..) => cost.additions += 1,
                Operation::Mul(..) => cost.multiplications += 1,
                Operation::Div(..) => cost.divisions += 1,
                Operation::Neg(_) => cost.negations += 1,
                Operation::Sqrt(_) => cost.square_roots += 1,
                Operation::Sign(velocity) => velocities.add(velocity),
                Operation::Signed(_, velocity) => {
                    cost.multiplications += 1;
                    velocities.add(velocity);
                }
                Operation::Atan2(..) => cost.arc_tangents += 1,
                Operation::Sine(angle) | Operation::Cosine(angle) => angles.add(angle),
            }
        }
        cost.trigonometric_pairs = angles.0.len();
        cost.signs = velocities.0.len();
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

/// A set of operands.
#[derive(Default)]
struct Distinct(Vec<Operand>);

impl Distinct {
    fn add(&mut self, operand: Operand) {
        if !self.0.contains(&operand) {
            self.0.push(operand);
        }
    }
}
