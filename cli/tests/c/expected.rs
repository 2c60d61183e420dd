//! Expected result of a function: its program, evaluated as in Rust's runtime.

use crate::driver::Call;
use overact::{Error, Function, Model, guard};
use overact_codegen::derivation::BodyParameter;
use overact_codegen::internals::random_states;
use overact_codegen::interpreter::Rows;
use overact_codegen::{CompiledFunction, RobotModel};
use overact_robot::InterpretedRobot;
use std::collections::BTreeMap;

/// All inputs of a state, by argument name.
pub(crate) type Inputs = BTreeMap<&'static str, Vec<f64>>;

/// Name of forward kinematics, which is not in the table of functions.
pub(crate) const FORWARD: &str = "pose_from_actuators";

/// Names and lengths of a function's arguments.
pub(crate) fn arguments(model: &RobotModel, function: &CompiledFunction) -> Vec<(String, usize)> {
    let mut arguments = Vec::new();
    for array in &function.program.inputs {
        match array.name.as_str() {
            "joints" if model.finds_joints(function) => {}
            "pose" if model.finds_pose(function) => {
                arguments.push(("actuators".to_owned(), model.mechanism.actuator_count()));
            }
            name => arguments.push((name.to_owned(), array.len())),
        }
    }
    if model.finds_pose(function) {
        arguments.push(("start".to_owned(), model.mechanism.pose_len()));
    }
    arguments
}

/// The arguments of forward kinematics.
pub(crate) fn forward_arguments(model: &RobotModel) -> Vec<(String, usize)> {
    let mechanism = &model.mechanism;
    vec![
        ("actuators".to_owned(), mechanism.actuator_count()),
        ("start".to_owned(), mechanism.pose_len()),
    ]
}

/// All functions of a robot in the driver.
pub(crate) fn calls(model: &RobotModel) -> Vec<(Call, Vec<String>)> {
    let call = |name: &str, arguments: Vec<(String, usize)>, output: usize| {
        let (names, arguments) = arguments.into_iter().unzip();
        let name = name.to_owned();
        (
            Call {
                name,
                arguments,
                output,
            },
            names,
        )
    };
    let functions = model.functions.iter();
    let mut calls: Vec<_> = functions
        .map(|f| call(&f.name, arguments(model, f), f.program.entries.len()))
        .collect();
    if model.forward_kinematics {
        let length = model.mechanism.pose_len();
        calls.push(call(FORWARD, forward_arguments(model), length));
    }
    calls
}

/// Output of a function at a state, by its index among the calls.
pub(crate) fn output(
    robot: &InterpretedRobot,
    index: usize,
    inputs: &Inputs,
) -> Result<Vec<f64>, Error> {
    let model = robot.model();
    in_range(model, index, inputs)?;
    let (actuators, start) = (&inputs["actuators"], &inputs["start"]);
    let forward = || {
        let mut pose = start.clone();
        robot
            .pose_from_actuators(actuators, &mut pose)
            .map(|()| pose)
    };
    let Some(function) = model.functions.get(index) else {
        return forward();
    };
    let pose = if model.finds_pose(function) {
        forward()?
    } else {
        robot.unit_pose(&inputs["pose"])?
    };
    let joints = || {
        let mut joints = vec![0.0; model.mechanism.joints().len()];
        let found = robot.evaluate(Function::Joints, &[&pose], &mut joints);
        found.map(|()| joints).map_err(|error| error.error)
    };
    let finds_joints = model.finds_joints(function);
    if finds_joints && function.computes == Function::Joints {
        return joints();
    }
    let used = function.program.used_inputs();
    let arrays = function.program.inputs.iter().zip(used);
    let needs_joints = arrays.clone().any(|(a, used)| a.name == "joints" && used);
    let joints = if finds_joints && needs_joints {
        joints()?
    } else {
        inputs["joints"].clone()
    };
    let rows = arrays.map(|(array, _)| {
        let values = match array.name.as_str() {
            "pose" => &pose,
            "joints" => &joints,
            name => &inputs[name],
        };
        Rows {
            values,
            shared: false,
        }
    });
    let rows: Vec<Rows<'_>> = rows.collect();
    let mut output = vec![0.0; function.program.entries.len()];
    match function.program.evaluate(1, &rows, &mut output) {
        Ok(()) => Ok(output),
        Err(failed) => Err(robot.error(&function.program, &failed).error),
    }
}

