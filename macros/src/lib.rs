//! The attribute macro `#[redundant_robot("robot.toml")]`.
//!
//! It reads the description, whose path is relative to the crate's manifest, and puts the generated
//! items behind the struct. With `effort = "thorough"` operations are searched harder, with
//! `functions = ["control"]` only some are generated. The description is named to the compiler as an input, so
//! a changed file rebuilds the crate. Errors of the description are shown with their lines.

use overact_codegen::{Choice, Effort, Request, Source, compile_with, emission};
use proc_macro::TokenStream;
use quote::quote;
use syn::parse::{Parse, ParseStream};
use syn::punctuated::Punctuated;
use syn::{Attribute, Ident, Item, ItemStruct, LitStr, Path, Token, bracketed, parse_quote};

/// Derives a robot's model from its description: `#[redundant_robot("robots/dualv.toml")] struct DualV;`
///
/// With `effort = "thorough"` behind the path the generator searches longer for fewer operations; the
/// description can say the same. With `functions = ["inverse_dynamics", "mass_matrix"]` the struct gets these
/// functions and what they call; the groups `control`, `identification` and `kinematics` stand for several.
///
/// The struct gets the constants and functions of the robot, the documentation and the derives of a generated
/// file (`Debug`, `Clone`, `Copy`, `PartialEq`, `Eq`, `Default`; one that the struct asks for itself stands
/// below this attribute), and implements `overact::Model`, unless `functions` leaves something out that such a
/// model is asked for: all of `identification` is enough.
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
    functions: Option<Choice>,
}

impl Parse for Arguments {
    fn parse(input: ParseStream<'_>) -> syn::Result<Self> {
        let mut arguments = Self {
            path: input.parse()?,
            effort: None,
            functions: None,
        };
        while input.parse::<Option<Token![,]>>()?.is_some() && !input.is_empty() {
            let key: Ident = input.parse()?;
            let is_given = match key.to_string().as_str() {
                "effort" => arguments.effort.is_some(),
                "functions" => arguments.functions.is_some(),
                _ => {
                    return Err(syn::Error::new(
                        key.span(),
                        "expected `effort` or `functions`",
                    ));
                }
            };
            if is_given {
                return Err(syn::Error::new(
                    key.span(),
                    format!("`{key}` is given twice"),
                ));
            }
            input.parse::<Token![=]>()?;
            match key == "effort" {
                true => arguments.effort = Some(effort(input)?),
                false => arguments.functions = Some(functions(input)?),
            }
        }
        match input.is_empty() {
            true => Ok(arguments),
            false => Err(input.error("expected `,`")),
        }
    }
}

fn effort(input: ParseStream<'_>) -> syn::Result<Effort> {
    let name: LitStr = input.parse()?;
    let message = "expected \"none\", \"quick\" or \"thorough\"";
    Effort::named(&name.value()).ok_or_else(|| syn::Error::new(name.span(), message))
}

/// A list of names; each one that no function has is an error at its place.
fn functions(input: ParseStream<'_>) -> syn::Result<Choice> {
    let list;
    let bracket = bracketed!(list in input);
    let names = Punctuated::<LitStr, Token![,]>::parse_terminated(&list);
    let message = "expected names of functions in quotes, `[\"control\", \"jacobian\"]`";
    let names = names.map_err(|e| syn::Error::new(e.span(), message))?;
    let texts: Vec<String> = names.iter().map(LitStr::value).collect();
    if texts.is_empty() {
        let message = "name at least one function, or leave `functions` out for all of them";
        return Err(syn::Error::new(bracket.span.join(), message));
    }
    Choice::new(texts.iter().map(String::as_str)).map_err(|unknown| {
        let errors = unknown.into_iter().map(|one| {
            let message = format!("{one}; {}", one.help);
            let span = names
                .get(one.index)
                .map_or(bracket.span.join(), LitStr::span);
            syn::Error::new(span, message)
        });
        let combined = errors.reduce(|mut all, next| {
            all.combine(next);
            all
        });
        combined.unwrap_or_else(|| syn::Error::new(bracket.span.join(), "unknown functions"))
    })
}

/// The attribute's arguments and the struct.
fn read(attribute: TokenStream, item: TokenStream) -> syn::Result<(Arguments, ItemStruct)> {
    let is_empty = attribute.is_empty();
    let arguments = syn::parse::<Arguments>(attribute).map_err(|e| {
        let message =
            "expected the path of a robot's description: `#[redundant_robot(\"robot.toml\")]`";
        let is_path = is_empty || e.to_string().contains("string literal");
        // Others may be several, which stay together.
        match is_path {
            true => syn::Error::new(e.span(), message),
            false => e,
        }
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
        functions: arguments.functions.as_ref(),
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
    let is_documented = robot.attrs.iter().any(|a| a.path().is_ident("doc"));
    let summary = (!is_documented).then(|| emission::summary(&compiled.model));
    let lines = summary.iter().chain(&documentation);
    let lines = lines.map(|line| -> Attribute { parse_quote!(#[doc = #line]) });
    let derives = derives(&robot);
    let attributes: Vec<Attribute> = lines.chain(derives).collect();
    robot.attrs.extend(attributes);
    // The compiler watches files that are included.
    let watched = file.to_string_lossy().into_owned();
    Ok(quote! {
        #robot
        const _: &[::core::primitive::u8] = ::core::include_bytes!(#watched);
        #items
    })
}

/// The derives of a generated file that the struct does not ask for itself.
fn derives(robot: &ItemStruct) -> Option<Attribute> {
    let mut own: Vec<String> = Vec::new();
    for attribute in robot.attrs.iter().filter(|a| a.path().is_ident("derive")) {
        let parser = Punctuated::<Path, Token![,]>::parse_terminated;
        // What is no list of paths is told by the compiler.
        for path in attribute.parse_args_with(parser).unwrap_or_default() {
            own.extend(path.segments.last().map(|last| last.ident.to_string()));
        }
    }
    let mut missing: Vec<Path> = emission::derives();
    missing.retain(|path| {
        let last = path.segments.last();
        last.is_some_and(|last| !own.contains(&last.ident.to_string()))
    });
    (!missing.is_empty()).then(|| parse_quote!(#[derive(#(#missing),*)]))
}
