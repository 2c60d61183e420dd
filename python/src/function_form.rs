//! A function of a robot in one of its forms (from pose, joints or actuators), over samples.

use overact::{Error, Function, Input, Model, SampleError, guard, limits::DOUBLE};
use overact_codegen::{
    CompiledFunction, RobotModel,
    derivation::MotionInput,
    interpreter::{Evaluator, Rows},
};
use overact_robot::{InterpretedRobot, Robot};
use std::sync::{Arc, Mutex, PoisonError};

/// Owner of a form's program.
pub(crate) enum Owner {
    /// The robot, with which its usual functions are compiled.
    Robot(Arc<Robot>),
    /// A model of this function only.
    Own(Box<InterpretedRobot>),
}

impl Owner {
    pub(crate) fn model(&self) -> &InterpretedRobot {
        match self {
            Self::Robot(robot) => robot.model(),
            Self::Own(model) => model,
        }
    }
}

/// An argument of a form.
#[derive(Debug, Clone)]
pub(crate) struct Argument {
    pub(crate) name: String,
    pub(crate) length: usize,
}

/// A function in one of its forms.
pub(crate) struct Form {
    owner: Owner,
    /// Index among the model's functions.
    index: usize,
    /// Arguments from the caller.
    pub(crate) arguments: Vec<Argument>,
    /// Whether [`Model::evaluate`] offers this form.
    is_served: bool,
    evaluators: Mutex<Vec<Evaluator>>,
}

impl Form {
    /// Form of an owner's model by its full name.
    pub(crate) fn new(owner: Owner, name: &str) -> Option<Self> {
        let model = owner.model().model();
        let index = model.functions.iter().position(|f| f.name == name)?;
        let function = &model.functions[index];
        let is_served = is_served(model, function);
        let arguments = if is_served {
            served_arguments(owner.model(), function.computes)
        } else {
            own_arguments(model, function)
        };
        Some(Self {
            owner,
            index,
            arguments,
            is_served,
            evaluators: Mutex::default(),
        })
    }

    /// Model of the form.
    pub(crate) fn model(&self) -> &InterpretedRobot {
        self.owner.model()
    }

    /// Function with its program.
    pub(crate) fn function(&self) -> &CompiledFunction {
        &self.model().model().functions[self.index]
    }

    /// Shape of the output at a sample.
    pub(crate) fn shape(&self) -> &[usize] {
        &self.function().program.output.shape
    }

    /// Whether forward kinematics computes the poses, from a start.
    pub(crate) fn follows(&self) -> bool {
        self.model().model().finds_pose(self.function())
    }

    /// Evaluates the form at `samples` samples.
    ///
    /// Each input has a row per sample or one row for all. `start` is the start pose of forward
    /// kinematics, and then its last pose.
    pub(crate) fn evaluate(
        &self,
        inputs: &[&[f64]],
        samples: usize,
        start: &mut [f64],
        output: &mut [f64],
    ) -> Result<(), SampleError> {
        if self.is_served {
            return self
                .model()
                .evaluate(self.function().computes, inputs, output);
        }
        self.run(inputs, samples, start, output)
    }

    /// Runs the program after its inputs have been computed.
    fn run(
        &self,
        inputs: &[&[f64]],
        samples: usize,
        start: &mut [f64],
        output: &mut [f64],
    ) -> Result<(), SampleError> {
        self.check_range(inputs)?;
        let given = |name: &str| {
            let at = self.arguments.iter().position(|one| one.name == name);
            at.map(|at| (inputs[at], self.arguments[at].length))
        };
        let function = self.function();
        let mut found: Vec<Vec<f64>> = Vec::new();
        let mut places = Vec::new();
        let mut pose: Option<Vec<f64>> = None;
        for array in &function.program.inputs {
            let own = match array.name.as_str() {
                "pose" if self.follows() => {
                    let actuators = given("actuators").map_or(&[][..], |(values, _)| values);
                    Some(self.poses(actuators, samples, start)?)
                }
                "pose" => given("pose")
                    .map(|(poses, _)| self.unit(poses))
                    .transpose()?,
                "joints" if given("joints").is_none() => {
                    let poses = pose.as_deref().unwrap_or_default();
                    Some(self.joints(poses)?)
                }
                _ => None,
            };
            if array.name == "pose" {
                pose.clone_from(&own);
            }
            places.push(own.map(|own| {
                found.push(own);
                found.len() - 1
            }));
        }
        let rows = function.program.inputs.iter().zip(&places);
        let rows = rows.map(|(array, place)| {
            let values = match place {
                Some(place) => found[*place].as_slice(),
                None => given(&array.name).map_or(&[][..], |(values, _)| values),
            };
            Rows {
                values,
                shared: values.len() == array.len(),
            }
        });
        let rows: Vec<Rows<'_>> = rows.collect();
        self.with_evaluator(|evaluator| evaluator.evaluate(samples, &rows, output))
            .map_err(|failed| self.model().error(&function.program, &failed))
    }

    /// Calls `work` with memory from a pool.
    fn with_evaluator<R>(&self, work: impl FnOnce(&mut Evaluator) -> R) -> R {
        let free = || {
            self.evaluators
                .lock()
                .unwrap_or_else(PoisonError::into_inner)
        };
        let kept = free().pop();
        let mut evaluator = kept.unwrap_or_else(|| Evaluator::new(&self.function().program));
        let result = work(&mut evaluator);
        free().push(evaluator);
        result
    }

