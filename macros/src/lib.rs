//! The attribute macro `#[redundant_robot("robot.toml")]`.
//!
//! Use it through the crate `overact`, which re-exports it and has an example on its front page:
//! `#[redundant_robot("robot.toml")] struct Robot;`.
//!
//! The attribute reads the description, whose path is relative to the crate's manifest, and adds the generated
//! items after the struct. The compiler tracks the description as an input, so that a changed file
//! rebuilds the crate. Errors of the description are shown with their lines. Generated code is
//! cached in the target folder (`expansions`), because the compiler expands the attribute at every
//! change of the user's crate.

mod arguments;
mod expansions;

use arguments::Arguments;
use expansions::Expansion;
use overact_codegen::{Request, Source, VERSIONS, backends::rust, compile_with};
use proc_macro::TokenStream;
use quote::quote;
use syn::punctuated::Punctuated;
use syn::{Attribute, Item, ItemStruct, Path, Token, parse_quote};

/// Derives a robot's model from its description: `#[redundant_robot("robots/dualv.toml")] struct DualV;`
///
/// These keys may follow the path in any order:
///
/// | key | what |
/// |---|---|
/// | `effort = "thorough"` | effort of the search for fewer operations (`"none"`, `"quick"`, `"thorough"`); the description may set it, too |
/// | `functions = ["inverse_dynamics", "jacobian"]` | only these functions and those that they call; the groups `control`, `identification` and `kinematics` contain several |
/// | `from = ["joints"]` | only functions of these inputs (`"pose"`, `"joints"`, `"actuators"`); a name such as `inverse_dynamics` selects each of these forms |
/// | `columns = "base"` | only models with the columns of the base parameters (or of all, `"standard"`), and dynamics with their values as input |
/// | `float = "f32"` | single precision, for controllers without double precision; such a struct is no `overact::Model` |
/// | `crate = "::my::overact"` | the path under which the generated code finds this crate |
///
/// The struct gets the constants and functions of the robot, documentation, and the derives of a
/// generated file (`Debug`, `Clone`, `Copy`, `PartialEq`, `Eq`, `Default`). Its own derives have to
/// be below this attribute. It implements `overact::Model`, unless a function that such a model
/// needs is left out; all of `identification` is sufficient.
#[proc_macro_attribute]
pub fn redundant_robot(attribute: TokenStream, item: TokenStream) -> TokenStream {
    let (arguments, robot) = match read(attribute, item) {
        Ok(read) => read,
        Err(error) => return error.into_compile_error().into(),
    };
    match expand(&arguments, &robot) {
        Ok(tokens) => tokens.into(),
        Err(error) => {
            // The struct is kept, so that its uses cause no further errors.
            let error = error.into_compile_error();
            quote!(#robot #error).into()
        }
    }
}

/// The attribute's arguments and the struct.
fn read(attribute: TokenStream, item: TokenStream) -> syn::Result<(Arguments, ItemStruct)> {
    let is_empty = attribute.is_empty();
    let arguments = syn::parse::<Arguments>(attribute).map_err(|e| {
        let message =
            "expected the path of a robot's description: `#[redundant_robot(\"robot.toml\")]`";
        let is_path = is_empty || e.to_string().contains("string literal");
        // Errors of other kinds may be several, which stay together.
        if is_path {
            syn::Error::new(e.span(), message)
        } else {
            e
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
    let expansion = expansion(arguments, robot, &source)?;
    let items: proc_macro2::TokenStream = expansion.items.parse().map_err(|_| {
        // Reached only if the generator's own output does not parse.
        syn::Error::new(
            path.span(),
            "internal error of overact: the generated code is no Rust",
        )
    })?;
    let mut robot = robot.clone();
    let is_documented = robot.attrs.iter().any(|a| a.path().is_ident("doc"));
    let summary = (!is_documented).then_some(&expansion.summary);
    let lines = summary.into_iter().chain(&expansion.documentation);
    let lines = lines.map(|line| -> Attribute { parse_quote!(#[doc = #line]) });
    let derives = derives(&robot);
    let attributes: Vec<Attribute> = lines.chain(derives).collect();
    robot.attrs.extend(attributes);
    // The compiler tracks included files.
    let watched = file.to_string_lossy().into_owned();
    Ok(quote! {
        #robot
        const _: &[::core::primitive::u8] = ::core::include_bytes!(#watched);
        #items
    })
}

/// The generated code, from the cache if possible.
fn expansion(arguments: &Arguments, robot: &ItemStruct, source: &Source) -> syn::Result<Expansion> {
    let Arguments {
        effort,
        functions,
        float,
        runtime,
        path,
    } = arguments;
    let folder = expansions::folder();
    let generator = (VERSIONS, env!("OVERACT_GENERATOR"));
    let wanted = (robot.ident.to_string(), effort, functions, float, runtime);
    let key = format!("{generator:?}\n{wanted:?}\n{}", source.text);
    if let Some(expansion) = folder.as_deref().and_then(|at| expansions::read(at, &key)) {
        return Ok(expansion);
    }
    let request = Request {
        effort: *effort,
        functions: functions.as_ref(),
        float: *float,
        runtime: runtime.as_ref(),
        ..Request::default()
    };
    let compiled = compile_with(source, &request).map_err(|errors| {
        let count = errors.len();
        let noun = if count == 1 { "error" } else { "errors" };
        let list = errors.render_plain(source);
        syn::Error::new(
            path.span(),
            format!("{count} {noun} in the robot's description\n\n{list}"),
        )
    })?;
    let rust = rust::robot(&compiled.model, &robot.ident);
    let expansion = Expansion {
        summary: rust::summary(&compiled.model),
        items: rust.items().to_string(),
        documentation: rust.documentation,
    };
    if let Some(folder) = folder {
        expansions::keep(&folder, &key, &expansion);
    }
    Ok(expansion)
}

/// The derives of a generated file that the struct does not have itself.
fn derives(robot: &ItemStruct) -> Option<Attribute> {
    let mut own: Vec<String> = Vec::new();
    for attribute in robot.attrs.iter().filter(|a| a.path().is_ident("derive")) {
        let parser = Punctuated::<Path, Token![,]>::parse_terminated;
        // The compiler reports attributes that are not lists of paths.
        for path in attribute.parse_args_with(parser).unwrap_or_default() {
            own.extend(path.segments.last().map(|last| last.ident.to_string()));
        }
    }
    let mut missing: Vec<Path> = rust::derives();
    missing.retain(|path| {
        let last = path.segments.last();
        last.is_some_and(|last| !own.contains(&last.ident.to_string()))
    });
    (!missing.is_empty()).then(|| parse_quote!(#[derive(#(#missing),*)]))
}
