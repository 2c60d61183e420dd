//! A function around its body: arguments, what is found before the body runs, and what its documentation
//! says.

use crate::derivation::MotionInput;
use crate::lowering::Array;
use crate::model::{CompiledFunction, RobotModel};
use overact_core::{Columns, Function};

/// The table of parameters that columns stand for.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Table {
    /// Standard parameters.
    Parameters,
    /// Base parameters.
    BaseParameters,
    /// The payload's.
    PayloadParameters,
}

/// A function of a robot as its caller sees it.
pub struct Outline<'m> {
    /// The arguments in order: the program's inputs, but for what is found first, and what it is found from.
    pub arguments: Vec<Array>,
    /// Whether forward kinematics finds the pose that the rest takes.
    pub finds_pose: bool,
    /// Whether Newton's method finds the joints that the program takes.
    pub finds_joints: bool,
    /// Whether the joints that Newton's method finds are all that there is to the function.
    pub is_newton: bool,
    /// The function from joints that has the same program: where Newton's method finds the joints of a
    /// pose, the function from the pose only calls it.
    pub twin: Option<&'m CompiledFunction>,
    /// From what it is evaluated, in a sentence.
    pub origin: &'static str,
    /// What each argument is.
    pub meanings: Vec<(String, String)>,
    /// What the columns of the output stand for.
    pub columns: Option<Table>,
    /// Whether more than an input that is not finite can be wrong.
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
            can_fail: model.finds_pose(function)
                || finds_joints
                || !function.program.guards.is_empty(),
        }
    }
}

impl Outline<'_> {
    /// Whether the output is written into a place that the caller hands in, number by number: that of models with a
    /// column for each parameter, which is too large to be handed back without a copy.
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

fn origin(model: &RobotModel, function: &CompiledFunction) -> &'static str {
    match (function.from, model.is_tree()) {
        (_, true) => "From the joints' positions and rates.",
        (MotionInput::Pose, _) => "From the platform's pose and motion.",
        (MotionInput::Joints, _) => {
            "From measured joint positions and the platform's motion; of the pose only the orientation is used."
        }
        (MotionInput::Actuators, _) if !model.finds_pose(function) => {
            "From the actuators' positions."
        }
        (MotionInput::Actuators, _) => {
            "From the actuators' motion: forward kinematics from the pose `start`, then least squares."
        }
    }
}

/// What the arguments are, each with its name.
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

fn columns(function: &CompiledFunction) -> Option<Table> {
    let columns = function.computes.columns()?;
    Some(match (function.computes, columns) {
        (Function::IdmRedPayload | Function::IdmRedPayloadActuators, _) => Table::PayloadParameters,
        (_, Columns::Base) => Table::BaseParameters,
        _ => Table::Parameters,
    })
}

/// What an input is.
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
    Some(match name {
        "pose" if platform.is_some_and(|p| p.motion.has_quaternion()) => format!(
            "x = `[{}]` (m), in the base frame; the quaternion is scaled to length 1",
            coordinates()
        ),
        "pose" if of_skeleton => {
            format!("x = `[{}]` (m, rad), independent joints", coordinates())
        }
        "twist" if of_skeleton => "v, velocities of the independent joints (m/s, rad/s)".to_owned(),
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
        "start" => "a pose near the wanted one, in its assembly mode (m, rad)".to_owned(),
        _ => return None,
    })
}
