//! Programs of equal legs in SIMD lanes: shared values are computed once, those of a leg in one
//! lane each.
//!
//! The program computes one leg and the shared values. The numbers by which legs differ are its
//! input [`Lanes::constants`]. Values that depend on these numbers alone are constants themselves,
//! so they are computed here and not by the generated code.

use super::program::{Array, Entry, Operand, Program, Step};

/// Positions of the legs' numbers in an array.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct OfLegs {
    /// Position of the first leg's number.
    pub first: usize,
    /// Distance from one leg's number to the next.
    pub stride: usize,
    /// Number of legs that have one; columns of later legs were eliminated.
    pub count: usize,
}

impl OfLegs {
    /// Position of a leg's number, if the leg has one.
    #[must_use]
    pub fn of(self, leg: usize) -> Option<usize> {
        (leg < self.count).then_some(self.first + leg * self.stride)
    }
}

/// Position of a column of the program among those of the function.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Column {
    /// Shared by all legs, at this position.
    Shared(usize),
    /// One column per leg.
    OfLegs(OfLegs),
}

/// Ownership of the elements of an input.
#[derive(Debug, Clone, PartialEq, Eq)]
pub enum Elements {
    /// Shared by all legs.
    Shared,
    /// The legs' constants, [`Lanes::constants`].
    Constants,
    /// This many for each leg, one leg after the other.
    InTurn(usize),
    /// Elements of another input for each leg; zero for legs that have none.
    Scattered {
        /// Index of the other input.
        of: usize,
        /// Positions of each element.
        places: Vec<OfLegs>,
    },
}

/// Use of the entries of a program in lanes.
#[derive(Debug, Clone, PartialEq)]
pub enum LaneOutput {
    /// Columns of the function's output, row by row, at these positions.
    Columns(Vec<Column>),
    /// Terms of sums over the legs.
    Sums(Sums),
}

/// Sums over the legs, and the output computed from them.
///
/// The entries are a leg's contributions to each sum, then the shared contributions, and then rows
/// of a leg's numbers that are used again.
#[derive(Debug, Clone, PartialEq)]
pub struct Sums {
    /// Number of sums.
    pub count: usize,
    /// Program with the sums as its first input.
    ///
    /// It computes the function's output, or the factor of the legs' rows.
    pub program: Program,
    /// Rows of each leg.
    pub rows: LegRows,
}

/// Use of the legs' rows.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum LegRows {
    /// No rows.
    None,
    /// This many for each leg; each gives one number of the function's output.
    ///
    /// That number is the row without its last element times the program's output, plus the last
    /// element.
    Times(usize),
    /// This many for each leg: the program's second input, with each nonzero number for all legs.
    Given(usize),
}

impl Sums {
    /// Length of each row.
    #[must_use]
    pub fn width(&self) -> usize {
        self.program.entries.len() + 1
    }

    /// Splits the entries of a program: contributions of a leg, shared contributions, and rows.
    pub(crate) fn split<'e>(&self, entries: &'e [Entry]) -> [&'e [Entry]; 3] {
        let (own, rest) = entries.split_at(self.count);
        let (shared, rows) = rest.split_at(self.count);
        [own, shared, rows]
    }
}

/// Numbers of lanes with which the program is faster than straight code.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Profitable {
    /// Two and more.
    Always,
    /// Four and more; with fewer the straight program runs, which is generated, too.
    WithFour,
}

impl Profitable {
    /// The smallest such number of lanes.
    #[must_use]
    pub const fn least(self) -> usize {
        match self {
            Self::Always => 2,
            Self::WithFour => 4,
        }
    }
}

/// A program of equal legs in SIMD lanes.
#[derive(Debug, Clone, PartialEq)]
pub struct Lanes {
    /// The program of one leg and of the shared values.
    pub program: Program,
    /// The function's output.
    pub output: Array,
    /// Use of the program's output.
    pub gathered: LaneOutput,
    /// Numbers of lanes with which the program is faster than straight code.
    pub pays: Profitable,
    /// Names of the legs.
    pub legs: Vec<String>,
    /// Ownership of the elements of each input.
    pub inputs: Vec<Elements>,
    /// Descriptions of the legs' constants.
    pub names: Vec<String>,
    /// Values of the legs' constants, leg by leg.
    pub constants: Vec<Vec<f64>>,
    /// For each guard of the program, the magnitude of its value at home in each leg.
    pub homes: Vec<Vec<f64>>,
}

