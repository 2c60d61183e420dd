//! One generated function: documentation, signature, body.
//!
//! A model with a column for each parameter is written into the caller's matrix by the function
//! with the suffix `_into`. The function without the suffix passes a matrix of its own.

use super::boundary::boundary;
use super::expression::{self, Writer, array_type, ident};
use super::layout::Sections;
use super::simd::{self, Work};
use crate::backends::writing::body::Body;
use crate::backends::writing::labels::Labels;
use crate::backends::writing::operations;
use crate::backends::writing::outline::{Outline, Table};
use crate::lowering::{Profitable, Program};
use crate::model::{CompiledFunction, RobotModel};
use overact_core::Function;
use proc_macro2::TokenStream;
use quote::quote;

/// A function as an item of an `impl` block.
pub struct Item {
    /// The function.
    pub tokens: TokenStream,
    /// Starts of the sections of its body, which tokens cannot represent.
    pub sections: Sections,
    /// All names assigned in the body.
    pub names: Vec<String>,
    /// Whether it exists twice, once for the caller's matrix.
    pub is_placed: bool,
}

/// The function as an item of an `impl` block.
#[must_use]
pub fn item(model: &RobotModel, function: &CompiledFunction) -> Item {
    let outline = Outline::new(model, function);
    if outline.is_newton {
        return Item {
            tokens: super::inverse::item(model),
            sections: Sections::none(&function.name),
            names: Vec::new(),
            is_placed: outline.is_placed(),
        };
    }
    if let Some(twin) = outline.twin {
        return Item {
            tokens: around(
                model,
                function,
                &outline,
                &TokenStream::new(),
                &call(twin, &outline),
            ),
            sections: Sections::none(&function.name),
            names: Vec::new(),
            is_placed: outline.is_placed(),
        };
    }
    let Some(lanes) = &function.lanes else {
        return straight(model, function, &outline, TokenStream::new());
    };
    let name = body_name(function, &outline);
    let mut written = simd::write(model, function, lanes, &name);
    written.sections.columns = columns(model, function, outline.columns);
    let Work { item, value } = Work::new(function, lanes, &written);
    if lanes.pays == Profitable::Always {
        return Item {
            tokens: around(model, function, &outline, &item, &value),
            sections: written.sections,
            names: written.names,
            is_placed: outline.is_placed(),
        };
    }
    let before = quote! {
        #item
        if ::overact::simd::four() {
            return #value;
        }
    };
    let mut both = straight(model, function, &outline, before);
    both.sections.starts.splice(..0, written.sections.starts);
    both.names.splice(..0, written.names);
    both
}

