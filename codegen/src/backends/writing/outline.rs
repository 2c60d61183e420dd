//! A function around its body: arguments, iterations before the body, and documentation.

use crate::derivation::MotionInput;
use crate::lowering::Array;
use crate::model::{CompiledFunction, RobotModel};
use overact_core::{Columns, Function};

/// The table of parameters that corresponds to the columns.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Table {
    /// Standard parameters.
    Parameters,
    /// Base parameters.
    BaseParameters,
    /// Payload parameters.
    PayloadParameters,
}

/// A function of a robot as its caller sees it.
pub struct Outline<'m> {
    /// The arguments in order: the program's inputs, with values of iterations replaced by the
    /// iterations' inputs.
    pub arguments: Vec<Array>,
    /// Whether forward kinematics computes the program's pose.
    pub finds_pose: bool,
    /// Whether Newton's method computes the program's joints.
    pub finds_joints: bool,
    /// Whether the function consists of Newton's method for the joints only.
    pub is_newton: bool,
    /// The function of the joints with the same program.
    ///
    /// If Newton's method computes the joints, the function of the pose only calls it.
    pub twin: Option<&'m CompiledFunction>,
    /// Sentence on the input from which it is evaluated.
    pub origin: &'static str,
    /// Description of each argument.
    pub meanings: Vec<(String, String)>,
    /// The parameters of the output's columns.
    pub columns: Option<Table>,
    /// Sentence on the masses that are missing in the result, if any.
    pub missing_masses: Option<String>,
    /// Whether it can fail for other reasons than an input that is not finite.
    pub can_fail: bool,
}

impl<'m> Outline<'m> {
    /// The outline of a robot's function.
    #[must_use]
    pub fn new(model: &'m RobotModel, function: &'m CompiledFunction) -> Self {
        let finds_joints = model.needs_joints(function);
        let is_newton = model.finds_joints(function) && function.computes == Function::Joints;
        let is_pose = finds_joints && function.from == MotionInput::Pose && !is_newton;
        let twin = || model.function(function.computes, MotionInput::Joints);
        Self {
            arguments: arguments(model, function),
            finds_pose: model.finds_pose(function) && model.needs_pose(function),
            finds_joints,
            is_newton,
            twin: is_pose.then(twin).flatten(),
            origin: origin(model, function),
            meanings: meanings(model, function),
            columns: columns(function),
            missing_masses: missing_masses(model, function),
            can_fail: model.finds_pose(function)
                || finds_joints
                || !function.program.guards.is_empty(),
        }
    }
}

impl Outline<'_> {
    /// Whether the caller provides the matrix into which the output is written, number by number.
    ///
    /// It holds for models with a column per parameter, which are too large to be returned without
    /// a copy.
    #[must_use]
    pub fn is_placed(&self) -> bool {
        self.columns.is_some()
    }
}

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
                arguments.push(array("actuators", model.mechanism.actuator_count()));
            }
            _ => arguments.push(input.clone()),
        }
    }
    if model.finds_pose(function) {
        arguments.push(array("start", model.mechanism.pose_len()));
    }
    arguments
}

fn origin(model: &RobotModel, function: &CompiledFunction) -> &'static str {
    match (function.from, model.is_tree()) {
        (_, true) => "From the joints' positions and rates.",
        (MotionInput::Pose, _) => "From the platform's pose and motion.",
        (MotionInput::Joints, _) => {
            "From measured joint positions and the platform's motion; only the orientation of the pose is used."
        }
        (MotionInput::Actuators, _) if !model.finds_pose(function) => {
            "From the actuators' positions."
        }
        (MotionInput::Actuators, _) => {
            "From the actuators' motion: forward kinematics from the pose `start`, then least squares."
        }
    }
}

/// The arguments' names and descriptions.
fn meanings(model: &RobotModel, function: &CompiledFunction) -> Vec<(String, String)> {
    let mut meanings = Vec::new();
    for array in &function.program.inputs {
        let pose_is_found = model.finds_pose(function) && array.name == "pose";
        let joints_are_found = model.finds_joints(function) && array.name == "joints";
        if let Some(text) = input_meaning(model, &array.name)
            && !pose_is_found
            && !joints_are_found
        {
            meanings.push((array.name.clone(), text));
        }
    }
    if model.finds_pose(function) {
        for name in ["actuators", "start"] {
            let text = input_meaning(model, name);
            meanings.extend(text.map(|text| (name.to_owned(), text)));
        }
    }
    meanings
}

