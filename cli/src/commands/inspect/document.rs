//! What `inspect` tells: its fields are the keys of the JSON document.

use super::conditioning::Conditioning;
use overact::Columns;
use overact_codegen::{
    BaseParameter, RobotModel, WholeCost, derivation::MotionInput, lowering::Array,
};
use overact_robot::{CompiledFile, InterpretedRobot};
use serde::Serialize;

#[derive(Debug, Serialize)]
pub(super) struct Document {
    pub(super) robot: String,
    pub(super) summary: String,
    pub(super) file: String,
    pub(super) dof: usize,
    pub(super) actuators: usize,
    pub(super) joints: usize,
    pub(super) actuator_names: Vec<String>,
    pub(super) joint_names: Vec<String>,
    pub(super) coordinates: Vec<String>,
    pub(super) pose: Vec<String>,
    pub(super) home_pose: Vec<f64>,
    pub(super) home_joints: Vec<f64>,
    pub(super) kept_actuators: Vec<String>,
    pub(super) bodies: Vec<Body>,
    /// Names in column order, the payload's last.
    pub(super) parameters: Vec<String>,
    pub(super) base_parameters: Vec<Base>,
    pub(super) functions: Vec<Function>,
    pub(super) conditioning: Conditioning,
}

/// A joint with the body behind it, the platform or the payload.
#[derive(Debug, Serialize)]
pub(super) struct Body {
    pub(super) name: String,
    pub(super) joint: &'static str,
    pub(super) actuated: bool,
    /// The name of its motor, if it has one.
    pub(super) actuator: Option<String>,
    /// Parameters whose columns are not identically zero.
    pub(super) parameters: Vec<String>,
}

#[derive(Debug, Serialize)]
pub(super) struct Base {
    pub(super) name: String,
    /// The kept parameter first, with coefficient 1.
    pub(super) regrouping: Vec<Term>,
}

#[derive(Debug, Serialize)]
pub(super) struct Term {
    pub(super) parameter: String,
    pub(super) coefficient: f64,
}

#[derive(Debug, Serialize)]
pub(super) struct Function {
    pub(super) name: &'static str,
    /// Name of the Rust function.
    pub(super) function: String,
    pub(super) columns: Option<&'static str>,
    pub(super) from: &'static str,
    pub(super) inputs: Vec<Argument>,
    pub(super) outputs: Vec<Argument>,
    /// Additions, multiplications and divisions; what is called is counted in, once.
    pub(super) operations: usize,
    #[serde(flatten)]
    pub(super) cost: WholeCost,
}

#[derive(Debug, Serialize)]
pub(super) struct Argument {
    pub(super) name: String,
    pub(super) shape: Vec<usize>,
    #[serde(skip_serializing_if = "std::ops::Not::not")]
    pub(super) optional: bool,
}

impl Document {
    pub(super) fn new(robot: CompiledFile) -> Self {
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
