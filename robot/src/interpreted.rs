//! A robot's description served as [`overact::Model`]: its programs are evaluated block by block,
//! with no compiler at hand.
//!
//! A tree (a robot without platform) is served like any other: its pose are its joint positions and
//! its twist their velocities.

mod names;
mod newton;

use names::Names;
use overact::{
    Error, Function, Info, Input, Model, SampleError,
    forward::{self, Measured},
};
use overact_codegen::{
    RobotModel,
    derivation::{Columns, Family, MotionInput},
    evaluation::{Evaluator, Failed, Rows},
    lowering::{Condition, Program},
    mechanism::Mechanism,
};
use std::sync::{Mutex, PoisonError};

/// Most inputs that a program has: those of a function of [`overact::Model`], and joints that are found
/// before it runs.
const INPUTS: usize = 5;

/// Where an input of a program comes from.
#[derive(Debug, Clone, Copy, PartialEq)]
enum Given {
    /// From the function's input at this place.
    At(usize),
    /// From Newton's method, which finds the joints first.
    Joints,
    /// From nowhere: the program does not read it.
    Unread,
}

/// A robot that is interpreted.
#[derive(Debug)]
pub struct InterpretedRobot {
    model: RobotModel,
    names: Names,
    functions: Vec<Served>,
    scratch: Pool<Scratch>,
}

/// A function of the trait and the program that computes it.
#[derive(Debug)]
struct Served {
    function: Function,
    /// Index among the model's functions.
    index: usize,
    /// Where each input of the program comes from.
    inputs: Vec<Given>,
    evaluators: Pool<Evaluator>,
}

/// Memory for forward kinematics.
#[derive(Debug, Default)]
struct Scratch {
    actuators: Vec<f64>,
    inverse_jacobian: Vec<f64>,
    normal: Vec<f64>,
    step: Vec<f64>,
    pose: Vec<f64>,
}

/// Memory that calls take and give back, so that a call allocates only when more threads than ever
/// before are in it. Programs have memory of their own: sizing it anew would cost more than a sample.
#[derive(Debug)]
struct Pool<T>(Mutex<Vec<T>>);

impl<T> Default for Pool<T> {
    fn default() -> Self {
        Self(Mutex::default())
    }
}

impl<T> Pool<T> {
    fn with<R>(&self, make: impl FnOnce() -> T, work: impl FnOnce(&mut T) -> R) -> R {
        // What a panicking thread left behind is memory like any other.
        let free = || self.0.lock().unwrap_or_else(PoisonError::into_inner);
        let mut memory = free().pop().unwrap_or_else(make);
        let result = work(&mut memory);
        free().push(memory);
        result
    }
}

impl InterpretedRobot {
    /// Serves a model.
    ///
    /// The names that errors and parameters carry live as long as the program (`&'static str`, as in
    /// generated code), so each robot leaks a few kilobytes once.
    #[must_use]
    pub fn new(model: RobotModel) -> Self {
        let names = Names::new(&model);
        let mut robot = Self {
            model,
            names,
            functions: Vec::new(),
            scratch: Pool::default(),
        };
        robot.functions = ALL
            .iter()
            .filter_map(|&(f, family)| robot.serve(f, family))
            .collect();
        robot
    }

    /// Whether a function of a model is served, or serves to find pose and joints. A model needs no
    /// others to be interpreted.
    #[must_use]
    pub fn serves(mechanism: &Mechanism, family: Family, from: MotionInput) -> bool {
        let plain = match mechanism.platform {
            Some(_) => MotionInput::Pose,
            None => MotionInput::Joints,
        };
        match family {
            Family::PoseInClosedForm => true,
            Family::ClosureError | Family::LegsJacobian | Family::ClosureActuatorJacobian => {
                from == MotionInput::Joints
            }
            _ => from == plain && ALL.iter().any(|(_, served)| *served == family),
        }
    }

    /// The model.
    #[must_use]
    pub const fn model(&self) -> &RobotModel {
        &self.model
    }

    fn serve(&self, function: Function, family: Family) -> Option<Served> {
        let from_joints = || self.model.function(family, MotionInput::Joints);
        let wanted = self.model.plain(family).or_else(from_joints)?;
        let index = self
            .model
            .functions
            .iter()
            .position(|f| std::ptr::eq(f, wanted))?;
        let finds_joints = self.model.finds_joints(wanted);
        let place = |(array, used): (&overact_codegen::lowering::Array, bool)| {
            if finds_joints && array.name == "joints" {
                return Some(Given::Joints);
            }
            if !used {
                return Some(Given::Unread);
            }
            let joints = array.name == "joints" && function.inputs().contains(&Input::Joints);
            let input = match joints {
                true => Input::Joints,
                false => input_of(&array.name)?,
            };
            let mut known = function.inputs().iter();
            known.position(|i| *i == input).map(Given::At)
        };
        let arrays = wanted.program.inputs.iter();
        let inputs: Option<Vec<Given>> = arrays
            .zip(wanted.program.used_inputs())
            .map(place)
            .collect();
        let (rows, columns) = function.shape(&self.names.sizes);
        // A program that does not fit the trait is not offered rather than misread.
        let inputs = inputs
            .filter(|i| i.len() <= INPUTS && wanted.program.entries.len() == rows * columns)?;
        let evaluators = Pool::default();
        Some(Served {
            function,
            index,
            inputs,
            evaluators,
        })
    }

