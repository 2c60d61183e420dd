//! Programs of legs that are alike, side by side: what all share is computed once, what belongs to a leg in lanes
//! of vectors, a leg in each.
//!
//! The program is that of one leg and of what is shared. The numbers in which legs differ are an input of it,
//! [`Lanes::constants`]; what depends on these alone is a number itself, so it is computed here and not by the
//! generated code.

use super::program::{Array, Operand, Operation, Program, Step};

/// Where a column of the program stands among those of the function.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Column {
    /// It is shared by all legs, and stands here.
    Shared(usize),
    /// Each leg has one.
    OfLegs {
        /// That of the first leg.
        first: usize,
        /// From one leg's to the next one's.
        stride: usize,
    },
}

/// A program of legs that are alike.
#[derive(Debug, Clone, PartialEq)]
pub struct Lanes {
    /// The program of one leg and of what is shared.
    pub program: Program,
    /// The function's output.
    pub output: Array,
    /// Where the columns of the program's output stand in the function's.
    pub columns: Vec<Column>,
    /// The legs' names.
    pub legs: Vec<String>,
    /// Which of the inputs has the legs' constants.
    pub array: usize,
    /// The values of its elements in each leg.
    pub constants: Vec<Vec<f64>>,
    /// How many elements of each input belong to a leg; 0 for inputs that all share.
    pub strides: Vec<usize>,
    /// For each guard of the program, what its value is at home in each leg.
    pub homes: Vec<Vec<f64>>,
}

impl Lanes {
    /// For each step, whether it belongs to a leg.
    #[must_use]
    pub fn of_legs(&self) -> Vec<bool> {
        of_legs(&self.program, &self.strides)
    }

    /// Whether an operand belongs to a leg, where `of_legs` says which steps do.
    #[must_use]
    pub fn is_of_leg(&self, operand: Operand, of_legs: &[bool]) -> bool {
        is_of_leg(operand, &self.strides, of_legs)
    }

    /// Operations that are done once, and those of each leg.
    #[must_use]
    pub fn operations(&self) -> (usize, usize) {
        let counted = self.program.steps.iter().zip(self.of_legs());
        let counted = counted.filter(|(step, _)| step.operation.is_counted());
        let (own, shared): (Vec<_>, Vec<_>) = counted.partition(|(_, own)| *own);
        (shared.len(), own.len())
    }
}

fn is_of_leg(operand: Operand, strides: &[usize], of_legs: &[bool]) -> bool {
    match operand {
        Operand::Constant(_) => false,
        Operand::Input { array, .. } => strides[array] > 0,
        Operand::Step(at) => of_legs[at],
    }
}

fn of_legs(program: &Program, strides: &[usize]) -> Vec<bool> {
    let mut found: Vec<bool> = Vec::with_capacity(program.steps.len());
    for step in &program.steps {
        let operands = step.operation.operands();
        let own = operands.iter().any(|o| is_of_leg(*o, strides, &found));
        found.push(own);
    }
    found
}

/// A program in which steps that depend on the elements of one input alone are elements of it themselves.
#[derive(Debug)]
pub(crate) struct Folded {
    /// The program.
    pub(crate) program: Program,
    /// What each element of the input is: an element or a step of the program before.
    pub(crate) elements: Vec<Operand>,
}

/// Folds what depends on the elements of the input `array` alone.
pub(crate) fn fold(program: &Program, array: usize) -> Folded {
    let mut folding = Folding {
        array,
        elements: Vec::new(),
        places: Vec::with_capacity(program.steps.len()),
        steps: Vec::new(),
    };
    for (at, step) in program.steps.iter().enumerate() {
        let operands = step.operation.operands();
        let is_constant = operands.iter().all(|operand| folding.is_constant(*operand));
        let place = if is_constant {
            Place::Constant(at)
        } else {
            let operation = folding.operation(step.operation);
            folding.steps.push(Step {
                operation,
                ..step.clone()
            });
            Place::Step(folding.steps.len() - 1)
        };
        folding.places.push(place);
    }
    let mut folded = program.clone();
    for entry in &mut folded.entries {
        entry.operand = folding.operand(entry.operand);
    }
    for guard in &mut folded.guards {
        guard.operand = folding.operand(guard.operand);
    }
    folded.steps = folding.steps;
    folded.inputs[array].shape = vec![folding.elements.len()];
    Folded {
        program: folded,
        elements: folding.elements,
    }
}

/// Where a step has gone.
#[derive(Debug, Clone, Copy)]
enum Place {
    Step(usize),
    /// It is the value of this step of the program before, and an element once something needs it.
    Constant(usize),
}

struct Folding {
    array: usize,
    elements: Vec<Operand>,
    places: Vec<Place>,
    steps: Vec<Step>,
}

impl Folding {
    fn is_constant(&self, operand: Operand) -> bool {
        match operand {
            Operand::Constant(_) => true,
            Operand::Input { array, .. } => array == self.array,
            Operand::Step(at) => matches!(self.places[at], Place::Constant(_)),
        }
    }

    fn operand(&mut self, operand: Operand) -> Operand {
        match operand {
            Operand::Input { array, .. } if array == self.array => self.element(operand),
            Operand::Step(at) => match self.places[at] {
                Place::Step(to) => Operand::Step(to),
                Place::Constant(step) => self.element(Operand::Step(step)),
            },
            other => other,
        }
    }

    fn element(&mut self, of: Operand) -> Operand {
        let known = self.elements.iter().position(|element| *element == of);
        let index = known.unwrap_or_else(|| {
            self.elements.push(of);
            self.elements.len() - 1
        });
        Operand::Input {
            array: self.array,
            index,
        }
    }

    fn operation(&mut self, operation: Operation) -> Operation {
        use Operation::{Add, Atan2, Cosine, Div, Mul, Neg, Sign, Signed, Sine, Sqrt, Sub};
        let mut to = |operand| self.operand(operand);
        match operation {
            Add(a, b) => Add(to(a), to(b)),
            Sub(a, b) => Sub(to(a), to(b)),
            Mul(a, b) => Mul(to(a), to(b)),
            Div(a, b) => Div(to(a), to(b)),
            Signed(a, b) => Signed(to(a), to(b)),
            Atan2(a, b) => Atan2(to(a), to(b)),
            Neg(a) => Neg(to(a)),
            Sqrt(a) => Sqrt(to(a)),
            Sine(a) => Sine(to(a)),
            Cosine(a) => Cosine(to(a)),
            Sign(a) => Sign(to(a)),
        }
    }
}
