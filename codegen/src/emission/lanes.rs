//! The body of a function whose legs run side by side in the lanes of vectors: what all share, then a loop over as
//! many legs at once as a vector holds.

use super::expression::{self, Writer, ident, number};
use super::layout::Sections;
use crate::float::Float;
use crate::lowering::{Column, Condition, Lanes, Operand};
use crate::model::{CompiledFunction, RobotModel};
use crate::writing::body::Body;
use crate::writing::labels::Labels;
use crate::writing::statement::{Expression, Pair, Statement};
use proc_macro2::{Literal, TokenStream};
use quote::quote;
use std::collections::HashSet;

/// A function's body, and what its item tells of it.
pub(super) struct Loop {
    /// The statements.
    pub(super) statements: TokenStream,
    /// The output.
    pub(super) value: TokenStream,
    /// Where sections begin.
    pub(super) sections: Sections,
    /// All names that are assigned.
    pub(super) names: Vec<String>,
}

/// The body of a function in lanes.
pub(super) fn write(model: &RobotModel, function: &CompiledFunction, lanes: &Lanes) -> Loop {
    let kept = between(lanes);
    let labels = Labels::new(model, function).in_lanes(lanes);
    let body = Body::write_with(&lanes.program, &labels, &|name| name == "at", &|at| {
        kept[at]
    });
    let mut split = Split {
        lanes,
        shared_writer: Writer::new(&lanes.program.inputs, Float::F64),
        own_writer: Writer::of_lanes(&lanes.program.inputs),
        own_names: HashSet::new(),
        shared: Vec::new(),
        own: Vec::new(),
        guards: 0,
    };
    for statement in &body.statements {
        split.statement(statement);
    }
    let constants = expression::constants(&body, Float::F64);
    let tables = tables(lanes);
    let arrays = arrays(lanes);
    let (of_all, of_legs) = split.output(&body.output);
    let (rows, columns) = (&lanes.output.shape[0], &lanes.output.shape[1]);
    let (rows, columns) = (unsuffixed(*rows), unsuffixed(*columns));
    let count = unsuffixed(lanes.legs.len());
    let (shared, own) = (&split.shared, &split.own);
    let statements = quote! {
        #constants
        #(#shared)*
        let mut output = [[0.0; #columns]; #rows];
        #(#of_all)*
        #tables
        for at in ::overact::lanes::places::<#count>() {
            #arrays
            #(#own)*
            #(#of_legs)*
        }
    };
    let (own, shared): (Vec<_>, Vec<_>) = body
        .sections
        .into_iter()
        .partition(|(name, _)| split.own_names.contains(name));
    Loop {
        statements,
        value: quote!(output),
        sections: Sections {
            function: function.name.clone(),
            starts: shared.into_iter().chain(own).collect(),
        },
        names: body.names,
    }
}

/// The steps that all legs share and that those of a leg need: each is computed once, in front of the loop.
fn between(lanes: &Lanes) -> Vec<bool> {
    let of_legs = lanes.of_legs();
    let mut kept = vec![false; of_legs.len()];
    let steps = lanes.program.steps.iter().zip(&of_legs);
    let of_own = steps.filter(|(_, own)| **own);
    let operands = of_own.flat_map(|(step, _)| step.operation.operands());
    for operand in operands {
        if let Operand::Step(at) = operand {
            kept[at] |= !of_legs[at];
        }
    }
    kept
}

/// The constants of the legs, their names, and the magnitudes at home of what is guarded.
fn tables(lanes: &Lanes) -> TokenStream {
    let count = unsuffixed(lanes.legs.len());
    let numbers = |values: Vec<f64>| {
        let numbers = values.into_iter().map(|value| number(value, Float::F64));
        quote!([#(#numbers),*])
    };
    let elements = lanes.program.inputs[lanes.array].len();
    let of_element = |at| lanes.constants.iter().map(|leg| leg[at]).collect();
    let constants = (0..elements).map(|at| numbers(of_element(at)));
    let rows = unsuffixed(elements);
    let legs = &lanes.legs;
    let homes = lanes.program.guards.iter().zip(&lanes.homes);
    let homes = homes.enumerate().filter_map(|(at, (guard, homes))| {
        let name = home(at);
        let homes = numbers(homes.clone());
        matches!(guard.condition, Condition::Leg { .. })
            .then(|| quote!(static #name: [::core::primitive::f64; #count] = #homes;))
    });
    quote! {
        static OF_LEG: [[::core::primitive::f64; #count]; #rows] = [#(#constants),*];
        static LEGS: [&::core::primitive::str; #count] = [#(#legs),*];
        #(#homes)*
    }
}

/// The arrays of which a leg has elements of its own.
fn arrays(lanes: &Lanes) -> TokenStream {
    let inputs = lanes.program.inputs.iter().enumerate();
    let inputs = inputs.filter(|(at, _)| lanes.strides[*at] > 0);
    let arrays = inputs.map(|(at, input)| {
        let name = ident(&input.name);
        let stride = unsuffixed(lanes.strides[at]);
        match at == lanes.array {
            true => quote!(let #name = ::overact::lanes::constants(&OF_LEG, at);),
            false => quote!(let #name = ::overact::lanes::elements::<#stride>(#name, at);),
        }
    });
    quote!(#(#arrays)*)
}

fn unsuffixed(number: usize) -> Literal {
    Literal::usize_unsuffixed(number)
}

/// The table of a guard's magnitudes at home.
fn home(guard: usize) -> proc_macro2::Ident {
    ident(&format!("HOME_{guard}"))
}

/// Statements, those that all legs share and those of a leg.
struct Split<'a> {
    lanes: &'a Lanes,
    shared_writer: Writer<'a>,
    own_writer: Writer<'a>,
    /// What is assigned of a leg.
    own_names: HashSet<String>,
    shared: Vec<TokenStream>,
    own: Vec<TokenStream>,
    /// How many guards were written.
    guards: usize,
}

impl Split<'_> {
    fn statement(&mut self, statement: &Statement) {
        match statement {
            Statement::Assign { name, value } => {
                let own = self.is_own(value);
                self.push(own, statement);
                if own {
                    self.own_names.insert(name.clone());
                }
            }
            Statement::Pair(pair) => self.pairs(std::slice::from_ref(pair)),
            Statement::Pairs(pairs) => self.pairs(pairs),
            Statement::Guard { value, condition } => {
                let at = self.guards;
                self.guards += 1;
                if self.is_own(value) {
                    let guard = self.guard(at, value, condition);
                    self.own.push(guard);
                } else {
                    self.push(false, statement);
                }
            }
        }
    }

    fn push(&mut self, own: bool, statement: &Statement) {
        if own {
            self.own.push(self.own_writer.statement(statement));
        } else {
            self.shared.push(self.shared_writer.statement(statement));
        }
    }

    fn pairs(&mut self, pairs: &[Pair]) {
        let (own, shared): (Vec<Pair>, Vec<Pair>) = pairs
            .iter()
            .cloned()
            .partition(|pair| self.is_own(&pair.angle));
        let names = own.iter().flat_map(|pair| [&pair.sine, &pair.cosine]);
        let names: Vec<String> = names.flatten().cloned().collect();
        self.own_names.extend(names);
        for (is_own, pairs) in [(false, shared), (true, own)] {
            if !pairs.is_empty() {
                self.push(is_own, &Statement::Pairs(pairs));
            }
        }
    }

    /// A condition in all lanes; of several legs the first is told.
    fn guard(&self, at: usize, value: &Expression, condition: &Condition) -> TokenStream {
        let value = self.own_writer.tokens(value);
        match condition {
            Condition::Reach { .. } => quote!(::overact::lanes::reach(#value, &LEGS, at)?;),
            Condition::Closed { within, .. } => {
                let within = number(*within, Float::F64);
                quote!(::overact::lanes::closed(#value, #within, &LEGS, at)?;)
            }
            _ => {
                let home = home(at);
                quote!(::overact::lanes::leg(#value, &#home, &LEGS, at)?;)
            }
        }
    }

    /// Whether an expression belongs to a leg.
    fn is_own(&self, expression: &Expression) -> bool {
        match expression {
            Expression::Number(_) | Expression::Constant { .. } | Expression::Broken(_) => false,
            Expression::Input { array, .. } => self.lanes.strides[*array] > 0,
            Expression::Value(name) => self.own_names.contains(name),
            Expression::Negative(inner) => self.is_own(inner),
            Expression::Binary(_, operands) => operands.iter().any(|o| self.is_own(o)),
            Expression::Call(_, operands) => operands.iter().any(|o| self.is_own(o)),
        }
    }

    /// What is written into the output: that of all, and that of the legs.
    fn output(&self, values: &[Expression]) -> (Vec<TokenStream>, Vec<TokenStream>) {
        let (mut of_all, mut of_legs) = (Vec::new(), Vec::new());
        let places = &self.lanes.columns;
        for (at, value) in values.iter().enumerate() {
            if matches!(value, Expression::Number(zero) if *zero == 0.0) {
                continue;
            }
            let row = unsuffixed(at / places.len());
            match places[at % places.len()] {
                Column::Shared(column) => {
                    let (column, value) = (unsuffixed(column), self.shared_writer.tokens(value));
                    of_all.push(quote!(output[#row][#column] = #value;));
                }
                Column::OfLegs { first, stride } => {
                    let (first, stride) = (unsuffixed(first), unsuffixed(stride));
                    let value = self.own_writer.tokens(value);
                    of_legs.push(quote! {
                        ::overact::lanes::put(&mut output[#row], [#first, #stride], at, #value);
                    });
                }
            }
        }
        (of_all, of_legs)
    }
}
