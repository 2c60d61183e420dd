//! Labels of a function's inputs and outputs, for use in names.

use super::dimensions::{Dimension, Dimensions};
use crate::lowering::{Array, Column, Elements, LaneOutput, Lanes, Program};
use crate::mechanism::{Actuator, Motor, TwistCoordinate};
use crate::model::{CompiledFunction, RobotModel};
use overact_core::Function;
use std::collections::BTreeSet;

/// Short names of a function's inputs and outputs.
#[derive(Debug, Default)]
pub struct Labels {
    /// Labels of the elements of every input.
    inputs: Vec<Vec<Label>>,
    /// Inputs whose elements are assigned to names before use.
    bound: Vec<bool>,
    /// Labels of the output's entries, row by row; empty for entries without a name.
    outputs: Vec<String>,
    /// Names of the legs.
    places: Vec<String>,
    /// Names of the joints.
    joints: Vec<String>,
    /// Names of constants.
    dimensions: Dimensions,
}

/// A quantity and the leg that it belongs to, such as `q1` and `leg2`; the leg may be empty.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Label {
    /// The quantity.
    pub what: String,
    /// The leg.
    pub place: String,
}

impl Label {
    /// The name, `q1_leg2`.
    #[must_use]
    pub fn name(&self) -> String {
        if self.place.is_empty() {
            self.what.clone()
        } else {
            format!("{}_{}", self.what, self.place)
        }
    }

    /// The same quantity of any leg.
    fn of_any_leg(self) -> Self {
        let place = if self.place.is_empty() { "" } else { "leg" };
        Self {
            place: place.to_owned(),
            ..self
        }
    }
}

impl Labels {
    /// Labels common to all functions of a robot.
    #[must_use]
    pub fn of_robot(model: &RobotModel) -> Self {
        let legs = model.mechanism.legs.iter().map(|leg| leg.name.clone());
        let joints = model.mechanism.legs.iter().flat_map(|leg| &leg.joints);
        let joints: BTreeSet<String> = joints.map(|joint| joint.name.clone()).collect();
        Self {
            places: legs.chain(["platform".to_owned()]).collect(),
            joints: joints.into_iter().collect(),
            dimensions: Dimensions::of(model),
            ..Self::default()
        }
    }

    /// Labels of a robot's function.
    #[must_use]
    pub fn new(model: &RobotModel, function: &CompiledFunction) -> Self {
        let mut labels = Self::of_robot(model);
        let inputs = &function.program.inputs;
        labels.bound = inputs.iter().map(are_parameters).collect();
        labels.inputs = inputs
            .iter()
            .map(|array| labels.of_elements(model, array))
            .collect();
        labels.outputs = outputs(model, function);
        labels
    }

    /// Labels of a program whose only inputs with a label are the robot's parameters.
    #[must_use]
    pub fn of_parameters(model: &RobotModel, program: &Program) -> Self {
        let mut labels = Self::of_robot(model);
        labels.bound = program.inputs.iter().map(are_parameters).collect();
        let inputs = program.inputs.iter();
        let inputs = inputs.map(|array| {
            if are_parameters(array) {
                labels.of_elements(model, array)
            } else {
                Vec::new()
            }
        });
        labels.inputs = inputs.collect();
        labels
    }

    /// Labels of the elements of an input; the leg in the name of a parameter is split off.
    fn of_elements(&self, model: &RobotModel, array: &Array) -> Vec<Label> {
        let labels = input(model, &array.name, array.len());
        if !are_parameters(array) {
            return labels;
        }
        let labels = labels.iter().map(|label| self.parsed(&label.name()));
        labels.collect()
    }

    /// Labels of one input's elements and a leg.
    #[cfg(test)]
    pub(super) fn of_input(elements: &[&str], leg: &str) -> Self {
        let mut labels = Self {
            places: vec![leg.to_owned()],
            ..Self::default()
        };
        let elements = elements.iter().map(|name| labels.parsed(name)).collect();
        labels.inputs.push(elements);
        labels
    }

    /// Label of an input's element.
    #[must_use]
    pub fn input(&self, array: usize, index: usize) -> Option<&Label> {
        self.inputs.get(array)?.get(index)
    }

    /// Label of an input's element that is assigned to a name before use.
    #[must_use]
    pub fn bound(&self, array: usize, index: usize) -> Option<&Label> {
        let is_bound = self.bound.get(array).copied().unwrap_or_default();
        self.input(array, index).filter(|_| is_bound)
    }