/// Checks that the arguments of a call are finite and not too large.
fn in_range(model: &RobotModel, index: usize, inputs: &Inputs) -> Result<(), Error> {
    let largest = model.float.limits().largest;
    let arguments = model
        .functions
        .get(index)
        .map_or_else(|| forward_arguments(model), |f| arguments(model, f));
    for (name, _) in arguments {
        let (name, values) = (inputs.get_key_value(name.as_str())).ok_or(Error::Overflow)?;
        guard::within(&[(*name, &values[..], largest.of(name))])?;
    }
    Ok(())
}

/// Reproducible numbers between -1 and 1.
pub(crate) struct Dice(u64);

impl Dice {
    pub(crate) const fn new(seed: u64) -> Self {
        Self(seed)
    }

    fn next(&mut self) -> f64 {
        self.0 = self
            .0
            .wrapping_mul(6_364_136_223_846_793_005)
            .wrapping_add(1_442_695_040_888_963_407);
        (self.0 >> 11) as f64 / (1_u64 << 52) as f64 - 1.0
    }

    /// Number of either sign with a magnitude between 1e-30 and ten to the power `largest`.
    pub(crate) fn of_any_size(&mut self, largest: f64) -> f64 {
        let exponent = 0.5 * (self.next() + 1.0) * (largest + 30.0) - 30.0;
        10.0_f64.powf(exponent).copysign(self.next())
    }

    fn many(&mut self, count: usize, size: f64) -> Vec<f64> {
        (0..count).map(|_| size * self.next()).collect()
    }
}

/// Random states with all inputs; actuator positions are those of the pose if there is one.
pub(crate) fn states(robot: &InterpretedRobot, count: usize, seed: u64) -> Vec<Inputs> {
    let model = robot.model();
    let mechanism = &model.mechanism;
    let mut dice = Dice::new(seed);
    let (n, r) = (mechanism.actuator_count(), mechanism.dof());
    let drawn = random_states(mechanism, count, seed).into_iter();
    let all = drawn.map(|state| {
        let actuators = mechanism.actuator_positions(&state.joints);
        let mut start = state.pose.clone();
        let step = dice.many(r, 0.02);
        robot.displace(&mut start, &step);
        let mut numbers = |parameters: &[BodyParameter]| -> Vec<f64> {
            let all = parameters.iter().chain(&model.selection.payload);
            all.map(|&parameter| {
                let name = model.parameter_name(parameter);
                let is_large = ["m_", "xx_", "yy_", "zz_", "ia_"]
                    .iter()
                    .any(|p| name.starts_with(p));
                if is_large {
                    2.0 + dice.next()
                } else {
                    0.1 * dice.next()
                }
            })
            .collect()
        };
        let parameters = numbers(&model.selection.standard);
        let base_parameters = numbers(&model.selection.base);
        BTreeMap::from([
            ("wrench", vec![3.0, -5.0, 2.0, 0.7, -1.1, 0.4]),
            ("parameters", parameters),
            ("base_parameters", base_parameters),
            ("pose", state.pose),
            ("joints", state.joints),
            ("joint_velocities", state.twist.clone()),
            ("joint_accelerations", state.acceleration.clone()),
            ("twist", state.twist),
            ("acceleration", state.acceleration),
            ("actuators", actuators),
            ("actuator_velocities", dice.many(n, 1.0)),
            ("actuator_accelerations", dice.many(n, 5.0)),
            ("torques", dice.many(n, 10.0)),
            ("preload", dice.many(n - r.min(n), 3.0)),
            ("start", start),
        ])
    });
    all.collect()
}
