//! Sums over the legs, and the output from the sums.
//!
//! Contributions of all legs are stored until the loop ends. Then they are summed in an order that
//! does not depend on the number of lanes.

use super::split::{Split, is_zero};
use super::{Parts, places, rows as rows_of, unsuffixed};
use crate::backends::rust::expression::{self, Writer};
use crate::backends::writing::body::Body;
use crate::backends::writing::labels::Labels;
use crate::backends::writing::statement::Expression;
use crate::float::Float;
use crate::lowering::{LegRows, Sums};
use crate::model::RobotModel;
use proc_macro2::TokenStream;
use quote::quote;

/// The heading of the sums.
pub(super) const SUMS: (&str, &str) = ("sums", "sums of the shared terms and those of all legs");

/// The headings of the tables that the legs fill.
pub(super) fn tables(sums: &Sums) -> Vec<(&'static str, &'static str)> {
    let added = (
        "added",
        "terms of the sums: one row for each sum, one column for each leg",
    );
    let own = ("own", "values of the legs that are used after the sums");
    match sums.rows {
        LegRows::None => vec![added],
        LegRows::Given(_) | LegRows::Times(_) => vec![added, own],
    }
}

/// Statements around those of the legs, for a function of sums.
pub(super) fn parts(
    model: &RobotModel,
    split: &Split<'_>,
    sums: &Sums,
    values: &[Expression],
) -> Parts {
    let count = unsuffixed(split.lanes.legs.len());
    let (added, rest) = values.split_at(sums.count);
    let (shared, rows) = rest.split_at(sums.count);
    let (adding, added) = kept(split, "added", added);
    let (owning, own) = kept(split, "own", rows);
    let of_sum = shared.iter().zip(&added).map(|(shared, added)| {
        let shared = (!is_zero(shared)).then(|| split.shared_writer.tokens(shared));
        let added = added
            .as_ref()
            .map(|added| quote!(::overact::simd::sum(&#added)));
        let parts: Vec<TokenStream> = shared.into_iter().chain(added).collect();
        if parts.is_empty() {
            quote!(0.0)
        } else {
            quote!(#(#parts)+*)
        }
    });
    let follows = following(model, split, sums);
    let after = match sums.rows {
        LegRows::None => quote!(let output = #follows;),
        LegRows::Given(_) => quote! {
            let rows = own.as_flattened();
            let output = #follows;
        },
        LegRows::Times(rows) => {
            let width = sums.width();
            let torques = own.chunks(width).enumerate().map(|(row, own)| {
                let value = along(own);
                let (first, stride) = (unsuffixed(row), unsuffixed(rows));
                quote!(::overact::simd::put(&mut output, [#first, #stride], at, #value);)
            });
            let loaded = rows_of(&quote!(own), own.iter().flatten().count());
            let places = places(split.lanes);
            let length = unsuffixed(split.lanes.output.len());
            quote! {
                let solution = #follows;
                let mut output = [0.0; #length];
                for at in #places {
                    let own = #loaded;
                    #(#torques)*
                }
            }
        }
    };
    let tables = [("added", &added), ("own", &own)].map(|(name, places)| {
        let length = places.iter().flatten().count();
        let (name, length) = (expression::ident(name), unsuffixed(length));
        quote!(let mut #name = [[0.0; #count]; #length];)
    });
    let tables = &tables[..if sums.rows == LegRows::None { 1 } else { 2 }];
    Parts {
        zeros: TokenStream::new(),
        before: quote!(#(#tables)*),
        of_legs: quote!(#adding #owning),
        after: quote! {
            let sums = [#(#of_sum),*];
            #after
        },
    }
}

/// Stores nonzero values in a table with a row for each number and a column for each leg; also
/// returns the row of each number.
fn kept(
    split: &Split<'_>,
    table: &str,
    values: &[Expression],
) -> (TokenStream, Vec<Option<TokenStream>>) {
    let table = expression::ident(table);
    let (mut statements, mut places) = (Vec::new(), Vec::new());
    for value in values {
        if is_zero(value) {
            places.push(None);
            continue;
        }
        let (at, value) = (unsuffixed(statements.len()), split.own_writer.tokens(value));
        statements.push(quote!(::overact::simd::put(&mut #table[#at], [0, 1], at, #value);));
        places.push(Some(quote!(#table[#at])));
    }
    (quote!(#(#statements)*), places)
}

/// The computation from the sums, as a block.
fn following(model: &RobotModel, split: &Split<'_>, sums: &Sums) -> TokenStream {
    let program = &sums.program;
    let body = Body::write(program, &Labels::of_parameters(model, program), &|_| false);
    let output = match sums.rows {
        LegRows::Times(_) => &program.output,
        _ => &split.lanes.output,
    };
    let written = expression::write(
        &Writer::new(&program.inputs, Float::F64),
        &body,
        Some(output),
    );
    let (statements, value) = (written.statements, written.value);
    if statements.is_empty() {
        value
    } else {
        quote!({ #statements #value })
    }
}

/// The product of a row with the solution, plus the row's last number.
fn along(row: &[Option<TokenStream>]) -> TokenStream {
    let Some((last, row)) = row.split_last() else {
        return quote!(0.0);
    };
    let products = row.iter().enumerate().filter_map(|(at, number)| {
        let (at, number) = (unsuffixed(at), number.as_ref()?);
        Some(quote!(#number * solution[#at]))
    });
    let parts: Vec<TokenStream> = products.chain(last.clone()).collect();
    if parts.is_empty() {
        quote!(0.0)
    } else {
        quote!(#(#parts)+*)
    }
}
