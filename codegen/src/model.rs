//! A compiled robot: sizes, parameters and one program per function.

use crate::derivation::{
    BodyParameter, FunctionForm, JointsBy, MotionInput, Selection, name_in_robot,
};
use crate::float::Float;
use crate::lowering::{Lanes, Magnitudes, Program};
use crate::mechanism::{JointIndex, JointKind, Mechanism, StandardParameter};
use crate::runtime::Runtime;
use crate::selection::{self, BaseParameter};
use overact_core::{Columns, FrameQuantity, Function};
use std::collections::BTreeMap;

/// A function of the robot with its program.
#[derive(Debug, Clone)]
#[non_exhaustive]
pub struct CompiledFunction {
    /// Name of the Rust function.
    pub name: String,
    /// The function that it computes.
    pub computes: Function,
    /// The motion from which it is evaluated. For actuators, the program's pose is that of forward
    /// kinematics.
    pub from: MotionInput,
    /// The program.
    pub program: Program,
    /// The program with equal legs in SIMD lanes, if the program is long and this is requested.
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
            name: name_in_robot(mechanism, FunctionForm::new(function, from)),
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
            // Of length 1 up to rounding.
            Some("pose") if has_quaternion && index >= position => 0.5,
            // Iterated values are one step farther than the last pose or joints.
            Some(name @ ("pose" | "joints")) => magnitudes.of_input(name) + 1.0,
            Some(name) => magnitudes.of_input(name),
            None => f64::INFINITY,
        };
        // Functions that start from this pose use it unchanged.
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
    /// Standard, base and payload columns, kept actuators, and the inverse kinematics.
    pub selection: Selection,
    /// Base parameters with their regroupings, in column order.
    ///
    /// The columns are chosen in the symmetric order (43), or such that they take the fewest
    /// operations.
    pub base: Vec<BaseParameter>,
    /// All functions.
    pub functions: Vec<CompiledFunction>,
    /// Whether generated code has forward kinematics, `pose_from_actuators`.
    pub forward_kinematics: bool,
    /// Whether all functions of `overact::Model` are included.
    pub is_model: bool,
    /// The floating-point type of generated code.
    pub float: Float,
    /// Path of the runtime crate in generated Rust.
    pub runtime: Runtime,
}

impl RobotModel {
    /// The function that is evaluated from a given motion.
    #[must_use]
    pub fn function(&self, function: Function, from: MotionInput) -> Option<&CompiledFunction> {
        self.functions
            .iter()
            .find(|f| f.computes == function && f.from == from)
    }

    /// All functions that robots have, with those of this robot's frames.
    pub fn all_functions(&self) -> impl Iterator<Item = Function> + use<> {
        let frames = 0..self.mechanism.frames.len();
        let of_frames = frames.flat_map(|frame| {
            let all = FrameQuantity::ALL.into_iter();
            all.map(move |quantity| Function::of_frame(frame, quantity))
        });
        Function::ALL.into_iter().chain(of_frames)
    }

    /// Name of a function in its form of plain states.
    #[must_use]
    pub fn function_name(&self, function: Function) -> String {
        match function {
            Function::Frame(_) => {
                let form = FunctionForm::new(function, MotionInput::Pose);
                name_in_robot(&self.mechanism, form)
            }
            _ => function.name().to_owned(),
        }
    }

    /// Names of the bodies whose mass is no parameter: `leg1.2`, `platform`.
    #[must_use]
    pub fn bodies_without_mass(&self) -> Vec<String> {
        let mechanism = &self.mechanism;
        let has = |body: BodyParameter| self.selection.standard.contains(&body);
        let symbol = StandardParameter::M;
        let mut names = Vec::new();
        for (leg, own) in mechanism.legs.iter().enumerate() {
            for (joint, of) in own.joints.iter().enumerate() {
                if of.motor.is_none() && !has(BodyParameter::Leg { leg, joint, symbol }) {
                    names.push(mechanism.joint_name(JointIndex { leg, joint }));
                }
            }
        }
        if mechanism.platform.is_some() && !has(BodyParameter::Platform(symbol)) {
            names.push("platform".to_owned());
        }
        names
    }

    /// The function of plain states (the pose or, for a tree, the joints).
    #[must_use]
    pub fn plain(&self, function: Function) -> Option<&CompiledFunction> {
        let from = if self.is_tree() {
            MotionInput::Joints
        } else {
            MotionInput::Pose
        };
        self.function(function, from)
    }

    /// The form of a function that [`overact::Model`](https://docs.rs/overact) evaluates, with the
    /// inputs [`Function::inputs`].
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

    /// Whether Newton's method computes the function's joints before its program runs.
    #[must_use]
    pub fn finds_joints(&self, function: &CompiledFunction) -> bool {
        self.selection.joints == JointsBy::Newton && function.from != MotionInput::Joints
    }

    /// Whether forward kinematics computes the function's pose before its program runs.
    #[must_use]
    pub fn finds_pose(&self, function: &CompiledFunction) -> bool {
        function.from == MotionInput::Actuators && function.computes != Function::PoseInClosedForm
    }

    /// Whether the function's program, or Newton's method for its joints, uses the pose.
    #[must_use]
    pub(crate) fn needs_pose(&self, function: &CompiledFunction) -> bool {
        uses(function, "pose") || self.needs_joints(function)
    }

    /// Whether the function's program uses joints that Newton's method computes.
    #[must_use]
    pub(crate) fn needs_joints(&self, function: &CompiledFunction) -> bool {
        // The joints themselves are the result of Newton's method.
        let needs = uses(function, "joints") || function.computes == Function::Joints;
        self.finds_joints(function) && needs
    }

    /// The parameters of a function's columns.
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

    /// Name of a base parameter: with the suffix `R` if others are regrouped into it.
    #[must_use]
    pub fn base_name(&self, base: &BaseParameter) -> String {
        let suffix = if base.regrouped.is_empty() { "" } else { "R" };
        format!("{}{suffix}", self.parameter_name(base.parameter))
    }

    /// Values of the base parameters with their regroupings, then of the payload, from standard
    /// parameters by name.
    ///
    /// Missing values are zero.
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
            BodyParameter::Spring(index) => {
                let force = self.mechanism.springs[index].force.as_ref();
                force.map_or("", |force| &force.unit)
            }
            BodyParameter::Motor { motor, symbol } => {
                let kind = self.mechanism.motors[motor].kind;
                symbol.unit(kind == JointKind::Prismatic)
            }
            BodyParameter::Platform(symbol)
            | BodyParameter::Payload(symbol)
            | BodyParameter::Load { symbol, .. } => symbol.unit(false),
        }
    }
}

/// Whether a function's program reads an input.
fn uses(function: &CompiledFunction, input: &str) -> bool {
    let program = &function.program;
    let mut inputs = program.inputs.iter().zip(program.used_inputs());
    inputs.any(|(array, used)| used && array.name == input)
}
