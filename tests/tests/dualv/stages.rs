//! Snapshots of each stage of the generator for the DualV.
//!
//! The cost table pins the operation counts of all functions.

use overact::{Columns, Function};
use overact_codegen::backends::rust;
use overact_codegen::derivation::MotionInput;
use overact_codegen::description::{self, Description};
use overact_codegen::internals::{Arena, Derived, derive, random_states};
use overact_codegen::lowering::{Operand, Operation, Program};
use overact_codegen::mechanism::Mechanism;
use overact_codegen::{CompiledFunction, Effort, Request, RobotModel, compile_with};
use overact_tests::support::backend::evaluate;
use overact_tests::support::{Failure, dualv};
use overact_tier::is_full;
use std::fmt::Write;

/// Model with some functions only, searched as in the checked-in module.
fn searched(
    is_wanted: impl Fn(Function, MotionInput) -> bool + Sync,
) -> Result<RobotModel, Failure> {
    let source = overact_tests::support::description("dualv")?;
    let request = Request {
        wanted: &|_, function, from| is_wanted(function, from),
        ..Request::with_effort(Effort::Thorough)
    };
    let compiled = compile_with(&source, &request).map_err(|e| e.render_plain(&source))?;
    Ok(compiled.model)
}

/// The regressor from joint angles.
fn regressor(model: &RobotModel) -> Result<&CompiledFunction, Failure> {
    let function = Function::IdmRedPlatform(Columns::Standard);
    let found = model.function(function, MotionInput::Joints);
    found.ok_or_else(|| "no regressor".into())
}

#[test]
fn dualv_description_matches_its_snapshot() -> Result<(), Failure> {
    let source = overact_tests::support::description("dualv")?;
    let parsed = description::parse(&source).map_err(|e| e.render_plain(&source))?;
    insta::assert_snapshot!(described(&parsed)?);
    Ok(())
}

fn described(robot: &Description) -> Result<String, Failure> {
    let mut text = format!("{}: {}\n", robot.type_name(), robot.summary);
    writeln!(text, "gravity {:?}", robot.gravity.map(|g| g.value()))?;
    if let Some(platform) = &robot.platform {
        writeln!(text, "platform {:?}", platform.motion.value)?;
        writeln!(text, "  parameters {:?}", platform.parameters)?;
        writeln!(text, "  payload {:?}", platform.payload)?;
    }
    for leg in &robot.legs {
        writeln!(
            text,
            "{} of shape {} ({})",
            leg.name.value, leg.shape, leg.shape_name
        )?;
        for joint in &leg.joints {
            write!(text, "  {} {:?}", joint.name.value, joint.kind.value)?;
            write!(text, " home {:.4}", joint.home.value())?;
            writeln!(text, " {:?}", joint.parameters)?;
        }
    }
    let kept = &robot.identification.kept_actuators;
    writeln!(text, "kept {kept:?}")?;
    let runs = robot.experiment.as_ref().map_or(0, |e| e.runs.len());
    writeln!(text, "{runs} runs of a virtual experiment")?;
    Ok(text)
}

#[test]
fn dualv_mechanism_matches_its_snapshot() -> Result<(), Failure> {
    insta::assert_snapshot!(legs(&dualv()?.mechanism)?);
    Ok(())
}

fn legs(mechanism: &Mechanism) -> Result<String, Failure> {
    let mut text = format!("home pose {:?}\n", mechanism.home.pose);
    writeln!(text, "actuators {:?}", mechanism.actuator_names())?;
    for (k, leg) in mechanism.legs.iter().enumerate() {
        writeln!(text, "{}", leg.name)?;
        for joint in &leg.joints {
            let numbers = [
                ("gamma", joint.gamma.value()),
                ("b", joint.b.value()),
                ("alpha", joint.alpha.value()),
                ("d", joint.d.value()),
                ("theta", joint.theta.value()),
                ("r", joint.r.value()),
            ];
            write!(text, "  {} {:?}", joint.name, joint.kind)?;
            for (name, value) in numbers.iter().filter(|(_, value)| *value != 0.0) {
                write!(text, " {name} {value:.6}")?;
            }
            writeln!(text, "{}", if joint.actuated { " actuated" } else { "" })?;
        }
        let home = &mechanism.home.joints[mechanism.leg_range(k)];
        writeln!(text, "  home {home:.9?}")?;
    }
    Ok(text)
}

