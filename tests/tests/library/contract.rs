//! Every backend of [`overact::Model`] gives equal answers, for all functions and all kinds of
//! invalid input.
//!
//! A backend is one line in [`backends`]. Answers are compared with those of the compiled robot,
//! relative to the largest number of the output. Other tests check that the values are right.

use overact::{Condition, Error, Function, Input, Model, SampleError, Sizes};
use overact_codegen::RobotModel;
use overact_robot::InterpretedRobot;
use overact_tests::support::library::described;
use overact_tests::support::sample::samples;
use overact_tests::support::{Failure, Sample};

/// Samples in a block.
const SAMPLES: usize = 3;

/// Largest difference of two backends, relative to the largest number of the output.
///
/// Their search may differ, and some poses are far out, where condition numbers are large.
const TOLERANCE: f64 = 1e-10;

/// Tolerance far from the workspace, where legs are nearly parallel.
///
/// Torques of a square system too large for cofactors come from normal equations, which square the
/// condition number of J_p^inv.
const FAR_TOLERANCE: f64 = 1e-7;

/// Distance of a pose far from the workspace, m.
const UNREACHABLE_DISTANCE: f64 = 10.0;

overact_tests::library!(check);

/// All backends of a robot.
fn backends<'a>(
    compiled: &'a dyn Model,
    interpreted: &'a dyn Model,
) -> Vec<(&'a str, &'a dyn Model)> {
    vec![("compiled", compiled), ("interpreted", interpreted)]
}

fn check(stem: &str, compiled: &dyn Model) -> Result<(), Failure> {
    let (model, expected) = described(stem)?;
    let all = samples(
        &expected.mechanism,
        &expected.parameters(),
        SAMPLES,
        31,
        false,
    )?;
    let offered = Function::ALL.map(|function| (function, is_offered(model, function)));
    let has_quaternion =
        (model.mechanism.platform.as_ref()).is_some_and(|p| p.motion.has_quaternion());
    let interpreted = InterpretedRobot::new(model.clone());
    let contract = Contract {
        stem,
        sizes: compiled.info().sizes,
        backends: backends(compiled, &interpreted),
        has_quaternion,
    };
    contract.check_info();
    for (function, is_offered) in offered {
        contract.check(function, is_offered, &all)?;
    }
    contract.check_forward_kinematics(&all)
}

/// Whether the table gives the robot the function.
fn is_offered(model: &RobotModel, function: Function) -> bool {
    use overact_codegen::derivation::JointsBy;
    let mechanism = &model.mechanism;
    let platform = mechanism.platform.as_ref();
    match function.condition() {
        _ if function.is_on_request() => false,
        Condition::Platform => !mechanism.is_tree(),
        Condition::Redundancy => mechanism.actuated().len() > mechanism.dof(),
        Condition::Payload => platform.is_some_and(|p| p.payload.is_some()),
        Condition::NumericJoints => model.selection.joints == JointsBy::Newton,
        Condition::Parasitic => mechanism.is_parasitic(),
        Condition::DependentJoints => mechanism.has_dependent_joints(),
        Condition::JointsByRule => !mechanism.is_tree() && model.selection.joints == JointsBy::Rule,
        // Only the generator knows whether there is a closed form.
        Condition::ClosedForm => model.served(function).is_some(),
        _ => true,
    }
}

/// Answer of a backend: the output, or an error.
type Answer = Result<Vec<f64>, SampleError>;

/// Backends of a robot that must agree.
struct Contract<'a> {
    stem: &'a str,
    sizes: Sizes,
    backends: Vec<(&'a str, &'a dyn Model)>,
    has_quaternion: bool,
}

