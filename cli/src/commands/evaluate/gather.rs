//! Computes the inputs of a function from states with other quantities.
//!
//! Poses are computed from actuators or joints by forward kinematics, joints from a pose by inverse
//! kinematics.

use super::GivenParameters;
use crate::{
    failure::{Failure, Problem},
    states::States,
};
use overact::{Function, Model};
use overact_codegen::{
    derivation::MotionInput,
    lowering::{Array, Program},
};
use overact_robot::InterpretedRobot;

/// Largest number of quantities listed in a message.
const MOST_NAMED: usize = 12;

/// A problem of a state, or its missing quantities.
enum Lack {
    Missing(Vec<String>),
    Problem(Problem),
}

impl std::convert::From<Problem> for Lack {
    fn from(problem: Problem) -> Self {
        Self::Problem(problem)
    }
}

/// Rows of each input of the program for all states.
///
/// # Errors
/// The first state with missing quantities, or without a kinematic solution.
pub(super) fn inputs(
    robot: &InterpretedRobot,
    program: &Program,
    from: MotionInput,
    parameters: GivenParameters,
    states: &States,
) -> Result<Vec<Vec<f64>>, Failure> {
    let mut gatherer = Gatherer {
        parameters,
        robot,
        states,
        from,
        previous: robot.info().home_pose.to_vec(),
    };
    let mut inputs = vec![Vec::new(); program.inputs.len()];
    for at in 0..states.len() {
        let mut missing: Vec<String> = Vec::new();
        for (array, rows) in program.inputs.iter().zip(&mut inputs) {
            match gatherer.input(at, array) {
                Ok(values) => rows.extend(values),
                Err(Lack::Missing(names)) => missing.extend(names),
                Err(Lack::Problem(problem)) => return Err(problem.into()),
            }
        }
        missing.dedup();
        if !missing.is_empty() {
            return Err(lacking(at, &missing, states, &gatherer.takes(program)).into());
        }
    }
    Ok(inputs)
}

/// Problem of a state with missing quantities.
fn lacking(at: usize, missing: &[String], states: &States, takes: &[String]) -> Problem {
    let quoted = |names: &mut dyn Iterator<Item = &str>| {
        let names: Vec<String> = names.map(|name| format!("`{name}`")).collect();
        names.join(", ")
    };
    let found = states.found(at);
    let more = match found.len().saturating_sub(MOST_NAMED) {
        0 => String::new(),
        more => format!(" and {more} more"),
    };
    let held = if found.is_empty() {
        "nothing".to_owned()
    } else {
        quoted(&mut found.into_iter().take(MOST_NAMED)) + &more
    };
    let mut help = format!("the function takes {}", takes.join(", "));
    if missing.iter().any(|name| name.ends_with("parameters")) {
        help += "; `--parameters FILE` gives those of all states";
    }
    let missing = quoted(&mut missing.iter().map(String::as_str));
    let message = format!("missing {missing}; the state has {held}");
    states.problem(at, &message).help(help)
}

struct Gatherer<'a> {
    robot: &'a InterpretedRobot,
    states: &'a States,
    from: MotionInput,
    /// Parameters of all states.
    parameters: GivenParameters,
    /// Start pose of forward kinematics.
    previous: Vec<f64>,
}

