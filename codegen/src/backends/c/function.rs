//! One function: documentation, signature, body.

use super::errors;
use super::expression::{Writer, fails};
use super::lines::documentation;
use super::naming::Naming;
use super::tables::number;
use crate::backends::writing::body::Body;
use crate::backends::writing::labels::Labels;
use crate::backends::writing::operations;
use crate::backends::writing::outline::{Outline, Table};
use crate::lowering::Array;
use crate::model::{CompiledFunction, RobotModel};
use overact_core::Extent;

/// A function as its parts.
pub struct FunctionText {
    /// The comment in the header.
    pub documentation: String,
    /// The signature, without the terminating character.
    pub signature: String,
    /// The body in braces; empty if the runtime part contains it.
    pub body: String,
    /// All names assigned in the body.
    pub names: Vec<String>,
}

/// Writes a function of a robot.
#[must_use]
pub fn written(model: &RobotModel, function: &CompiledFunction, naming: &Naming) -> FunctionText {
    let outline = Outline::new(model, function);
    let (mut body, mut names) = (String::new(), Vec::new());
    if !outline.is_newton {
        let boundary = boundary(model, &outline, naming);
        let (rest, own) = rest(model, function, &outline, naming);
        body = format!("{{\n{boundary}{rest}}}\n");
        names = own;
    }
    FunctionText {
        documentation: documented(model, function, &outline, naming),
        signature: signature(&function.name, &outline.arguments, naming),
        body,
        names,
    }
}

/// Signature of a function with these arguments and an output.
#[must_use]
pub fn signature(name: &str, arguments: &[Array], naming: &Naming) -> String {
    let restrict = naming.constant("RESTRICT");
    let arguments = arguments.iter();
    let mut lines: Vec<String> = arguments
        .map(|argument| format!("    const double *{restrict} {}", argument.name))
        .collect();
    lines.push(format!("    double *{restrict} output"));
    let (kind, name) = (naming.name("error"), naming.name(name));
    format!("{kind} {name}(\n{})", lines.join(",\n"))
}

/// Whether a robot's pose ends with a quaternion.
#[must_use]
pub fn has_quaternion(model: &RobotModel) -> bool {
    let platform = model.mechanism.platform.as_ref();
    platform.is_some_and(|platform| platform.motion.has_quaternion())
}

/// Start of a function: checks, and iterations for pose and joints.
///
/// It rejects numbers that are not finite or too large, and normalises the quaternion of a pose.
fn boundary(model: &RobotModel, outline: &Outline<'_>, naming: &Naming) -> String {
    let mut out = String::new();
    for Array { name, shape } in &outline.arguments {
        let length = shape.iter().product::<usize>();
        // C compilers warn about comparisons of an unsigned count with 0.
        if length == 0 {
            out += &format!("    (void){name};\n");
            continue;
        }
        out += &in_range(name, &length.to_string(), naming);
    }
    if takes_pose(outline) && has_quaternion(model) {
        out += &format!("    double unit_pose[{}];\n", naming.constant("POSE"));
        let holds = format!("{}(pose, unit_pose)", naming.name("unit_quaternion"));
        out += &fails(&holds, &naming.constant("ZERO_QUATERNION_POSE"));
    }
    if outline.finds_pose {
        let call = format!(
            "{}(actuators, start, found_pose)",
            naming.name("pose_from_actuators")
        );
        out += &found("found_pose", "POSE", &call, naming);
    }
    if outline.finds_joints {
        let pose = pose_name(model, outline);
        let call = format!("{}({pose}, found_joints)", naming.name("joints"));
        out += &found("found_joints", "JOINTS", &call, naming);
    }
    out
}

/// Rejects an input with a number that is not finite or too large.
#[must_use]
pub fn in_range(name: &str, length: &str, naming: &Naming) -> String {
    let most = number(naming.float.limits().largest.of(name));
    let holds = format!("{}({name}, {length}, {most})", naming.name("is_within"));
    let error = format!(
        "{}({name}, {length}) ? {} : {}",
        naming.name("is_finite"),
        naming.constant(&errors::out_of_range(name)),
        naming.constant(&errors::not_finite(name))
    );
    fails(&holds, &error)
}

/// An array that a function fills; returns its error.
fn found(array: &str, size: &str, call: &str, naming: &Naming) -> String {
    let (size, kind, ok) = (
        naming.constant(size),
        naming.name("error"),
        naming.constant("OK"),
    );
    format!(
        "    double {array}[{size}];\n    const {kind} {array}_error = {call};\n    \
         if ({array}_error != {ok}) {{\n        return {array}_error;\n    }}\n"
    )
}

fn takes_pose(outline: &Outline<'_>) -> bool {
    outline
        .arguments
        .iter()
        .any(|argument| argument.name == "pose")
}