impl Contract<'_> {
    /// Checks that all backends give the same information.
    fn check_info(&self) {
        let mut infos = self
            .backends
            .iter()
            .map(|(name, model)| (name, format!("{:#?}", model.info())));
        let first = infos.next();
        for (name, info) in infos {
            let (other, expected) = first.as_ref().expect("there is a first backend");
            assert_eq!(
                &info, expected,
                "{}: what {name} and {other} say",
                self.stem
            );
        }
    }

    /// Checks everything about one function.
    fn check(&self, function: Function, is_offered: bool, all: &[Sample]) -> Result<(), Failure> {
        let (rows, columns) = function.shape(&self.sizes);
        let width = rows * columns;
        let inputs = function
            .inputs()
            .iter()
            .map(|input| block(function, *input, all));
        let inputs = inputs.collect::<Result<Vec<_>, Failure>>()?;
        let ask = |inputs: &[Vec<f64>], length: usize, case: &str| {
            self.agree(&format!("{function:?}, {case}"), |model| {
                let inputs: Vec<&[f64]> = inputs.iter().map(Vec::as_slice).collect();
                let mut output = vec![0.0; length];
                model.evaluate(function, &inputs, &mut output)?;
                Ok(output)
            })
        };
        let answer = ask(&inputs, width * SAMPLES, "regular states");
        if !is_offered {
            let function = function.name();
            let error = answer.map_err(|error| error.error);
            assert_eq!(error, Err(Error::NotOffered { function }), "{}", self.stem);
            return Ok(());
        }
        answer?;
        self.check_lengths(function, &inputs, width, &ask)?;
        self.check_sharing(function, &inputs, width, &ask)?;
        self.check_numbers(function, &inputs, width, &ask);
        self.check_masses(function, &inputs, width, &ask);
        self.check_poses(function, &inputs, width, &ask)
    }

    /// Checks wrong numbers of inputs, wrong lengths of inputs and outputs, and zero samples.
    fn check_lengths(
        &self,
        function: Function,
        inputs: &[Vec<f64>],
        width: usize,
        ask: &impl Fn(&[Vec<f64>], usize, &str) -> Answer,
    ) -> Result<(), Failure> {
        let length = width * SAMPLES;
        let mut more = inputs.to_vec();
        more.push(vec![0.0; 3]);
        for wrong in [&[][..], &inputs[..inputs.len() - 1], &more] {
            let error = ask(wrong, length, "another number of inputs")
                .expect_err("refused")
                .error;
            assert!(
                matches!(error, Error::Inputs { .. }),
                "{}: {function:?}: {error}",
                self.stem
            );
        }
        for at in 0..inputs.len() {
            let row = inputs[at].len() / SAMPLES;
            for wrong in [0, inputs[at].len() - 1, inputs[at].len() + 1, 2 * row] {
                let mut inputs = inputs.to_vec();
                inputs[at].resize(wrong, 0.5);
                // A row of one number minus two would be a row for all samples.
                if wrong == row {
                    continue;
                }
                let answer = ask(&inputs, length, &format!("{wrong} numbers in input {at}"));
                assert!(
                    is_length(&answer),
                    "{}: {function:?}: {answer:?}",
                    self.stem
                );
            }
        }
        if width > 1 {
            for wrong in [length - 1, length + 1] {
                let answer = ask(inputs, wrong, "an output of another length");
                assert!(
                    is_length(&answer),
                    "{}: {function:?}: {answer:?}",
                    self.stem
                );
            }
        }
        let empty_inputs = vec![Vec::new(); inputs.len()];
        assert!(ask(&empty_inputs, 0, "no samples")?.is_empty());
        Ok(())
    }

    /// One row of an input serves all samples.
    fn check_sharing(
        &self,
        function: Function,
        inputs: &[Vec<f64>],
        width: usize,
        ask: &impl Fn(&[Vec<f64>], usize, &str) -> Answer,
    ) -> Result<(), Failure> {
        for at in 0..inputs.len() {
            let (mut one, mut repeated) = (inputs.to_vec(), inputs.to_vec());
            one[at].truncate(inputs[at].len() / SAMPLES);
            repeated[at] = one[at].repeat(SAMPLES);
            let shared = ask(&one, width * SAMPLES, &format!("input {at} shared"))?;
            let given = ask(&repeated, width * SAMPLES, &format!("input {at} repeated"))?;
            assert!(
                difference(&shared, &given) == 0.0,
                "{}: {function:?}",
                self.stem
            );
        }
        Ok(())
    }

    /// Checks NaN and infinities in each input, alone and after a sample that fails for another
    /// reason.
    fn check_numbers(
        &self,
        function: Function,
        inputs: &[Vec<f64>],
        width: usize,
        ask: &impl Fn(&[Vec<f64>], usize, &str) -> Answer,
    ) {
        for (at, kind) in function.inputs().iter().enumerate() {
            let row = inputs[at].len() / SAMPLES;
            for bad in [f64::NAN, f64::INFINITY, f64::NEG_INFINITY] {
                for place in 0..row {
                    let mut inputs = inputs.to_vec();
                    inputs[at][row + place] = bad;
                    let case = format!("{bad} in `{}`", kind.name());
                    let answer = ask(&inputs, width * SAMPLES, &case);
                    let named = [kind.name(), kind.name_without_platform()];
                    let is_named = |error: &SampleError| {
                        matches!(error.error, Error::NotFinite { input } if named.contains(&input))
                            && error.sample == 1
                    };
                    let error = answer.expect_err("refused");
                    assert!(
                        is_named(&error),
                        "{}: {function:?}, {case}: {error}",
                        self.stem
                    );
                }
            }
            let mut inputs = inputs.to_vec();
            inputs[at].fill(f64::NAN);
            inputs[0][0] = f64::INFINITY;
            let _ = ask(&inputs, width * SAMPLES, "everything wrong");
        }
    }

    /// Checks that massless bodies are rejected where a function divides by masses.
    fn check_masses(
        &self,
        function: Function,
        inputs: &[Vec<f64>],
        width: usize,
        ask: &impl Fn(&[Vec<f64>], usize, &str) -> Answer,
    ) {
        if !matches!(function, Function::ForwardDynamics(_)) {
            return;
        }
        let mut inputs = inputs.to_vec();
        let parameters = function
            .inputs()
            .iter()
            .position(|i| matches!(i, Input::Parameters | Input::BaseParameters));
        inputs[parameters.expect("parameters")].fill(0.0);
        let answer = ask(&inputs, width * SAMPLES, "no masses");
        let error = Err(SampleError {
            sample: 0,
            error: Error::MassMatrix,
        });
        assert_eq!(answer, error, "{}", self.stem);
    }

    /// Checks unreachable and singular poses, and quaternions of any length.
    fn check_poses(
        &self,
        function: Function,
        inputs: &[Vec<f64>],
        width: usize,
        ask: &impl Fn(&[Vec<f64>], usize, &str) -> Answer,
    ) -> Result<(), Failure> {
        let Some(at) = function.inputs().iter().position(|i| *i == Input::Pose) else {
            return Ok(());
        };
        let size = self.sizes.pose;
        for far in [1.5, UNREACHABLE_DISTANCE, 1e3] {
            let mut inputs = inputs.to_vec();
            inputs[at][size] += far;
            let _ = ask(&inputs, width * SAMPLES, &format!("a pose off by {far}"));
            // The first failing sample is reported, whatever follows.
            inputs[at][2 * size] = f64::NAN;
            let _ = ask(
                &inputs,
                width * SAMPLES,
                &format!("a pose off by {far} before NaN"),
            );
        }
        if !self.has_quaternion {
            return Ok(());
        }
        let regular = ask(inputs, width * SAMPLES, "unit quaternions")?;
        for length in [3.0, 1e-3, 1e-170, 1e5] {
            let mut inputs = inputs.to_vec();
            for pose in inputs[at].chunks_mut(size) {
                pose[size - 4..].iter_mut().for_each(|q| *q *= length);
            }
            let scaled = ask(
                &inputs,
                width * SAMPLES,
                &format!("quaternions of length {length}"),
            )?;
            let off = difference(&scaled, &regular);
            assert!(off < TOLERANCE, "{}: {function:?}: {off:e}", self.stem);
        }
        let mut inputs = inputs.to_vec();
        inputs[at][2 * size - 4..2 * size].fill(0.0);
        let error = ask(&inputs, width * SAMPLES, "a zero quaternion").expect_err("refused");
        let expected = Error::ZeroQuaternion { input: "pose" };
        assert_eq!(
            (error.sample, error.error),
            (1, expected),
            "{}: {function:?}",
            self.stem
        );
        Ok(())
    }

    /// Checks forward kinematics from home.
    fn check_forward_kinematics(&self, all: &[Sample]) -> Result<(), Failure> {
        let Some((_, first)) = self.backends.first() else {
            return Ok(());
        };
        let home = first.info().home_pose.to_vec();
        let ask = |actuators: &[f64], start: &[f64], case: &str| {
            self.agree(&format!("pose_from_actuators, {case}"), |model| {
                let mut pose = start.to_vec();
                let found = model.pose_from_actuators(actuators, &mut pose);
                found.map_err(|error| SampleError { sample: 0, error })?;
                Ok(pose)
            })
        };
        for sample in all {
            let actuators = sample.input("actuators")?;
            ask(actuators, &home, "a regular state")?;
            assert!(is_length(&ask(&actuators[1..], &home, "too few actuators")));
            assert!(is_length(&ask(actuators, &home[1..], "too short a start")));
            for bad in [f64::NAN, f64::INFINITY] {
                let mut wrong = actuators.to_vec();
                wrong[0] = bad;
                let error = ask(&wrong, &home, "actuators that are no numbers");
                let expected = Error::NotFinite { input: "actuators" };
                assert_eq!(
                    error.map_err(|error| error.error),
                    Err(expected),
                    "{}",
                    self.stem
                );
                let mut start = home.clone();
                start[0] = bad;
                let error = ask(actuators, &start, "a start that is no number");
                let expected = Error::NotFinite { input: "start" };
                assert_eq!(
                    error.map_err(|error| error.error),
                    Err(expected),
                    "{}",
                    self.stem
                );
            }
            let far = actuators.iter().map(|q| q + 50.0).collect::<Vec<_>>();
            let _ = ask(&far, &home, "far actuators");
            self.check_huge_actuators(actuators, &home);
            if self.has_quaternion {
                let mut start = home.clone();
                start[self.sizes.pose - 4..].fill(0.0);
                let error = ask(actuators, &start, "a start without orientation");
                let expected = Error::ZeroQuaternion { input: "start" };
                assert_eq!(
                    error.map_err(|error| error.error),
                    Err(expected),
                    "{}",
                    self.stem
                );
            }
        }
        Ok(())
    }

    /// Checks that no invalid pose results if squares of actuator positions overflow.
    fn check_huge_actuators(&self, actuators: &[f64], start: &[f64]) {
        for (size, (name, model)) in [1e70, 1e120, 1e150]
            .into_iter()
            .flat_map(|size| self.backends.iter().map(move |backend| (size, backend)))
        {
            let signs = [-size, 0.0, size].into_iter().cycle();
            let huge: Vec<f64> = actuators.iter().zip(signs).map(|(_, q)| q).collect();
            let mut pose = start.to_vec();
            if model.pose_from_actuators(&huge, &mut pose).is_ok() {
                let stem = self.stem;
                assert!(
                    pose.iter().all(|number| number.is_finite()),
                    "{stem}, {name}: {pose:?} of {huge:?}"
                );
            }
        }
    }

    /// Answer of the first backend, which must equal that of all.
    fn agree(&self, case: &str, ask: impl Fn(&dyn Model) -> Answer) -> Answer {
        let mut answers = self
            .backends
            .iter()
            .map(|(name, model)| (name, ask(*model)));
        let Some((first, wanted)) = answers.next() else {
            panic!("no backend");
        };
        let tolerance = if case.contains(&format!("a pose off by {UNREACHABLE_DISTANCE}")) {
            FAR_TOLERANCE
        } else {
            TOLERANCE
        };
        for (name, found) in answers {
            let is_same = match (&wanted, &found) {
                (Ok(wanted), Ok(found)) => difference(found, wanted) <= tolerance,
                (Err(wanted), Err(found)) => is_same_error(wanted, found),
                _ => false,
            };
            let stem = self.stem;
            assert!(
                is_same,
                "{stem}: {case}: {first} {wanted:?}, {name} {found:?}"
            );
        }
        wanted
    }
}