    /// Names of all joints.
    pub(super) fn joints(&self) -> &[String] {
        &self.joints
    }

    /// The named constant of a positive value.
    #[must_use]
    pub fn dimension(&self, value: f64) -> Option<&Dimension> {
        self.dimensions.find(value)
    }

    /// Splits a name into quantity and leg.
    #[must_use]
    pub fn parsed(&self, name: &str) -> Label {
        let ends = |place: &&String| {
            name.strip_suffix(place.as_str())
                .is_some_and(|rest| rest.ends_with('_') && rest.len() > 1)
        };
        let longest = self
            .places
            .iter()
            .filter(ends)
            .max_by_key(|place| place.len());
        match longest {
            Some(place) => Label {
                what: name[..name.len() - place.len() - 1].to_owned(),
                place: place.clone(),
            },
            None => Label {
                what: name.to_owned(),
                place: String::new(),
            },
        }
    }

    /// Labels of a program in lanes, where all legs share the name `leg`.
    #[must_use]
    pub(crate) fn in_lanes(mut self, model: &RobotModel, lanes: &Lanes) -> Self {
        let arrays = &lanes.program.inputs;
        let elements = arrays.iter().zip(&lanes.inputs);
        let elements = elements.map(|(array, elements)| match elements {
            Elements::Shared => self.of_elements(model, array),
            Elements::Constants => Vec::new(),
            Elements::InTurn(_) => {
                let labels = self.of_elements(model, array).into_iter();
                labels.map(Label::of_any_leg).collect()
            }
            Elements::Scattered { of, places } => {
                let labels = self.of_elements(model, &arrays[*of]);
                let labels = places.iter().map(|place| labels[place.first].clone());
                labels.map(Label::of_any_leg).collect()
            }
        });
        self.inputs = elements.collect();
        let elements = arrays.iter().zip(&lanes.inputs);
        let bound = elements.map(|(array, elements)| {
            are_parameters(array) || matches!(elements, Elements::Scattered { .. })
        });
        self.bound = bound.collect();
        let LaneOutput::Columns(columns) = &lanes.gathered else {
            self.outputs.clear();
            return self;
        };
        let width = lanes.output.shape.last().copied().unwrap_or_default();
        let of_first = lanes.legs.first().map(|leg| format!("_{leg}_on_"));
        let label = |row: &[String], column: &Column| {
            let (at, of_leg) = match *column {
                Column::Shared(at) => (at, None),
                Column::OfLegs(place) => (place.first, of_first.as_deref()),
            };
            let label = row.get(at).cloned().unwrap_or_default();
            of_leg.map_or(label.clone(), |of_leg| label.replace(of_leg, "_leg_on_"))
        };
        let rows = self.outputs.chunks(width.max(1));
        let labels = rows.flat_map(|row| columns.iter().map(|column| label(row, column)));
        self.outputs = labels.collect();
        self
    }

    /// For every step of a program, the name of its value as an entry of the output.
    #[must_use]
    pub(crate) fn of_outputs(&self, program: &Program) -> Vec<Option<String>> {
        let mut names = vec![None; program.steps.len()];
        for (entry, label) in program.entries.iter().zip(&self.outputs) {
            if let crate::lowering::Operand::Step(at) = entry.operand
                && !label.is_empty()
            {
                let name = if entry.negative {
                    format!("minus_{label}")
                } else {
                    label.clone()
                };
                names[at].get_or_insert(name);
            }
        }
        names
    }
}

/// Whether an input has the robot's parameters.
fn are_parameters(input: &Array) -> bool {
    matches!(input.name.as_str(), "parameters" | "base_parameters")
}

/// A coordinate's name as part of a word; joints of branches include the leg, `foot.pitch`.
fn word(name: &str) -> String {
    name.replace('.', "_")
}

