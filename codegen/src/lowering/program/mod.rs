//! The straight-line program, the common input of all backends.

mod cost;
mod verify;

pub use cost::Cost;

use overact_core::ActuatorGroup;

/// Source of an operand.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Operand {
    /// A constant.
    Constant(f64),
    /// Element of an input array.
    Input {
        /// Index of the input.
        array: usize,
        /// Index of the element.
        index: usize,
    },
    /// The result of an earlier step.
    Step(usize),
}

/// The computation of a step.
#[derive(Debug, Clone, Copy, PartialEq)]
#[expect(missing_docs, reason = "the variants say it")]
pub enum Operation {
    Add(Operand, Operand),
    Sub(Operand, Operand),
    Mul(Operand, Operand),
    Div(Operand, Operand),
    Neg(Operand),
    Sqrt(Operand),
    /// Sine of an angle in radians; the cosine of the same angle follows or precedes it.
    Sine(Operand),
    Cosine(Operand),
    /// -1, 0 or 1.
    Sign(Operand),
    /// The first operand with the sign of the second: a × sign(b), a multiplication.
    Signed(Operand, Operand),
    Atan2(Operand, Operand),
}

impl Operation {
    /// Whether the operation is counted.
    #[must_use]
    pub(crate) const fn is_counted(&self) -> bool {
        matches!(
            self,
            Self::Add(..) | Self::Sub(..) | Self::Mul(..) | Self::Div(..) | Self::Signed(..)
        )
    }

    /// The same operation on other operands.
    #[must_use]
    pub(crate) fn map(self, mut to: impl FnMut(Operand) -> Operand) -> Self {
        match self {
            Self::Add(a, b) => Self::Add(to(a), to(b)),
            Self::Sub(a, b) => Self::Sub(to(a), to(b)),
            Self::Mul(a, b) => Self::Mul(to(a), to(b)),
            Self::Div(a, b) => Self::Div(to(a), to(b)),
            Self::Signed(a, b) => Self::Signed(to(a), to(b)),
            Self::Atan2(a, b) => Self::Atan2(to(a), to(b)),
            Self::Neg(a) => Self::Neg(to(a)),
            Self::Sqrt(a) => Self::Sqrt(to(a)),
            Self::Sine(a) => Self::Sine(to(a)),
            Self::Cosine(a) => Self::Cosine(to(a)),
            Self::Sign(a) => Self::Sign(to(a)),
        }
    }

    /// The operands.
    #[must_use]
    pub fn operands(&self) -> Vec<Operand> {
        match *self {
            Self::Add(a, b)
            | Self::Sub(a, b)
            | Self::Mul(a, b)
            | Self::Div(a, b)
            | Self::Signed(a, b)
            | Self::Atan2(a, b) => vec![a, b],
            Self::Neg(a) | Self::Sqrt(a) | Self::Sine(a) | Self::Cosine(a) | Self::Sign(a) => {
                vec![a]
            }
        }
    }
}

/// One assignment.
#[derive(Debug, Clone, PartialEq)]
pub struct Step {
    /// The computation.
    pub operation: Operation,
    /// The name from the derivation.
    pub name: Option<String>,
    /// The heading of the step, for instance a leg's name.
    pub scope: String,
}

/// A number of the output.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Entry {
    /// The value.
    pub operand: Operand,
    /// Whether the output is the negative of the value.
    pub negative: bool,
}

impl Entry {
    /// The value itself.
    #[must_use]
    pub const fn positive(operand: Operand) -> Self {
        Self {
            operand,
            negative: false,
        }
    }

    /// Whether it is zero for all inputs.
    #[must_use]
    pub fn is_zero(&self) -> bool {
        matches!(self.operand, Operand::Constant(zero) if zero == 0.0)
    }

    /// The value or its negative.
    #[must_use]
    pub const fn times(self, negative: bool) -> Self {
        Self {
            operand: self.operand,
            negative: self.negative != negative,
        }
    }
}

/// A named array of numbers.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Array {
    /// Name, a Rust identifier.
    pub name: String,
    /// Length, or rows and columns.
    pub shape: Vec<usize>,
}

impl Array {
    /// Number of elements.
    #[must_use]
    pub fn len(&self) -> usize {
        self.shape.iter().product()
    }

    /// Whether the array has no elements.
    #[must_use]
    pub fn is_empty(&self) -> bool {
        self.len() == 0
    }
}

