//! Names for the intermediate values of a function.
//!
//! Names from the derivation are kept. A value that is an entry of the output is named by its
//! column and row. Other values are named by their operands, as long as that stays short: `a_b` is
//! a product, `a_plus_b` and `a_minus_b` are sums, `a_per_b` is a quotient, `inv_a` a reciprocal,
//! `a_squared` a square, and `minus_a` a negative. All others are numbered within their section.

use super::labels::{Label, Labels};
use crate::lowering::{Operand, Operation, Program};
use std::collections::HashMap;

/// Longest name composed of operands' names.
const LONGEST: usize = 34;

/// The names of a function's steps.
pub struct Names<'p> {
    program: &'p Program,
    labels: &'p Labels,
    of_outputs: Vec<Option<String>>,
    /// Count of numbered values in each section.
    numbered: HashMap<String, usize>,
    /// Assigned names by step, with their kind.
    given: Vec<Option<Term>>,
}

/// A name as part of other names.
#[derive(Debug, Clone)]
struct Term {
    negative: bool,
    label: Label,
    kind: NameUse,
}

/// The composite names that a name can be part of.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
enum NameUse {
    /// All.
    Name,
    /// Products and sums.
    Product,
    /// None: it would need parentheses.
    Closed,
}

impl<'p> Names<'p> {
    /// No step has a name yet.
    #[must_use]
    pub fn new(program: &'p Program, labels: &'p Labels) -> Self {
        Self {
            program,
            labels,
            of_outputs: labels.of_outputs(program),
            numbered: HashMap::new(),
            given: vec![None; program.steps.len()],
        }
    }

    /// A name for a step's value; `is_free` tests whether a name is unused.
    pub fn name(&mut self, at: usize, is_free: &dyn Fn(&str) -> bool) -> String {
        let term = self.meaningful(at, is_free);
        match term {
            Some(term) => {
                let name = text(&term);
                self.given[at] = Some(term);
                name
            }
            None => self.number(at, is_free),
        }
    }

    fn meaningful(&self, at: usize, is_free: &dyn Fn(&str) -> bool) -> Option<Term> {
        let step = &self.program.steps[at];
        let own = step.name.iter().chain(&self.of_outputs[at]);
        let own = own.map(|name| self.term(name));
        let made = self.made(step.operation).into_iter();
        let made = made.filter(|term| text(term).len() <= LONGEST);
        own.chain(made).find(|term| is_free(&text(term)))
    }

    /// Splits a name into sign and label.
    fn term(&self, name: &str) -> Term {
        let positive = name.strip_prefix("minus_");
        Term {
            negative: positive.is_some(),
            label: self.labels.parsed(positive.unwrap_or(name)),
            kind: NameUse::Name,
        }
    }

    fn number(&mut self, at: usize, is_free: &dyn Fn(&str) -> bool) -> String {
        let section = self.program.steps[at].scope.clone();
        loop {
            let count = self.numbered.entry(section.clone()).or_default();
            *count += 1;
            let name = if section.is_empty() {
                format!("t{count}")
            } else {
                format!("t{count}_{section}")
            };
            if is_free(&name) {
                return name;
            }
        }
    }

    /// The name of an operand; `None` if it has none.
    fn operand(&self, operand: Operand) -> Option<Term> {
        match operand {
            Operand::Constant(value) => {
                let name = match value.abs() {
                    0.5 => "half",
                    2.0 => "twice",
                    size => &self.labels.dimension(size)?.name,
                };
                Some(Term {
                    negative: value < 0.0,
                    label: Label {
                        what: name.to_lowercase(),
                        place: String::new(),
                    },
                    kind: NameUse::Name,
                })
            }
            Operand::Input { array, index } => Some(Term {
                negative: false,
                label: self.labels.input(array, index)?.clone(),
                kind: NameUse::Name,
            }),
            // An inlined value has no name of its own, but its operands may have.
            Operand::Step(at) => match &self.given[at] {
                Some(term) => Some(term.clone()),
                None => self.made(self.program.steps[at].operation),
            },
        }
    }

