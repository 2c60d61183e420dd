//! The attribute macro `#[redundant_robot("robot.toml")]`.
//!
//! It reads the description, whose path is relative to the crate's manifest, and puts the generated
//! items behind the struct. The description is named to the compiler as an input, so a changed file
//! rebuilds the crate. Errors of the description are shown with their lines.

use overact_codegen::{Source, compile, emission};
use proc_macro::TokenStream;
use quote::quote;
use syn::{ItemStruct, LitStr, parse_macro_input};

/// Derives a robot's model from its description: `#[redundant_robot("robots/dualv.toml")] struct DualV;`
///
/// The struct gets the constants and functions of the robot and implements `overact::Model`.
#[proc_macro_attribute]
pub fn redundant_robot(attribute: TokenStream, item: TokenStream) -> TokenStream {
    let path = parse_macro_input!(attribute as LitStr);
    let robot = parse_macro_input!(item as ItemStruct);
    match expand(&path, &robot) {
        Ok(tokens) => tokens.into(),
        Err(error) => {
            let error = error.into_compile_error();
            quote!(#robot #error).into()
        }
    }
}

fn expand(path: &LitStr, robot: &ItemStruct) -> syn::Result<proc_macro2::TokenStream> {
    if !robot.fields.is_empty() || !robot.generics.params.is_empty() {
        let message = "`#[redundant_robot]` goes on a struct without fields and generics, for instance `struct DualV;`";
        return Err(syn::Error::new_spanned(robot, message));
    }
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
    let model = compile(&source)
        .map_err(|errors| syn::Error::new(path.span(), errors.render_plain(&source)))?;
    let items = emission::items(&model, &robot.ident);
    // The compiler watches files that are included.
    let watched = file.to_string_lossy().into_owned();
    Ok(quote! {
        #robot
        const _: &[u8] = include_bytes!(#watched);
        #items
    })
}