    /// The pose by rule, where the robot has one and the spheres meet.
    fn pose_in_closed_form(&self, actuators: &[f64]) -> Option<Vec<f64>> {
        let function = self
            .model
            .function(Family::PoseInClosedForm, MotionInput::Actuators)?;
        let mut pose = vec![0.0; self.names.sizes.pose];
        let given = [Rows {
            values: actuators,
            shared: false,
        }];
        let found = function.program.evaluate(1, &given, &mut pose);
        found.ok().map(|()| pose)
    }

    /// The pose of least squares, found from the one in `pose`.
    fn fit_pose(&self, actuators: &[f64], pose: &mut [f64]) -> Result<(), Error> {
        let sizes = self.names.sizes;
        self.scratch.with(Scratch::default, |scratch| {
            scratch.resize(&sizes);
            let Scratch {
                actuators: reached,
                inverse_jacobian,
                normal,
                step,
                pose: at,
            } = scratch;
            at.copy_from_slice(pose);
            let is_revolute = &self.names.actuator_is_revolute;
            forward::gauss_newton(
                Measured {
                    positions: actuators,
                    is_revolute,
                },
                at,
                forward::Workspace {
                    actuators: reached,
                    inverse_jacobian,
                    normal,
                    step,
                },
                |pose, reached, jacobian| {
                    self.evaluate(Function::ActuatorPositions, &[pose], reached)
                        .and_then(|()| self.evaluate(Function::InverseJacobian, &[pose], jacobian))
                        .map_err(|error| error.error)
                },
                |pose, step| self.displace(pose, step),
            )?;
            pose.copy_from_slice(at);
            Ok(())
        })
    }

    fn program(&self, served: &Served) -> &Program {
        &self.model.functions[served.index].program
    }

    /// What a failed condition of a program means.
    #[must_use]
    pub fn error(&self, program: &Program, failed: &Failed) -> SampleError {
        let times = |home: f64| {
            let ratio = home / failed.value.abs();
            if ratio.is_nan() { f64::INFINITY } else { ratio }
        };
        let leg = |name: &str| self.names.leg(name);
        let error = match program
            .guards
            .get(failed.guard)
            .map(|guard| &guard.condition)
        {
            Some(Condition::Reach { leg: name }) => Error::OutOfReach { leg: leg(name) },
            Some(Condition::Leg { leg: name, home }) => Error::SingularLeg {
                leg: leg(name),
                condition: times(*home),
            },
            Some(Condition::Platform { actuators, home }) => Error::SingularPlatform {
                actuators,
                condition: times(*home),
            },
            None => Error::NotFinite,
        };
        SampleError {
            sample: failed.sample,
            error,
        }
    }

    /// Lengths and finiteness of all inputs.
    fn check(
        &self,
        function: Function,
        inputs: &[&[f64]],
        samples: usize,
    ) -> Result<(), SampleError> {
        let kinds = function.inputs();
        let whole = |error| SampleError { sample: 0, error };
        if inputs.len() != kinds.len() {
            return Err(whole(Error::Length {
                expected: kinds.len(),
                found: inputs.len(),
            }));
        }
        let mut first: Option<usize> = None;
        for (kind, values) in kinds.iter().zip(inputs) {
            let row = self.names.sizes.of(*kind);
            let shared = *kind == Input::Parameters;
            let expected = if shared { row } else { row * samples };
            if values.len() != expected {
                return Err(whole(Error::Length {
                    expected,
                    found: values.len(),
                }));
            }
            if let Some(at) = values.iter().position(|value| !value.is_finite()) {
                let sample = if shared { 0 } else { at / row };
                first = Some(first.map_or(sample, |known| known.min(sample)));
            }
        }
        first.map_or(Ok(()), |sample| {
            Err(SampleError {
                sample,
                error: Error::NotFinite,
            })
        })
    }

    /// Functions that a robot without redundancy does not need, but that have a meaning.
    fn trivial(
        &self,
        function: Function,
        inputs: &[&[f64]],
        output: &mut [f64],
    ) -> Result<(), Error> {
        let sizes = &self.names.sizes;
        match (function, inputs) {
            // Without redundancy there are no internal torques to remove.
            (Function::ProjectTorques, [_, torques]) if sizes.actuators == sizes.dof => {
                output.copy_from_slice(torques);
                Ok(())
            }
            _ => Err(Error::NotOffered {
                function: function.name(),
            }),
        }
    }
}

