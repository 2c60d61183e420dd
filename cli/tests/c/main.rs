//! Generated C, compiled by GCC and Clang with warnings as errors, compared with its programs.
//!
//! The random states include unreachable and singular ones, and inputs that are not numbers.

mod cpp;
mod driver;
mod expected;
mod extreme;
mod partition;
mod single;

use driver::{Compiler, Driver, Failure, Question, UNTOUCHED};
use expected::{Inputs, calls, output, states};
use overact::{Columns, Function};
use overact_codegen::derivation::MotionInput;
use overact_codegen::{
    Choice, Effort, Float, Request, RobotModel, Source, backends::c, compile_with,
};
use overact_robot::InterpretedRobot;
use overact_tier::{by_tier, of_many};
use std::fs;
use std::path::{Path, PathBuf};

/// Largest ratio of a difference above the tolerance to the effect of one rounding of the inputs.
///
/// It applies near singularities, and to values that are zero up to rounding. Formulas that divide
/// by small intermediate results lose up to 40 times that effect, for example a humanoid's leg far
/// from home.
const ROUNDINGS: f64 = 60.0;

/// Largest difference, relative to the largest number of an output; sines differ in their last
/// digit.
const TOLERANCE: f64 = 1e-13;

/// Robots of the default tier, with some functions if all take long to compile.
///
/// They include forward kinematics with and without a quaternion, the actuator projection, and
/// functions from each kind of input.
const DEFAULT_TIER_ROBOTS: [(&str, &[&str]); 4] = [
    (
        "dualv",
        &[
            "control",
            "idm_red_platform",
            "idm_red_actuators_base_from_joints",
            "idm_red_payload_from_actuators",
        ],
    ),
    ("emps", &[]),
    ("five_bar", &[]),
    ("hexapod", &["pose_from_actuators", "twist_from_actuators"]),
];

/// Inputs below this (m, rad and their rates) are rounded like this value, because intermediate
/// results have their own magnitude.
const SMALL: f64 = 0.1;

fn repository(path: &str) -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("..").join(path)
}

fn model(
    path: &Path,
    effort: Effort,
    functions: &[&str],
    float: Float,
) -> Result<RobotModel, Failure> {
    let name = path.file_name().unwrap_or_default().to_string_lossy();
    let source = Source::new(name, fs::read_to_string(path)?);
    let choice = Choice::new(functions.iter().copied()).ok();
    let request = Request {
        functions: choice.as_ref(),
        float,
        ..Request::with_effort(effort)
    };
    let compiled = compile_with(&source, &request);
    Ok(compiled
        .map_err(|errors| errors.render_plain(&source))?
        .model)
}

/// Separate folder for compiled files.
fn folder(name: &str) -> PathBuf {
    Path::new(env!("CARGO_TARGET_TMPDIR")).join("c").join(name)
}

/// Results of a robot.
struct ComparisonCounts {
    /// Largest relative difference, and its function.
    worst: (f64, String),
    /// Number of compared outputs.
    values: usize,
    /// Number of differences above the tolerance that a rounding of the inputs explains, the
    /// largest ratio of both, and its function.
    sensitive: (usize, f64, String),
    /// Texts of the errors that both gave.
    errors: Vec<String>,
}

