//! Splits statements of a program in lanes into shared ones and those of a leg.

use super::{Parts, home, unsuffixed};
use crate::backends::rust::expression::{Writer, ident, magnitude, number};
use crate::backends::writing::statement::{Expression, SineCosinePair, Statement};
use crate::float::Float;
use crate::lowering::{Column, Condition, Elements, Lanes, OfLegs};
use proc_macro2::{Literal, TokenStream};
use quote::quote;
use std::collections::HashSet;

/// Shared statements and those of a leg.
pub(super) struct Split<'a> {
    pub(super) lanes: &'a Lanes,
    pub(super) shared_writer: Writer<'a>,
    pub(super) own_writer: Writer<'a>,
    /// Names assigned per leg.
    pub(super) own_names: HashSet<String>,
    pub(super) shared: Vec<TokenStream>,
    pub(super) own: Vec<TokenStream>,
    /// Whether a leg may fail.
    pub(super) has_guards: bool,
    /// Number of guards written.
    guards: usize,
}

impl<'a> Split<'a> {
    /// An empty split.
    pub(super) fn new(lanes: &'a Lanes) -> Self {
        Self {
            lanes,
            shared_writer: Writer::wide(&lanes.program.inputs, Float::F64),
            own_writer: Writer::of_lanes(&lanes.program.inputs),
            own_names: HashSet::new(),
            shared: Vec::new(),
            own: Vec::new(),
            has_guards: false,
            guards: 0,
        }
    }

