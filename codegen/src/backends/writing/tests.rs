//! Compares named values with independently computed numbers.

use crate::Request;
use crate::compile::compile_with;
use crate::derivation::MotionInput;
use crate::interpreter::Rows;
use crate::lowering::{Array, Entry, Operand, Program};
use crate::mechanism::states::{State, random_states};
use crate::model::RobotModel;
use overact_core::{Columns, Function};
use overact_description::diagnostic::Source;
use std::collections::HashMap;

/// The model with velocities, accelerations and the identification model.
fn model(text: &str) -> RobotModel {
    let source = Source::new("robot.toml", text);
    let request = Request {
        wanted: &|_, function, _| {
            let idm = Function::IdmRedPlatform(Columns::Standard);
            [idm, Function::JointVelocities, Function::JointAccelerations].contains(&function)
        },
        ..Request::default()
    };
    compile_with(&source, &request).unwrap().model
}

/// The output of a program in a state.
fn evaluated(program: &Program, state: &State) -> Vec<f64> {
    let values = |array: &Array| match array.name.as_str() {
        "pose" => &state.pose,
        "joints" => &state.joints,
        "twist" => &state.twist,
        _ => &state.acceleration,
    };
    let inputs = program.inputs.iter().map(|array| Rows {
        values: values(array).as_slice(),
        shared: false,
    });
    let inputs: Vec<Rows<'_>> = inputs.collect();
    let mut output = vec![0.0; program.entries.len()];
    program.evaluate(1, &inputs, &mut output).unwrap();
    output
}

/// The values of all steps.
fn steps(program: &Program, state: &State) -> Vec<f64> {
    let entries = (0..program.steps.len()).map(|at| Entry::positive(Operand::Step(at)));
    let probe = Program {
        least_torques: Vec::new(),
        output: Array {
            name: "steps".to_owned(),
            shape: vec![program.steps.len()],
        },
        entries: entries.collect(),
        ..program.clone()
    };
    evaluated(&probe, state)
}

/// Values of a planar robot's named quantities.
fn meanings(model: &RobotModel, state: &State) -> HashMap<String, f64> {
    let mut meanings = HashMap::new();
    let mechanism = &model.mechanism;
    let of = |function| {
        evaluated(
            &model.function(function, MotionInput::Pose).unwrap().program,
            state,
        )
    };
    let (rates, accelerations) = (
        of(Function::JointVelocities),
        of(Function::JointAccelerations),
    );
    let (phi, w, dw) = match state.pose.len() {
        3 => (state.pose[2], state.twist[2], state.acceleration[2]),
        _ => (0.0, 0.0, 0.0),
    };
    for (index, leg) in mechanism.legs.iter().enumerate() {
        let mut add =
            |what: String, value: f64| meanings.insert(format!("{what}_{}", leg.name), value);
        let first = mechanism.leg_range(index).start;
        let labels: Vec<&str> = leg
            .independent()
            .map(|j| leg.joints[j].name.as_str())
            .collect();
        let (mut rate, mut acceleration) = (0.0, 0.0);
        for i in 0..labels.len() {
            rate += rates[first + i];
            acceleration += accelerations[first + i];
            add(format!("qd_{}", labels[i]), rates[first + i]);
            add(format!("qdd_{}", labels[i]), accelerations[first + i]);
            add(format!("rate_{}", labels[i]), rate);
            add(format!("rate_dot_{}", labels[i]), acceleration);
            for j in i..labels.len() {
                let angle: f64 = state.joints[first + i..=first + j].iter().sum();
                let label = labels[i..=j].concat();
                add(format!("c{label}"), angle.cos());
                add(format!("s{label}"), angle.sin());
            }
        }
        let [x, y, _] = leg.end.as_ref().unwrap().point().map(|c| c.value());
        let p = [phi.cos() * x - phi.sin() * y, phi.sin() * x + phi.cos() * y];
        let v_arm = [-w * p[1], w * p[0]];
        let a_arm = [-dw * p[1] - w * w * p[0], dw * p[0] - w * w * p[1]];
        for (axis, name) in ["x", "y"].iter().enumerate() {
            add(format!("p_{name}"), p[axis]);
            add(format!("v_arm_{name}"), v_arm[axis]);
            add(format!("a_arm_{name}"), a_arm[axis]);
            add(format!("v_end_{name}"), state.twist[axis] + v_arm[axis]);
            add(
                format!("a_end_{name}"),
                state.acceleration[axis] + a_arm[axis],
            );
        }
    }
    meanings
}

#[test]
fn names_describe_the_computed_values() {
    let robots = [
        (include_str!("../../../../robots/dualv.toml"), 150),
        (include_str!("../../../../robots/five_bar.toml"), 40),
    ];
    for (text, least) in robots {
        let model = model(text);
        let mut checked = 0;
        for state in random_states(&model.mechanism, 3, 5) {
            let meanings = meanings(&model, &state);
            let given = model.functions.iter();
            for function in given.filter(|f| f.from != MotionInput::Actuators) {
                let values = steps(&function.program, &state);
                for (step, value) in function.program.steps.iter().zip(values) {
                    let Some(name) = &step.name else { continue };
                    let (name, value) = match name.strip_prefix("minus_") {
                        Some(positive) => (positive, -value),
                        None => (name.as_str(), value),
                    };
                    let Some(expected) = meanings.get(name) else {
                        continue;
                    };
                    checked += 1;
                    // The joints of a state close the legs to about eight digits.
                    let error = (value - expected).abs();
                    assert!(
                        error <= 1e-6 * (1.0 + expected.abs()),
                        "{}: {name} is {value}, not {expected}",
                        function.name
                    );
                }
            }
        }
        assert!(checked >= 3 * least, "only {checked} names are checked");
    }
}