/// Names the bodies whose masses are no parameters, for functions of all masses.
fn missing_masses(model: &RobotModel, function: &CompiledFunction) -> Option<String> {
    let is_of_masses = matches!(
        function.computes,
        Function::TotalMass
            | Function::CentreOfMass
            | Function::CentreOfMassJacobian
            | Function::PotentialEnergy
    );
    let names = model.bodies_without_mass();
    if !is_of_masses || names.is_empty() {
        return None;
    }
    let names: Vec<String> = names.iter().map(|name| format!("`{name}`")).collect();
    Some(format!(
        "Bodies whose mass is no parameter of the robot, so that it counts as zero: {}.",
        names.join(", ")
    ))
}

fn columns(function: &CompiledFunction) -> Option<Table> {
    let columns = function.computes.columns()?;
    Some(match (function.computes, columns) {
        (Function::IdmRedPayload | Function::IdmRedPayloadActuators, _) => Table::PayloadParameters,
        (_, Columns::Base) => Table::BaseParameters,
        _ => Table::Parameters,
    })
}

/// Names of the subjects of a sentence with its verb.
fn are(names: &[String]) -> String {
    let names: Vec<String> = names.iter().map(|name| format!("`{name}`")).collect();
    match names.as_slice() {
        [one] => format!("{one} is"),
        all => format!("{} are", all.join(", ")),
    }
}

/// Description of an input.
#[must_use]
pub fn input_meaning(model: &RobotModel, name: &str) -> Option<String> {
    let platform = model.mechanism.platform.as_ref();
    let coordinates = || model.mechanism.pose_coordinates().join(", ");
    let rates = || {
        platform
            .map(|p| p.motion.twist_names().join(", "))
            .unwrap_or_default()
    };
    let of_skeleton = model.mechanism.skeleton().is_some();
    let driven = || model.mechanism.kind_of_actuators();
    Some(match name {
        "pose" if platform.is_some_and(|p| p.motion.has_quaternion()) => format!(
            "x = `[{}]` (m), in the base frame; the quaternion is scaled to length 1",
            coordinates()
        ),
        "pose" if model.mechanism.has_dependent_joints() => format!(
            "x = `[{}]` (m, rad), joints that satisfy the closures; {} independent",
            coordinates(),
            are(&model.mechanism.coordinates())
        ),
        "pose" if of_skeleton => {
            format!("x = `[{}]` (m, rad), independent joints", coordinates())
        }
        "twist" if of_skeleton => "v, velocities of the independent joints (m/s, rad/s)".to_owned(),
        "pose" => format!("x = `[{}]` (m, rad), in the base frame", coordinates()),
        "joints" => "q_t, all joint positions, leg by leg (m, rad)".to_owned(),
        "actuators" => format!("q, positions of the {} (m, rad)", driven()),
        "twist" => format!("v = `[{}]` (m/s, rad/s), in the base frame", rates()),
        "acceleration" => "the derivative of `twist` (m/s², rad/s²)".to_owned(),
        "joint_velocities" => "velocities of the joints (m/s, rad/s)".to_owned(),
        "joint_accelerations" => "accelerations of the joints (m/s², rad/s²)".to_owned(),
        "actuator_velocities" => format!("velocities of the {} (m/s, rad/s)", driven()),
        "actuator_accelerations" => {
            format!("accelerations of the {} (m/s², rad/s²)", driven())
        }
        "torques" => "τ, forces and torques of the actuators (N, N m)".to_owned(),
        "parameters" => {
            "values of `PARAMETERS` followed by those of `PAYLOAD_PARAMETERS` (SI)".to_owned()
        }
        "base_parameters" => {
            "values of `BASE_PARAMETERS` followed by those of `PAYLOAD_PARAMETERS` (SI)".to_owned()
        }
        "preload" => "coordinates of the internal torque on `null_space` (N, N m)".to_owned(),
        "wrench" => {
            "force (N) and moment (N m) of the environment on the frame, at its origin, in the base frame".to_owned()
        }
        "start" => "a pose near the solution, in its assembly mode (m, rad)".to_owned(),
        _ => return None,
    })
}
