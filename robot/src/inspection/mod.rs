//! Composition and cost of a robot's model: the document of `overact inspect`.
//!
//! The field names are the keys of the document.

mod conditioning;

pub use conditioning::{Conditioning, Partition};

use crate::{compiled_file::CompiledFile, interpreted::InterpretedRobot};
use overact::Columns;
use overact_codegen::{
    BaseParameter, RobotModel, TotalCost, derivation::MotionInput, lowering::Array,
};
use serde::Serialize;

/// Composition and cost of a robot's model.
#[derive(Debug, Serialize)]
#[non_exhaustive]
pub struct Inspection {
    /// Name of the robot.
    pub robot: String,
    /// Summary of one sentence; empty if the description has none.
    pub summary: String,
    /// File name as the user gave it.
    pub file: String,
    /// Degrees of freedom r.
    pub dof: usize,
    /// Actuators n.
    pub actuators: usize,
    /// Number of joints of all legs, n_t.
    pub joints: usize,
    /// Names of the n actuators.
    pub actuator_names: Vec<String>,
    /// Names of the n_t joints.
    pub joint_names: Vec<String>,
    /// Names of the r coordinates of the twist.
    pub coordinates: Vec<String>,
    /// Names of the coordinates of the pose.
    pub pose: Vec<String>,
    /// The pose at home, m and rad.
    pub home_pose: Vec<f64>,
    /// The joints at home, rad or m.
    pub home_joints: Vec<f64>,
    /// Names of the actuators that the actuator projection keeps.
    pub kept_actuators: Vec<String>,
    /// Joints with their bodies, platform and payload.
    pub bodies: Vec<Body>,
    /// Parameter names in column order, the payload's last.
    pub parameters: Vec<String>,
    /// Names of the payload's parameters among them.
    pub payload_parameters: Vec<String>,
    /// Base parameters in column order, with their regrouping.
    pub base_parameters: Vec<Base>,
    /// All functions with their cost.
    pub functions: Vec<Function>,
    /// Conditioning of the actuators at home.
    pub conditioning: Conditioning,
}

/// A joint with the body that it carries, the platform or the payload.
#[derive(Debug, Serialize)]
#[non_exhaustive]
pub struct Body {
    /// Name of the joint, `platform` or `payload`.
    pub name: String,
    /// Joint type: `revolute`, `prismatic`, `fixed`, `motor`, `spring`, `payload` or `free`.
    pub joint: &'static str,
    /// Whether a motor drives the joint.
    pub actuated: bool,
    /// Name of its motor, if it has one.
    pub actuator: Option<String>,
    /// Parameters whose columns are not identically zero.
    pub parameters: Vec<String>,
}

/// A base parameter with its regrouping.
#[derive(Debug, Serialize)]
#[non_exhaustive]
pub struct Base {
    /// Name, with the suffix `R` if others are regrouped into it.
    pub name: String,
    /// The kept parameter first, with coefficient 1.
    pub regrouping: Vec<Term>,
}

/// A standard parameter in a regrouping.
#[derive(Debug, Serialize)]
#[non_exhaustive]
pub struct Term {
    /// Its name.
    pub parameter: String,
    /// What it is multiplied by.
    pub coefficient: f64,
}

/// A function of the robot and its cost.
#[derive(Debug, Serialize)]
#[non_exhaustive]
pub struct Function {
    /// Name in the table of functions.
    pub name: String,
    /// Name of the Rust function.
    pub function: String,
    /// Parameters of its columns, if the function is a regressor.
    pub columns: Option<&'static str>,
    /// Variables that it is evaluated from: pose, joints or actuators.
    pub from: &'static str,
    /// Inputs in order.
    pub inputs: Vec<Argument>,
    /// Its output.
    pub outputs: Vec<Argument>,
    /// Additions, multiplications and divisions; each called function is counted once.
    pub operations: usize,
    /// Operations by type, including called functions.
    #[serde(flatten)]
    pub cost: TotalCost,
}

/// An input or output array.
#[derive(Debug, Serialize)]
#[non_exhaustive]
pub struct Argument {
    /// Name of the array.
    pub name: String,
    /// Number of values along each axis.
    pub shape: Vec<usize>,
    /// Whether a caller may omit it.
    #[serde(skip_serializing_if = "std::ops::Not::not")]
    pub optional: bool,
}

impl Inspection {
    /// Inspects a compiled robot.
    #[must_use]
    pub fn new(robot: CompiledFile) -> Self {
        let CompiledFile { file, model, .. } = robot;
        let mechanism = &model.mechanism;
        let joints = mechanism.joints();
        let joint_names: Vec<String> = joints.iter().map(|&at| mechanism.joint_name(at)).collect();
        let coordinates = mechanism.coordinates();
        let pose = match &mechanism.platform {
            None => mechanism.pose_joint_names(),
            Some(_) => mechanism.pose_coordinates(),
        };
        let actuator_names = mechanism.actuator_names();
        let standard = model
            .selection
            .standard
            .iter()
            .chain(&model.selection.payload);
        Self {
            robot: mechanism.name.clone(),
            summary: mechanism.summary.clone(),
            file,
            dof: mechanism.dof(),
            actuators: actuator_names.len(),
            joints: joints.len(),
            kept_actuators: mechanism
                .kept_actuators
                .iter()
                .map(|&i| actuator_names[i].clone())
                .collect(),
            actuator_names,
            joint_names,
            coordinates,
            pose,
            home_pose: mechanism.home.pose.clone(),
            home_joints: mechanism.home.joints.clone(),
            bodies: bodies(&model),
            parameters: standard.map(|&p| model.parameter_name(p)).collect(),
            payload_parameters: model
                .selection
                .payload
                .iter()
                .map(|&p| model.parameter_name(p))
                .collect(),
            base_parameters: model
                .base
                .iter()
                .map(|base| Base::new(&model, base))
                .collect(),
            functions: model
                .functions
                .iter()
                .map(|f| Function::new(&model, f))
                .collect(),
            // Last, because it takes ownership of the model.
            conditioning: Conditioning::new(&InterpretedRobot::new(model)),
        }
    }
}

