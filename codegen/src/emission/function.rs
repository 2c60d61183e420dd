//! One generated function: documentation, signature, body.

use super::boundary::boundary;
use super::expression::Body;
use super::labels::Labels;
use super::layout::Sections;
use crate::derivation::MotionInput;
use crate::lowering::Array;
use crate::model::{CompiledFunction, RobotModel};
use overact_core::{Columns, Function};
use proc_macro2::{Literal, TokenStream};
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
    if model.finds_joints(function) && function.computes == Function::Joints {
        return Item {
            tokens: super::inverse::item(model),
            sections: Sections::none(&function.name),
            names: Vec::new(),
        };
    }
    let (mut sections, mut names) = (Vec::new(), Vec::new());
    let (statements, value) = match twin(model, function) {
        Some(twin) => (TokenStream::new(), call(twin)),
        None => {
            let written = Body::write(&function.program, &Labels::new(model, function));
            (sections, names) = (written.sections, written.names);
            let value = written.value;
            let value = quote!(::core::result::Result::Ok(#value));
            (written.statements, value)
        }
    };
    Item {
        tokens: around(model, function, &statements, &value),
        sections: Sections {
            function: function.name.clone(),
            starts: sections,
        },
        names,
    }
}

/// The function with these statements and this value.
fn around(
    model: &RobotModel,
    function: &CompiledFunction,
    statements: &TokenStream,
    value: &TokenStream,
) -> TokenStream {
    let arguments = arguments(model, function);
    let name = format_ident!("{}", function.name);
    let output = array_type(&function.program.output);
    let documentation = documentation(model, function);
    let check = boundary(model, &arguments);
    let find_pose = (model.finds_pose(function) && model.needs_pose(function)).then(|| {
        quote! {
            let pose = &Self::pose_from_actuators(actuators, start)?;
        }
    });
    let find_joints = model
        .needs_joints(function)
        .then(|| quote!(let joints = &Self::joints(pose)?;));
    let parameters = arguments.iter().map(|argument| {
        let (name, kind) = (format_ident!("{}", argument.name), array_type(argument));
        quote!(#name: &#kind)
    });
    quote! {
        #(#[doc = #documentation])*
        pub fn #name(#(#parameters),*) -> ::core::result::Result<#output, ::overact::Error> {
            #check
            #find_pose
            #find_joints
            #statements
            #value
        }
    }
}

/// The function from joints that has the same program: where Newton's method finds the joints of a
/// pose, the function from the pose only calls it.
fn twin<'m>(model: &'m RobotModel, function: &CompiledFunction) -> Option<&'m CompiledFunction> {
    let is_pose = model.needs_joints(function) && function.from == MotionInput::Pose;
    is_pose
        .then(|| model.function(function.computes, MotionInput::Joints))
        .flatten()
}

/// The call of a function with arguments of the names of its inputs.
fn call(function: &CompiledFunction) -> TokenStream {
    let name = format_ident!("{}", function.name);
    let inputs = function.program.inputs.iter();
    let inputs = inputs.map(|array| format_ident!("{}", array.name));
    quote!(Self::#name(#(#inputs),*))
}

/// `[f64; 3]` or `[[f64; 64]; 3]`.
#[must_use]
pub(crate) fn array_type(array: &Array) -> TokenStream {
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

/// The arguments in order: the program's inputs, but for what is found first, and what it is found from.
fn arguments(model: &RobotModel, function: &CompiledFunction) -> Vec<Array> {
    let array = |name: &str, length: usize| Array {
        name: name.to_owned(),
        shape: vec![length],
    };
    let mut arguments = Vec::new();
    for input in &function.program.inputs {
        match input.name.as_str() {
            "joints" if model.finds_joints(function) => {}
            "pose" if model.finds_pose(function) => {
                arguments.push(array("actuators", model.mechanism.actuated().len()));
            }
            _ => arguments.push(input.clone()),
        }
    }
    if model.finds_pose(function) {
        arguments.push(array("start", model.mechanism.pose_len()));
    }
    arguments
}

/// Lines of documentation: meaning, inputs, output, errors, operations.
fn documentation(model: &RobotModel, function: &CompiledFunction) -> Vec<String> {
    let mut lines = vec![format!(" {}", function.computes.summary()), String::new()];
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
    if function.computes.columns().is_some() {
        lines.push(format!(" Columns: {}.", columns_constant(function)));
    }
    lines.push(String::new());
    lines.extend(super::operations::of_function(&model.cost(function)));
    if function.program.pieces > 0 {
        lines.push(format!(
            " Too large to be searched as a whole: fewer operations were searched in {} pieces.",
            function.program.pieces
        ));
    }
    lines.push(String::new());
    lines.push(" # Errors".to_owned());
    let can_fail = model.finds_pose(function)
        || model.needs_joints(function)
        || !function.program.guards.is_empty();
    lines.push(if can_fail {
        " An input that is not finite, a pose out of reach, or a singular configuration.".to_owned()
    } else {
        " An input that is not finite.".to_owned()
    });
    lines
}

fn columns_constant(function: &CompiledFunction) -> &'static str {
    match (function.computes, function.computes.columns()) {
        (Function::IdmRedPayload | Function::IdmRedPayloadActuators, _) => "`PAYLOAD_PARAMETERS`",
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
        "pose" if platform.is_some_and(|p| p.motion.has_quaternion()) => format!(
            "x = `[{}]` (m), in the base frame; the quaternion is scaled to length 1",
            coordinates()
        ),
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
        "base_parameters" => {
            "values of `BASE_PARAMETERS` followed by those of `PAYLOAD_PARAMETERS` (SI)".to_owned()
        }
        "preload" => "coordinates of the internal torque on `null_space` (N, N m)".to_owned(),
        _ => return None,
    })
}