#[test]
fn derived_dualv_expressions_match_their_snapshot() -> Result<(), Failure> {
    let model = dualv()?;
    let derived_text = |wanted: Function, selected: &dyn Fn(usize, usize) -> bool| {
        let arena = Arena::new();
        let (mechanism, selection) = (&model.mechanism, &model.selection);
        let derived = derive(&arena, mechanism, selection, wanted, MotionInput::Joints)
            .map_err(|e| format!("{e:?}"))?;
        Ok::<String, Failure>(printed(&derived, selected))
    };
    let jacobian = derived_text(Function::InverseJacobian, &|_, _| true)?;
    let regressor = Function::IdmRedPlatform(Columns::Standard);
    let column = model
        .columns_of(regressor)
        .iter()
        .position(|p| model.parameter_name(*p) == "my_2_leg1");
    let my = derived_text(regressor, &|_, c| Some(c) == column)?;
    insta::assert_snapshot!(format!("J_p^inv\n{jacobian}\ncolumn my_2_leg1\n{my}"));
    Ok(())
}

fn printed(derived: &Derived<'_>, selected: &dyn Fn(usize, usize) -> bool) -> String {
    let columns = derived.shape.1;
    let entries = derived.entries.iter().enumerate();
    entries
        .filter(|(at, _)| selected(at / columns, at % columns))
        .map(|(at, e)| format!("[{}, {}] {e}\n", at / columns, at % columns))
        .collect()
}

#[test]
fn lowered_inverse_jacobian_matches_its_snapshot() -> Result<(), Failure> {
    let is_wanted =
        |function, from| function == Function::InverseJacobian && from == MotionInput::Joints;
    let model = searched(is_wanted)?;
    insta::assert_snapshot!(listing(&model.functions[0].program)?);
    Ok(())
}

/// A program, one step per line.
fn listing(program: &Program) -> Result<String, Failure> {
    let mut text = String::new();
    for input in &program.inputs {
        writeln!(text, "input {} {:?}", input.name, input.shape)?;
    }
    let of = |operand: &Operand| match *operand {
        Operand::Constant(value) => format!("{value:?}"),
        Operand::Input { array, index } => format!("{}[{index}]", program.inputs[array].name),
        Operand::Step(at) => format!("${at}"),
    };
    for (at, step) in program.steps.iter().enumerate() {
        let operands: Vec<String> = step.operation.operands().iter().map(of).collect();
        let name = step.name.as_deref().unwrap_or_default();
        let line = format!(
            "${at} = {} {} {name}",
            operation(&step.operation),
            operands.join(" ")
        );
        writeln!(text, "{}", line.trim_end())?;
    }
    for guard in &program.guards {
        writeln!(text, "guard {} {:?}", of(&guard.operand), guard.condition)?;
    }
    writeln!(
        text,
        "output {} {:?}",
        program.output.name, program.output.shape
    )?;
    for entry in &program.entries {
        let sign = if entry.negative { "-" } else { "" };
        writeln!(text, "  {sign}{}", of(&entry.operand))?;
    }
    Ok(text)
}

const fn operation(operation: &Operation) -> &'static str {
    match operation {
        Operation::Add(..) => "add",
        Operation::Sub(..) => "sub",
        Operation::Mul(..) => "mul",
        Operation::Div(..) => "div",
        Operation::Neg(_) => "neg",
        Operation::Sqrt(_) => "sqrt",
        Operation::Sine(_) => "sin",
        Operation::Cosine(_) => "cos",
        Operation::Sign(_) => "sign",
        Operation::Signed(..) => "signed",
        Operation::Atan2(..) => "atan2",
    }
}

