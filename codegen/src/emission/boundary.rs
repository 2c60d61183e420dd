//! What a function does before all else.

use crate::lowering::Array;
use crate::model::RobotModel;
use proc_macro2::TokenStream;
use quote::{format_ident, quote};

/// Refuses numbers that are not finite, and scales the
/// quaternion of a pose to length 1.
#[must_use]
pub fn boundary(model: &RobotModel, arguments: &[Array]) -> TokenStream {
    let named = arguments.iter().map(|argument| {
        let (name, value) = (&argument.name, format_ident!("{}", argument.name));
        quote!((#name, #value))
    });
    let platform = model.mechanism.platform.as_ref();
    let has_quaternion = platform.is_some_and(|p| p.motion.has_quaternion());
    let poses = arguments.iter().filter(|a| a.name == "pose");
    let unit = poses.filter(|_| has_quaternion).map(|pose| {
        let (name, value) = (&pose.name, format_ident!("{}", pose.name));
        quote!(let #value = &::overact::guard::unit_quaternion(#value, #name)?;)
    });
    quote! {
        ::overact::guard::finite(&[#(#named),*])?;
        #(#unit)*
    }
}