impl Model for InterpretedRobot {
    fn info(&self) -> Info<'_> {
        self.names.info(&self.model)
    }

    fn evaluate(
        &self,
        function: Function,
        inputs: &[&[f64]],
        output: &mut [f64],
    ) -> Result<(), SampleError> {
        let whole = |error| SampleError { sample: 0, error };
        let (rows, columns) = function.shape(&self.names.sizes);
        let width = rows * columns;
        let samples = output.len().checked_div(width).unwrap_or(0);
        if output.len() != samples * width {
            let expected = (samples + usize::from(width > 0)) * width;
            return Err(whole(Error::Length {
                expected,
                found: output.len(),
            }));
        }
        if width == 0 {
            return Ok(());
        }
        self.check(function, inputs, samples)?;
        let Some(served) = self.functions.iter().find(|s| s.function == function) else {
            return self.trivial(function, inputs, output).map_err(whole);
        };
        let mut given = [Rows {
            values: &[],
            shared: false,
        }; INPUTS];
        let found = match served.inputs.contains(&Given::Joints) {
            true => self.find_joints(inputs[0])?,
            false => Vec::new(),
        };
        if function == Function::Joints && !found.is_empty() {
            output.copy_from_slice(&found);
            return Ok(());
        }
        for (slot, &at) in given.iter_mut().zip(&served.inputs) {
            *slot = match at {
                Given::At(at) => Rows {
                    values: inputs[at],
                    shared: function.inputs()[at] == Input::Parameters,
                },
                Given::Joints => Rows {
                    values: &found,
                    shared: false,
                },
                Given::Unread => Rows {
                    values: &[],
                    shared: false,
                },
            };
        }
        let given = &given[..served.inputs.len()];
        let program = self.program(served);
        let run = |evaluator: &mut Evaluator| evaluator.evaluate(samples, given, output);
        served
            .evaluators
            .with(|| Evaluator::new(program), run)
            .map_err(|failed| self.error(program, &failed))
    }

    fn pose_from_actuators(&self, actuators: &[f64], pose: &mut [f64]) -> Result<(), Error> {
        let sizes = self.names.sizes;
        for (expected, found) in [(sizes.actuators, actuators.len()), (sizes.pose, pose.len())] {
            if expected != found {
                return Err(Error::Length { expected, found });
            }
        }
        if actuators.iter().any(|q| !q.is_finite()) {
            return Err(Error::NotFinite);
        }
        if self.model.is_tree() {
            pose.copy_from_slice(actuators);
            return Ok(());
        }
        let closed = self.pose_in_closed_form(actuators);
        if let (Some(found), true) = (&closed, sizes.actuators == sizes.dof) {
            pose.copy_from_slice(found);
            return Ok(());
        }
        self.fit_pose(actuators, pose).or_else(|error| {
            let found = closed.ok_or(error)?;
            pose.copy_from_slice(&found);
            self.fit_pose(actuators, pose)
        })
    }

    fn displace(&self, pose: &mut [f64], step: &[f64]) {
        let motion = self
            .model
            .mechanism
            .platform
            .as_ref()
            .map(|platform| platform.motion);
        if motion.is_some_and(overact_codegen::mechanism::Motion::has_quaternion) {
            forward::displace_quaternion(pose, step);
        } else {
            forward::displace(pose, step);
        }
    }
}

impl Scratch {
    fn resize(&mut self, sizes: &overact::Sizes) {
        let (n, r) = (sizes.actuators, sizes.dof);
        self.actuators.resize(n, 0.0);
        self.inverse_jacobian.resize(n * r, 0.0);
        self.normal.resize(r * r, 0.0);
        self.step.resize(r, 0.0);
        self.pose.resize(sizes.pose, 0.0);
    }
}

/// The functions of the trait and what they are called in the generator.
const ALL: [(Function, Family); 16] = [
    (Function::Joints, Family::Joints),
    (Function::ActuatorPositions, Family::ActuatorPositions),
    (Function::InverseJacobian, Family::InverseJacobian),
    (Function::JointVelocities, Family::JointVelocities),
    (Function::JointAccelerations, Family::JointAccelerations),
    (Function::TwistFromActuators, Family::TwistFromActuators),
    (
        Function::AccelerationFromActuators,
        Family::AccelerationFromActuators,
    ),
    (
        Function::IdmRedPlatform,
        Family::IdmRedPlatform(Columns::Standard),
    ),
    (Function::IdmRedPayload, Family::IdmRedPayload),
    (Function::ProjectPlatform, Family::ProjectPlatform),
    (Function::InverseDynamics, Family::InverseDynamics),
    (Function::MassMatrix, Family::MassMatrix),
    (Function::Bias, Family::Bias),
    (Function::ProjectTorques, Family::ProjectTorques),
    (Function::NullSpace, Family::NullSpace),
    (
        Function::ClosureActuatorJacobian,
        Family::ClosureActuatorJacobian,
    ),
];

/// The input that a program's array of this name is. A tree's joints are its pose.
fn input_of(name: &str) -> Option<Input> {
    Some(match name {
        "pose" | "joints" => Input::Pose,
        "twist" | "joint_velocities" => Input::Twist,
        "acceleration" | "joint_accelerations" => Input::Acceleration,
        "actuator_velocities" => Input::ActuatorVelocities,
        "actuator_accelerations" => Input::ActuatorAccelerations,
        "torques" => Input::Torques,
        "parameters" => Input::Parameters,
        _ => return None,
    })
}
