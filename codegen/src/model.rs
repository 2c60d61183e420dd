//! A compiled robot: sizes, parameters and one program per function.

use crate::derivation::{BodyParameter, JointsBy, MotionInput, Selection, function_name};
use crate::float::Float;
use crate::lowering::{Lanes, Magnitudes, Program};
use crate::mechanism::{JointKind, Mechanism, StandardParameter};
use crate::runtime::Runtime;
use crate::selection::{self, BaseParameter};
use overact_core::{Columns, Function};
use std::collections::BTreeMap;

/// A function of the robot with its program.
#[derive(Debug, Clone)]
#[non_exhaustive]
pub struct CompiledFunction {
    /// Name of the Rust function.
    pub name: String,
    /// What it computes.
    pub computes: Function,
    /// What it is evaluated from. From actuators, the program's pose is the one that forward
    /// kinematics finds.
    pub from: MotionInput,
    /// The program.
    pub program: Program,
    /// The same with legs that are alike side by side, where the program is long and that is asked for.
    pub lanes: Option<Lanes>,
}

impl CompiledFunction {
    /// A function of a robot with its program.
    pub(crate) fn new(
        mechanism: &Mechanism,
        function: Function,
        from: MotionInput,
        program: Program,
        lanes: Option<Lanes>,
    ) -> Self {
        Self {
            name: function_name(function, from, mechanism.is_tree()),
            computes: function,
            from,
            program,
            lanes,
        }
    }

    /// Adds guards so that all values of the function's programs are finite.
    pub(crate) fn guard_sizes(&mut self, mechanism: &Mechanism, float: Float) {
        let magnitudes = Magnitudes::new(float);
        let platform = mechanism.platform.as_ref();
        let has_quaternion = platform.is_some_and(|platform| platform.motion.has_quaternion());
        let position = mechanism.pose_len().saturating_sub(4);
        let names: Vec<String> = self.program.inputs.iter().map(|i| i.name.clone()).collect();
        let bounds = |array: usize, index: usize| match names.get(array).map(String::as_str) {
            // Of length 1 but for rounding.
            Some("pose") if has_quaternion && index >= position => 0.5,
            // What an iteration finds is a step further than its last pose or joints.
            Some(name @ ("pose" | "joints")) => magnitudes.of_input(name) + 1.0,
            Some(name) => magnitudes.of_input(name),
            None => f64::INFINITY,
        };
        // What starts from this pose takes it as it is.
        let most = match self.computes {
            Function::PoseInClosedForm => float.limits().largest.pose,
            _ => f64::INFINITY,
        };
        magnitudes.guard(&mut self.program, &bounds, most);
        if let Some(lanes) = &mut self.lanes {
            magnitudes.guard_lanes(lanes, &bounds);
        }
    }
}

/// A robot's model.
#[derive(Debug, Clone)]
#[non_exhaustive]
pub struct RobotModel {
    /// The robot.
    pub mechanism: Mechanism,
    /// Standard, base and payload columns, kept actuators, and how the joints follow from the pose.
    pub selection: Selection,
    /// Base parameters with their regroupings, in the order of the columns: the symmetric one (43), or the one whose
    /// columns take the fewest operations.
    pub base: Vec<BaseParameter>,
    /// All functions.
    pub functions: Vec<CompiledFunction>,
    /// Whether generated code has forward kinematics, `pose_from_actuators`.
    pub forward_kinematics: bool,
    /// Whether no function was left out that `overact::Model` is asked for.
    pub is_model: bool,
    /// The numbers that generated code computes with.
    pub float: Float,
    /// Under which path generated Rust finds the runtime crate.
    pub runtime: Runtime,
}

impl RobotModel {
    /// The program of a function, evaluated from what is asked for.
    #[must_use]
    pub fn function(&self, function: Function, from: MotionInput) -> Option<&CompiledFunction> {
        self.functions
            .iter()
            .find(|f| f.computes == function && f.from == from)
    }

    /// The function that plain states (pose or, for a tree, joints) are given to.
    #[must_use]
    pub fn plain(&self, function: Function) -> Option<&CompiledFunction> {
        let from = if self.is_tree() {
            MotionInput::Joints
        } else {
            MotionInput::Pose
        };
        self.function(function, from)
    }

