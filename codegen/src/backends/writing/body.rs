//! The body of a function as assignments and results, independent of a language.
//!
//! A value without a name that is used once is written inline, as long as the expression stays
//! short. All other values are assignments with one of the [`names`](super::names). Each language
//! has its own rules for reserved names and for the format of expressions.

use super::angles;
use super::labels::Labels;
use super::names::Names;
use super::output_ranges::{OutputRange, OutputRanges};
use super::statement::{Call, Expression, Operator, SineCosinePair, Statement};
use crate::lowering::{Entry, Operand, Operation, Program, schedule_min_live};
use std::collections::{BTreeMap, HashMap, HashSet};

/// Largest number of operations in one expression.
const LONGEST: usize = 10;

/// A named constant of a body.
#[derive(Debug, Clone, PartialEq)]
pub struct Constant {
    /// The name.
    pub name: String,
    /// The value.
    pub value: f64,
    /// Its expression in the description's names.
    pub expression: String,
}

/// A function's body.
#[derive(Debug, Clone, PartialEq)]
pub struct Body {
    /// Constants in the body, sorted by name.
    pub constants: Vec<Constant>,
    /// The assignments and conditions.
    pub statements: Vec<Statement>,
    /// The output, row-major; empty if statements write it.
    pub output: Vec<Expression>,
    /// Starts of sections: the first name of the first assignment, and the section's heading.
    pub sections: Vec<(String, String)>,
    /// All assigned names, in the order of the program's steps.
    pub names: Vec<String>,
}

impl Body {
    /// Statements and values of a program, with labels of its inputs and outputs.
    ///
    /// Names that are `reserved` are not used.
    #[must_use]
    pub fn write(program: &Program, labels: &Labels, reserved: &dyn Fn(&str) -> bool) -> Self {
        Self::write_with(program, labels, reserved, &|_| false)
    }

    /// The same with a statement that writes each number of the output as soon as it is known, in
    /// an order with few live values.
    #[must_use]
    pub fn placed(program: &Program, labels: &Labels, reserved: &dyn Fn(&str) -> bool) -> Self {
        let program = schedule_min_live(program);
        let mut writer = Writer::new(&program, labels, reserved, &|_| false);
        writer.output_ranges = Some(OutputRanges::new(&program));
        writer.write_known_output();
        writer.steps();
        writer.body(Vec::new())
    }

    /// The same, with a name for each step that is `kept`, however short.
    #[must_use]
    pub fn write_with(
        program: &Program,
        labels: &Labels,
        reserved: &dyn Fn(&str) -> bool,
        kept: &dyn Fn(usize) -> bool,
    ) -> Self {
        let mut writer = Writer::new(program, labels, reserved, kept);
        writer.steps();
        let output = writer.output();
        writer.body(output)
    }
}

/// An expression and its number of operations.
#[derive(Debug, Clone)]
struct SizedExpression {
    expression: Expression,
    size: usize,
}

/// State of writing a program's body.
struct Writer<'p> {
    program: &'p Program,
    naming: Names<'p>,
    labels: &'p Labels,
    reserved: &'p dyn Fn(&str) -> bool,
    kept: &'p dyn Fn(usize) -> bool,
    constants: BTreeMap<String, Constant>,
    sections: Vec<(String, String)>,
    names: Vec<Option<String>>,
    uses: Vec<usize>,
    inlined: Vec<Option<SizedExpression>>,
    statements: Vec<Statement>,
    taken: HashSet<String>,
    /// Names of the input elements that are bound to a name.
    bound: HashMap<(usize, usize), String>,
    /// Section of the step that is being written.
    section: String,
    /// Steps that are already written.
    written: Vec<bool>,
    /// Number of guards written.
    guarded: usize,
    /// Output elements of each step, if statements write the output.
    output_ranges: Option<OutputRanges>,
}

impl<'p> Writer<'p> {
    /// A writer for a program, with nothing written yet.
    fn new(
        program: &'p Program,
        labels: &'p Labels,
        reserved: &'p dyn Fn(&str) -> bool,
        kept: &'p dyn Fn(usize) -> bool,
    ) -> Self {
        let count = program.steps.len();
        Self {
            program,
            naming: Names::new(program, labels),
            labels,
            reserved,
            kept,
            constants: BTreeMap::new(),
            sections: Vec::new(),
            names: vec![None; count],
            uses: program.uses(),
            inlined: vec![None; count],
            statements: Vec::new(),
            taken: program.inputs.iter().map(|a| a.name.clone()).collect(),
            bound: HashMap::new(),
            section: String::new(),
            written: vec![false; count],
            guarded: 0,
            output_ranges: None,
        }
    }

    /// Writes all steps.
    fn steps(&mut self) {
        self.angles(&angles::early(self.program));
        let mut at = 0;
        while at < self.program.steps.len() {
            let count = self.step(at);
            (at..at + count).for_each(|at| self.write_output_of(at));
            at += count;
        }
    }

