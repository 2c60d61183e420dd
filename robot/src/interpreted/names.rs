//! Builds [`overact::Info`] of a model.

use crate::parameters::body::body;
use overact::{Info, Parameter, Sizes};
use overact_codegen::{RobotModel, derivation::BodyParameter, mechanism::Mechanism};

/// Names, sizes and parameters of a robot.
#[derive(Debug)]
pub(super) struct Names {
    name: &'static str,
    pub(super) sizes: Sizes,
    legs: Vec<&'static str>,
    actuators: Vec<&'static str>,
    actuated_joints: Vec<usize>,
    /// Joints that each actuator drives; empty if none drives several.
    pub(super) actuator_terms: Vec<Vec<(usize, f64)>>,
    pub(super) actuator_is_revolute: Vec<bool>,
    /// Whether each actuator is a cable; empty if none is.
    pub(super) pulls: Vec<bool>,
    coordinates: Vec<&'static str>,
    parameters: Vec<Parameter>,
    payload_parameters: Vec<Parameter>,
    pub(super) frames: Vec<&'static str>,
    /// Standard parameters that the functions of base parameters keep.
    pub(super) base_columns: Vec<&'static str>,
}

impl Names {
    pub(super) fn new(model: &RobotModel) -> Self {
        let mechanism = &model.mechanism;
        let joints = mechanism.joints();
        let actuated_joints = mechanism.first_joints();
        let coordinates = mechanism.coordinates().into_iter().map(leaked).collect();
        Self {
            name: leaked(mechanism.name.clone()),
            sizes: Sizes {
                pose: mechanism.pose_len(),
                dof: mechanism.dof(),
                actuators: actuated_joints.len(),
                joints: joints.len(),
                parameters: model.selection.standard.len(),
                base_parameters: model.base.len(),
                payload_parameters: model.selection.payload.len(),
            },
            legs: mechanism
                .legs
                .iter()
                .map(|leg| leaked(leg.name.clone()))
                .collect(),
            actuators: mechanism.actuator_names().into_iter().map(leaked).collect(),
            actuator_is_revolute: mechanism.actuator_is_revolute(),
            actuated_joints,
            pulls: if mechanism.has_cables() {
                mechanism.pulls()
            } else {
                Vec::new()
            },
            actuator_terms: actuator_terms(mechanism),
            coordinates,
            parameters: parameters(model, &model.selection.standard),
            payload_parameters: parameters(model, &model.selection.payload),
            frames: { mechanism.frames.iter() }
                .map(|frame| leaked(frame.name.clone()))
                .collect(),
            base_columns: { model.base.iter() }
                .map(|base| leaked(model.parameter_name(base.parameter)))
                .collect(),
        }
    }

    /// Name of a leg with static lifetime, for errors.
    pub(super) fn leg(&self, name: &str) -> &'static str {
        self.legs
            .iter()
            .find(|leg| **leg == name)
            .copied()
            .unwrap_or("")
    }

    pub(super) fn info<'a>(&'a self, model: &'a RobotModel) -> Info<'a> {
        Info {
            name: self.name,
            sizes: self.sizes,
            legs: &self.legs,
            actuators: &self.actuators,
            actuated_joints: &self.actuated_joints,
            actuator_is_revolute: &self.actuator_is_revolute,
            coordinates: &self.coordinates,
            parameters: &self.parameters,
            payload_parameters: &self.payload_parameters,
            home_pose: &model.mechanism.home.pose,
            home_joints: &model.mechanism.home.joints,
            kept_actuators: &model.mechanism.kept_actuators,
        }
    }
}

/// Joints that each actuator drives, with factors; empty without motors of several joints.
fn actuator_terms(mechanism: &Mechanism) -> Vec<Vec<(usize, f64)>> {
    if mechanism.motors.is_empty() {
        return Vec::new();
    }
    let actuators = mechanism.actuators().into_iter();
    let terms = actuators.map(|actuator| {
        let terms = mechanism.actuator_terms(actuator).into_iter();
        terms
            .map(|(joint, factor)| (joint, factor.value()))
            .collect()
    });
    terms.collect()
}

fn leaked(name: String) -> &'static str {
    Box::leak(name.into_boxed_str())
}

fn parameters(model: &RobotModel, all: &[BodyParameter]) -> Vec<Parameter> {
    let parameter = |&parameter: &BodyParameter| Parameter {
        name: leaked(model.parameter_name(parameter)),
        symbol: parameter.symbol(),
        unit: leaked(model.parameter_unit(parameter).to_owned()),
        body: body(&model.mechanism, parameter),
    };
    all.iter().map(parameter).collect()
}