impl Gatherer<'_> {
    /// Names of the required quantities; for actuators, the pose is computed.
    fn takes(&self, program: &Program) -> Vec<String> {
        let form = |array: &Array| match array.name.as_str() {
            "pose" if self.from == MotionInput::Actuators => self
                .states
                .form("actuators", self.robot.info().sizes.actuators),
            name => self.states.form(name, array.len()),
        };
        program.inputs.iter().map(form).collect()
    }

    fn input(&mut self, at: usize, array: &Array) -> Result<Vec<f64>, Lack> {
        let is_tree = self.robot.model().is_tree();
        if let Some(given) = self.parameters.input(&array.name) {
            return Ok(given.clone());
        }
        match array.name.as_str() {
            "pose" => self.pose(at),
            "joints" if !is_tree => self.joints(at, array.len()),
            name => {
                // The joints of a serial robot are also its pose and its actuators.
                let names: &[&str] = match name {
                    "joints" => &["joints", "pose", "actuators"],
                    "joint_velocities" => &["joint_velocities", "twist", "actuator_velocities"],
                    "joint_accelerations" => &[
                        "joint_accelerations",
                        "acceleration",
                        "actuator_accelerations",
                    ],
                    _ => &[name],
                };
                self.first(at, names, array.len())
            }
        }
    }

    /// First of several names that the state contains.
    fn first(&self, at: usize, names: &[&str], length: usize) -> Result<Vec<f64>, Lack> {
        for name in names {
            if let Some(values) = self.states.get(at, name, length)? {
                return Ok(values.to_vec());
            }
        }
        let first = names.first().copied().unwrap_or_default();
        Err(Lack::Missing(vec![first.to_owned()]))
    }

    /// Pose: given, or by forward kinematics from the actuators or actuated joints.
    fn pose(&mut self, at: usize) -> Result<Vec<f64>, Lack> {
        let sizes = self.robot.info().sizes;
        if self.from != MotionInput::Actuators
            && let Some(pose) = self.states.get(at, "pose", sizes.pose)?
        {
            let unit = self.robot.unit_pose(pose);
            return Ok(unit.map_err(|error| self.states.problem(at, &error.to_string()))?);
        }
        let mut actuators = self
            .states
            .get(at, "actuators", sizes.actuators)?
            .map(<[f64]>::to_vec);
        if self.from == MotionInput::Joints && actuators.is_none() {
            let joints = self.states.get(at, "joints", sizes.joints)?;
            let of_all = |joints: &[f64]| {
                let all = 0..sizes.actuators;
                all.map(|at| self.robot.of_actuator(at, joints)).collect()
            };
            actuators = joints.map(of_all);
        }
        let Some(actuators) = actuators else {
            let wanted = if self.from == MotionInput::Actuators {
                "actuators"
            } else {
                "pose"
            };
            return Err(Lack::Missing(vec![wanted.to_owned()]));
        };
        self.forward(at, &actuators)
    }

    /// Forward kinematics from the state's `start`, the previous pose, or home.
    fn forward(&mut self, at: usize, actuators: &[f64]) -> Result<Vec<f64>, Lack> {
        let info = self.robot.info();
        let given = self
            .states
            .get(at, "start", info.sizes.pose)?
            .map(<[f64]>::to_vec);
        let starts = match given {
            Some(start) => vec![start],
            None => vec![self.previous.clone(), info.home_pose.to_vec()],
        };
        let mut first = None;
        for mut pose in starts {
            match self.robot.follow_actuators(actuators, &mut pose) {
                Ok(()) => {
                    self.previous.clone_from(&pose);
                    return Ok(pose);
                }
                Err(error) => first = first.or(Some(error)),
            }
        }
        let message = first.map_or_else(String::new, |error| error.to_string());
        let help = "give a pose near the solution as `start`";
        Err(self.states.problem(at, &message).help(help).into())
    }

    /// Joints: given, or by inverse kinematics from the pose.
    fn joints(&mut self, at: usize, length: usize) -> Result<Vec<f64>, Lack> {
        if let Some(joints) = self.states.get(at, "joints", length)? {
            return Ok(joints.to_vec());
        }
        // Without a pose, report the joints as missing.
        let Some(pose) = self.states.get(at, "pose", self.robot.info().sizes.pose)? else {
            return Err(Lack::Missing(vec!["joints".to_owned()]));
        };
        let mut joints = vec![0.0; length];
        let done = self.robot.evaluate(Function::Joints, &[pose], &mut joints);
        done.map_err(|error| self.states.problem(at, &error.error.to_string()))?;
        Ok(joints)
    }
}
