//! The body of a function whose legs run in SIMD lanes.
//!
//! Shared values come first, then a loop over batches of legs. It either writes the legs' columns
//! of the output ([`split`]), or sums over all legs, after which the output follows from the sums
//! ([`sums`]).

mod split;
mod sums;
mod work;

use super::expression::{self, ident, number};
use super::layout::Sections;
use crate::backends::writing::body::Body;
use crate::backends::writing::labels::Labels;
use crate::float::Float;
use crate::lowering::{Elements, LaneOutput, Lanes, Operand};
use crate::model::{CompiledFunction, RobotModel};
use proc_macro2::{Literal, TokenStream};
use quote::quote;
use split::Split;
pub(super) use work::Work;

/// A function's body with data for its item.
pub(super) struct Loop {
    /// The statements.
    pub(super) statements: TokenStream,
    /// The returned value; empty if the columns are written to the output.
    pub(super) value: TokenStream,
    /// Starts of sections.
    pub(super) sections: Sections,
    /// All assigned names.
    pub(super) names: Vec<String>,
}

/// Number of legs up to which half of the widest registers would be empty.
const FEW: usize = 4;

/// Names reserved for the loop.
const RESERVED: [&str; 10] = [
    "at", "added", "failed", "lanes", "own", "rows", "sums", "solution", "output", "place",
];

/// The body of a function in lanes, which is placed in a function of this name.
pub(super) fn write(
    model: &RobotModel,
    function: &CompiledFunction,
    lanes: &Lanes,
    name: &str,
) -> Loop {
    let kept = between(lanes);
    let labels = Labels::new(model, function).in_lanes(model, lanes);
    let is_reserved = |name: &str| RESERVED.contains(&name);
    let body = Body::write_with(&lanes.program, &labels, &is_reserved, &|at| kept[at]);
    let mut split = Split::new(lanes);
    for statement in &body.statements {
        split.statement(statement);
    }
    let constants = expression::constants(&body, Float::F64);
    let (tables, arrays) = (tables(lanes), arrays(lanes));
    let (parts, value) = match &lanes.gathered {
        LaneOutput::Columns(columns) => (split.columns(columns, &body.output), quote!(())),
        LaneOutput::Sums(sums) => {
            let parts = sums::parts(model, &split, sums, &body.output);
            (parts, quote!(output))
        }
    };
    let Parts {
        zeros,
        before,
        of_legs,
        after,
    } = parts;
    let places = places(lanes);
    let [none_failed, failed] = if split.has_guards {
        [
            quote!(let mut failed = ::overact::simd::Failed::none();),
            quote!(failed.result()?;),
        ]
    } else {
        [TokenStream::new(), TokenStream::new()]
    };
    let (shared, own) = (&split.shared, &split.own);
    let statements = quote! {
        #constants
        #zeros
        #(#shared)*
        #before
        #tables
        for at in #places {
            #arrays
            #none_failed
            #(#own)*
            #failed
            #of_legs
        }
        #after
    };
    let (own, shared): (Vec<_>, Vec<_>) = body
        .sections
        .into_iter()
        .partition(|(name, _)| split.own_names.contains(name));
    Loop {
        statements,
        value,
        sections: Sections {
            function: name.to_owned(),
            starts: headings(lanes, shared, own),
            columns: Vec::new(),
        },
        names: body.names,
    }
}

/// Headings in the order of the statements: shared values, tables, legs, sums.
fn headings(
    lanes: &Lanes,
    shared: Vec<(String, String)>,
    own: Vec<(String, String)>,
) -> Vec<(String, String)> {
    let heading = |(name, text): (&str, &str)| (name.to_owned(), text.to_owned());
    let (before, after) = match &lanes.gathered {
        LaneOutput::Columns(_) => (None, None),
        LaneOutput::Sums(sums) => (Some(sums::tables(sums)), Some(sums::SUMS)),
    };
    let used = lanes.program.used_inputs();
    let inputs = lanes.program.inputs.iter().zip(&lanes.inputs).zip(used);
    let arrays = inputs.filter_map(|((input, elements), is_used)| {
        let text = match elements {
            _ if !is_used => return None,
            Elements::Shared | Elements::Scattered { .. } => return None,
            Elements::Constants => "constants of the legs in this batch",
            Elements::InTurn(_) => "inputs of the legs in this batch",
        };
        Some((input.name.as_str(), text))
    });
    let mut arrays: Vec<_> = arrays.collect();
    arrays.dedup_by_key(|(_, text)| *text);
    shared
        .into_iter()
        .chain(before.into_iter().flatten().map(heading))
        .chain(arrays.into_iter().map(heading))
        .chain(own)
        .chain(after.map(heading))
        .collect()
}

