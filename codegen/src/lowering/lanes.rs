//! Programs of legs that are alike, side by side: what all share is computed once, what belongs to a leg in lanes
//! of vectors, a leg in each.
//!
//! The program is that of one leg and of what is shared. The numbers in which legs differ are an input of it,
//! [`Lanes::constants`]; what depends on these alone is a number itself, so it is computed here and not by the
//! generated code.

use super::program::{Array, Entry, Operand, Program, Step};

/// Where numbers of legs stand in a row.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct OfLegs {
    /// That of the first leg.
    pub first: usize,
    /// From one leg's to the next one's.
    pub stride: usize,
    /// The first so many legs have one; the column of another leg was eliminated.
    pub count: usize,
}

impl OfLegs {
    /// That of a leg, if it has one.
    #[must_use]
    pub fn of(self, leg: usize) -> Option<usize> {
        (leg < self.count).then_some(self.first + leg * self.stride)
    }
}

/// Where a column of the program stands among those of the function.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Column {
    /// It is shared by all legs, and stands here.
    Shared(usize),
    /// Legs have one each.
    OfLegs(OfLegs),
}

/// Whose the elements of an input are.
#[derive(Debug, Clone, PartialEq, Eq)]
pub enum Elements {
    /// All legs share them.
    Shared,
    /// The legs' constants, [`Lanes::constants`].
    Constants,
    /// So many of each leg, one leg after the other.
    InTurn(usize),
    /// Of each leg these of another input's; zero for legs that have none.
    Scattered {
        /// Which input.
        of: usize,
        /// For each element where it stands.
        places: Vec<OfLegs>,
    },
}

/// What becomes of the entries of a program in lanes.
#[derive(Debug, Clone, PartialEq)]
pub enum Gathered {
    /// They are columns of the function's output, row by row, that stand here in it.
    Columns(Vec<Column>),
    /// They are added up.
    Sums(Sums),
}

/// Sums over the legs, and what follows from them.
///
/// The entries are what a leg adds to each sum, what all share adds to it, and then rows of numbers of a leg that are
/// needed again.
#[derive(Debug, Clone, PartialEq)]
pub struct Sums {
    /// How many sums there are.
    pub count: usize,
    /// What follows from the sums, its first input: the function's output, or what the legs' rows are multiplied with.
    pub program: Program,
    /// The rows of each leg.
    pub rows: LegRows,
}

/// What the rows of legs are needed for.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum LegRows {
    /// There are none.
    None,
    /// So many of each leg. The function's output is each of them but for its last number times the program's output, and
    /// that number added to it.
    Times(usize),
    /// So many of each leg, which are the program's second input: each number that is not zero, of all legs.
    Given(usize),
}

impl Sums {
    /// The numbers of each row.
    #[must_use]
    pub fn width(&self) -> usize {
        self.program.entries.len() + 1
    }

    /// The entries of a program that a leg adds, that all share, and of rows.
    pub(crate) fn split<'e>(&self, entries: &'e [Entry]) -> [&'e [Entry]; 3] {
        let (own, rest) = entries.split_at(self.count);
        let (shared, rows) = rest.split_at(self.count);
        [own, shared, rows]
    }
}

/// Which lanes are faster than straight code.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Pays {
    /// Two and more.
    Always,
    /// Four and more: with fewer the straight program runs, which stands beside.
    WithFour,
}

impl Pays {
    /// How many lanes there have to be.
    #[must_use]
    pub const fn least(self) -> usize {
        match self {
            Self::Always => 2,
            Self::WithFour => 4,
        }
    }
}

/// A program of legs that are alike.
#[derive(Debug, Clone, PartialEq)]
pub struct Lanes {
    /// The program of one leg and of what is shared.
    pub program: Program,
    /// The function's output.
    pub output: Array,
    /// What becomes of the program's output.
    pub gathered: Gathered,
    /// Which lanes are faster than straight code.
    pub pays: Pays,
    /// The legs' names.
    pub legs: Vec<String>,
    /// Whose the elements of each input are.
    pub inputs: Vec<Elements>,
    /// What the legs' constants are, in words.
    pub names: Vec<String>,
    /// The values of the legs' constants, leg by leg.
    pub constants: Vec<Vec<f64>>,
    /// For each guard of the program, what its value is at home in each leg.
    pub homes: Vec<Vec<f64>>,
}

impl Lanes {
    /// For each step, whether it belongs to a leg.
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

    /// Whether an operand belongs to a leg, where `of_legs` says which steps do.
    #[must_use]
    pub fn is_of_leg(&self, operand: Operand, of_legs: &[bool]) -> bool {
        match operand {
            Operand::Constant(_) => false,
            Operand::Input { array, .. } => self.inputs[array] != Elements::Shared,
            Operand::Step(at) => of_legs[at],
        }
    }

    /// Operations that are done once, and those of each leg.
    #[must_use]
    pub fn operations(&self) -> (usize, usize) {
        let counted = self.program.steps.iter().zip(self.of_legs());
        let counted = counted.filter(|(step, _)| step.operation.is_counted());
        let (own, shared): (Vec<_>, Vec<_>) = counted.partition(|(_, own)| *own);
        let (shared, own) = (shared.len(), own.len());
        let Gathered::Sums(sums) = &self.gathered else {
            return (shared, own);
        };
        let is_there = |entry: &&Entry| !entry.is_zero();
        let [added, of_all, rows] = sums.split(&self.program.entries);
        let [added, of_all] = [added, of_all].map(|part| part.iter().filter(is_there).count());
        let products = match sums.rows {
            LegRows::None | LegRows::Given(_) => 0,
            LegRows::Times(of_leg) => {
                // A number of a row is one operation if it is added, two if it is multiplied before.
                let adding = rows.chunks(sums.width()).filter_map(<[Entry]>::last);
                let less = adding.filter(is_there).count() + of_leg;
                (rows.iter().filter(is_there).count() * 2).saturating_sub(less)
            }
        };
        let once = sums.program.cost().operations() + of_all;
        (shared + once, own + added + products)
    }
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
}

/// Puts elements of an input, those of the first of some legs, into an input of their own. `places` has of each element
/// where those of the legs stand; none if all legs share it.
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
