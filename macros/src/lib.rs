//! The attribute macro `#[redundant_robot("robot.toml")]`.
//!
//! It reads the description, whose path is relative to the crate's manifest, and puts the generated
//! items behind the struct. The description is named to the compiler as an input, so a changed file
//! rebuilds the crate. Errors of the description are shown with their lines.

use overact_codegen::{Source, compile, emission};
use proc_macro::TokenStream;
use quote::quote;
use syn::{Item, ItemStruct, LitStr};

/// Derives a robot's model from its description: `#[redundant_robot("robots/dualv.toml")] struct DualV;`
///
/// The struct gets the constants and functions of the robot and implements `overact::Model`.
#[proc_macro_attribute]
pub fn redundant_robot(attribute: TokenStream, item: TokenStream) -> TokenStream {
    let (path, robot) = match read(attribute, item) {
        Ok(read) => read,
        Err(error) => return error.into_compile_error().into(),
    };
    match expand(&path, &robot) {
        Ok(tokens) => tokens.into(),
        Err(error) => {
            // The struct stays, so that its users add no errors of their own.
            let error = error.into_compile_error();
            quote!(#robot #error).into()
        }
    }
}

/// The description's path and the struct.
fn read(attribute: TokenStream, item: TokenStream) -> syn::Result<(LitStr, ItemStruct)> {
    let path = syn::parse::<LitStr>(attribute).map_err(|e| {
        let message =
            "expected the path of a robot's description: `#[redundant_robot(\"robot.toml\")]`";
        syn::Error::new(e.span(), message)
    })?;
    let item = syn::parse::<Item>(item)?;
    let message = "`#[redundant_robot]` goes on a struct without fields and generics, for instance `struct DualV;`";
    match item {
        Item::Struct(robot) if robot.fields.is_empty() && robot.generics.params.is_empty() => {
            Ok((path, robot))
        }
        other => Err(syn::Error::new_spanned(other, message)),
    }
}

fn expand(path: &LitStr, robot: &ItemStruct) -> syn::Result<proc_macro2::TokenStream> {
    let folder = std::env::var("CARGO_MANIFEST_DIR").unwrap_or_default();
    let file = std::path::Path::new(&folder).join(path.value());
    let text = std::fs::read_to_string(&file).map_err(|e| {
        let message = format!(
            "cannot read the robot's description `{}`: {e}; the path is relative to the folder of the crate's Cargo.toml",
            path.value()
        );
        syn::Error::new(path.span(), message)
    })?;
    let source = Source::new(path.value(), text);
    let model = compile(&source).map_err(|errors| {
        let count = errors.len();
        let noun = if count == 1 { "error" } else { "errors" };
        let list = errors.render_plain(&source);
        syn::Error::new(
            path.span(),
            format!("{count} {noun} in the robot's description\n\n{list}"),
        )
    })?;
    let items = emission::items(&model, &robot.ident);
    // The compiler watches files that are included.
    let watched = file.to_string_lossy().into_owned();
    Ok(quote! {
        #robot
        const _: &[u8] = include_bytes!(#watched);
        #items
    })
}