    /// The finished body.
    fn body(self, output: Vec<Expression>) -> Body {
        Body {
            constants: self.constants.into_values().collect(),
            statements: self.statements,
            output,
            sections: sections(&self.sections),
            names: self.names.into_iter().flatten().collect(),
        }
    }

    /// Writes the output elements that need no step.
    fn write_known_output(&mut self) {
        let known = self.output_ranges.as_mut().map(OutputRanges::take_known);
        for (range, entry) in known.unwrap_or_default() {
            self.write_range(range, entry);
        }
    }

    /// Writes the output elements that a step computes.
    fn write_output_of(&mut self, step: usize) {
        let ranges = self.output_ranges.as_mut();
        let own = ranges.map(|ranges| ranges.take_of_step(step));
        for (range, entry) in own.unwrap_or_default() {
            self.write_range(range, entry);
        }
    }

    fn write_range(&mut self, OutputRange { row, columns }: OutputRange, entry: Entry) {
        let value = self.entry(entry);
        self.statements.push(Statement::Output {
            row,
            columns,
            value,
        });
    }

    fn entry(&mut self, entry: Entry) -> Expression {
        let value = self.operand(entry.operand).expression;
        if entry.negative {
            Expression::Negative(Box::new(value))
        } else {
            value
        }
    }

    /// Writes the sines and cosines of angles that depend on inputs alone.
    fn angles(&mut self, early: &angles::Early) {
        if early.pairs.is_empty() {
            return;
        }
        for &at in &early.steps {
            self.step(at);
            self.written[at] = true;
        }
        let first = self.sections.len();
        let mut pairs = Vec::new();
        for pair in &early.pairs {
            let angle = self.operand(pair.angle).expression;
            let mut name = |step: Option<usize>| {
                let at = step?;
                self.written[at] = true;
                Some(self.declare(at))
            };
            let (sine, cosine) = (name(pair.sine), name(pair.cosine));
            pairs.push(SineCosinePair {
                angle,
                sine,
                cosine,
            });
        }
        self.statements.push(Statement::Pairs(pairs));
        // They belong to all legs at once.
        for (_, section) in &mut self.sections[first..] {
            "sines and cosines".clone_into(section);
        }
        self.guards();
    }

    /// Writes step `at`; returns how many steps were written.
    fn step(&mut self, at: usize) -> usize {
        if self.written[at] {
            return 1;
        }
        self.section.clone_from(&self.program.steps[at].scope);
        if let Some(angle) = self.pair(at) {
            return self.sine_and_cosine(at, angle);
        }
        let text = self.text(self.program.steps[at].operation);
        let named = self.program.steps[at].name.is_some() || (self.kept)(at);
        let guards = &self.program.guards;
        let guarded = guards.iter().any(|g| g.operand == Operand::Step(at));
        if self.uses[at] == 1 && !named && !guarded && text.size < LONGEST {
            self.inlined[at] = Some(text);
        } else {
            let name = self.declare(at);
            self.statements.push(Statement::Assign {
                name,
                value: text.expression,
            });
        }
        self.guards();
        1
    }

    /// The angle, if steps `at` and `at + 1` are its cosine and sine in any order.
    fn pair(&self, at: usize) -> Option<Operand> {
        let operation = |i: usize| self.program.steps.get(i).map(|s| s.operation);
        match (operation(at)?, operation(at + 1)?) {
            (Operation::Cosine(a), Operation::Sine(b))
            | (Operation::Sine(a), Operation::Cosine(b))
                if a == b =>
            {
                Some(a)
            }
            _ => None,
        }
    }

    fn sine_and_cosine(&mut self, at: usize, angle: Operand) -> usize {
        let angle = self.operand(angle).expression;
        let (first, second) = (self.declare(at), self.declare(at + 1));
        let cosine_first = matches!(self.program.steps[at].operation, Operation::Cosine(_));
        let (sine, cosine) = if cosine_first {
            (second, first)
        } else {
            (first, second)
        };
        self.statements.push(Statement::Pair(SineCosinePair {
            angle,
            sine: Some(sine),
            cosine: Some(cosine),
        }));
        self.guards();
        2
    }

    /// Writes the guards whose values are known, in their order.
    ///
    /// If several legs fail at once the first is reported, whatever the order of their values.
    fn guards(&mut self) {
        let program = self.program;
        while let Some(guard) = program.guards.get(self.guarded) {
            if let Operand::Step(at) = guard.operand
                && self.names[at].is_none()
            {
                return;
            }
            self.guarded += 1;
            let value = self.operand(guard.operand).expression;
            self.statements.push(Statement::Guard {
                value,
                condition: guard.condition.clone(),
            });
        }
    }

    /// A unique name for the value of a step.
    fn declare(&mut self, at: usize) -> String {
        let (taken, reserved) = (&self.taken, self.reserved);
        let is_free = |name: &str| !taken.contains(name) && !reserved(name);
        let name = self.naming.name(at, &is_free);
        self.taken.insert(name.clone());
        let section = &self.program.steps[at].scope;
        self.sections.push((name.clone(), section.clone()));
        self.names[at] = Some(name.clone());
        name
    }