    pub(super) fn statement(&mut self, statement: &Statement) {
        match statement {
            Statement::Assign { name, value } => {
                let own = self.is_own(value);
                match self.scattered(value) {
                    Some(value) => {
                        let name = ident(name);
                        self.own.push(quote!(let #name = #value;));
                    }
                    None => self.push(own, statement),
                }
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
                    self.has_guards = true;
                    let guard = self.guard(at, value, condition);
                    self.own.push(guard);
                } else {
                    self.push(false, statement);
                }
            }
            // Columns are written to their places after all other statements.
            Statement::Output { .. } => {}
        }
    }

    /// The elements of an input that are scattered over the legs: the position of the first leg's,
    /// and the distance to the next leg's.
    fn scattered(&self, value: &Expression) -> Option<TokenStream> {
        let Expression::Input { array, index } = value else {
            return None;
        };
        let Elements::Scattered { of, places } = &self.lanes.inputs[*array] else {
            return None;
        };
        let (of, place) = (ident(&self.lanes.program.inputs[*of].name), places[*index]);
        let [first, stride, count] = [place.first, place.stride, place.count].map(unsuffixed);
        Some(if place.count == self.lanes.legs.len() {
            quote!(::overact::simd::scattered(#of, [#first, #stride], at))
        } else {
            quote!(::overact::simd::scattered_of_first(#of, [#first, #stride], #count, at))
        })
    }

    fn push(&mut self, own: bool, statement: &Statement) {
        if own {
            self.own.push(self.own_writer.statement(statement));
        } else {
            self.shared.push(self.shared_writer.statement(statement));
        }
    }

    fn pairs(&mut self, pairs: &[SineCosinePair]) {
        let (own, shared): (Vec<SineCosinePair>, Vec<SineCosinePair>) = pairs
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

    /// A guard in all lanes.
    fn guard(&self, at: usize, value: &Expression, condition: &Condition) -> TokenStream {
        let value = self.own_writer.tokens(value);
        match condition {
            Condition::Reach { .. } => {
                let home = home(self.lanes, at);
                quote!(::overact::simd::reach(&mut failed, #value, #home, &LEGS, at);)
            }
            Condition::Size { most } => {
                let most = magnitude(*most);
                quote!(::overact::simd::size(&mut failed, #value, #most, &LEGS, at);)
            }
            Condition::Closed { within, .. } => {
                let within = number(*within, Float::F64);
                quote!(::overact::simd::closed(&mut failed, #value, #within, &LEGS, at);)
            }
            _ => {
                let home = home(self.lanes, at);
                quote!(::overact::simd::leg(&mut failed, #value, #home, &LEGS, at);)
            }
        }
    }

    /// Whether an expression depends on the leg.
    fn is_own(&self, expression: &Expression) -> bool {
        match expression {
            Expression::Number(_) | Expression::Constant { .. } | Expression::Broken(_) => false,
            Expression::Input { array, .. } => self.lanes.inputs[*array] != Elements::Shared,
            Expression::Value(name) => self.own_names.contains(name),
            Expression::Negative(inner) => self.is_own(inner),
            Expression::Binary(_, operands) => operands.iter().any(|o| self.is_own(o)),
            Expression::Call(_, operands) => operands.iter().any(|o| self.is_own(o)),
        }
    }

    /// Writes columns to their places in the output.
    pub(super) fn columns(&self, places: &[Column], values: &[Expression]) -> Parts {
        let (mut of_all, mut of_legs) = (Vec::new(), Vec::new());
        let shape = &self.lanes.output.shape;
        let mut is_written = vec![vec![false; shape[1]]; shape[0]];
        for (at, value) in values.iter().enumerate() {
            if is_zero(value) {
                continue;
            }
            let written = &mut is_written[at / places.len()];
            let row = unsuffixed(at / places.len());
            match places[at % places.len()] {
                Column::Shared(column) => {
                    written[column] = true;
                    let (column, value) = (unsuffixed(column), self.shared_writer.tokens(value));
                    of_all.push(quote!(output[#row][#column] = #value;));
                }
                Column::OfLegs(place) => {
                    let legs = 0..self.lanes.legs.len();
                    legs.filter_map(|leg| place.of(leg))
                        .for_each(|column| written[column] = true);
                    of_legs.push(self.of_legs(&row, place, value));
                }
            }
        }
        let (zeros, after) = if are_scattered(places) {
            local(shape)
        } else {
            (zeros(&is_written), TokenStream::new())
        };
        Parts {
            zeros,
            before: quote!(#(#of_all)*),
            of_legs: quote!(#(#of_legs)*),
            after,
        }
    }

    /// Writes a number of a row for each leg.
    fn of_legs(&self, row: &Literal, place: OfLegs, value: &Expression) -> TokenStream {
        let value = self.own_writer.tokens(value);
        let [first, stride, count] = [place.first, place.stride, place.count].map(unsuffixed);
        let row = quote!(&mut output[#row]);
        if place.count == self.lanes.legs.len() {
            quote!(::overact::simd::put(#row, [#first, #stride], at, #value);)
        } else {
            let place = quote!([#first, #stride]);
            quote!(::overact::simd::put_of_first(#row, #place, #count, at, #value);)
        }
    }
}

/// Whether the legs' entries of a column are mostly not adjacent, but the columns of each leg are.
fn are_scattered(places: &[Column]) -> bool {
    let of_legs = places.iter().filter_map(|place| match place {
        Column::OfLegs(place) => Some(place.stride != 1),
        Column::Shared(_) => None,
    });
    let (apart, side_by_side): (Vec<bool>, Vec<bool>) = of_legs.partition(|&apart| apart);
    apart.len() > side_by_side.len()
}

/// The output as a local matrix, which is copied to its place at the end.
///
/// Compilers keep it in registers and write adjacent numbers at once, whereas numbers that are
/// apart would be written one by one.
fn local(shape: &[usize]) -> (TokenStream, TokenStream) {
    let (rows, columns) = (unsuffixed(shape[0]), unsuffixed(shape[1]));
    let begin = quote! {
        let place = output;
        let mut output = [[0.0; #columns]; #rows];
    };
    (begin, quote!(*place = output;))
}

/// Zeros in all places that nothing else writes.
fn zeros(is_written: &[Vec<bool>]) -> TokenStream {
    let zero = Expression::Number(0.0);
    let writer = Writer::new(&[], Float::F64);
    let mut zeros = Vec::new();
    for (row, is_written) in is_written.iter().enumerate() {
        let mut first = 0;
        for same in is_written.chunk_by(|a, b| a == b) {
            let columns = first..first + same.len();
            first = columns.end;
            if !same[0] {
                zeros.push(writer.place(row, &columns, &zero));
            }
        }
    }
    quote!(#(#zeros)*)
}

/// Whether a value is zero for all inputs.
pub(super) fn is_zero(value: &Expression) -> bool {
    matches!(value, Expression::Number(zero) if *zero == 0.0)
}