    /// A name composed of the operands' names.
    fn made(&self, operation: Operation) -> Option<Term> {
        match operation {
            Operation::Add(a, b) if a == b => self.prefixed("twice", a),
            Operation::Add(a, b) => self.sum(a, b, false),
            Operation::Sub(a, b) => self.sum(a, b, true),
            Operation::Mul(a, b) if a == b => self.square(a),
            Operation::Mul(a, b) => self.product(a, b),
            Operation::Div(Operand::Constant(1.0), a) => self.prefixed("inv", a),
            Operation::Div(a, b) => self.quotient(a, b),
            Operation::Neg(a) => self.factor(a).map(|term| Term {
                negative: !term.negative,
                ..term
            }),
            Operation::Sqrt(a) => self.of_positive("sqrt", a),
            Operation::Sign(a) => self.prefixed("sign", a),
            _ => None,
        }
    }

    /// An operand's name, if it can be part of a product.
    fn factor(&self, operand: Operand) -> Option<Term> {
        self.operand(operand)
            .filter(|term| term.kind != NameUse::Closed)
    }

    /// An operand's name, if it is not composite.
    fn whole(&self, operand: Operand) -> Option<Term> {
        self.operand(operand)
            .filter(|term| term.kind == NameUse::Name)
    }

    /// `what_a` for an odd function.
    fn prefixed(&self, what: &str, a: Operand) -> Option<Term> {
        let a = self.whole(a)?;
        let label = Label {
            what: format!("{what}_{}", a.label.what),
            ..a.label
        };
        Some(Term {
            label,
            kind: NameUse::Closed,
            ..a
        })
    }

    /// `what_a` for a function of a nonnegative value.
    fn of_positive(&self, what: &str, a: Operand) -> Option<Term> {
        self.prefixed(what, a).filter(|term| !term.negative)
    }

    fn square(&self, a: Operand) -> Option<Term> {
        let a = self.whole(a)?;
        Some(Term {
            negative: false,
            label: Label {
                what: format!("{}_squared", a.label.what),
                ..a.label
            },
            kind: NameUse::Product,
        })
    }

    fn product(&self, a: Operand, b: Operand) -> Option<Term> {
        let (a, b) = (self.factor(a)?, self.factor(b)?);
        // `half_a_b` for a × half b: numbers come first.
        let (first, second) = if matches!(b.label.what.as_str(), "half" | "twice") {
            (&b, &a)
        } else {
            (&a, &b)
        };
        Some(Term {
            negative: a.negative != b.negative,
            label: pair(&first.label, "_", &second.label),
            kind: NameUse::Product,
        })
    }

    fn quotient(&self, a: Operand, b: Operand) -> Option<Term> {
        let (a, b) = (self.factor(a)?, self.whole(b)?);
        Some(Term {
            negative: a.negative != b.negative,
            label: pair(&a.label, "_per_", &b.label),
            kind: NameUse::Closed,
        })
    }

    /// a ± b, with the positive one first. The sum of two negatives has no name.
    fn sum(&self, a: Operand, b: Operand, is_difference: bool) -> Option<Term> {
        let (a, mut b) = (self.factor(a)?, self.factor(b)?);
        b.negative ^= is_difference;
        let (first, word, second) = match (a.negative, b.negative) {
            (false, false) => (a, "_plus_", b),
            (false, true) => (a, "_minus_", b),
            (true, false) => (b, "_minus_", a),
            (true, true) => return None,
        };
        Some(Term {
            negative: false,
            label: pair(&first.label, word, &second.label),
            kind: NameUse::Closed,
        })
    }
}

/// The text of a name.
fn text(term: &Term) -> String {
    let name = term.label.name();
    if term.negative {
        format!("minus_{name}")
    } else {
        name
    }
}