/// Name of the pose in the body.
fn pose_name(model: &RobotModel, outline: &Outline<'_>) -> &'static str {
    match (outline.finds_pose, has_quaternion(model)) {
        (true, _) => "found_pose",
        (false, true) => "unit_pose",
        (false, false) => "pose",
    }
}

/// The code after the checks, and the names that it assigns.
fn rest(
    model: &RobotModel,
    function: &CompiledFunction,
    outline: &Outline<'_>,
    naming: &Naming,
) -> (String, Vec<String>) {
    let program = &function.program;
    let called = |array: &Array| match array.name.as_str() {
        "pose" => pose_name(model, outline).to_owned(),
        "joints" if outline.finds_joints => "found_joints".to_owned(),
        name => name.to_owned(),
    };
    let inputs: Vec<String> = program.inputs.iter().map(called).collect();
    if let Some(twin) = outline.twin {
        let name = naming.name(&twin.name);
        let call = format!("    return {name}({}, output);\n", inputs.join(", "));
        return (call, Vec::new());
    }
    let reserved = |name: &str| naming.is_reserved(name);
    let labels = Labels::new(model, function);
    // An error leaves the output unchanged: functions that may still fail write it last.
    let body = if outline.is_placed() && program.guards.is_empty() {
        Body::placed(program, &labels, &reserved)
    } else {
        Body::write(program, &labels, &reserved)
    };
    let mut writer = Writer {
        model,
        naming,
        inputs,
        angles: 0,
    };
    let statements = writer.write(&body, &program.output);
    if !program.least_torques.is_empty() {
        let statements = statements.replace(" output[", " system[");
        let count = program.entries.len();
        let distribute = naming.name("distribute_tensions");
        let text = format!(
            "    double system[{count}];\n{statements}    return {distribute}(system, output);\n"
        );
        return (text, body.names);
    }
    let ok = naming.constant("OK");
    (format!("{statements}    return {ok};\n"), body.names)
}

/// The comment before a function.
fn documented(
    model: &RobotModel,
    function: &CompiledFunction,
    outline: &Outline<'_>,
    naming: &Naming,
) -> String {
    let mut lines = vec![function.computes.summary().to_owned(), String::new()];
    lines.push(outline.origin.to_owned());
    lines.extend(
        outline
            .missing_masses
            .iter()
            .map(|text| text.replace('`', "")),
    );
    let meaning = |name: &str| {
        let known = outline.meanings.iter().find(|(known, _)| known == name);
        let meaning = known.map_or("", |(_, meaning)| meaning.as_str());
        let table = |name| naming.name(name);
        let meaning = meaning
            .replace("`PARAMETERS`", &table("parameters"))
            .replace("`PAYLOAD_PARAMETERS`", &table("payload_parameters"));
        meaning.replace('`', "")
    };
    for argument in &outline.arguments {
        let (name, size) = (&argument.name, size(model, &argument.name, naming));
        lines.push(format!("@param {name} {} ({size})", meaning(name)));
    }
    let extents = extents(function, naming).into_iter();
    let shape: String = extents.map(|extent| format!("[{extent}]")).collect();
    let table = outline.columns.map(|table| match table {
        Table::Parameters => "parameters",
        Table::BaseParameters => "base_parameters",
        Table::PayloadParameters => "payload_parameters",
    });
    let table = table.map(|table| format!("; columns: {}", naming.name(table)));
    let shapes = function.program.output.shape.iter();
    let shapes: Vec<String> = shapes.map(ToString::to_string).collect();
    lines.push(format!(
        "@param[out] output {shape}, {}{}",
        shapes.join(" x "),
        table.unwrap_or_default()
    ));
    lines.push(if outline.can_fail { "@return 0, or an error: an input is infinite, NaN or too large, the pose is out of reach, or the configuration is singular." } else { "@return 0, or an error: an input is infinite, NaN or too large." }.to_owned());
    lines.push(String::new());
    let operations = operations::of_function(&model.cost(function));
    lines.extend(operations.iter().map(|line| line.trim_start().to_owned()));
    documentation(&lines)
}

/// The extents of a function's output, one of a vector or two of a matrix, as macros of sizes.
#[must_use]
pub fn extents(function: &CompiledFunction, naming: &Naming) -> Vec<String> {
    let (rows, columns) = function.computes.extents();
    let extent = |extent| match extent {
        Extent::Fixed(count) => count.to_string(),
        _ => naming.constant(extent_name(extent)),
    };
    std::iter::once(rows).chain(columns).map(extent).collect()
}

/// Number of elements of an argument, as macros of sizes.
#[must_use]
pub fn size(model: &RobotModel, argument: &str, naming: &Naming) -> String {
    let sizes: &[&str] = match argument {
        "pose" | "start" => &["POSE"],
        "joints" => &["JOINTS"],
        "parameters" => &["PARAMETERS", "PAYLOAD_PARAMETERS"],
        "base_parameters" => &["BASE_PARAMETERS", "PAYLOAD_PARAMETERS"],
        "preload" => &["REDUNDANCY"],
        "wrench" => return "6".to_owned(),
        "twist" | "acceleration" => &["DOF"],
        "joint_velocities" | "joint_accelerations" if model.is_tree() => &["DOF"],
        _ => &["ACTUATORS"],
    };
    let sizes: Vec<String> = sizes.iter().map(|size| naming.constant(size)).collect();
    sizes.join(" + ")
}

/// The macro of an extent, without prefix.
const fn extent_name(extent: Extent) -> &'static str {
    match extent {
        Extent::Pose => "POSE",
        Extent::Actuators => "ACTUATORS",
        Extent::Joints => "JOINTS",
        Extent::Redundancy => "REDUNDANCY",
        Extent::Parameters => "PARAMETERS",
        Extent::BaseParameters => "BASE_PARAMETERS",
        Extent::PayloadParameters => "PAYLOAD_PARAMETERS",
        Extent::Free => "FREE",
        Extent::Blocked => "BLOCKED",
        Extent::Dependent => "DEPENDENT",
        _ => "DOF",
    }
}
