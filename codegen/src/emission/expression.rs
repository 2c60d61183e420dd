//! The body of a function: assignments and results as tokens.
//!
//! A value that is used once and has no name is written where it is used, as long as the expression
//! stays short; every other value is a `let` with one of the [`names`](super::names).

use super::angles;
use super::labels::Labels;
use super::names::Names;
use crate::lowering::{Condition, Operand, Operation, Program};
use overact_core::ActuatorGroup;
use proc_macro2::{Ident, Literal, Span, TokenStream};
use quote::quote;
use std::collections::{BTreeMap, HashSet};

/// Operations that one expression may hold.
const LONGEST: usize = 10;

/// How tightly an expression binds: sums, products, atoms.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord)]
enum Binding {
    Sum,
    Product,
    Atom,
}

struct Text {
    tokens: TokenStream,
    binding: Binding,
    size: usize,
}

impl Text {
    fn atom(tokens: TokenStream) -> Self {
        Self {
            tokens,
            binding: Binding::Atom,
            size: 0,
        }
    }

    /// The tokens, in parentheses if the context binds more tightly.
    fn within(&self, binding: Binding) -> TokenStream {
        let tokens = &self.tokens;
        if self.binding < binding {
            quote!((#tokens))
        } else {
            quote!(#tokens)
        }
    }
}

/// A function's body.
pub struct Written {
    /// The assignments.
    pub statements: TokenStream,
    /// The output.
    pub value: TokenStream,
    /// Where a section begins: the first name of its first assignment, and the section's.
    pub sections: Vec<(String, String)>,
    /// All names that are assigned.
    pub names: Vec<String>,
}

/// Writes the body of a program: statements and the value of its output.
pub struct Body<'p> {
    program: &'p Program,
    naming: Names<'p>,
    labels: &'p Labels,
    /// Named constants that the body uses: value and expression by name.
    dimensions: BTreeMap<String, (f64, String)>,
    sections: Vec<(String, String)>,
    names: Vec<Option<Ident>>,
    uses: Vec<usize>,
    inlined: Vec<Option<Text>>,
    statements: TokenStream,
    taken: HashSet<String>,
    /// Steps that are written before their turn.
    written: Vec<bool>,
    /// How many guards are written.
    guarded: usize,
}

impl<'p> Body<'p> {
    /// Statements and value of a program whose inputs and outputs have these labels.
    #[must_use]
    pub fn write(program: &'p Program, labels: &'p Labels) -> Written {
        let taken = program.inputs.iter().map(|a| a.name.clone()).collect();
        let count = program.steps.len();
        let mut body = Self {
            program,
            naming: Names::new(program, labels),
            labels,
            dimensions: BTreeMap::new(),
            sections: Vec::new(),
            names: vec![None; count],
            uses: program.uses(),
            inlined: (0..count).map(|_| None).collect(),
            statements: TokenStream::new(),
            taken,
            written: vec![false; count],
            guarded: 0,
        };
        let mut at = 0;
        body.angles(&angles::early(program));
        while at < count {
            at += body.step(at);
        }
        let value = body.output();
        let names = body.names.iter().flatten().map(ToString::to_string);
        let (constants, statements) = (body.constants(), &body.statements);
        Written {
            names: names.collect(),
            statements: quote!(#constants #statements),
            value,
            sections: sections(&body.sections),
        }
    }

    /// Writes the sines and cosines of angles that are known from the start.
    fn angles(&mut self, early: &angles::Early) {
        if early.pairs.is_empty() {
            return;
        }
        for &at in &early.steps {
            self.step(at);
            self.written[at] = true;
        }
        let first = self.sections.len();
        let mut names = Vec::new();
        let mut values = Vec::new();
        for pair in &early.pairs {
            values.push(self.operand(pair.angle).tokens);
            let mut name = |step: Option<usize>| match step {
                Some(at) => {
                    self.written[at] = true;
                    let name = self.declare(at);
                    quote!(#name)
                }
                None => quote!(_),
            };
            let (sine, cosine) = (name(pair.sine), name(pair.cosine));
            names.push(quote!((#sine, #cosine)));
        }
        self.statements
            .extend(quote!(let [#(#names),*] = ::overact::math::sin_cos_all([#(#values),*]);));
        // They are of all legs at once.
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
        if let Some(angle) = self.pair(at) {
            return self.sine_and_cosine(at, angle);
        }
        let text = self.text(self.program.steps[at].operation);
        let named = self.program.steps[at].name.is_some();
        let guarded = self
            .program
            .guards
            .iter()
            .any(|g| g.operand == Operand::Step(at));
        if self.uses[at] == 1 && !named && !guarded && text.size < LONGEST {
            self.inlined[at] = Some(text);
        } else {
            let name = self.declare(at);
            let tokens = text.tokens;
            self.statements.extend(quote!(let #name = #tokens;));
        }
        self.guards();
        1
    }

    /// The angle, if steps `at` and `at + 1` are its cosine and sine in whatever order.
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
        let angle = self.operand(angle).tokens;
        let (first, second) = (self.declare(at), self.declare(at + 1));
        let cosine_first = matches!(self.program.steps[at].operation, Operation::Cosine(_));
        let (sine, cosine) = if cosine_first {
            (second, first)
        } else {
            (first, second)
        };
        self.statements
            .extend(quote!(let (#sine, #cosine) = ::overact::math::sin_cos(#angle);));
        self.guards();
        2
    }

    /// Writes the guards whose values are there, each behind those before it: of several legs that fail at
    /// once the first is told, in whichever order their values come.
    fn guards(&mut self) {
        let program = self.program;
        while let Some(guard) = program.guards.get(self.guarded) {
            if let Operand::Step(at) = guard.operand
                && self.names[at].is_none()
            {
                return;
            }
            self.guarded += 1;
            let value = self.operand(guard.operand).tokens;
            self.statements.extend(match &guard.condition {
                Condition::Reach { leg } => quote!(::overact::guard::reach(#value, #leg)?;),
                Condition::Leg { leg, home } => {
                    let home = number(*home);
                    quote!(::overact::guard::leg(#value, #home, #leg)?;)
                }
                Condition::Mass => quote!(::overact::guard::mass(#value)?;),
                Condition::Platform { actuators, home } => {
                    let home = number(*home);
                    let actuators = match actuators {
                        ActuatorGroup::All => quote!(::overact::ActuatorGroup::All),
                        ActuatorGroup::Kept => quote!(::overact::ActuatorGroup::Kept),
                    };
                    quote!(::overact::guard::platform(#value, #home, #actuators)?;)
                }
            });
        }
    }

    /// A name for the value of a step that no other value has.
    fn declare(&mut self, at: usize) -> Ident {
        let name = self.naming.name(at, &|name| !self.taken.contains(name));
        self.taken.insert(name.clone());
        let section = &self.program.steps[at].scope;
        self.sections.push((name.clone(), section.clone()));
        let ident = Ident::new(&name, Span::call_site());
        self.names[at] = Some(ident.clone());
        ident
    }

    fn operand(&mut self, operand: Operand) -> Text {
        match operand {
            Operand::Constant(value) => {
                let literal = self.constant(value);
                let binding = if value < 0.0 {
                    Binding::Product
                } else {
                    Binding::Atom
                };
                Text {
                    tokens: literal,
                    binding,
                    size: 0,
                }
            }
            Operand::Input { array, index } => {
                let name = Ident::new(&self.program.inputs[array].name, Span::call_site());
                let index = Literal::usize_unsuffixed(index);
                Text::atom(quote!(#name[#index]))
            }
            Operand::Step(at) => match (&self.names[at], self.inlined[at].take()) {
                (Some(name), _) => Text::atom(quote!(#name)),
                (None, Some(text)) => text,
                (None, None) => Text::atom(internal_error("an operand is used before its step")),
            },
        }
    }

    /// A number, or the named constant that it is.
    fn constant(&mut self, value: f64) -> TokenStream {
        let Some(dimension) = self.labels.dimension(value.abs()) else {
            return number(value);
        };
        let name = Ident::new(&dimension.name, Span::call_site());
        let used = (value.abs(), dimension.expression.clone());
        self.dimensions.insert(dimension.name.clone(), used);
        match value < 0.0 {
            true => quote!(-#name),
            false => quote!(#name),
        }
    }

    /// The constants that the body uses.
    fn constants(&self) -> TokenStream {
        let constants = self.dimensions.iter().map(|(name, (value, expression))| {
            let (name, value) = (Ident::new(name, Span::call_site()), number(*value));
            let doc = format!(" {expression}");
            quote!(#[doc = #doc] const #name: ::core::primitive::f64 = #value;)
        });
        quote!(#(#constants)*)
    }

    fn text(&mut self, operation: Operation) -> Text {
        match operation {
            Operation::Add(a, b) => self.binary(a, b, &quote!(+), Binding::Sum, Binding::Sum),
            Operation::Sub(a, b) => self.binary(a, b, &quote!(-), Binding::Sum, Binding::Product),
            Operation::Mul(a, b) => self.binary(a, b, &quote!(*), Binding::Product, Binding::Atom),
            Operation::Div(a, b) => self.binary(a, b, &quote!(/), Binding::Product, Binding::Atom),
            Operation::Neg(a) => {
                let inner = self.operand(a);
                let tokens = inner.within(Binding::Atom);
                Text {
                    tokens: quote!(-#tokens),
                    binding: Binding::Product,
                    size: inner.size,
                }
            }
            Operation::Sqrt(a) => self.call(&quote!(sqrt), &[a]),
            Operation::Sign(a) => self.call(&quote!(sign), &[a]),
            Operation::Signed(a, b) => self.call(&quote!(signed), &[a, b]),
            Operation::Atan2(y, x) => self.call(&quote!(atan2), &[y, x]),
            // A sine without its cosine, or the other way round.
            Operation::Sine(a) => self.part(a, &quote!(0)),
            Operation::Cosine(a) => self.part(a, &quote!(1)),
        }
    }

    fn binary(
        &mut self,
        a: Operand,
        b: Operand,
        operator: &TokenStream,
        binding: Binding,
        right: Binding,
    ) -> Text {
        let (a, b) = (self.operand(a), self.operand(b));
        let (left, right) = (a.within(binding), b.within(right));
        Text {
            tokens: quote!(#left #operator #right),
            binding,
            size: a.size + b.size + 1,
        }
    }

    fn call(&mut self, function: &TokenStream, arguments: &[Operand]) -> Text {
        let arguments: Vec<Text> = arguments.iter().map(|&a| self.operand(a)).collect();
        let size = arguments.iter().map(|a| a.size).sum::<usize>() + 1;
        let tokens = arguments.iter().map(|a| &a.tokens);
        let tokens = quote!(::overact::math::#function(#(#tokens),*));
        Text {
            tokens,
            binding: Binding::Atom,
            size,
        }
    }

    fn part(&mut self, angle: Operand, index: &TokenStream) -> Text {
        let angle = self.operand(angle).tokens;
        Text {
            tokens: quote!(::overact::math::sin_cos(#angle).#index),
            binding: Binding::Atom,
            size: 1,
        }
    }

    fn output(&mut self) -> TokenStream {
        let values: Vec<TokenStream> = self
            .program
            .entries
            .iter()
            .map(|entry| {
                let text = self.operand(entry.operand);
                if entry.negative {
                    let inner = text.within(Binding::Atom);
                    quote!(-#inner)
                } else {
                    text.tokens
                }
            })
            .collect();
        match self.program.output.shape[..] {
            [_, columns] if columns > 0 => {
                let rows = values.chunks(columns).map(|row| quote!([#(#row),*]));
                quote!([#(#rows),*])
            }
            [rows, _] => {
                let rows = (0..rows).map(|_| quote!([]));
                quote!([#(#rows),*])
            }
            _ => quote!([#(#values),*]),
        }
    }
}

/// Where sections begin, from the section of every assignment. A few assignments on their own, of what a
/// leg and the platform share for instance, stand in the section around them.
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

/// What stands in the generated code where a program breaks a rule that lowering guarantees: nothing that
/// compiles, for a number that means nothing must not reach a user.
fn internal_error(what: &str) -> TokenStream {
    let message = format!(
        "internal error of overact {}: {what}; please report it with the robot's description",
        env!("CARGO_PKG_VERSION")
    );
    quote!(::core::compile_error!(#message))
}

/// A float that reads back as the same float.
#[must_use]
pub fn number(value: f64) -> TokenStream {
    if !value.is_finite() {
        return internal_error("a constant is not finite");
    }
    let literal = Literal::f64_unsuffixed(value.abs());
    if value < 0.0 {
        quote!(-#literal)
    } else {
        quote!(#literal)
    }
}

#[cfg(test)]
mod tests {
    use super::number;

    #[test]
    fn floats_read_back() {
        for value in [0.0, 1.0, -2.5, 0.1 + 0.2, 1e-300, f64::MAX] {
            let text = number(value).to_string().replace(' ', "");
            assert_eq!(
                text.parse::<f64>().map(f64::to_bits),
                Ok(value.to_bits()),
                "{text}"
            );
        }
    }

    #[test]
    fn a_number_that_means_nothing_does_not_compile() {
        for value in [f64::NAN, f64::INFINITY, f64::NEG_INFINITY] {
            let text = number(value).to_string();
            assert!(
                text.contains("compile_error") && text.contains("report"),
                "{text}"
            );
        }
    }
}