    /// The form of a function that [`overact::Model`](https://docs.rs/overact) evaluates, whose inputs are
    /// those of [`Function::inputs`].
    #[must_use]
    pub fn served(&self, function: Function) -> Option<&CompiledFunction> {
        let from = |from| self.function(function, from);
        self.plain(function)
            .or_else(|| from(MotionInput::Joints))
            .or_else(|| from(MotionInput::Actuators))
    }

    /// Whether the robot has no platform.
    #[must_use]
    pub fn is_tree(&self) -> bool {
        self.mechanism.is_tree()
    }

    /// Whether the function's joints are found by Newton's method before its program runs.
    #[must_use]
    pub fn finds_joints(&self, function: &CompiledFunction) -> bool {
        self.selection.joints == JointsBy::Newton && function.from != MotionInput::Joints
    }

    /// Whether forward kinematics finds the function's pose before its program runs.
    #[must_use]
    pub fn finds_pose(&self, function: &CompiledFunction) -> bool {
        function.from == MotionInput::Actuators && function.computes != Function::PoseInClosedForm
    }

    /// Whether the function's program, or the search of its joints, uses the pose.
    #[must_use]
    pub(crate) fn needs_pose(&self, function: &CompiledFunction) -> bool {
        uses(function, "pose") || self.needs_joints(function)
    }

    /// Whether the function's program uses joints that Newton's method has to find first.
    #[must_use]
    pub(crate) fn needs_joints(&self, function: &CompiledFunction) -> bool {
        // The joints themselves are what Newton's method gives.
        let needs = uses(function, "joints") || function.computes == Function::Joints;
        self.finds_joints(function) && needs
    }

    /// The parameters that the columns of a function stand for.
    #[must_use]
    pub fn columns_of(&self, function: Function) -> &[BodyParameter] {
        match function {
            Function::IdmRedPayload | Function::IdmRedPayloadActuators => &self.selection.payload,
            _ => match function.columns() {
                Some(Columns::Standard) => &self.selection.standard,
                Some(Columns::Base) => &self.selection.base,
                None => &[],
            },
        }
    }

    /// Name of a parameter, `zz_2_leg3`, `m_platform` or `m_payload`.
    #[must_use]
    pub fn parameter_name(&self, parameter: BodyParameter) -> String {
        parameter.name(&self.mechanism)
    }

    /// Name of a base parameter: with the suffix `R` where others are regrouped into it.
    #[must_use]
    pub fn base_name(&self, base: &BaseParameter) -> String {
        let suffix = if base.regrouped.is_empty() { "" } else { "R" };
        format!("{}{suffix}", self.parameter_name(base.parameter))
    }

    /// Values of the base parameters, with what is regrouped into them, followed by the payload's, of given
    /// standard parameters by name; what is not given is zero.
    #[must_use]
    pub fn regrouped(&self, given: &BTreeMap<String, f64>) -> Vec<(BodyParameter, f64)> {
        selection::regrouped(&self.mechanism, &self.selection, &self.base, given)
    }

    /// SI unit of a parameter.
    #[must_use]
    pub fn parameter_unit(&self, parameter: BodyParameter) -> &str {
        match parameter {
            BodyParameter::Leg { leg, joint, symbol } => {
                let joint = &self.mechanism.legs[leg].joints[joint];
                let formula = match symbol {
                    StandardParameter::K => joint.spring.as_ref(),
                    StandardParameter::Fl => joint.load.as_ref(),
                    _ => None,
                };
                match formula {
                    Some(formula) => &formula.unit,
                    None => symbol.unit(joint.kind == JointKind::Prismatic),
                }
            }
            BodyParameter::Platform(symbol) | BodyParameter::Payload(symbol) => symbol.unit(false),
        }
    }
}

/// Whether a function's program reads an input.
fn uses(function: &CompiledFunction, input: &str) -> bool {
    let program = &function.program;
    let mut inputs = program.inputs.iter().zip(program.used_inputs());
    inputs.any(|(array, used)| used && array.name == input)
}