/// Labels of the elements of an input.
fn input(model: &RobotModel, name: &str, count: usize) -> Vec<Label> {
    let plain = |what: String| Label {
        what,
        place: String::new(),
    };
    let coordinates = |prefix: &str| -> Vec<Label> {
        let labels = twist(model).into_iter();
        labels
            .map(|label| plain(format!("{prefix}{label}")))
            .collect()
    };
    let joints = |prefix: &str, all: &[usize]| -> Vec<Label> {
        let indices = model.mechanism.joints();
        let label = |&at: &usize| Label {
            what: format!("{prefix}{}", model.mechanism.joint(indices[at]).suffix()),
            place: if model.is_tree() {
                String::new()
            } else {
                model.mechanism.legs[indices[at].leg].name.clone()
            },
        };
        all.iter().map(label).collect()
    };
    let all: Vec<usize> = (0..model.mechanism.joints().len()).collect();
    let actuators = |prefix: &str| -> Vec<Label> {
        let motors = model.mechanism.motors.iter();
        let label = |motor: &Motor| Label {
            what: format!("{prefix}_{}", motor.name),
            place: motor
                .leg
                .map_or_else(String::new, |leg| model.mechanism.legs[leg].name.clone()),
        };
        let mut labels = joints(prefix, &model.mechanism.actuated());
        labels.extend(motors.map(label));
        labels
    };
    match name {
        "pose" => {
            let names = model.mechanism.pose_coordinates().into_iter();
            names.map(|name| plain(word(&name))).collect()
        }
        "twist" => coordinates(""),
        "acceleration" => coordinates("d"),
        "joints" => joints("q", &all),
        "joint_velocities" => joints("qd", &all),
        "joint_accelerations" => joints("qdd", &all),
        "actuators" => actuators("q"),
        "actuator_velocities" => actuators("qd"),
        "actuator_accelerations" => actuators("qdd"),
        "torques" => actuators("tau"),
        "parameters" => {
            let all = model
                .selection
                .standard
                .iter()
                .chain(&model.selection.payload);
            all.map(|&parameter| plain(model.parameter_name(parameter)))
                .collect()
        }
        "base_parameters" => {
            let base = model.base.iter().map(|base| model.base_name(base));
            let payload = model.selection.payload.iter();
            let payload = payload.map(|&parameter| model.parameter_name(parameter));
            base.chain(payload).map(plain).collect()
        }
        _ => (1..=count).map(|i| plain(format!("{name}_{i}"))).collect(),
    }
}

/// Labels of the twist's coordinates: `vx`, `wz`.
fn twist(model: &RobotModel) -> Vec<String> {
    const AXES: [&str; 3] = ["x", "y", "z"];
    let Some(platform) = &model.mechanism.platform else {
        let names = model.mechanism.coordinates().into_iter();
        return names.map(|name| format!("qd_{}", word(&name))).collect();
    };
    let coordinates = platform.motion.twist();
    let label = |coordinate: TwistCoordinate| match coordinate {
        TwistCoordinate::Linear(axis) => format!("v{}", AXES[axis]),
        TwistCoordinate::Angular(axis) => format!("w{}", AXES[axis]),
    };
    coordinates.into_iter().map(label).collect()
}

/// Labels of the entries of an output.
fn outputs(model: &RobotModel, function: &CompiledFunction) -> Vec<String> {
    let shape = &function.program.output.shape;
    let columns = model.columns_of(function.computes);
    if let ([_, width], false) = (&shape[..], columns.is_empty()) {
        let count = function.program.entries.len();
        let name = |at: usize| {
            let column = columns.get(at % width).map(|&p| model.parameter_name(p));
            let row = row(model, function.computes, at / width);
            column.map_or_else(String::new, |column| format!("{column}_on_{row}"))
        };
        return (0..count).map(name).collect();
    }
    Vec::new()
}

/// Label of the equation in an identification model's row: a twist coordinate or a joint.
fn row(model: &RobotModel, function: Function, row: usize) -> String {
    let joints = model.mechanism.joints();
    let joint = |at: usize| {
        let index = joints[at];
        let joint = model.mechanism.joint(index).suffix();
        if model.is_tree() {
            format!("q{joint}")
        } else {
            format!("q{joint}_{}", model.mechanism.legs[index.leg].name)
        }
    };
    let on_actuators = matches!(
        function,
        Function::IdmRedActuators(_) | Function::IdmRedPayloadActuators
    );
    if model.is_tree() {
        return joint(row);
    }
    if on_actuators {
        let actuators = model.mechanism.actuators();
        let kept = model.selection.kept_actuators.get(row);
        let label = |&kept: &usize| match actuators[kept] {
            Actuator::Joint(at) => joint(at),
            Actuator::Motor(at) => format!("q_{}", model.mechanism.motors[at].name),
        };
        return kept.map_or_else(String::new, label);
    }
    twist(model).get(row).cloned().unwrap_or_default()
}