/// The rows of an input at all samples.
fn block(function: Function, input: Input, all: &[Sample]) -> Result<Vec<f64>, Failure> {
    let rows = all
        .iter()
        .map(|sample| sample.argument(function, input.name()));
    Ok(rows.collect::<Result<Vec<_>, Failure>>()?.concat())
}

fn is_length(answer: &Answer) -> bool {
    matches!(answer, Err(error) if matches!(error.error, Error::Length { .. }) && error.sample == 0)
}

/// Whether two errors are equal except for rounding of a condition.
pub(super) fn is_same_error(one: &SampleError, other: &SampleError) -> bool {
    let error = match (one.error, other.error) {
        (Error::OutOfReach { leg }, Error::OutOfReach { leg: other })
        | (Error::SingularLeg { leg, .. }, Error::SingularLeg { leg: other, .. }) => leg == other,
        (Error::NotClosed { leg, .. }, Error::NotClosed { leg: other, .. }) => leg == other,
        (Error::SingularCoordinates { .. }, Error::SingularCoordinates { .. })
        | (Error::SingularPlatform { .. }, Error::SingularPlatform { .. })
        | (Error::NoConvergence { .. }, Error::NoConvergence { .. }) => true,
        (one, other) => one == other,
    };
    error && one.sample == other.sample
}

/// Largest difference, relative to the largest number.
fn difference(found: &[f64], wanted: &[f64]) -> f64 {
    assert_eq!(found.len(), wanted.len());
    // Values that are zero up to rounding, such as closure residuals, are not compared digit by
    // digit.
    let largest = wanted.iter().fold(1e-6, |m: f64, x| m.max(x.abs()));
    let differences = found
        .iter()
        .zip(wanted)
        .map(|(a, b)| (a - b).abs() / largest);
    differences.fold(0.0, f64::max)
}