/// Full tier, with the searched model; the default tier compares the text of the module.
#[test]
fn costs_of_all_functions_match_their_snapshot() -> Result<(), Failure> {
    if !is_full() {
        return Ok(());
    }
    let mut table = format!(
        "{:<38} {:>10} {:>5} {:>5} {:>4} {:>5} {:>5} {:>6} {:>6} {:>6} {:>5} {:>13}\n",
        "function",
        "operations",
        "add",
        "mul",
        "div",
        "sqrt",
        "trig",
        "atan2",
        "signs",
        "guards",
        "neg",
        "intermediates"
    );
    for function in &dualv()?.functions {
        let cost = function.program.cost();
        writeln!(
            table,
            "{:<38} {:>10} {:>5} {:>5} {:>4} {:>5} {:>5} {:>6} {:>6} {:>6} {:>5} {:>13}",
            function.name,
            cost.operations(),
            cost.additions,
            cost.multiplications,
            cost.divisions,
            cost.square_roots,
            cost.trigonometric_pairs,
            cost.arc_tangents,
            cost.signs,
            cost.guards,
            cost.negations,
            cost.intermediates
        )?;
    }
    insta::assert_snapshot!(table);
    Ok(())
}

/// Full tier, like the cost of all functions.
#[test]
fn the_regressor_from_joints_keeps_its_operation_counts() -> Result<(), Failure> {
    if !is_full() {
        return Ok(());
    }
    let program = &regressor(dualv()?)?.program;
    let cost = program.cost();
    assert_eq!(program.output.shape, [3, 64]);
    assert!(cost.operations() <= OPERATIONS, "{cost}");
    assert_eq!(cost.trigonometric_pairs, 9, "{cost}");
    Ok(())
}

/// Operation count of the standard regressor; it may only decrease.
const OPERATIONS: usize = 404;

#[test]
fn emitted_code_of_two_functions_matches_its_snapshot() -> Result<(), Failure> {
    let both = [Function::ProjectPlatform, Function::IdmRedPayload];
    let model = searched(|function, _| both.contains(&function))?;
    let file = rust::file(&model, "robots/dualv.toml");
    let text = |name: &str| -> Result<String, Failure> {
        let signature = format!("    pub fn {name}(");
        let at = file.find(&signature).ok_or("no such function")?;
        let lines = file[..at].lines().rev();
        let documentation = lines.take_while(|line| line.starts_with("    ///"));
        let start = at - documentation.map(|line| line.len() + 1).sum::<usize>();
        let length = file[at..].find("\n    }\n").ok_or("no end")?;
        Ok(file[start..at + length + 7].to_owned())
    };
    let names = [
        "project_platform",
        "idm_red_payload",
        "idm_red_payload_into",
    ];
    let texts = names.map(text).into_iter().collect::<Result<Vec<_>, _>>()?;
    insta::assert_snapshot!(texts.join("\n"));
    Ok(())
}

#[test]
fn regressor_values_match_their_snapshot() -> Result<(), Failure> {
    let model = dualv()?;
    let function = regressor(model)?;
    let state = &random_states(&model.mechanism, 1, 7)[0];
    let values = evaluate(&function.program, &|name| match name {
        "pose" => Some(&state.pose),
        "joints" => Some(&state.joints),
        "twist" => Some(&state.twist),
        "acceleration" => Some(&state.acceleration),
        _ => None,
    })?;
    let mut text = String::new();
    for (column, parameter) in model.columns_of(function.computes).iter().enumerate() {
        write!(text, "{:<12}", model.parameter_name(*parameter))?;
        for row in 0..3 {
            write!(text, " {:>19}", digits(values[row * 64 + column]))?;
        }
        writeln!(text)?;
    }
    insta::assert_snapshot!(text);
    Ok(())
}

/// Twelve significant digits; rounding errors become zero.
fn digits(value: f64) -> String {
    if value.abs() < 1e-14 {
        "0".to_owned()
    } else {
        format!("{value:.11e}")
    }
}

#[test]
fn dualv_base_parameters_match_their_snapshot() -> Result<(), Failure> {
    let model = dualv()?;
    let mut text = String::new();
    for base in &model.base {
        write!(text, "{}", model.base_name(base))?;
        if !base.regrouped.is_empty() {
            write!(text, " = {}", model.parameter_name(base.parameter))?;
        }
        for (parameter, coefficient) in &base.regrouped {
            let sign = if *coefficient < 0.0 { '-' } else { '+' };
            let size = coefficient.abs();
            let name = model.parameter_name(*parameter);
            write!(text, " {sign} {size:?} {name}")?;
        }
        writeln!(text)?;
    }
    insta::assert_snapshot!(text);
    Ok(())
}
