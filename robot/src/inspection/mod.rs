//! What a robot's model consists of and what it costs: the document of `overact inspect`, whose keys are the
//! names of the fields.

mod conditioning;

pub use conditioning::{Conditioning, Partition};

use crate::{compiled_file::CompiledFile, interpreted::InterpretedRobot};
use overact::Columns;
use overact_codegen::{
    BaseParameter, RobotModel, TotalCost, derivation::MotionInput, lowering::Array,
};
use serde::Serialize;

/// What a robot's model consists of and what it costs.
#[derive(Debug, Serialize)]
#[non_exhaustive]
pub struct Inspection {
    /// Name of the robot.
    pub robot: String,
    /// What the robot is, in a sentence; empty where the description does not say.
    pub summary: String,
    /// The description as the user named it.
    pub file: String,
    /// Degrees of freedom r.
    pub dof: usize,
    /// Actuators n.
    pub actuators: usize,
    /// Joints of all legs n_t.
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
    /// Names of the actuators that case 2 keeps.
    pub kept_actuators: Vec<String>,
    /// Joints with their bodies, platform and payload.
    pub bodies: Vec<Body>,
    /// Names in column order, the payload's last.
    pub parameters: Vec<String>,
    /// Those of them that are the platform's payload's.
    pub payload_parameters: Vec<String>,
    /// Base parameters in the order of their columns, with what is regrouped into them.
    pub base_parameters: Vec<Base>,
    /// All functions with what they cost.
    pub functions: Vec<Function>,
    /// How well the actuators determine the platform at home.
    pub conditioning: Conditioning,
}

/// A joint with the body behind it, the platform or the payload.
#[derive(Debug, Serialize)]
#[non_exhaustive]
pub struct Body {
    /// Name of the joint, `platform` or `payload`.
    pub name: String,
    /// What kind of joint holds it: `revolute`, `prismatic`, `fixed`, `motor` or `free`.
    pub joint: &'static str,
    /// Whether a motor drives the joint.
    pub actuated: bool,
    /// The name of its motor, if it has one.
    pub actuator: Option<String>,
    /// Parameters whose columns are not identically zero.
    pub parameters: Vec<String>,
}

/// A base parameter with its regrouping.
#[derive(Debug, Serialize)]
#[non_exhaustive]
pub struct Base {
    /// Name, with the suffix `R` where others are regrouped into it.
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
    pub name: &'static str,
    /// Name of the Rust function.
    pub function: String,
    /// Which parameters the columns stand for, where the function is a model of them.
    pub columns: Option<&'static str>,
    /// What it is evaluated from: pose, joints or actuators.
    pub from: &'static str,
    /// Its inputs in their order.
    pub inputs: Vec<Argument>,
    /// Its output.
    pub outputs: Vec<Argument>,
    /// Additions, multiplications and divisions; what is called is counted in, once.
    pub operations: usize,
    /// Operations by kind, with those of what is called.
    #[serde(flatten)]
    pub cost: TotalCost,
}

/// An array that goes in or comes out.
#[derive(Debug, Serialize)]
#[non_exhaustive]
pub struct Argument {
    /// Name of the array.
    pub name: String,
    /// How many numbers there are along each axis.
    pub shape: Vec<usize>,
    /// Whether a caller may leave it out.
    #[serde(skip_serializing_if = "std::ops::Not::not")]
    pub optional: bool,
}

impl Inspection {
    /// What there is to be told of a robot that has been compiled.
    #[must_use]
    pub fn new(robot: CompiledFile) -> Self {
        let CompiledFile { file, model, .. } = robot;
        let mechanism = &model.mechanism;
        let joints = mechanism.joints();
        let joint_names: Vec<String> = joints.iter().map(|&at| mechanism.joint_name(at)).collect();
        let coordinates = mechanism.coordinates();
        let pose = match &mechanism.platform {
            None => coordinates.clone(),
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
            // Last, since it takes the model.
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
    // Legs and joints are gone through in the order of the actuators.
    let mut actuators = mechanism.actuator_names().into_iter();
    let mut bodies = Vec::new();
    for (leg, l) in mechanism.legs.iter().enumerate() {
        for (joint, j) in l.joints.iter().enumerate() {
            let kind = match j.kind {
                // A motor that turns several joints carries no body.
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
                actuator: match j.actuated {
                    true => actuators.next(),
                    false => None,
                },
                parameters: named(&is_own),
            });
        }
    }
    if let Some(platform) = &mechanism.platform {
        let free = |name: &str, parameters| Body {
            name: name.to_owned(),
            joint: "free",
            actuated: false,
            actuator: None,
            parameters,
        };
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
            // The pose is what forward kinematics finds from the actuators, near the start pose.
            let free = |name: &str, length, optional| Argument {
                name: name.to_owned(),
                shape: vec![length],
                optional,
            };
            inputs.retain(|input| input.name != "pose");
            inputs.insert(
                0,
                free("actuators", model.mechanism.actuated().len(), false),
            );
            inputs.push(free("start", model.mechanism.pose_len(), true));
        }
        let cost = model.cost(function);
        Self {
            name: function.computes.name(),
            function: function.name.clone(),
            columns: match function.computes.is_of_base_parameters() {
                true => Some(Columns::Base.name()),
                false => function.computes.columns().map(Columns::name),
            },
            from: function.from.name(),
            inputs,
            outputs: vec![argument(&program.output)],
            operations: cost.once.operations(),
            cost,
        }
    }
}