/// Joins two names; a leg that both share, or that only one has, comes last.
fn pair(a: &Label, word: &str, b: &Label) -> Label {
    let place = if a.place.is_empty() {
        &b.place
    } else {
        &a.place
    };
    let shared = a.place == b.place || a.place.is_empty() || b.place.is_empty();
    if shared {
        Label {
            what: format!("{}{word}{}", a.what, b.what),
            place: place.clone(),
        }
    } else {
        Label {
            what: format!("{}{word}{}", a.name(), b.what),
            place: b.place.clone(),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::{Labels, Names};
    use crate::lowering::{Array, Operand, Operation, Program, Step};

    /// The names of the steps of a program on the inputs `a_leg`, `b_leg` and `c`.
    fn names(operations: &[Operation]) -> Vec<String> {
        let labels = Labels::of_input(&["a_leg", "b_leg", "c"], "leg");
        let step = |&operation: &Operation| Step {
            operation,
            name: None,
            scope: "leg".to_owned(),
        };
        let program = Program {
            least_torques: Vec::new(),
            inputs: vec![Array {
                name: "x".to_owned(),
                shape: vec![3],
            }],
            output: Array {
                name: "y".to_owned(),
                shape: vec![0],
            },
            entries: Vec::new(),
            steps: operations.iter().map(step).collect(),
            guards: Vec::new(),
            pieces: 0,
        };
        let mut naming = Names::new(&program, &labels);
        let mut taken: Vec<String> = Vec::new();
        for at in 0..operations.len() {
            let name = naming.name(at, &|name| !taken.iter().any(|t| t == name));
            taken.push(name);
        }
        taken
    }

    const A: Operand = Operand::Input { array: 0, index: 0 };
    const B: Operand = Operand::Input { array: 0, index: 1 };
    const C: Operand = Operand::Input { array: 0, index: 2 };
    const HALF: Operand = Operand::Constant(0.5);
    const OTHER: Operand = Operand::Constant(0.123);

    #[test]
    fn names_are_composed_of_operand_names() {
        use Operation::{Add, Div, Mul, Neg, Sqrt, Sub};
        let made = names(&[
            Mul(A, B),
            Add(A, C),
            Sub(B, A),
            Mul(A, A),
            Div(Operand::Constant(1.0), A),
            Div(C, B),
            Add(C, C),
            Mul(A, HALF),
            Neg(B),
            Sqrt(A),
        ]);
        let wanted = [
            "a_b_leg",
            "a_plus_c_leg",
            "b_minus_a_leg",
            "a_squared_leg",
            "inv_a_leg",
            "c_per_b_leg",
            "twice_c",
            "half_a_leg",
            "minus_b_leg",
            "sqrt_a_leg",
        ];
        assert_eq!(made, wanted);
    }

    #[test]
    fn negated_operands_keep_their_sign_in_names() {
        use Operation::{Add, Mul, Neg, Sub};
        let step = Operand::Step;
        let made = names(&[
            Neg(A),
            Mul(step(0), B),
            Mul(step(0), step(1)),
            Add(step(0), C),
            Sub(C, step(0)),
            Mul(step(0), step(0)),
        ]);
        let wanted = [
            "minus_a_leg",
            "minus_a_b_leg",
            "a_a_b_leg",
            "c_minus_a_leg",
            "c_plus_a_leg",
            "a_squared_leg",
        ];
        assert_eq!(made, wanted);
    }

    #[test]
    fn nested_and_unnamed_values_are_numbered() {
        use Operation::{Add, Div, Mul, Sub};
        let step = Operand::Step;
        let made = names(&[
            Add(A, B),
            Mul(step(0), C),
            Div(A, C),
            Mul(step(2), B),
            Mul(OTHER, A),
            Sub(A, B),
            Sub(A, B),
        ]);
        let wanted = [
            "a_plus_b_leg",
            "t1_leg",
            "a_per_c_leg",
            "t2_leg",
            "t3_leg",
            "a_minus_b_leg",
            "t4_leg",
        ];
        assert_eq!(made, wanted);
    }
}
