//! Implements [`overact::Model`] by interpreting a robot's programs, without a compiler.
//!
//! The pose of a serial robot is its joint positions, and the twist its joint velocities.

mod follow;
mod forward;
mod names;
mod newton;

use forward::Scratch;
use names::Names;
use overact::{
    Error, Function, Info, Input, Model, SampleError, block::samples, guard, limits::DOUBLE,
};
use overact_codegen::{
    RobotModel,
    derivation::MotionInput,
    interpreter::{Evaluator, Failed, Rows},
    lowering::{Array, Condition, Program},
    mechanism::Mechanism,
};
use std::sync::{Mutex, PoisonError};

/// Largest number of inputs of a program, including joints found by Newton's method.
const MAX_INPUTS: usize = 6;

/// Source of a program's input.
#[derive(Debug, Clone, Copy, PartialEq)]
enum InputSource {
    /// Input of the function with this index.
    Argument(usize),
    /// Joints from Newton's method.
    Joints,
    /// The program does not read it.
    Unread,
}

/// A robot whose programs are interpreted.
#[derive(Debug)]
pub struct InterpretedRobot {
    model: RobotModel,
    names: Names,
    /// Independent coordinates of a pose with dependent ones: among the six of a platform with
    /// parasitic motion, or among the joints of a skeleton.
    independent: Option<Vec<usize>>,
    functions: Vec<ServedFunction>,
    scratch: Pool<Scratch>,
}

/// A function of [`Model`] with the program that computes it.
#[derive(Debug)]
struct ServedFunction {
    function: Function,
    /// Index among the model's functions.
    index: usize,
    /// Source of each input of the program.
    inputs: Vec<InputSource>,
    evaluators: Pool<Evaluator>,
}

/// Pool of working memory, reused between calls.
///
/// A call allocates only if more threads than ever before run at once. Resizing per call would cost
/// more than a sample; boxes make taking and returning cheap.
#[derive(Debug)]
struct Pool<T>(Mutex<Vec<Box<T>>>);

impl<T> Default for Pool<T> {
    fn default() -> Self {
        Self(Mutex::default())
    }
}

impl<T> Pool<T> {
    /// Calls `work` with memory of the pool, which `make` creates if none is free.
    fn with<R>(&self, make: impl FnOnce() -> T, work: impl FnOnce(&mut T) -> R) -> R {
        // A panic elsewhere does not invalidate the memory, so a poisoned lock is used.
        let free = || self.0.lock().unwrap_or_else(PoisonError::into_inner);
        let mut memory = free().pop().unwrap_or_else(|| Box::new(make()));
        let result = work(&mut memory);
        free().push(memory);
        result
    }
}

impl InterpretedRobot {
    /// Creates an interpreter of a model.
    ///
    /// Names in errors and parameters are `&'static str`, as in generated code. Each robot
    /// therefore leaks a few kilobytes once.
    #[must_use]
    pub fn new(model: RobotModel) -> Self {
        let names = Names::new(&model);
        let independent = model.mechanism.independent_coordinates();
        let mut robot = Self {
            model,
            names,
            independent,
            functions: Vec::new(),
            scratch: Pool::default(),
        };
        let served = |function| robot.program_of(function);
        let all = robot.model.all_functions();
        robot.functions = all.filter_map(served).collect();
        robot
    }

    /// Whether identification, simulation or the search for pose and joints need a function, or
    /// it is one of a frame.
    ///
    /// A model of only these functions compiles faster.
    #[must_use]
    pub fn serves(mechanism: &Mechanism, function: Function, from: MotionInput) -> bool {
        matches!(function, Function::Frame(_))
            || overact_codegen::serves_model(mechanism, function, from)
    }

    /// Whether a function computes pose and joints from encoder positions.
    ///
    /// A caller of any single function needs these functions as well.
    #[must_use]
    pub fn finds_pose(mechanism: &Mechanism, function: Function, from: MotionInput) -> bool {
        let finds = matches!(
            function,
            Function::PoseInClosedForm
                | Function::Joints
                | Function::ActuatorPositions
                | Function::PoseStep
                | Function::InverseJacobian
                | Function::ClosureError
                | Function::BlockedError
                | Function::BlockedJacobian
                | Function::PoseError
                | Function::PoseErrorJacobian
                | Function::ClosureActuatorJacobian
                | Function::LegsJacobian
        );
        finds && Self::serves(mechanism, function, from)
    }

    /// The model.
    #[must_use]
    pub const fn model(&self) -> &RobotModel {
        &self.model
    }

