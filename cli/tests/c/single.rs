//! 32-bit C compared with 64-bit programs, at states that both can represent.

use crate::driver::{Compiler, Driver, Failure, Question};
use crate::expected::{Inputs, calls, output, states};
use crate::extreme::{Errors, check, extremes};
use crate::{change, difference, folder, model, repository, robots};
use overact_codegen::{Effort, Float, backends::c};
use overact_robot::InterpretedRobot;
use overact_tier::{by_tier, is_full};

/// Largest difference, relative to the largest number of an output: about ten roundings of 6 ·
/// 10⁻⁸.
const TOLERANCE: f64 = 1e-6;

/// Largest ratio of a difference to the effect of input roundings.
///
/// Operations round their results too, and forward kinematics ends with steps of 10⁻⁵.
const ROUNDINGS: f64 = 60.0;

/// Fraction of the outputs that may differ by more, near singularities of intermediate systems.
///
/// The largest count is 70 of 9600, for the Exechon-like head.
const LARGEST_FRACTION_BEYOND: f64 = 0.01;

/// Robots of the full tier: chains and trees, legs with and without redundancy, skeletons with
/// loops, and a platform with parasitic motion.
///
/// Others take minutes to compile.
const ROBOTS: [&str; 9] = [
    "ankle",
    "delta_4",
    "dualv",
    "dvrk_mtm",
    "emps",
    "excavator",
    "exechon",
    "five_bar",
    "four_bar",
];

/// The state rounded to 32 bits.
fn rounded(state: &Inputs) -> Inputs {
    let short = |values: &Vec<f64>| values.iter().map(|&x| f64::from(x as f32)).collect();
    state
        .iter()
        .map(|(name, values)| (*name, short(values)))
        .collect()
}

/// Compares all functions of a robot.
///
/// Reports the worst relative difference, and for those beyond the tolerance the worst ratio to
/// input roundings.
pub(crate) fn compare(
    name: &str,
    functions: &[&str],
    path: &str,
    count: usize,
) -> Result<(), Failure> {
    let effort = by_tier([Effort::None, Effort::Quick]);
    let model = model(&repository(path), effort, functions, Float::F32)?;
    let Some(compiler) = Compiler::all().into_iter().next() else {
        return Ok(());
    };
    let files = c::files(&model, path);
    let robot = InterpretedRobot::new(model);
    let states: Vec<Inputs> = states(&robot, count, 11).iter().map(rounded).collect();
    let (calls, arguments): (Vec<_>, Vec<_>) = calls(robot.model()).into_iter().unzip();
    let each = || {
        states
            .iter()
            .flat_map(|state| (0..calls.len()).map(move |call| (state, call)))
    };
    let questions = each().map(|(state, call)| Question {
        call,
        inputs: arguments[call]
            .iter()
            .flat_map(|name| state[name.as_str()].clone())
            .collect(),
    });
    let questions: Vec<Question> = questions.collect();
    let at = folder(name).join("single");
    let compiler = by_tier([compiler, compiler.unoptimised()]);
    let driver = Driver::build(compiler, &at, &files, calls.clone(), Float::F32)?;
    let texts = driver.texts()?;
    let extremes = extremes(&states, 38.0);
    check(&robot, &driver, &arguments, &extremes, Errors::Any)?;
    let (mut worst, mut sensitive, mut beyond) = ((0.0, ""), (0, 0.0, ""), 0);
    for ((state, call), (error, found)) in each().zip(driver.answers(&questions)?) {
        let function = calls[call].name.as_str();
        let Ok(wanted) = output(&robot, call, state) else {
            continue;
        };
        assert_eq!(error, 0, "{name}: {function}: {}", texts[error]);
        let difference = difference(&found, &wanted);
        if difference > TOLERANCE {
            let change = change(&robot, call, state, &wanted, f64::from(f32::EPSILON));
            sensitive.0 += 1;
            beyond += usize::from(difference / change >= ROUNDINGS);
            if difference / change > sensitive.1 {
                (sensitive.1, sensitive.2) = (difference / change, function);
            }
        } else if difference > worst.0 {
            worst = (difference, function);
        }
    }
    println!(
        "{name}, f32: {:.1e} ({}) of {} outputs; {} differ more, by up to {:.1} roundings of the inputs ({})",
        worst.0,
        worst.1,
        questions.len(),
        sensitive.0,
        sensitive.1,
        sensitive.2
    );
    assert!(
        beyond as f64 <= LARGEST_FRACTION_BEYOND * questions.len() as f64,
        "{name}: {beyond} by more than {ROUNDINGS} roundings, {}",
        sensitive.2
    );
    Ok(())
}

#[test]
fn single_precision_c_agrees_within_rounding() -> Result<(), Failure> {
    let all = robots()?.into_iter();
    for (stem, functions) in all.filter(|(stem, _)| !is_full() || ROBOTS.contains(&&**stem)) {
        compare(
            &stem,
            functions,
            &format!("robots/{stem}.toml"),
            by_tier([20, 200]),
        )?;
    }
    compare(
        "newton_point",
        &[],
        "cli/tests/c/newton_point.toml",
        by_tier([20, 100]),
    )
}
