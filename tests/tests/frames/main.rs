//! Functions of frames, of the centre of mass and of energies, for all robots of `robots/`.
//!
//! Each robot gets frames on its platform, on bodies of a leg, and on the last body of another leg.

mod agreement;
mod compiled;
mod differences;
mod operation_counts;
mod refusals;

use overact::Function;
use overact_codegen::{Effort, Request, RobotModel, Source, description::parse};
use overact_tests::support::conversion::reference;
use overact_tests::support::expected::Expected;
use overact_tests::support::library::{is_of_the_tier, stems, workspace};
use overact_tests::support::{Failure, description, model_with};

/// A robot with frames, and its reference.
struct Robot {
    stem: String,
    model: RobotModel,
    expected: Expected,
}

impl Robot {
    /// A robot of the library with frames on several bodies.
    fn new(stem: &str) -> Result<Self, Failure> {
        let source = with_frames(stem)?;
        let request = Request {
            wanted: &|_, function, _| is_tested(function),
            ..Request::with_effort(Effort::None)
        };
        let model = model_with(&source, &request)?;
        let mechanism = reference(&model.mechanism, workspace(&model));
        Ok(Self {
            stem: stem.to_owned(),
            expected: Expected::by_position(&model, mechanism),
            model,
        })
    }
}

/// Whether a function is one of a frame or of all bodies.
fn is_tested(function: Function) -> bool {
    let is_of_masses = function.is_on_request() && !function.is_derivative();
    is_of_masses || matches!(function, Function::Frame(_))
}

/// A description of the library with frames on several bodies.
fn with_frames(stem: &str) -> Result<Source, Failure> {
    let Source { name, mut text } = description(stem)?;
    let described = parse(&Source::new(name.as_str(), text.as_str()));
    let described = described.map_err(|errors| format!("{stem}: {errors:?}"))?;
    let place = "at = [0.11, -0.07, \"0.23 m\"]\nrotation = [0.3, \"-50 deg\", 1.1]\n";
    text += &format!("\n[frame.tool]\n{place}");
    let is_single = described.platform.is_none() && described.legs.len() == 1;
    let (first, last) = (described.legs.first(), described.legs.last());
    let ends = first.into_iter().chain(last);
    // A cable is no body.
    for (number, leg) in ends.filter(|leg| leg.cable.is_none()).enumerate() {
        let bodies: Vec<_> = leg
            .joints
            .iter()
            .filter(|joint| joint.motor.is_none())
            .collect();
        let places = [bodies.len() / 3, bodies.len() * 2 / 3, bodies.len() - 1];
        for (which, at) in places.into_iter().enumerate() {
            let joint = &bodies[at].name.value;
            let body = if is_single {
                joint.clone()
            } else {
                format!("{}.{joint}", leg.name.value)
            };
            text += &format!("[frame.f{number}{which}]\nbody = \"{body}\"\n{place}");
        }
    }
    Ok(Source::new(name, text))
}

/// Calls `check` with each robot of the tier whose index has this remainder, so that tests share the
/// work.
fn each(part: usize, check: fn(&Robot) -> Result<(), Failure>) -> Result<(), Failure> {
    let mut failures = Vec::new();
    let stems = stems()?;
    let own = stems.iter().enumerate();
    for (_, stem) in own.filter(|(at, _)| at % PARTS == part) {
        if !is_of_the_tier(stem) {
            continue;
        }
        let done = Robot::new(stem).and_then(|robot| check(&robot));
        failures.extend(done.err().map(|error| format!("{stem}: {error}")));
    }
    if failures.is_empty() {
        return Ok(());
    }
    Err(failures.join("\n").into())
}

/// Number of tests that share the robots.
const PARTS: usize = 4;

/// Defines tests of all robots.
macro_rules! all_robots {
    ($check:path) => {
        #[test]
        fn frames_agree_for_the_first_quarter_of_robots() -> Result<(), Failure> {
            each(0, $check)
        }

        #[test]
        fn frames_agree_for_the_second_quarter_of_robots() -> Result<(), Failure> {
            each(1, $check)
        }

        #[test]
        fn frames_agree_for_the_third_quarter_of_robots() -> Result<(), Failure> {
            each(2, $check)
        }

        #[test]
        fn frames_agree_for_the_fourth_quarter_of_robots() -> Result<(), Failure> {
            each(3, $check)
        }
    };
}
use all_robots;