impl Lanes {
    /// For each step, whether it depends on the leg.
    #[must_use]
    pub fn of_legs(&self) -> Vec<bool> {
        let mut found: Vec<bool> = Vec::with_capacity(self.program.steps.len());
        for step in &self.program.steps {
            let operands = step.operation.operands();
            let own = operands.iter().any(|o| self.is_of_leg(*o, &found));
            found.push(own);
        }
        found
    }

    /// Whether an operand depends on the leg, given `of_legs` for the steps.
    #[must_use]
    pub fn is_of_leg(&self, operand: Operand, of_legs: &[bool]) -> bool {
        match operand {
            Operand::Constant(_) => false,
            Operand::Input { array, .. } => self.inputs[array] != Elements::Shared,
            Operand::Step(at) => of_legs[at],
        }
    }

    /// Number of shared operations and of operations per leg.
    #[must_use]
    pub fn operations(&self) -> (usize, usize) {
        let counted = self.program.steps.iter().zip(self.of_legs());
        let counted = counted.filter(|(step, _)| step.operation.is_counted());
        let (own, shared): (Vec<_>, Vec<_>) = counted.partition(|(_, own)| *own);
        let (shared, own) = (shared.len(), own.len());
        let LaneOutput::Sums(sums) = &self.gathered else {
            return (shared, own);
        };
        let is_there = |entry: &&Entry| !entry.is_zero();
        let [added, of_all, rows] = sums.split(&self.program.entries);
        let [added, of_all] = [added, of_all].map(|part| part.iter().filter(is_there).count());
        let products = match sums.rows {
            LegRows::None | LegRows::Given(_) => 0,
            LegRows::Times(of_leg) => {
                // A number of a row takes one operation if it is added, two if it is multiplied
                // first.
                let adding = rows.chunks(sums.width()).filter_map(<[Entry]>::last);
                let less = adding.filter(is_there).count() + of_leg;
                (rows.iter().filter(is_there).count() * 2).saturating_sub(less)
            }
        };
        let once = sums.program.cost().operations() + of_all;
        (shared + once, own + added + products)
    }
}

/// A program whose steps that depend on one input alone are replaced by elements of that input.
#[derive(Debug)]
pub(crate) struct Folded {
    /// The program.
    pub(crate) program: Program,
    /// Each element of the input, as an element or a step of the original program.
    pub(crate) elements: Vec<Operand>,
}

/// Folds steps that depend on elements of the input `array` alone.
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
            let operation = step.operation.map(|operand| folding.operand(operand));
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

/// New place of a step.
#[derive(Debug, Clone, Copy)]
enum Place {
    Step(usize),
    /// The value of this step of the original program; it becomes an element if it is needed.
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
}

/// Moves elements of the first leg to an input of their own.
///
/// `places` has the positions of the legs' elements for each element; `None` if all legs share it.
pub(crate) fn scatter(program: &mut Program, of: usize, places: &[Option<OfLegs>]) -> Elements {
    let mut found: Vec<OfLegs> = Vec::new();
    let own = program.inputs.len();
    program.replace(|operand| {
        let Operand::Input { array, index } = operand else {
            return operand;
        };
        let place = places.get(index).copied().flatten();
        let Some(place) = place.filter(|_| array == of) else {
            return operand;
        };
        let known = found.iter().position(|other| *other == place);
        let index = known.unwrap_or_else(|| {
            found.push(place);
            found.len() - 1
        });
        Operand::Input { array: own, index }
    });
    program.inputs.push(Array {
        name: format!("own_{}", program.inputs[of].name),
        shape: vec![found.len()],
    });
    Elements::Scattered { of, places: found }
}
