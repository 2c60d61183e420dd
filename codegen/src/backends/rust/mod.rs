//! Rust code of a [`RobotModel`].
//!
//! Macro, build script, command line and `generated/` all use [`robot()`]. It returns one `impl`
//! block with constants and flat functions, and one `impl overact::Model`. The latter is missing if
//! the parameters are known, or if functions that it needs were left out. The code does not
//! allocate, does not panic and has no unsafe code. A singular configuration is an error that names
//! the leg. The code may be in any scope: it is in a block that imports what it uses by absolute
//! paths (`short_paths`).
//!
//! The code follows the paper: `writing` names its values and explains the names in the type's
//! documentation, and `layout` adds headings to the sections of a body.

#![allow(unreachable_pub, reason = "public to the files of this folder")]

mod boundary;
mod constants;
mod expression;
mod function;
mod inverse;
mod layout;
mod model_impl;
mod runtime;
mod short_paths;
mod simd;

use crate::backends::writing::{labels::Labels, legend, operations, text};
use crate::float::Float;
use crate::model::RobotModel;
use function::Item;
use layout::Sections;
use proc_macro2::{Ident, Span, TokenStream};
use quote::quote;
use short_paths::ShortPaths;

/// A robot as Rust.
pub struct Robot {
    /// Lines of documentation for its type: sizes, and a legend of the names in the functions'
    /// bodies.
    pub documentation: Vec<String>,
    /// Imports and `impl` blocks.
    items: TokenStream,
    /// Starts of the sections of the functions' bodies.
    sections: Vec<Sections>,
}

/// The Rust code of a robot under the name of its type.
#[must_use]
pub fn robot(model: &RobotModel, name: &Ident) -> Robot {
    let constants = constants::items(model);
    let functions = model.functions.iter().map(|f| function::item(model, f));
    let functions: Vec<Item> = functions.collect();
    let tokens = functions.iter().map(|f| &f.tokens);
    let forward = model
        .forward_kinematics
        .then(|| model_impl::pose_from_actuators(model));
    // Functions of an `overact::Model` take the parameters as an input, are complete, and have the
    // floating-point type of the identification.
    let is_long = model.float == Float::F64;
    let is_model = model.selection.values.is_none() && model.is_model && is_long;
    let model_impl = is_model.then(|| model_impl::item(model, name));
    let items = quote! {
        impl #name {
            #constants
            #(#tokens)*
            #forward
        }

        #model_impl
    };
    let ShortPaths { imports, items } = short_paths::shortened(items, name);
    let names = functions.iter().flat_map(|f| f.names.iter().cloned());
    let mut documentation = vec![String::new(), sizes(model)];
    documentation.extend(is_short(model).map(str::to_owned));
    documentation.extend(source(&model.mechanism.source));
    documentation.push(String::new());
    documentation.extend(operations::of_robot(model));
    let is_placed = functions.iter().any(|function| function.is_placed);
    documentation.extend(is_placed.then(written_into).into_iter().flatten());
    let legend = legend::lines(&Labels::of_robot(model), &names.collect());
    if !legend.is_empty() {
        documentation.push(String::new());
        documentation.extend(legend);
    }
    Robot {
        documentation,
        items: runtime::renamed(quote!(#imports #items), &model.runtime),
        sections: functions.into_iter().map(|f| f.sections).collect(),
    }
}

impl Robot {
    /// The items after the type: a block with imports and `impl` blocks.
    #[must_use]
    pub fn items(&self) -> TokenStream {
        let (allowed, items) = (allowed(), &self.items);
        quote!(#allowed const _: () = { #items };)
    }
}

/// The items of a robot whose type is called `name`.
#[must_use]
pub fn items(model: &RobotModel, name: &Ident) -> TokenStream {
    robot(model, name).items()
}

/// The documented type and its items: the content of a generated file.
#[must_use]
pub fn module(model: &RobotModel) -> TokenStream {
    let name = Ident::new(&model.mechanism.name, Span::call_site());
    let robot = robot(model, &name);
    let (kind, items) = (documented_type(model, &robot), robot.items());
    quote!(#kind #items)
}

/// The robot's type with its documentation.
fn documented_type(model: &RobotModel, robot: &Robot) -> TokenStream {
    let name = Ident::new(&model.mechanism.name, Span::call_site());
    let (summary, derives) = (summary(model), derives());
    let documentation = &robot.documentation;
    // A trailing comma, as in lists on several lines.
    quote! {
        #[doc = #summary]
        #(#[doc = #documentation])*
        #[derive(#(#derives,)*)]
        pub struct #name;
    }
}

/// The lints that generated code violates, in any scope.
fn allowed() -> TokenStream {
    quote! {
        #[allow(
            clippy::all,
            clippy::pedantic,
            non_local_definitions,
            nonstandard_style,
            unused,
            unused_qualifications,
            reason = "straight-line code with the names of the derivation, in any scope"
        )]
    }
}

/// The first line of documentation of a robot's type.
#[must_use]
pub fn summary(model: &RobotModel) -> String {
    sentence(&model.mechanism.summary)
}

/// The traits that a robot's type derives.
#[must_use]
pub fn derives() -> Vec<syn::Path> {
    vec![
        syn::parse_quote!(::core::fmt::Debug),
        syn::parse_quote!(::core::clone::Clone),
        syn::parse_quote!(::core::marker::Copy),
        syn::parse_quote!(::core::cmp::PartialEq),
        syn::parse_quote!(::core::cmp::Eq),
        syn::parse_quote!(::core::default::Default),
    ]
}

/// The sizes of the robot, in words.
fn sizes(model: &RobotModel) -> String {
    let mechanism = &model.mechanism;
    let counted = |count: usize, one: &str, many: &str| match count {
        1 => format!("1 {one}"),
        _ => format!("{count} {many}"),
    };
    format!(
        " {}, {}, {}, {}; {}, {}.",
        counted(mechanism.legs.len(), "leg", "legs"),
        counted(mechanism.joints().len(), "joint", "joints"),
        counted(mechanism.actuator_count(), "actuator", "actuators"),
        counted(mechanism.dof(), "degree of freedom", "degrees of freedom"),
        counted(
            model.selection.standard.len(),
            "standard parameter",
            "standard parameters"
        ),
        counted(model.base.len(), "base parameter", "base parameters"),
    )
}

/// A note on single precision, if it is used.
fn is_short(model: &RobotModel) -> Option<&'static str> {
    let is_short = model.float == Float::F32;
    is_short.then_some(" All numbers are `f32`, with seven digits.")
}