    /// Name of a leg, for errors, which need a static lifetime.
    pub(crate) fn leg_name(&self, index: usize) -> &'static str {
        let leg = self.model.mechanism.legs.get(index);
        leg.map_or("", |leg| self.names.leg(&leg.name))
    }

    /// The program of a function, with the sources of its inputs; `None` if the model lacks it.
    fn program_of(&self, function: Function) -> Option<ServedFunction> {
        let wanted = self.model.served(function)?;
        let all = &self.model.functions;
        let index = all.iter().position(|f| std::ptr::eq(f, wanted))?;
        let finds_joints = self.model.finds_joints(wanted);
        let source = |(array, used): (&Array, bool)| {
            if finds_joints && array.name == "joints" {
                return Some(InputSource::Joints);
            }
            if !used {
                return Some(InputSource::Unread);
            }
            let mut known = function.inputs().iter();
            known
                .position(|&i| self.input_name(i) == array.name)
                .map(InputSource::Argument)
        };
        let arrays = wanted.program.inputs.iter();
        let inputs: Option<Vec<InputSource>> = arrays
            .zip(wanted.program.used_inputs())
            .map(source)
            .collect();
        let (rows, columns) = function.shape(&self.names.sizes);
        // Omit a program that does not match the table.
        let inputs = inputs
            .filter(|i| i.len() <= MAX_INPUTS && wanted.program.output.len() == rows * columns)?;
        let evaluators = Pool::default();
        Some(ServedFunction {
            function,
            index,
            inputs,
            evaluators,
        })
    }

    fn program(&self, served: &ServedFunction) -> &Program {
        &self.model.functions[served.index].program
    }

    /// Error for a failed guard of a program.
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
            Some(Condition::Reach { leg: name, .. })
                if failed.value.is_nan() || failed.value < 0.0 =>
            {
                Error::OutOfReach { leg: leg(name) }
            }
            Some(Condition::Reach { leg: name, home }) => Error::SingularLeg {
                leg: leg(name),
                condition: times(*home).sqrt(),
            },
            Some(Condition::Leg { leg: name, home }) => Error::SingularLeg {
                leg: leg(name),
                condition: times(*home),
            },
            Some(Condition::Platform { actuators, home }) => Error::SingularPlatform {
                actuators: *actuators,
                condition: times(*home),
            },
            Some(Condition::Closed { leg: name, .. }) => Error::NotClosed {
                leg: leg(name),
                gap: failed.value.abs(),
            },
            Some(Condition::Coordinates { home }) => Error::SingularCoordinates {
                condition: times(*home),
            },
            Some(Condition::Mass) => Error::MassMatrix,
            None if !program.least_torques.is_empty() && !failed.value.is_nan() => Error::Tensions,
            Some(Condition::Size { .. }) | None => Error::Overflow,
        };
        SampleError {
            sample: failed.sample,
            error,
        }
    }

    /// Error of the first sample with an input that is not finite or too large.
    fn first_out_of_range(&self, function: Function, inputs: &[&[f64]]) -> Option<SampleError> {
        let sizes = &self.names.sizes;
        let kinds = function.inputs().iter().zip(inputs);
        let of = |(kind, values): (&Input, &&[f64])| {
            // Such inputs are rare: test all without branches, then search only if needed.
            let input = self.input_name(*kind);
            let most = DOUBLE.largest.of(input);
            let is_good = |value: &f64| value.abs() <= most;
            if values.iter().fold(true, |all, value| all & is_good(value)) {
                return None;
            }
            let at = values.iter().position(|value| !is_good(value))?;
            let row = sizes.of(*kind);
            let sample = if values.len() == row { 0 } else { at / row };
            let numbers = values.chunks(row).nth(at / row).unwrap_or_default();
            let error = guard::within(&[(input, numbers, most)]).err()?;
            Some(SampleError { sample, error })
        };
        kinds.filter_map(of).min_by_key(|error| error.sample)
    }

    /// Normalises the quaternion at the end of a pose, if the pose has one.
    ///
    /// # Errors
    /// A quaternion of length zero.
    pub fn unit_pose(&self, pose: &[f64]) -> Result<Vec<f64>, Error> {
        let mut unit = pose.to_vec();
        if self.has_quaternion() {
            guard::normalise(&mut unit, Input::Pose.name())?;
        }
        Ok(unit)
    }

    /// Poses with normalised quaternions, and the first sample whose quaternion is zero.
    fn unit_quaternions(&self, poses: &[f64]) -> (Vec<f64>, Option<SampleError>) {
        let mut unit = poses.to_vec();
        let mut poses = unit.chunks_mut(self.names.sizes.pose).enumerate();
        let bad = poses.find_map(|(sample, pose)| {
            let error = guard::normalise(pose, Input::Pose.name()).err()?;
            Some(SampleError { sample, error })
        });
        (unit, bad)
    }

    /// Name of an input in generated code.
    fn input_name(&self, input: Input) -> &'static str {
        if self.model.is_tree() {
            input.name_without_platform()
        } else {
            input.name()
        }
    }

    fn has_quaternion(&self) -> bool {
        let platform = self.model.mechanism.platform.as_ref();
        platform.is_some_and(|platform| platform.motion.has_quaternion())
    }

    /// Evaluates a function at the first `samples` samples of a block.
    fn run_samples(
        &self,
        served: &ServedFunction,
        inputs: &[&[f64]],
        samples: usize,
        output: &mut [f64],
    ) -> Result<(), SampleError> {
        let kinds = served.function.inputs();
        // An input with a single row is used for all samples.
        let rows = |at: usize| {
            let (values, row) = (inputs[at], self.names.sizes.of(kinds[at]));
            let shared = values.len() == row;
            let values = if shared {
                values
            } else {
                &values[..row * samples]
            };
            Rows { values, shared }
        };
        const NOTHING: Rows<'_> = Rows {
            values: &[],
            shared: false,
        };
        let poses = rows(0);
        let found = if served.inputs.contains(&InputSource::Joints) {
            self.find_joints(poses.values)?
        } else {
            Vec::new()
        };
        if served.function == Function::Joints && !found.is_empty() {
            let joints = output.chunks_mut(self.names.sizes.joints);
            joints
                .zip(found.chunks(self.names.sizes.joints).cycle())
                .for_each(|(out, found)| out.copy_from_slice(found));
            return Ok(());
        }
        let mut given = [NOTHING; MAX_INPUTS];
        for (slot, &at) in given.iter_mut().zip(&served.inputs) {
            *slot = match at {
                InputSource::Argument(at) => rows(at),
                InputSource::Joints => Rows {
                    values: &found,
                    shared: poses.shared,
                },
                InputSource::Unread => NOTHING,
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
}

impl Model for InterpretedRobot {
    fn info(&self) -> Info<'_> {
        self.names.info(&self.model)
    }

    fn base_columns(&self) -> &[&'static str] {
        &self.names.base_columns
    }

    fn frames(&self) -> &[&'static str] {
        &self.names.frames
    }

    fn pulls(&self) -> &[bool] {
        &self.names.pulls
    }

    fn actuator_terms(&self, actuator: usize) -> &[(usize, f64)] {
        let terms = self.names.actuator_terms.get(actuator);
        terms.map_or(&[], Vec::as_slice)
    }

    fn evaluate(
        &self,
        function: Function,
        inputs: &[&[f64]],
        output: &mut [f64],
    ) -> Result<(), SampleError> {
        let served = self.functions.iter().find(|s| s.function == function);
        let served = served.ok_or(SampleError {
            sample: 0,
            error: Error::NotOffered {
                function: function.name(),
            },
        })?;
        let samples = samples(function, &self.names.sizes, inputs, output)?;
        if samples == 0 {
            return Ok(());
        }
        // As in compiled robots, report the first failing sample, of whatever kind.
        let mut bad = self.first_out_of_range(function, inputs);
        let (mut scaled, unit);
        let mut inputs = inputs;
        if self.has_quaternion() && function.inputs().first() == Some(&Input::Pose) {
            let zero;
            (unit, zero) = self.unit_quaternions(inputs[0]);
            let earlier = |zero: &SampleError| bad.is_none_or(|bad| zero.sample < bad.sample);
            bad = zero.filter(earlier).or(bad);
            scaled = inputs.to_vec();
            scaled[0] = &unit;
            inputs = &scaled;
        }
        let good = bad.map_or(samples, |error| error.sample);
        let width = output.len() / samples;
        if good > 0 {
            self.run_samples(served, inputs, good, &mut output[..good * width])?;
        }
        bad.map_or(Ok(()), Err)
    }

    fn pose_from_actuators(&self, actuators: &[f64], pose: &mut [f64]) -> Result<(), Error> {
        let sizes = self.names.sizes;
        for (expected, found) in [(sizes.actuators, actuators.len()), (sizes.pose, pose.len())] {
            if expected != found {
                return Err(Error::Length { expected, found });
            }
        }
        let largest = DOUBLE.largest;
        guard::within(&[
            ("actuators", actuators, largest.position),
            ("start", pose, largest.pose),
        ])?;
        if self.model.is_tree() {
            pose.copy_from_slice(actuators);
            return Ok(());
        }
        let found = self.found_pose(actuators, pose.to_vec())?;
        pose.copy_from_slice(&found);
        Ok(())
    }

    fn displace(&self, pose: &mut [f64], step: &[f64]) {
        self.displaced(pose, step);
    }
}