    /// Rejects the first sample with a number that is not finite or too large.
    fn check_range(&self, inputs: &[&[f64]]) -> Result<(), SampleError> {
        let bad = self
            .arguments
            .iter()
            .zip(inputs)
            .filter_map(|(own, values)| {
                let most = DOUBLE.largest.of(&own.name);
                let at = (values.iter()).position(|value| value.is_nan() || value.abs() > most)?;
                let is_row = values.len() == own.length;
                let row = values.chunks(own.length).nth(at / own.length);
                let input = known_name(&own.name);
                let error = guard::within(&[(input, row.unwrap_or_default(), most)]);
                Some(SampleError {
                    sample: if is_row { 0 } else { at / own.length },
                    error: error.err()?,
                })
            });
        bad.min_by_key(|error| error.sample).map_or(Ok(()), Err)
    }

    /// Poses by forward kinematics, one after the other.
    fn poses(
        &self,
        actuators: &[f64],
        samples: usize,
        start: &mut [f64],
    ) -> Result<Vec<f64>, SampleError> {
        let info = self.model().info();
        let mut poses = Vec::with_capacity(samples * info.sizes.pose);
        let rows = actuators.chunks(info.sizes.actuators.max(1)).cycle();
        for (sample, row) in rows.take(samples).enumerate() {
            follow(self.model(), row, start).map_err(|error| SampleError { sample, error })?;
            poses.extend_from_slice(start);
        }
        Ok(poses)
    }

    /// Poses with normalised quaternions.
    fn unit(&self, poses: &[f64]) -> Result<Vec<f64>, SampleError> {
        let length = self.model().info().sizes.pose.max(1);
        let mut unit = Vec::with_capacity(poses.len());
        for (sample, pose) in poses.chunks(length).enumerate() {
            let pose = self.model().unit_pose(pose);
            unit.extend(pose.map_err(|error| SampleError { sample, error })?);
        }
        Ok(unit)
    }

    /// Joints by inverse kinematics, if they are not arguments.
    fn joints(&self, poses: &[f64]) -> Result<Vec<f64>, SampleError> {
        let sizes = self.model().info().sizes;
        let mut joints = vec![0.0; poses.len() / sizes.pose.max(1) * sizes.joints];
        self.model()
            .evaluate(Function::Joints, &[poses], &mut joints)?;
        Ok(joints)
    }
}

/// Forward kinematics from the last pose, else from home.
pub(crate) fn follow(
    model: &InterpretedRobot,
    actuators: &[f64],
    pose: &mut [f64],
) -> Result<(), Error> {
    model.follow_actuators(actuators, pose).or_else(|error| {
        let mut home = model.info().home_pose.to_vec();
        model
            .follow_actuators(actuators, &mut home)
            .map_err(|_| error)?;
        pose.copy_from_slice(&home);
        Ok(())
    })
}

/// Whether [`Model::evaluate`] offers a form.
///
/// A model of one form only always offers it, with inputs that are not its own.
fn is_served(model: &RobotModel, function: &CompiledFunction) -> bool {
    let computes = function.computes;
    let has_own_inputs = match function.from {
        MotionInput::Pose => true,
        MotionInput::Joints => model.is_tree() || computes.inputs().contains(&Input::Joints),
        MotionInput::Actuators => computes == Function::PoseInClosedForm,
    };
    let served = model.served(computes);
    has_own_inputs && served.is_some_and(|served| std::ptr::eq(served, function))
}

/// Arguments of a function that [`Model::evaluate`] offers.
fn served_arguments(robot: &InterpretedRobot, function: Function) -> Vec<Argument> {
    let sizes = robot.info().sizes;
    let is_tree = robot.model().is_tree();
    let argument = |input: &Input| Argument {
        name: if is_tree {
            input.name_without_platform()
        } else {
            input.name()
        }
        .to_owned(),
        length: sizes.of(*input),
    };
    function.inputs().iter().map(argument).collect()
}

/// Arguments of a program whose pose or joints are computed first.
fn own_arguments(model: &RobotModel, function: &CompiledFunction) -> Vec<Argument> {
    let follows = model.finds_pose(function);
    let finds_joints = model.finds_joints(function);
    let arrays = function.program.inputs.iter();
    let kept = arrays.filter(|array| {
        !(follows && array.name == "pose" || finds_joints && array.name == "joints")
    });
    let own = kept.map(|array| Argument {
        name: array.name.clone(),
        length: array.len(),
    });
    let actuators = follows.then(|| Argument {
        name: Input::Actuators.name().to_owned(),
        length: model.mechanism.actuator_count(),
    });
    let mut all: Vec<Argument> = actuators.into_iter().chain(own).collect();
    // Newton's method needs the pose to compute the joints.
    let has = |all: &[Argument], name: &str| all.iter().any(|one| one.name == name);
    if finds_joints && function.from == MotionInput::Pose && !has(&all, "pose") {
        all.insert(
            0,
            Argument {
                name: Input::Pose.name().to_owned(),
                length: model.mechanism.pose_len(),
            },
        );
    }
    all
}

/// Name of an argument with static lifetime, for errors.
fn known_name(name: &str) -> &'static str {
    let all = [
        Input::Pose,
        Input::Joints,
        Input::Twist,
        Input::Acceleration,
        Input::Actuators,
        Input::ActuatorVelocities,
        Input::ActuatorAccelerations,
        Input::Torques,
        Input::Parameters,
        Input::BaseParameters,
        Input::Preload,
        Input::Wrench,
    ];
    let names = all
        .into_iter()
        .flat_map(|input| [input.name(), input.name_without_platform()]);
    names
        .into_iter()
        .find(|own| *own == name)
        .unwrap_or("input")
}
