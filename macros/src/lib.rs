//! The attribute macro `#[redundant_robot("robot.toml")]`.
//!
//! It reads the description, whose path is relative to the crate's manifest, and puts the generated
//! items behind the struct. With `effort = "thorough"` operations are searched harder. The description is named to the compiler as an input, so a changed file
//! rebuilds the crate. Errors of the description are shown with their lines.

use overact_codegen::{Effort, Request, Source, compile_with, emission};
use proc_macro::TokenStream;
use quote::quote;
use syn::parse::{Parse, ParseStream};
use syn::{Attribute, Ident, Item, ItemStruct, LitStr, Token, parse_quote};

/// Derives a robot's model from its description: `#[redundant_robot("robots/dualv.toml")] struct DualV;`
///
/// With `effort = "thorough"` behind the path the generator searches longer for fewer operations; the
/// description can say the same.
///
/// The struct gets the constants and functions of the robot and implements `overact::Model`.
#[proc_macro_attribute]
pub fn redundant_robot(attribute: TokenStream, item: TokenStream) -> TokenStream {
    let (arguments, robot) = match read(attribute, item) {
        Ok(read) => read,
        Err(error) => return error.into_compile_error().into(),
    };
    match expand(&arguments, &robot) {
        Ok(tokens) => tokens.into(),
        Err(error) => {
            // The struct stays, so that its users add no errors of their own.
            let error = error.into_compile_error();
            quote!(#robot #error).into()
        }
    }
}

/// What the attribute says.
struct Arguments {
    path: LitStr,
    effort: Option<Effort>,
}

impl Parse for Arguments {
    fn parse(input: ParseStream<'_>) -> syn::Result<Self> {
        let path = input.parse()?;
        let mut effort = None;
        if input.parse::<Option<Token![,]>>()?.is_some() && !input.is_empty() {
            let key: Ident = input.parse()?;
            if key != "effort" {
                return Err(syn::Error::new(key.span(), "expected `effort`"));
            }
            input.parse::<Token![=]>()?;
            let name: LitStr = input.parse()?;
            let message = "expected \"none\", \"quick\" or \"thorough\"";
            let named = Effort::named(&name.value());
            effort = Some(named.ok_or_else(|| syn::Error::new(name.span(), message))?);
            input.parse::<Option<Token![,]>>()?;
        }
        Ok(Self { path, effort })
    }
}

/// The attribute's arguments and the struct.
fn read(attribute: TokenStream, item: TokenStream) -> syn::Result<(Arguments, ItemStruct)> {
    let is_empty = attribute.is_empty();
    let arguments = syn::parse::<Arguments>(attribute).map_err(|e| {
        let message =
            "expected the path of a robot's description: `#[redundant_robot(\"robot.toml\")]`";
        let is_path = is_empty || e.to_string().contains("string literal");
        let message = if is_path {
            message.to_owned()
        } else {
            e.to_string()
        };
        syn::Error::new(e.span(), message)
    })?;
    let item = syn::parse::<Item>(item)?;
    let message = "`#[redundant_robot]` goes on a struct without fields and generics, for instance `struct DualV;`";
    match item {
        Item::Struct(robot) if robot.fields.is_empty() && robot.generics.params.is_empty() => {
            Ok((arguments, robot))
        }
        other => Err(syn::Error::new_spanned(other, message)),
    }
}

fn expand(arguments: &Arguments, robot: &ItemStruct) -> syn::Result<proc_macro2::TokenStream> {
    let path = &arguments.path;
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
    let request = Request {
        effort: arguments.effort,
        ..Request::default()
    };
    let compiled = compile_with(&source, &request).map_err(|errors| {
        let count = errors.len();
        let noun = if count == 1 { "error" } else { "errors" };
        let list = errors.render_plain(&source);
        syn::Error::new(
            path.span(),
            format!("{count} {noun} in the robot's description\n\n{list}"),
        )
    })?;
    let emission::Robot {
        documentation,
        items,
        ..
    } = emission::robot(&compiled.model, &robot.ident);
    let mut robot = robot.clone();
    let lines = documentation.iter();
    robot
        .attrs
        .extend(lines.map(|line| -> Attribute { parse_quote!(#[doc = #line]) }));
    // The compiler watches files that are included.
    let watched = file.to_string_lossy().into_owned();
    Ok(quote! {
        #robot
        const _: &[::core::primitive::u8] = ::core::include_bytes!(#watched);
        #items
    })
}
