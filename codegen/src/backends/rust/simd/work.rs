//! A function in lanes as a type that contains its arrays and runs in any vectors.
//!
//! The vectors are chosen at run time, when the function is called.

use super::{FEW, Loop};
use crate::backends::rust::expression::{array_type, ident};
use crate::float::Float;
use crate::lowering::{Elements, LaneOutput, Lanes};
use crate::model::CompiledFunction;
use proc_macro2::TokenStream;
use quote::quote;

/// The function as a type, and the call.
pub(in crate::backends::rust) struct Work {
    /// The type and its implementation.
    pub(in crate::backends::rust) item: TokenStream,
    /// The value of a call.
    pub(in crate::backends::rust) value: TokenStream,
}

impl Work {
    /// The type of a function in lanes.
    pub(in crate::backends::rust) fn new(
        function: &CompiledFunction,
        lanes: &Lanes,
        written: &Loop,
    ) -> Self {
        let program = &function.program;
        let arrays = program
            .inputs
            .iter()
            .filter(|array| is_used(lanes, &array.name));
        let (names, kinds): (Vec<_>, Vec<TokenStream>) = arrays
            .map(|array| (ident(&array.name), array_type(array, Float::F64)))
            .unzip();
        let output = array_type(&program.output, Float::F64);
        let (statements, value) = (&written.statements, &written.value);
        let mut names: Vec<TokenStream> = names.into_iter().map(|name| quote!(#name)).collect();
        let mut kinds: Vec<TokenStream> = kinds.into_iter().map(|kind| quote!(&'a #kind)).collect();
        // Columns are written to their places, sums are returned.
        let given = match &lanes.gathered {
            LaneOutput::Columns(_) => {
                names.push(quote!(output));
                kinds.push(quote!(&'a mut #output));
                quote!(())
            }
            LaneOutput::Sums(_) => output,
        };
        let item = quote! {
            #[doc = " The function with one leg in each lane of SIMD vectors, whose width is chosen at run time."]
            struct Legs<'a> { #(#names: #kinds),* }
            impl ::overact::simd::SideBySide for Legs<'_> {
                type Output = ::core::result::Result<#given, ::overact::Error>;
                #[inline(always)]
                fn run<V: ::overact::simd::Vector>(self, lanes: V::Proof) -> Self::Output {
                    let Self { #(#names),* } = self;
                    #statements
                    ::core::result::Result::Ok(#value)
                }
            }
        };
        let work = quote!(Legs { #(#names),* });
        let run = if lanes.legs.len() <= FEW {
            quote!(::overact::simd::few)
        } else {
            quote!(::overact::simd::many)
        };
        Self {
            item,
            value: quote!(#run(#work)),
        }
    }
}

/// Whether the lanes use an array of the function, shared or with elements of each leg.
fn is_used(lanes: &Lanes, name: &str) -> bool {
    let inputs = &lanes.program.inputs;
    let used = lanes.program.used_inputs();
    let mut each = lanes.inputs.iter().zip(inputs).zip(used);
    each.any(|((elements, input), is_used)| {
        let of = match elements {
            Elements::Scattered { of, .. } => &inputs[*of].name,
            _ => &input.name,
        };
        is_used && of == name
    })
}