/// A condition for the outputs to be valid.
#[derive(Debug, Clone, PartialEq)]
pub enum Condition {
    /// The value is nonnegative, otherwise the pose is out of the leg's reach. It is not small
    /// relative to `home`, otherwise the leg is singular.
    Reach {
        /// Name of the leg.
        leg: String,
        /// The value at the home configuration; zero if only the sign matters.
        home: f64,
    },
    /// The value is not small relative to `home`, otherwise the leg is singular.
    Leg {
        /// Name of the leg.
        leg: String,
        /// The value's magnitude at the home configuration.
        home: f64,
    },
    /// The value is not small relative to `home`, otherwise the actuators do not determine the
    /// platform.
    Platform {
        /// The actuators.
        actuators: ActuatorGroup,
        /// The value's magnitude at the home configuration.
        home: f64,
    },
    /// The value is at most `within` from zero, otherwise the leg does not allow the pose.
    Closed {
        /// Name of the leg.
        leg: String,
        /// Largest distance of the value from zero, m or rad.
        within: f64,
    },
    /// The value is not small relative to `home`, otherwise the independent coordinates do not
    /// determine the others.
    Coordinates {
        /// The value's magnitude at the home configuration.
        home: f64,
    },
    /// The value is positive, otherwise the mass matrix is not positive definite.
    Mass,
    /// The value's magnitude is at most this, otherwise values computed from it might overflow.
    Size {
        /// The largest magnitude.
        most: f64,
    },
}

impl Condition {
    /// Whether it is a condition on the pose that applies to every function.
    pub(crate) const fn is_of_pose(&self) -> bool {
        matches!(self, Self::Closed { .. })
    }
}

/// A condition on a value.
#[derive(Debug, Clone, PartialEq)]
pub struct Guard {
    /// The value.
    pub operand: Operand,
    /// The condition.
    pub condition: Condition,
}

/// A straight-line program.
#[derive(Debug, Clone, PartialEq)]
pub struct Program {
    /// Inputs, in the order of the function's arguments.
    pub inputs: Vec<Array>,
    /// The output.
    pub output: Array,
    /// The output's numbers, row-major.
    pub entries: Vec<Entry>,
    /// The assignments, operands first.
    pub steps: Vec<Step>,
    /// Guards, each on an existing step.
    pub guards: Vec<Guard>,
    /// Least torques of a program whose entries are torques p and a basis N of the internal
    /// torques, row by row; -∞ for an actuator that is no cable.
    ///
    /// Its output are the torques p + N z nearest to the least ones
    /// ([`overact_core::tension`]). Empty for all other programs, whose output are the entries.
    pub least_torques: Vec<f64>,
    /// Number of pieces in which operations were searched, if the function was too large for a
    /// search as a whole.
    pub pieces: usize,
}

impl Program {
    /// All constants of the program.
    pub(crate) fn constants(&self) -> impl Iterator<Item = f64> {
        let operands = self.steps.iter().flat_map(|s| s.operation.operands());
        let operands = operands.chain(self.entries.iter().map(|e| e.operand));
        operands.filter_map(|operand| match operand {
            Operand::Constant(value) => Some(value),
            _ => None,
        })
    }

    /// All operands, including those of guards.
    pub(crate) fn operands(&self) -> impl Iterator<Item = Operand> {
        let of_steps = self.steps.iter().flat_map(|s| s.operation.operands());
        let of_entries = self.entries.iter().map(|e| e.operand);
        of_steps
            .chain(of_entries)
            .chain(self.guards.iter().map(|g| g.operand))
    }

    /// Replaces all operands.
    pub(crate) fn replace(&mut self, mut by: impl FnMut(Operand) -> Operand) {
        for step in &mut self.steps {
            step.operation = step.operation.map(&mut by);
        }
        for entry in &mut self.entries {
            entry.operand = by(entry.operand);
        }
        for guard in &mut self.guards {
            guard.operand = by(guard.operand);
        }
    }

    /// For each input, whether the program reads any of its elements.
    #[must_use]
    pub fn used_inputs(&self) -> Vec<bool> {
        let mut used = vec![false; self.inputs.len()];
        let operands = self.steps.iter().flat_map(|s| s.operation.operands());
        for operand in operands.chain(self.entries.iter().map(|e| e.operand)) {
            if let Operand::Input { array, .. } = operand {
                used[array] = true;
            }
        }
        used
    }

    /// Number of uses of each step by steps, entries and guards.
    #[must_use]
    pub fn uses(&self) -> Vec<usize> {
        let mut uses = vec![0; self.steps.len()];
        let operands = self.steps.iter().flat_map(|s| s.operation.operands());
        let entries = self.entries.iter().map(|entry| entry.operand);
        let guards = self.guards.iter().map(|guard| guard.operand);
        for operand in operands.chain(entries).chain(guards) {
            if let Operand::Step(at) = operand
                && let Some(uses) = uses.get_mut(at)
            {
                *uses += 1;
            }
        }
        uses
    }
}