/// The batches of legs.
fn places(lanes: &Lanes) -> TokenStream {
    let count = unsuffixed(lanes.legs.len());
    quote!(::overact::simd::places::<V, #count>(lanes))
}

/// Statements around those of the legs.
struct Parts {
    /// First: the zeros of the output, or the output itself.
    zeros: TokenStream,
    /// Before the loop.
    before: TokenStream,
    /// At the end of each iteration.
    of_legs: TokenStream,
    /// After the loop, when `output` is known.
    after: TokenStream,
}

/// The shared steps that those of a leg need; each is computed once, before the loop.
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

/// The constants of the legs, with their names.
fn tables(lanes: &Lanes) -> TokenStream {
    let count = unsuffixed(lanes.legs.len());
    let numbers = |values: Vec<f64>| {
        let numbers = values.into_iter().map(|value| number(value, Float::F64));
        quote!([#(#numbers),*])
    };
    let elements = lanes.constants.first().map_or(0, Vec::len);
    let of_element = |at| lanes.constants.iter().map(|leg| leg[at]).collect();
    let constants = (0..elements).map(|at| numbers(of_element(at)));
    let rows = unsuffixed(elements);
    let names = lanes.names.iter().enumerate();
    let names = names.map(|(row, name)| format!(" {row}: {name}"));
    let legs = &lanes.legs;
    quote! {
        #[doc = " Constants that differ between legs: rows of one number per leg."]
        #(#[doc = #names])*
        static OF_LEG: [[::core::primitive::f64; #count]; #rows] = [#(#constants),*];
        #[doc = " Names of the legs, for errors."]
        static LEGS: [&::core::primitive::str; #count] = [#(#legs),*];
    }
}

/// The arrays with elements for each leg.
fn arrays(lanes: &Lanes) -> TokenStream {
    let inputs = &lanes.program.inputs;
    let used = lanes.program.used_inputs();
    let arrays = lanes.inputs.iter().enumerate().map(|(at, elements)| {
        let name = ident(&inputs[at].name);
        match elements {
            _ if !used[at] => TokenStream::new(),
            Elements::Shared | Elements::Scattered { .. } => TokenStream::new(),
            Elements::Constants => {
                let rows = rows(&quote!(OF_LEG), inputs[at].len());
                quote!(let #name = #rows;)
            }
            Elements::InTurn(count) => {
                let count = unsuffixed(*count);
                quote!(let #name = ::overact::simd::elements::<#count, _, _, _>(#name, at);)
            }
        }
    });
    quote!(#(#arrays)*)
}

/// Rows of a table for the legs of a batch, written out because a mapped array is not inlined.
fn rows(table: &TokenStream, count: usize) -> TokenStream {
    let row = |at| {
        let at = unsuffixed(at);
        quote!(::overact::simd::row(&#table[#at], at))
    };
    let rows = (0..count).map(row);
    quote!([#(#rows),*])
}

fn unsuffixed(number: usize) -> Literal {
    Literal::usize_unsuffixed(number)
}

/// Magnitudes at home of a guarded value, one for each leg.
fn home(lanes: &Lanes, guard: usize) -> TokenStream {
    let homes = lanes.homes.get(guard).map_or(&[][..], Vec::as_slice);
    match homes {
        [first, rest @ ..] if rest.iter().all(|home| home == first) => {
            let (first, count) = (number(*first, Float::F64), unsuffixed(homes.len()));
            quote!(&[#first; #count])
        }
        _ => {
            let homes = homes.iter().map(|home| number(*home, Float::F64));
            quote!(&[#(#homes),*])
        }
    }
}