/// A note on functions with a variant that writes into the caller's matrix.
fn written_into() -> [String; 2] {
    [
        String::new(),
        " Functions with a column for each parameter have two variants: one returns a matrix; the other, with the suffix `_into`, writes into the caller's matrix, which is faster. Comments name the columns.".to_owned(),
    ]
}

/// A summary as a line of documentation.
fn sentence(text: &str) -> String {
    let text = text::documentation(text);
    let end = if text.ends_with('.') { "" } else { "." };
    if text.is_empty() {
        " A robot.".to_owned()
    } else {
        format!(" {text}{end}")
    }
}

/// A note on the origin of the robot's numbers, if the description has one.
fn source(text: &str) -> Option<String> {
    let text = text::documentation(text.trim().trim_end_matches('.'));
    (!text.is_empty()).then(|| format!(" Source: {text}."))
}

/// A formatted source file. `label` is the description's path in the header.
///
/// The content of the block around the items is not indented.
#[must_use]
pub fn file(model: &RobotModel, label: &str) -> String {
    let label = text::plain(label);
    let name = Ident::new(&model.mechanism.name, Span::call_site());
    let robot = robot(model, &name);
    let (kind, allowed) = (documented_type(model, &robot), allowed());
    // The tokens are our own: every test that compiles them proves that they parse.
    let written = |tokens: TokenStream| match syn::parse2(tokens.clone()) {
        Ok(file) => prettyplease::unparse(&file),
        Err(_) => tokens.to_string(),
    };
    let head = written(quote!(#kind #allowed const _: () = {};));
    let head = head.trim_end().trim_end_matches("};");
    let items = layout::with_comments(
        &layout::pack_arrays(&layout::join_closures(&written(robot.items))),
        &robot.sections,
    );
    format!(
        "// @generated by overact from {label}; do not edit; run `overact generate {label}`\n\n{head}\n{items}}};\n"
    )
}