fn bodies(model: &RobotModel) -> Vec<Body> {
    use overact_codegen::{derivation::BodyParameter, mechanism::JointKind};
    let mechanism = &model.mechanism;
    let named = |is_own: &dyn Fn(&BodyParameter) -> bool| {
        let all = model
            .selection
            .standard
            .iter()
            .chain(&model.selection.payload);
        all.filter(|p| is_own(p))
            .map(|&p| model.parameter_name(p))
            .collect()
    };
    // Legs and joints are in the order of the actuators.
    let mut actuators = mechanism.actuator_names().into_iter();
    let mut bodies = Vec::new();
    for (leg, l) in mechanism.legs.iter().enumerate() {
        for (joint, j) in l.joints.iter().enumerate() {
            let kind = match j.kind {
                // A motor that drives several joints carries no body.
                _ if j.motor.is_some() => "motor",
                JointKind::Revolute => "revolute",
                JointKind::Prismatic => "prismatic",
                JointKind::Fixed => "fixed",
            };
            let is_own = |p: &BodyParameter| matches!(p, BodyParameter::Leg { leg: l, joint: j, .. } if (*l, *j) == (leg, joint));
            bodies.push(Body {
                name: mechanism.joint_name(overact_codegen::mechanism::JointIndex { leg, joint }),
                joint: kind,
                actuated: j.actuated,
                actuator: if j.actuated { actuators.next() } else { None },
                parameters: named(&is_own),
            });
        }
    }
    let other = |name: &str, joint, parameters| Body {
        name: name.to_owned(),
        joint,
        actuated: false,
        actuator: None,
        parameters,
    };
    // Motors are the last actuators.
    for (motor, own) in mechanism.motors.iter().enumerate() {
        let is_own =
            |p: &BodyParameter| matches!(p, BodyParameter::Motor { motor: of, .. } if *of == motor);
        let leg = own.leg.map(|leg| mechanism.legs[leg].name.as_str());
        bodies.push(Body {
            name: leg.map_or_else(|| own.name.clone(), |leg| format!("{leg}.{}", own.name)),
            joint: "motor",
            actuated: true,
            actuator: actuators.next(),
            parameters: named(&is_own),
        });
    }
    for (index, spring) in mechanism.springs.iter().enumerate() {
        let own = named(&|p| *p == BodyParameter::Spring(index));
        bodies.push(other(&spring.name, "spring", own));
    }
    for (index, payload) in mechanism.payloads.iter().enumerate() {
        let is_own = |p: &BodyParameter| matches!(p, BodyParameter::Load { payload: of, .. } if *of == index);
        bodies.push(other(&payload.name, "payload", named(&is_own)));
    }
    if let Some(platform) = &mechanism.platform {
        let free = |name: &str, parameters| other(name, "free", parameters);
        bodies.push(free(
            "platform",
            named(&|p| matches!(p, BodyParameter::Platform(_))),
        ));
        if platform.payload.is_some() {
            bodies.push(free(
                "payload",
                named(&|p| matches!(p, BodyParameter::Payload(_))),
            ));
        }
    }
    bodies
}

impl Base {
    fn new(model: &RobotModel, base: &BaseParameter) -> Self {
        let kept = std::iter::once((base.parameter, 1.0));
        let term = |(parameter, coefficient)| Term {
            parameter: model.parameter_name(parameter),
            coefficient,
        };
        let all = kept.chain(base.regrouped.iter().copied());
        Self {
            name: model.base_name(base),
            regrouping: all.map(term).collect(),
        }
    }
}

impl Function {
    fn new(model: &RobotModel, function: &overact_codegen::CompiledFunction) -> Self {
        let argument = |array: &Array| Argument {
            name: array.name.clone(),
            shape: array.shape.clone(),
            optional: false,
        };
        let program = &function.program;
        let mut inputs: Vec<Argument> = program.inputs.iter().map(argument).collect();
        if function.from == MotionInput::Actuators {
            // Forward kinematics: the pose is computed from the actuators, near the start pose.
            let free = |name: &str, length, optional| Argument {
                name: name.to_owned(),
                shape: vec![length],
                optional,
            };
            inputs.retain(|input| input.name != "pose");
            inputs.insert(
                0,
                free("actuators", model.mechanism.actuator_count(), false),
            );
            inputs.push(free("start", model.mechanism.pose_len(), true));
        }
        let cost = model.cost(function);
        Self {
            name: model.function_name(function.computes),
            function: function.name.clone(),
            columns: if function.computes.is_of_base_parameters() {
                Some(Columns::Base.name())
            } else {
                function.computes.columns().map(Columns::name)
            },
            from: function.from.name(),
            inputs,
            outputs: vec![argument(&program.output)],
            operations: cost.once.operations(),
            cost,
        }
    }
}
