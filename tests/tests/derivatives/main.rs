//! Derivatives of inverse and forward dynamics, for all robots of `robots/`.

mod agreement;
mod compiled;
mod differences;
mod forces;
mod operation_counts;
mod refusals;

use overact_codegen::{Effort, Request, RobotModel, Source};
use overact_tests::support::conversion::reference;
use overact_tests::support::expected::Expected;
use overact_tests::support::library::{is_of_the_tier, stems, workspace};
use overact_tests::support::{Failure, description, model_with};
use overact_tier::of_many;

/// A robot and its reference.
struct Robot {
    stem: String,
    model: RobotModel,
    expected: Expected,
}

impl Robot {
    /// A robot of the library.
    fn new(stem: &str) -> Result<Self, Failure> {
        Self::of(stem, &description(stem)?)
    }

    /// A robot of a description.
    fn of(stem: &str, source: &Source) -> Result<Self, Failure> {
        let request = Request {
            wanted: &|_, function, _| function.is_derivative() || function.parameters().is_some(),
            ..Request::with_effort(Effort::None)
        };
        let model = model_with(source, &request)?;
        let mechanism = reference(&model.mechanism, workspace(&model));
        Ok(Self {
            stem: stem.to_owned(),
            expected: Expected::by_position(&model, mechanism),
            model,
        })
    }
}

/// Calls `check` with each robot of the tier whose index has this remainder, so that tests share the
/// work.
fn each(part: usize, check: fn(&Robot) -> Result<(), Failure>) -> Result<(), Failure> {
    let mut failures = Vec::new();
    let stems = stems()?;
    let many = of_many(stems.clone());
    let own = stems.iter().enumerate();
    for (_, stem) in own.filter(|(at, _)| at % PARTS == part) {
        if !is_of_the_tier(stem) || !(ROBOTS.contains(&stem.as_str()) || many.contains(stem)) {
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

/// Robots of the default tier: trees, parallel and redundant robots, chains, parasitic motion.
const ROBOTS: [&str; 7] = [
    "ankle",
    "dualv",
    "emps",
    "five_bar",
    "rx90",
    "spatial_3prs",
    "three_leg_point",
];

/// Number of tests that share the robots.
const PARTS: usize = 4;

/// Defines tests of all robots.
macro_rules! all_robots {
    ($check:path) => {
        #[test]
        fn derivatives_agree_for_the_first_quarter_of_robots() -> Result<(), Failure> {
            each(0, $check)
        }

        #[test]
        fn derivatives_agree_for_the_second_quarter_of_robots() -> Result<(), Failure> {
            each(1, $check)
        }

        #[test]
        fn derivatives_agree_for_the_third_quarter_of_robots() -> Result<(), Failure> {
            each(2, $check)
        }

        #[test]
        fn derivatives_agree_for_the_fourth_quarter_of_robots() -> Result<(), Failure> {
            each(3, $check)
        }
    };
}
use all_robots;
