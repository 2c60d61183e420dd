//! One generated function: documentation, signature, body.

use super::expression::Body;
use super::labels::Labels;
use super::layout::Sections;
use crate::derivation::{Family, MotionInput};
use crate::lowering::Array;
use crate::model::{CompiledFunction, RobotModel};
use proc_macro2::{Ident, Literal, Span, TokenStream};
use quote::{format_ident, quote};

/// A function as an item of an `impl` block.
pub struct Item {
    /// The function.
    pub tokens: TokenStream,
    /// Where the sections of its body begin, which tokens cannot say.
    pub sections: Sections,
    /// All names that its body assigns.
    pub names: Vec<String>,
}

/// The function as an item of an `impl` block.
#[must_use]
pub fn item(model: &RobotModel, function: &CompiledFunction) -> Item {
    if model.finds_joints(function) && function.family == Family::Joints {
        return Item {
            tokens: super::inverse::item(model),
            sections: Sections::none(&function.name),
            names: Vec::new(),
        };
    }
    let program = &function.program;
    let fallible = is_fallible(model, function);
    let (mut sections, mut names) = (Vec::new(), Vec::new());
    let (statements, value) = match twin(model, function) {
        Some(twin) => (TokenStream::new(), call(twin, is_fallible(model, twin))),
        None => {
            let written = Body::write(program, &Labels::new(model, function));
            (sections, names) = (written.sections, written.names);
            let value = written.value;
            let value = if fallible {
                quote!(::core::result::Result::Ok(#value))
            } else {
                value
            };
            (written.statements, value)
        }
    };
    let name = format_ident!("{}", function.name);
    let from_actuators = model.finds_pose(function);
    let finds_joints = needs_joints(model, function);
    let output = array_type(&program.output);
    let arguments = arguments(model, function);
    let documentation = documentation(model, function);
    let find_pose = (from_actuators && needs_pose(model, function)).then(|| {
        quote! {
            let pose = &Self::pose_from_actuators(actuators, start)?;
        }
    });
    let find_joints = finds_joints.then(|| quote!(let joints = &Self::joints(pose)?;));
    let signature = if fallible {
        quote!(pub fn #name(#arguments) -> ::core::result::Result<#output, ::overact::Error>)
    } else {
        quote!(#[must_use] pub fn #name(#arguments) -> #output)
    };
    let tokens = quote! {
        #(#[doc = #documentation])*
        #signature {
            #find_pose
            #find_joints
            #statements
            #value
        }
    };
    Item {
        tokens,
        sections: Sections {
            function: function.name.clone(),
            starts: sections,
        },
        names,
    }
}

/// The function from joints that has the same program: where Newton's method finds the joints of a
/// pose, the function from the pose only calls it.
fn twin<'m>(model: &'m RobotModel, function: &CompiledFunction) -> Option<&'m CompiledFunction> {
    let is_pose = needs_joints(model, function) && function.from == MotionInput::Pose;
    is_pose
        .then(|| model.function(function.family, MotionInput::Joints))
        .flatten()
}

/// The call of a function with arguments of the names of its inputs, as a `Result`.
fn call(function: &CompiledFunction, fallible: bool) -> TokenStream {
    let name = format_ident!("{}", function.name);
    let inputs = function
        .program
        .inputs
        .iter()
        .map(|array| format_ident!("{}", array.name));
    let call = quote!(Self::#name(#(#inputs),*));
    if fallible {
        call
    } else {
        quote!(::core::result::Result::Ok(#call))
    }
}

/// Whether the function returns a `Result`.
#[must_use]
pub fn is_fallible(model: &RobotModel, function: &CompiledFunction) -> bool {
    model.finds_pose(function)
        || needs_joints(model, function)
        || !function.program.guards.is_empty()
}

/// Whether the function's program, or the search of its joints, uses the pose.
fn needs_pose(model: &RobotModel, function: &CompiledFunction) -> bool {
    let used = function.program.used_inputs();
    let pose = function
        .program
        .inputs
        .iter()
        .position(|array| array.name == "pose");
    pose.is_some_and(|at| used[at]) || needs_joints(model, function)
}

/// Whether the function's program uses joints that Newton's method has to find first.
fn needs_joints(model: &RobotModel, function: &CompiledFunction) -> bool {
    let inputs = &function.program.inputs;
    let used = function.program.used_inputs();
    let joints = inputs
        .iter()
        .zip(used)
        .any(|(array, used)| array.name == "joints" && used);
    // The joints themselves are what Newton's method gives.
    model.finds_joints(function) && (joints || function.family == Family::Joints)
}

/// `[f64; 3]` or `[[f64; 64]; 3]`.
#[must_use]
pub fn array_type(array: &Array) -> TokenStream {
    let length = |n: usize| Literal::usize_unsuffixed(n);
    match array.shape[..] {
        [rows, columns] => {
            let (rows, columns) = (length(rows), length(columns));
            quote!([[::core::primitive::f64; #columns]; #rows])
        }
        _ => {
            let len = length(array.len());
            quote!([::core::primitive::f64; #len])
        }
    }
}

fn arguments(model: &RobotModel, function: &CompiledFunction) -> TokenStream {
    let used = function.program.used_inputs();
    // A pose is needed to find the joints; a function that only calls another one hands all on.
    let hands_on = twin(model, function).is_some();
    let finds_joints = needs_joints(model, function);
    let is_needed = |name: &str| hands_on || (finds_joints && name == "pose");
    let unused = if needs_pose(model, function) { "" } else { "_" };
    let mut arguments = Vec::new();
    for (index, array) in function.program.inputs.iter().enumerate() {
        if model.finds_joints(function) && array.name == "joints" {
            continue;
        }
        let pose_is_found = model.finds_pose(function) && array.name == "pose";
        let (name, array) = if pose_is_found {
            let actuators = model.mechanism.actuated().len();
            (
                format!("{unused}actuators"),
                Array {
                    name: String::new(),
                    shape: vec![actuators],
                },
            )
        } else if used[index] || is_needed(&array.name) {
            (array.name.clone(), array.clone())
        } else {
            (format!("_{}", array.name), array.clone())
        };
        let name = Ident::new(&name, Span::call_site());
        let kind = array_type(&array);
        arguments.push(quote!(#name: &#kind));
    }
    if model.finds_pose(function) {
        let pose = Literal::usize_unsuffixed(model.mechanism.pose_len());
        let start = format_ident!("{unused}start");
        arguments.push(quote!(#start: &[::core::primitive::f64; #pose]));
    }
    quote!(#(#arguments),*)
}

/// Lines of documentation: meaning, inputs, output, errors, operations.
fn documentation(model: &RobotModel, function: &CompiledFunction) -> Vec<String> {
    let mut lines = vec![format!(" {}", function.family.summary()), String::new()];
    let from = match (function.from, model.is_tree()) {
        (_, true) => " From the joints' positions and rates.",
        (MotionInput::Pose, _) => " From the platform's pose and motion.",
        (MotionInput::Joints, _) => {
            " From measured joint positions and the platform's motion; of the pose only the orientation is used."
        }
        (MotionInput::Actuators, _) if !model.finds_pose(function) => {
            " From the actuators' positions."
        }
        (MotionInput::Actuators, _) => {
            " From the actuators' motion: forward kinematics from the pose `start`, then least squares."
        }
    };
    lines.push(from.to_owned());
    for array in &function.program.inputs {
        if let Some(text) = input_meaning(model, &array.name) {
            let pose_is_found = model.finds_pose(function) && array.name == "pose";
            let joints_are_found = model.finds_joints(function) && array.name == "joints";
            if !pose_is_found && !joints_are_found {
                lines.push(format!(" - `{}`: {text}", array.name));
            }
        }
    }
    if model.finds_pose(function) {
        lines.push(" - `actuators`: q, positions of the actuated joints (m, rad)".to_owned());
        lines.push(
            " - `start`: a pose near the wanted one, in its assembly mode (m, rad)".to_owned(),
        );
    }
    let shape: Vec<String> = function
        .program
        .output
        .shape
        .iter()
        .map(ToString::to_string)
        .collect();
    lines.push(String::new());
    lines.push(format!(" Output: {}.", shape.join(" x ")));
    if function.family.columns().is_some() {
        lines.push(format!(" Columns: {}.", columns_constant(function)));
    }
    lines.push(String::new());
    lines.push(format!(" {}.", function.program.cost()));
    if is_fallible(model, function) {
        lines.push(String::new());
        lines.push(" # Errors".to_owned());
        lines.push(" A pose out of reach, or a singular configuration.".to_owned());
    }
    lines
}

fn columns_constant(function: &CompiledFunction) -> &'static str {
    use crate::derivation::Columns;
    match (function.family, function.family.columns()) {
        (Family::IdmRedPayload | Family::IdmRedPayloadActuators, _) => "`PAYLOAD_PARAMETERS`",
        (_, Some(Columns::Base)) => "`BASE_PARAMETERS`",
        _ => "`PARAMETERS`",
    }
}

fn input_meaning(model: &RobotModel, name: &str) -> Option<String> {
    let platform = model.mechanism.platform.as_ref();
    let coordinates = || {
        platform
            .map(|p| p.motion.pose_coordinates().join(", "))
            .unwrap_or_default()
    };
    let rates = || {
        platform
            .map(|p| p.motion.twist_names().join(", "))
            .unwrap_or_default()
    };
    Some(match name {
        "pose" => format!("x = `[{}]` (m, rad), in the base frame", coordinates()),
        "joints" => "q_t, all joint positions, leg by leg (m, rad)".to_owned(),
        "actuators" => "q, positions of the actuated joints (m, rad)".to_owned(),
        "twist" => format!("v = `[{}]` (m/s, rad/s), in the base frame", rates()),
        "acceleration" => "the derivative of `twist` (m/s², rad/s²)".to_owned(),
        "joint_velocities" => "velocities of the joints (m/s, rad/s)".to_owned(),
        "joint_accelerations" => "accelerations of the joints (m/s², rad/s²)".to_owned(),
        "actuator_velocities" => "velocities of the actuated joints (m/s, rad/s)".to_owned(),
        "actuator_accelerations" => {
            "accelerations of the actuated joints (m/s², rad/s²)".to_owned()
        }
        "torques" => "τ, forces and torques of the actuators (N, N m)".to_owned(),
        "parameters" => {
            "values of `PARAMETERS` followed by those of `PAYLOAD_PARAMETERS` (SI)".to_owned()
        }
        "preload" => "coordinates of the internal torque on `null_space` (N, N m)".to_owned(),
        _ => return None,
    })
}
