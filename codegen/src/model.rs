//! A compiled robot: sizes, parameters and one program per function.

use crate::derivation::{BodyParameter, Columns, Family, JointsBy, MotionInput, Selection};
use crate::lowering::Program;
use crate::mechanism::{JointKind, Mechanism};
use crate::selection::BaseParameter;

/// A function of the robot.
#[derive(Debug, Clone)]
#[non_exhaustive]
pub struct CompiledFunction {
    /// Name of the Rust function.
    pub name: String,
    /// What it computes.
    pub family: Family,
    /// What it is evaluated from. From actuators, the program's pose is the one that forward
    /// kinematics finds.
    pub from: MotionInput,
    /// The program.
    pub program: Program,
}

impl CompiledFunction {
    /// A function of a robot with its program.
    pub(crate) fn new(
        mechanism: &Mechanism,
        family: Family,
        from: MotionInput,
        program: Program,
    ) -> Self {
        Self {
            name: family.function_name(from, mechanism.platform.is_none()),
            family,
            from,
            program,
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
    /// Base parameters with their regroupings, in the symmetric order (43).
    pub base: Vec<BaseParameter>,
    /// All functions.
    pub functions: Vec<CompiledFunction>,
}

impl RobotModel {
    /// The function of a family, evaluated from what is asked for.
    #[must_use]
    pub fn function(&self, family: Family, from: MotionInput) -> Option<&CompiledFunction> {
        self.functions
            .iter()
            .find(|f| f.family == family && f.from == from)
    }

    /// The function that plain states (pose or, for a tree, joints) are given to.
    #[must_use]
    pub fn plain(&self, family: Family) -> Option<&CompiledFunction> {
        let from = if self.is_tree() {
            MotionInput::Joints
        } else {
            MotionInput::Pose
        };
        self.function(family, from)
    }

    /// Whether the robot has no platform.
    #[must_use]
    pub const fn is_tree(&self) -> bool {
        self.mechanism.platform.is_none()
    }

    /// Whether the function's joints are found by Newton's method before its program runs.
    #[must_use]
    pub fn finds_joints(&self, function: &CompiledFunction) -> bool {
        self.selection.joints == JointsBy::Newton && function.from != MotionInput::Joints
    }

    /// Whether forward kinematics finds the function's pose before its program runs.
    #[must_use]
    pub fn finds_pose(&self, function: &CompiledFunction) -> bool {
        function.from == MotionInput::Actuators && function.family != Family::PoseInClosedForm
    }

    /// The parameters that the columns of a function stand for.
    #[must_use]
    pub fn columns_of(&self, family: Family) -> &[BodyParameter] {
        match family {
            Family::IdmRedPayload | Family::IdmRedPayloadActuators => &self.selection.payload,
            _ => match family.columns() {
                Some(Columns::Standard) => &self.selection.standard,
                Some(Columns::Base) => &self.selection.base,
                None => &[],
            },
        }
    }

    /// Name of a parameter, `zz_2_leg3`, `m_platform` or `m_payload`.
    #[must_use]
    pub fn parameter_name(&self, parameter: BodyParameter) -> String {
        match parameter {
            BodyParameter::Leg { leg, joint, symbol } => {
                self.mechanism.parameter_name(symbol, leg, joint)
            }
            BodyParameter::Platform(symbol) => format!("{}_platform", symbol.name()),
            BodyParameter::Payload(symbol) => format!("{}_payload", symbol.name()),
        }
    }

    /// Name of a base parameter: with the suffix `R` where others are regrouped into it.
    #[must_use]
    pub fn base_name(&self, base: &BaseParameter) -> String {
        let suffix = if base.regrouped.is_empty() { "" } else { "R" };
        format!("{}{suffix}", self.parameter_name(base.parameter))
    }

    /// SI unit of a parameter.
    #[must_use]
    pub fn parameter_unit(&self, parameter: BodyParameter) -> &'static str {
        match parameter {
            BodyParameter::Leg { leg, joint, symbol } => {
                symbol.unit(self.mechanism.legs[leg].joints[joint].kind)
            }
            BodyParameter::Platform(symbol) | BodyParameter::Payload(symbol) => {
                symbol.unit(JointKind::Fixed)
            }
        }
    }
}