    fn operand(&mut self, operand: Operand) -> SizedExpression {
        let expression = match operand {
            Operand::Constant(value) => self.constant(value),
            Operand::Input { array, index } => self.input(array, index),
            Operand::Step(at) => match (&self.names[at], self.inlined[at].take()) {
                (Some(name), _) => Expression::Value(name.clone()),
                (None, Some(text)) => return text,
                (None, None) => Expression::Broken("an operand is used before its step"),
            },
        };
        SizedExpression {
            expression,
            size: 0,
        }
    }

    /// An element of an input: by its own name if it is a parameter, which its first use assigns.
    fn input(&mut self, array: usize, index: usize) -> Expression {
        let element = Expression::Input { array, index };
        let Some(label) = self.labels.bound(array, index) else {
            return element;
        };
        let name = self.bound.get(&(array, index)).cloned();
        let name = name.unwrap_or_else(|| {
            let name = self.unique(&label.name());
            self.bound.insert((array, index), name.clone());
            self.sections.push((name.clone(), self.section.clone()));
            self.statements.push(Statement::Assign {
                name: name.clone(),
                value: element,
            });
            name
        });
        Expression::Value(name)
    }

    /// This name, or one with a suffix if it is taken; it is taken then.
    fn unique(&mut self, name: &str) -> String {
        let is_free = |name: &String| !self.taken.contains(name) && !(self.reserved)(name);
        let mut count = 1;
        let mut unique = name.to_owned();
        while !is_free(&unique) {
            count += 1;
            unique = format!("{name}_{count}");
        }
        self.taken.insert(unique.clone());
        unique
    }

    /// A number, or its named constant.
    fn constant(&mut self, value: f64) -> Expression {
        let known = self.labels.dimension(value.abs());
        let Some(dimension) = known.filter(|known| !(self.reserved)(&known.name)) else {
            return Expression::Number(value);
        };
        let name = dimension.name.clone();
        let constant = Constant {
            name: name.clone(),
            value: value.abs(),
            expression: dimension.expression.clone(),
        };
        self.constants.insert(name.clone(), constant);
        Expression::Constant {
            name,
            negative: value < 0.0,
        }
    }

    fn text(&mut self, operation: Operation) -> SizedExpression {
        match operation {
            Operation::Add(a, b) => self.binary(Operator::Add, a, b),
            Operation::Sub(a, b) => self.binary(Operator::Sub, a, b),
            Operation::Mul(a, b) => self.binary(Operator::Mul, a, b),
            Operation::Div(a, b) => self.binary(Operator::Div, a, b),
            Operation::Neg(a) => {
                let inner = self.operand(a);
                SizedExpression {
                    expression: Expression::Negative(Box::new(inner.expression)),
                    size: inner.size,
                }
            }
            Operation::Sqrt(a) => self.call(Call::Sqrt, &[a]),
            Operation::Sign(a) => self.call(Call::Sign, &[a]),
            Operation::Signed(a, b) => self.call(Call::Signed, &[a, b]),
            Operation::Atan2(y, x) => self.call(Call::Atan2, &[y, x]),
            // A sine without its cosine, or a cosine without its sine.
            Operation::Sine(a) => self.part(Call::Sine, a),
            Operation::Cosine(a) => self.part(Call::Cosine, a),
        }
    }

    fn binary(&mut self, operator: Operator, a: Operand, b: Operand) -> SizedExpression {
        let (a, b) = (self.operand(a), self.operand(b));
        SizedExpression {
            size: a.size + b.size + 1,
            expression: Expression::Binary(operator, Box::new([a.expression, b.expression])),
        }
    }

    fn call(&mut self, function: Call, operands: &[Operand]) -> SizedExpression {
        let operands: Vec<SizedExpression> = operands.iter().map(|&a| self.operand(a)).collect();
        let size = operands.iter().map(|a| a.size).sum::<usize>() + 1;
        let operands = operands.into_iter().map(|a| a.expression);
        SizedExpression {
            expression: Expression::Call(function, operands.collect()),
            size,
        }
    }

    fn part(&mut self, function: Call, angle: Operand) -> SizedExpression {
        let angle = self.operand(angle).expression;
        SizedExpression {
            expression: Expression::Call(function, vec![angle]),
            size: 1,
        }
    }

    fn output(&mut self) -> Vec<Expression> {
        let entries = self.program.entries.iter();
        entries.map(|&entry| self.entry(entry)).collect()
    }
}

/// Starts of sections, from the section of every assignment.
///
/// A few isolated assignments, for instance of values that a leg and the platform share, join the
/// section around them.
fn sections(assigned: &[(String, String)]) -> Vec<(String, String)> {
    const SHORTEST: usize = 4;
    let mut starts: Vec<(String, String)> = Vec::new();
    for run in assigned.chunk_by(|a, b| a.1 == b.1) {
        let (name, section) = &run[0];
        let is_other = starts.last().is_none_or(|(_, last)| last != section);
        if !section.is_empty() && is_other && (run.len() >= SHORTEST || starts.is_empty()) {
            starts.push((name.clone(), section.clone()));
        }
    }
    starts
}
