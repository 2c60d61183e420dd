//! Generated C: compiled by GCC and Clang with every warning as an error, and compared with the programs that
//! it was written from at random states, with what is out of reach, singular or no number among them.

mod driver;
mod expected;

use driver::{Compiler, Driver, Failure, Question, UNTOUCHED};
use expected::{Inputs, calls, output, states};
use overact_codegen::{Effort, Request, RobotModel, Source, c, compile_with};
use overact_robot::InterpretedRobot;
use overact_tier::{by_tier, is_full};
use std::fs;
use std::path::{Path, PathBuf};

/// Largest difference, relative to the largest number of an output. Sines of the C library and those of the
/// evaluation differ in their last digit.
const TOLERANCE: f64 = 1e-13;

/// Robots of the default tier.
const FEW: [&str; 3] = ["dualv", "emps", "five_bar"];

fn repository(path: &str) -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("..").join(path)
}

fn model(path: &Path, effort: Effort) -> Result<RobotModel, Failure> {
    let name = path.file_name().unwrap_or_default().to_string_lossy();
    let source = Source::new(name, fs::read_to_string(path)?);
    let compiled = compile_with(&source, &Request::with_effort(effort));
    Ok(compiled
        .map_err(|errors| errors.render_plain(&source))?
        .model)
}

/// A folder of its own for what is compiled.
fn folder(name: &str) -> PathBuf {
    Path::new(env!("CARGO_TARGET_TMPDIR")).join("c").join(name)
}

/// What was seen of a robot.
struct Seen {
    /// The largest relative difference, and of which function.
    worst: (f64, String),
    /// How many outputs were compared.
    values: usize,
    /// Texts of the errors that both have.
    errors: Vec<String>,
}

/// Compares all functions of a robot, by both compilers.
fn compare(name: &str, model: RobotModel, count: usize) -> Result<Option<Seen>, Failure> {
    let files = c::files(&model, &format!("{name}.toml"));
    let robot = InterpretedRobot::new(model);
    let near = states(&robot, count, 11);
    let mut all = near.clone();
    all.extend(near.iter().map(|state| far(&robot, state)));
    let calls = calls(robot.model());
    let mut questions = Vec::new();
    let mut wanted = Vec::new();
    for state in &all {
        for (call, (_, arguments)) in calls.iter().enumerate() {
            let inputs = arguments
                .iter()
                .flat_map(|name| state[name.as_str()].clone());
            questions.push(Question {
                call,
                inputs: inputs.collect(),
            });
            wanted.push(output(&robot, call, state));
        }
    }
    let mut seen = None;
    for compiler in Compiler::all() {
        let own: Vec<_> = calls.iter().map(|(call, _)| call.clone()).collect();
        let driver = Driver::build(compiler, &folder(name).join(compiler.0), &files, own)?;
        let texts = driver.texts()?;
        let mut new = Seen {
            worst: (0.0, String::new()),
            values: 0,
            errors: Vec::new(),
        };
        let answers = driver.answers(&questions)?;
        for ((question, wanted), (error, found)) in questions.iter().zip(&wanted).zip(answers) {
            let function = &calls[question.call].0.name;
            let text = texts.get(error).ok_or("an error without a text")?;
            match wanted {
                Ok(wanted) => {
                    assert_eq!(error, 0, "{name}: {function}: {text}");
                    let difference = difference(&found, wanted);
                    new.values += 1;
                    if difference > new.worst.0 {
                        new.worst = (difference, function.clone());
                    }
                }
                Err(wanted) => {
                    let wanted = wanted.to_string();
                    assert!(
                        error != 0 && wanted.starts_with(text),
                        "{name}: {function}: {text}, not {wanted}"
                    );
                    assert!(
                        found.iter().all(|&x| x == UNTOUCHED),
                        "{name}: {function}: the output is touched"
                    );
                    new.errors.push(text.clone());
                }
            }
        }
        new.errors.sort();
        new.errors.dedup();
        println!(
            "{name}, {}: {:.1e} ({}) of {} outputs; errors: {}",
            compiler.0,
            new.worst.0,
            new.worst.1,
            new.values,
            new.errors.join(", ")
        );
        assert!(
            new.worst.0 < TOLERANCE,
            "{name}: {} differs by {:.1e}",
            new.worst.1,
            new.worst.0
        );
        seen = Some(new);
    }
    Ok(seen)
}

/// The state far from home, where most poses are out of reach.
fn far(robot: &InterpretedRobot, state: &Inputs) -> Inputs {
    let home = &robot.model().mechanism.home;
    let mut far = state.clone();
    for (name, home) in [
        ("pose", &home.pose),
        ("joints", &home.joints),
        ("start", &home.pose),
    ] {
        let moved = state[name]
            .iter()
            .zip(home)
            .map(|(x, home)| home + 4.0 * (x - home));
        far.insert(name, moved.collect());
    }
    far.insert(
        "actuators",
        state["actuators"].iter().map(|q| q + 1.0).collect(),
    );
    far
}

/// The largest difference relative to the largest number.
fn difference(found: &[f64], wanted: &[f64]) -> f64 {
    assert_eq!(found.len(), wanted.len());
    let size = wanted
        .iter()
        .fold(0.0_f64, |m, x| m.max(x.abs()))
        .max(1e-300);
    let worst = found.iter().zip(wanted).map(|(a, b)| (a - b).abs());
    // A maximum would pass over what is no number.
    worst
        .map(|d| {
            if d.is_finite() {
                d / size
            } else {
                f64::INFINITY
            }
        })
        .fold(0.0, f64::max)
}

#[test]
fn robots_of_the_library_agree() -> Result<(), Failure> {
    let mut stems = Vec::new();
    for entry in fs::read_dir(repository("robots"))? {
        let path = entry?.path();
        if path.extension().is_some_and(|e| e == "toml") {
            stems.extend(
                path.file_stem()
                    .map(|stem| stem.to_string_lossy().into_owned()),
            );
        }
    }
    stems.sort();
    stems.retain(|stem| is_full() || FEW.contains(&stem.as_str()));
    assert!(stems.len() >= FEW.len());
    for stem in stems {
        let path = repository(&format!("robots/{stem}.toml"));
        let model = model(&path, by_tier([Effort::None, Effort::Quick]))?;
        let seen = compare(&stem, model, by_tier([20, 200]))?;
        assert!(seen.is_none_or(|seen| seen.values > 0));
    }
    Ok(())
}

/// No robot of the library has joints that Newton's method finds.
#[test]
fn robots_that_iterate_agree() -> Result<(), Failure> {
    let names = by_tier([&["newton_point"][..], &["newton_point", "newton_spatial"]]);
    for name in names {
        let path = repository(&format!("cli/tests/c/{name}.toml"));
        let seen = compare(name, model(&path, Effort::None)?, by_tier([20, 100]))?;
        if let Some(seen) = seen {
            assert!(!seen.errors.is_empty());
        }
    }
    Ok(())
}