/// The function with its program's statements after others.
fn straight(
    model: &RobotModel,
    function: &CompiledFunction,
    outline: &Outline<'_>,
    before: TokenStream,
) -> Item {
    let program = &function.program;
    let labels = Labels::new(model, function);
    // Words of Rust are not among the derivation's names.
    let (body, output) = if outline.is_placed() {
        (
            Body::placed(program, &labels, &|name| name == "output"),
            None,
        )
    } else {
        let body = Body::write(program, &labels, &|_| false);
        (body, Some(&program.output))
    };
    let is_wide = is_wide(model, function);
    let writer = if is_wide {
        Writer::wide(&program.inputs, model.float)
    } else {
        Writer::new(&program.inputs, model.float)
    };
    let written = expression::write(&writer, &body, output);
    let (statements, value) = (written.statements, written.value);
    let value = value_of(program, &value, model);
    let (run, copies) = if outline.is_placed() {
        (quote!(::overact::with_avx512), copies(program))
    } else {
        (quote!(::overact::with_avx2), TokenStream::new())
    };
    let (statements, value) = if is_wide {
        (
            before,
            quote!(#run(#[inline(always)] || { #copies #statements #value })),
        )
    } else {
        (quote!(#before #statements), value)
    };
    Item {
        tokens: around(model, function, outline, &statements, &value),
        sections: Sections {
            function: body_name(function, outline),
            starts: body.sections,
            columns: columns(model, function, outline.columns),
        },
        names: body.names,
        is_placed: outline.is_placed(),
    }
}

/// The result of a function from its entries: these, or the torques that they determine.
fn value_of(program: &Program, entries: &TokenStream, model: &RobotModel) -> TokenStream {
    if program.least_torques.is_empty() {
        return quote!(::core::result::Result::Ok(#entries));
    }
    let kind = expression::kind(model.float);
    let least = program.least_torques.iter().map(|&least| {
        if least.is_finite() {
            expression::number(least, model.float)
        } else {
            quote!(#kind::NEG_INFINITY)
        }
    });
    let redundancy = program.entries.len() / program.least_torques.len() - 1;
    let [actuators, redundancy] =
        [program.least_torques.len(), redundancy].map(proc_macro2::Literal::usize_unsuffixed);
    quote! {
        ::overact::tension::distribute::<#kind, #actuators, #redundancy>(
            &#entries,
            &[#(#least),*],
        )
    }
}

/// Names of the columns in the table of parameters.
fn columns(model: &RobotModel, function: &CompiledFunction, table: Option<Table>) -> Vec<String> {
    if table == Some(Table::BaseParameters) {
        return model
            .base
            .iter()
            .map(|base| model.base_name(base))
            .collect();
    }
    let columns = model.columns_of(function.computes).iter();
    columns
        .map(|&column| model.parameter_name(column))
        .collect()
}

/// Copies of the inputs.
///
/// Inside a closure the compiler no longer knows that references do not alias, so values written in
/// between might change the inputs.
fn copies(program: &Program) -> TokenStream {
    let inputs = program.inputs.iter().zip(program.used_inputs());
    let used = inputs.filter(|(_, is_used)| *is_used);
    let names: Vec<_> = used.map(|(input, _)| ident(&input.name)).collect();
    match &names[..] {
        [] => TokenStream::new(),
        [name] => quote!(let #name = *#name;),
        _ => quote!(let (#(#names),*) = (#(*#names),*);),
    }
}

/// Operations above which a straight function is also compiled for wider vectors.
///
/// For shorter ones the detection of the processor's vectors costs more than they gain.
const WIDE: usize = 150;

/// Whether the straight program uses wider vectors if available.
///
/// It does not if legs run in SIMD lanes then, nor as a step of an iteration. Positions and
/// Jacobians are sequences of dependent roots and quotients, which wider vectors do not accelerate.
fn is_wide(model: &RobotModel, function: &CompiledFunction) -> bool {
    let is_of_steps = matches!(
        function.computes,
        Function::Joints
            | Function::ActuatorPositions
            | Function::InverseJacobian
            | Function::PoseInClosedForm
            | Function::PoseStep
            | Function::BlockedError
            | Function::BlockedJacobian
            | Function::PoseError
            | Function::PoseErrorJacobian
    );
    function.lanes.is_none() && !is_of_steps && model.cost(function).once.operations() >= WIDE
}

/// The function with given statements and value.
fn around(
    model: &RobotModel,
    function: &CompiledFunction,
    outline: &Outline<'_>,
    statements: &TokenStream,
    value: &TokenStream,
) -> TokenStream {
    let name = ident(&function.name);
    let output = array_type(&function.program.output, model.float);
    let documentation = documentation(model, function, outline);
    let check = boundary(model, &outline.arguments);
    let find_pose = outline.finds_pose.then(|| {
        quote! {
            let pose = &Self::pose_from_actuators(actuators, start)?;
        }
    });
    let find_joints = outline
        .finds_joints
        .then(|| quote!(let joints = &Self::joints(pose)?;));
    let arguments = outline.arguments.iter();
    let (names, kinds): (Vec<_>, Vec<_>) = arguments
        .map(|argument| (ident(&argument.name), array_type(argument, model.float)))
        .unzip();
    let body = quote!(#check #find_pose #find_joints #statements #value);
    if !outline.is_placed() {
        return quote! {
            #(#[doc = #documentation])*
            pub fn #name(#(#names: &#kinds),*) -> ::core::result::Result<#output, ::overact::Error> {
                #body
            }
        };
    }
    let into = ident(&body_name(function, outline));
    let written = [
        format!(" [`Self::{name}`] with its result in `output`."),
        String::new(),
        " # Errors".to_owned(),
        format!(" Those of [`Self::{name}`]; `output` is then only partly written."),
    ];
    quote! {
        #(#[doc = #documentation])*
        pub fn #name(#(#names: &#kinds),*) -> ::core::result::Result<#output, ::overact::Error> {
            ::overact::zeroed_then_fill(|output| Self::#into(#(#names,)* output))
        }

        #(#[doc = #written])*
        pub fn #into(#(#names: &#kinds,)* output: &mut #output) -> ::core::result::Result<(), ::overact::Error> {
            #body
        }
    }
}

/// Name of the function that contains the statements.
fn body_name(function: &CompiledFunction, outline: &Outline<'_>) -> String {
    if outline.is_placed() {
        into(&function.name)
    } else {
        function.name.clone()
    }
}

/// Name of a function that writes into the caller's matrix.
pub(super) fn into(name: &str) -> String {
    format!("{name}_into")
}

/// Call of a function with variables named like its inputs, and the output if the caller provides
/// it.
fn call(function: &CompiledFunction, outline: &Outline<'_>) -> TokenStream {
    let name = ident(&body_name(function, outline));
    let inputs = function.program.inputs.iter();
    let inputs = inputs.map(|array| ident(&array.name));
    let output = outline.is_placed().then(|| quote!(output));
    quote!(Self::#name(#(#inputs,)* #output))
}

/// Lines of documentation: description, inputs, output, errors, operations.
fn documentation(
    model: &RobotModel,
    function: &CompiledFunction,
    outline: &Outline<'_>,
) -> Vec<String> {
    let mut lines = vec![format!(" {}", function.computes.summary()), String::new()];
    lines.push(format!(" {}", outline.origin));
    let missing = outline.missing_masses.iter();
    lines.extend(missing.map(|sentence| format!(" {sentence}")));
    let meanings = outline.meanings.iter();
    lines.extend(meanings.map(|(name, meaning)| format!(" - `{name}`: {meaning}")));
    let shape = function.program.output.shape.iter();
    let shape: Vec<String> = shape.map(ToString::to_string).collect();
    lines.push(String::new());
    lines.push(format!(" Output: {}.", shape.join(" x ")));
    let table = outline.columns.map(|table| match table {
        Table::Parameters => "`PARAMETERS`",
        Table::BaseParameters => "`BASE_PARAMETERS`",
        Table::PayloadParameters => "`PAYLOAD_PARAMETERS`",
    });
    lines.extend(table.map(|table| format!(" Columns: {table}.")));
    lines.push(String::new());
    lines.extend(operations::of_function(&model.cost(function)));
    if function.program.pieces > 0 {
        lines.push(format!(
            " The program was too large to optimise as a whole; it was optimised in {} parts.",
            function.program.pieces
        ));
    }
    lines.push(String::new());
    lines.push(" # Errors".to_owned());
    lines.push(if outline.can_fail {
        " An input is infinite, NaN or too large, the pose is out of reach, or the configuration is singular.".to_owned()
    } else {
        " An input is infinite, NaN or too large.".to_owned()
    });
    lines
}
