//! Checks at the start of a generated function.

use super::expression::magnitude;
use crate::float::Float;
use crate::lowering::Array;
use crate::model::RobotModel;
use proc_macro2::TokenStream;
use quote::{format_ident, quote};

/// Rejects numbers that are not finite or too large.
#[must_use]
pub fn range(float: Float, arguments: &[&str]) -> TokenStream {
    let largest = float.limits().largest;
    let bounded = arguments.iter().map(|name| {
        let (value, most) = (format_ident!("{name}"), magnitude(largest.of(name)));
        quote!((#name, #value, #most))
    });
    quote!(::overact::guard::within(&[#(#bounded),*])?;)
}

/// Rejects numbers that are not finite or too large, and normalises the quaternion of a pose.
#[must_use]
pub fn boundary(model: &RobotModel, arguments: &[Array]) -> TokenStream {
    let names: Vec<&str> = arguments.iter().map(|a| a.name.as_str()).collect();
    let range = range(model.float, &names);
    let platform = model.mechanism.platform.as_ref();
    let has_quaternion = platform.is_some_and(|p| p.motion.has_quaternion());
    let poses = arguments.iter().filter(|a| a.name == "pose");
    let unit = poses.filter(|_| has_quaternion).map(|pose| {
        let (name, value) = (&pose.name, format_ident!("{}", pose.name));
        quote!(let #value = &::overact::guard::unit_quaternion(#value, #name)?;)
    });
    quote! {
        #range
        #(#unit)*
    }
}