/// Compares all functions of a robot, with some compilers.
fn compare(
    name: &str,
    model: RobotModel,
    count: usize,
    compilers: Vec<Compiler>,
) -> Result<Option<ComparisonCounts>, Failure> {
    let files = c::files(&model, &format!("{name}.toml"));
    let robot = InterpretedRobot::new(model);
    let near = states(&robot, count, 11);
    let mut all = near.clone();
    all.extend(near.iter().map(|state| far(&robot, state)));
    let mut calls = calls(robot.model());
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
    let functions = calls.len();
    let partitions = has_partitions(robot.model()).then(|| {
        calls.push((partition::call(&robot), Vec::new()));
        calls.len() - 1
    });
    let mut counts = None;
    for compiler in compilers {
        let own: Vec<_> = calls.iter().map(|(call, _)| call.clone()).collect();
        let driver = Driver::build(
            compiler,
            &folder(name).join(compiler.0),
            &files,
            own,
            Float::F64,
        )?;
        let texts = driver.texts()?;
        let mut new = ComparisonCounts {
            worst: (0.0, String::new()),
            values: 0,
            sensitive: (0, 0.0, String::new()),
            errors: Vec::new(),
        };
        let answers = driver.answers(&questions)?;
        let questions = questions.iter().zip(&wanted).enumerate();
        for ((at, (question, wanted)), (error, found)) in questions.zip(answers) {
            let function = &calls[question.call].0.name;
            let text = texts.get(error).ok_or("an error without a text")?;
            match wanted {
                Ok(wanted) => {
                    assert_eq!(error, 0, "{name}: {function}: {text}");
                    new.values += 1;
                    let difference = difference(&found, wanted);
                    if difference > TOLERANCE {
                        let state = &all[at / functions];
                        let change = change(&robot, question.call, state, wanted, f64::EPSILON);
                        new.sensitive.0 += 1;
                        if difference / change > new.sensitive.1 {
                            (new.sensitive.1, new.sensitive.2) =
                                (difference / change, function.clone());
                        }
                    } else if difference > new.worst.0 {
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
        let (count, ratio, of) = &new.sensitive;
        println!(
            "{name}, {}: {count} outputs differ by up to {ratio:.1} roundings of the inputs ({of})",
            compiler.0
        );
        assert!(*ratio < ROUNDINGS, "{name}: {of}: {ratio:.1e} roundings");
        assert!(
            *count < new.values / 20,
            "{name}: {count} of {} are sensitive",
            new.values
        );
        if let Some(index) = partitions {
            let (worst, values) = partition::compare(&robot, &driver, index, &near)?;
            println!(
                "{name}, {}: {worst:.1e} times the condition number of {values} partitions",
                compiler.0
            );
            assert!(
                worst < TOLERANCE && values > 0,
                "{name}: {worst:.1e} of partitions"
            );
        }
        let extremes = extreme::extremes(&near, 308.0);
        let arguments: Vec<Vec<String>> = calls.iter().map(|(_, names)| names.clone()).collect();
        let arguments = &arguments[..functions];
        extreme::check(
            &robot,
            &driver,
            arguments,
            &extremes,
            extreme::Errors::Compared,
        )?;
        counts = Some(new);
    }
    Ok(counts)
}

/// Effect of a rounding of the inputs on a function's output, relative to its largest number.
fn change(
    robot: &InterpretedRobot,
    call: usize,
    state: &Inputs,
    wanted: &[f64],
    rounding: f64,
) -> f64 {
    let mut largest = f64::MIN_POSITIVE;
    for turn in 0..8_usize {
        let mut rounded = state.clone();
        for (at, number) in rounded.values_mut().flatten().enumerate() {
            // Up or down, in another pattern each time.
            let up = (at * (2 * turn + 1) + turn) % 3 == 0;
            let by = rounding * number.abs().max(SMALL);
            *number += if up { by } else { -by };
        }
        if let Ok(output) = output(robot, call, &rounded) {
            largest = largest.max(difference(&output, wanted));
        }
    }
    largest
}

/// Whether the C has partitions for the actuator projection.
fn has_partitions(model: &RobotModel) -> bool {
    let regressor = model.function(
        Function::IdmRedPlatform(Columns::Standard),
        MotionInput::Pose,
    );
    model.mechanism.actuator_count() > model.mechanism.dof() && regressor.is_some()
}

/// The state far from home, where most poses are unreachable.
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
    // `f64::max` would ignore NaN.
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

/// Names of all descriptions of `robots/`.
fn stems() -> Result<Vec<String>, Failure> {
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
    Ok(stems)
}

/// Robots of the tier with the functions to compare; none means all.
fn robots() -> Result<Vec<(String, &'static [&'static str])>, Failure> {
    let all: &[&str] = &[];
    let few =
        DEFAULT_TIER_ROBOTS.map(|(stem, functions)| (stem.to_owned(), by_tier([functions, all])));
    let others = of_many(stems()?).into_iter();
    let others = others.filter(|stem| DEFAULT_TIER_ROBOTS.iter().all(|(few, _)| few != stem));
    let others = others.map(|stem| (stem, all));
    Ok(few.into_iter().chain(others).collect())
}

#[test]
fn c_agrees_with_the_interpreter_for_library_robots() -> Result<(), Failure> {
    for (index, (stem, functions)) in robots()?.into_iter().enumerate() {
        // Both compilers for some robots, one without optimisation for each of the others.
        let mut compilers = Compiler::all();
        if DEFAULT_TIER_ROBOTS.iter().all(|(few, _)| *few != stem) && !compilers.is_empty() {
            compilers = vec![compilers.swap_remove(index % compilers.len()).unoptimised()];
        }
        let path = repository(&format!("robots/{stem}.toml"));
        let model = model(&path, Effort::None, functions, Float::F64)?;
        let counts = compare(&stem, model, by_tier([20, 100]), compilers)?;
        assert!(counts.is_none_or(|counts| counts.values > 0));
    }
    Ok(())
}

/// Springs and known torques of passive joints take arc tangents.
#[test]
fn c_agrees_for_springs_on_passive_joints() -> Result<(), Failure> {
    let path = repository("tests/compiled/friction/spring_bar.toml");
    let model = model(&path, Effort::Quick, &[], Float::F64)?;
    let counts = compare("spring_bar", model, by_tier([20, 100]), Compiler::all())?;
    assert!(counts.is_none_or(|counts| counts.values > 0));
    Ok(())
}

/// Motors of several joints, more than degrees of freedom.
#[test]
fn c_agrees_for_coupled_motors() -> Result<(), Failure> {
    let path = repository("tests/compiled/friction/motor_bar.toml");
    let model = model(&path, Effort::Quick, &[], Float::F64)?;
    let counts = compare("motor_bar", model, by_tier([20, 100]), Compiler::all())?;
    assert!(counts.is_none_or(|counts| counts.values > 0));
    Ok(())
}

/// Functions of frames and of all masses, of robots of several kinds.
#[test]
fn c_agrees_for_frame_functions() -> Result<(), Failure> {
    const FUNCTIONS: [&str; 15] = [
        "tool_pose",
        "tool_jacobian",
        "tool_velocity",
        "tool_acceleration_bias",
        "tool_torques",
        "link_pose",
        "link_jacobian",
        "link_velocity",
        "link_acceleration_bias",
        "link_torques",
        "total_mass",
        "centre_of_mass",
        "centre_of_mass_jacobian",
        "kinetic_energy",
        "potential_energy",
    ];
    for stem in ["ankle", "delta", "dualv", "hexapod", "rx90"] {
        let robot = fs::read_to_string(repository(&format!("robots/{stem}.toml")))?;
        let frames = fs::read_to_string(repository(&format!("tests/compiled/framed/{stem}.toml")))?;
        let name = format!("framed_{stem}");
        let path = folder(&name).join("description.toml");
        fs::create_dir_all(folder(&name))?;
        fs::write(&path, format!("{robot}\n{frames}"))?;
        for float in [Float::F64, Float::F32] {
            let model = model(&path, Effort::None, &FUNCTIONS, float)?;
            match float {
                Float::F64 => {
                    let counts = compare(&name, model, by_tier([20, 100]), Compiler::all())?;
                    assert!(counts.is_none_or(|counts| counts.values > 0));
                }
                Float::F32 => {
                    let path = path.to_string_lossy();
                    single::compare(&name, &FUNCTIONS, &path, by_tier([20, 100]))?;
                }
            }
        }
    }
    Ok(())
}

/// Derivatives of the dynamics of a tree and of a redundant robot.
#[test]
fn c_agrees_for_dynamics_derivatives() -> Result<(), Failure> {
    const FUNCTIONS: [&str; 4] = [
        "inverse_dynamics_by_displacement",
        "inverse_dynamics_by_twist",
        "forward_dynamics_by_displacement",
        "forward_dynamics_by_twist",
    ];
    for stem in by_tier([&["dualv"][..], &["dualv", "ankle", "rx90"]]) {
        let path = repository(&format!("robots/{stem}.toml"));
        let name = format!("derived_{stem}");
        let model = model(&path, Effort::None, &FUNCTIONS, Float::F64)?;
        let counts = compare(&name, model, by_tier([20, 100]), Compiler::all())?;
        assert!(counts.is_none_or(|counts| counts.values > 0));
        let path = path.to_string_lossy();
        single::compare(&name, &FUNCTIONS, &path, by_tier([20, 100]))?;
    }
    Ok(())
}

/// No robot of the library needs Newton's method for its joints.
#[test]
fn c_agrees_for_joints_solved_by_newtons_method() -> Result<(), Failure> {
    let names = by_tier([&["newton_point"][..], &["newton_point", "newton_spatial"]]);
    for name in names {
        let path = repository(&format!("cli/tests/c/{name}.toml"));
        let model = model(&path, Effort::None, &[], Float::F64)?;
        let counts = compare(name, model, by_tier([20, 100]), Compiler::all())?;
        if let Some(counts) = counts {
            assert!(!counts.errors.is_empty());
        }
    }
    Ok(())
}
