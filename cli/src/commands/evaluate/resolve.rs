//! Resolves the function that the arguments name.

use super::Arguments;
use crate::{
    failure::{Failure, Problem},
    function_options::ColumnsOf,
    states::States,
};
use overact::Columns;
use overact_codegen::diagnostic::Code;
use overact_codegen::{
    CompiledFunction, RobotModel,
    derivation::{MotionInput, inventory, name_in_robot},
    diagnostic::did_you_mean,
};

/// Function with a name and an input form, or with the full name of a Rust function.
///
/// # Errors
/// An unknown name, or a function that does not exist in the requested form.
pub(super) fn function<'m>(
    model: &'m RobotModel,
    arguments: &Arguments,
    states: &States,
) -> Result<&'m CompiledFunction, Failure> {
    let name = arguments.function.as_str();
    let named: Vec<&CompiledFunction> = model
        .functions
        .iter()
        .filter(|f| model.function_name(f.computes) == name)
        .collect();
    if named.is_empty() {
        return by_full_name(model, name);
    }
    let columns = arguments
        .columns
        .map_or(Columns::Standard, ColumnsOf::columns);
    let is_meant = |f: &&CompiledFunction| {
        let of = f.computes.columns().or(f.computes.parameters());
        of.is_none_or(|of| of == columns)
    };
    let offered: Vec<&CompiledFunction> = named.into_iter().filter(is_meant).collect();
    if offered.is_empty() {
        let message = format!("`{name}` does not exist with {} columns", columns.name());
        return Err(Problem::new(Code::FUNCTION_VARIANT, message).into());
    }
    let from = |from: MotionInput| offered.iter().find(|f| f.from == from).copied();
    // The joints are the state of a serial robot, whatever their name in the file.
    let tree = model.is_tree().then(|| from(MotionInput::Joints)).flatten();
    if let Some(function) = tree {
        return Ok(function);
    }
    if let Some(source) = arguments.from {
        let offers: Vec<&str> = offered.iter().map(|f| f.from.name()).collect();
        let missing = || {
            let message = format!("`{name}` does not exist from {}", source.from().name());
            Problem::new(Code::FUNCTION_VARIANT, message)
                .help(format!("it exists from {}", offers.join(", ")))
                .into()
        };
        return from(source.from()).ok_or_else(missing);
    }
    let held = [
        ("actuators", MotionInput::Actuators),
        ("joints", MotionInput::Joints),
    ];
    let by_states = held
        .iter()
        .find(|(key, _)| states.hold(key))
        .map_or(MotionInput::Pose, |h| h.1);
    let order = [
        by_states,
        MotionInput::Pose,
        MotionInput::Joints,
        MotionInput::Actuators,
    ];
    // Exists because `offered` is not empty.
    order
        .into_iter()
        .find_map(from)
        .ok_or_else(|| Problem::new(Code::FUNCTION_VARIANT, "no such function").into())
}

fn by_full_name<'m>(model: &'m RobotModel, name: &str) -> Result<&'m CompiledFunction, Failure> {
    if let Some(function) = model.functions.iter().find(|f| f.name == name) {
        return Ok(function);
    }
    // The model only has the requested functions; suggest from all that exist.
    let all = inventory(&model.mechanism, &model.selection);
    let named = all.iter().map(|form| model.function_name(form.function));
    let mut names: Vec<String> = named.collect();
    names.dedup();
    let full = all
        .iter()
        .map(|form| name_in_robot(&model.mechanism, *form));
    let full: Vec<String> = full.collect();
    let known = names.iter().chain(&full).map(String::as_str);
    let help = did_you_mean(name, known);
    names.sort_unstable();
    names.dedup();
    let help = help.unwrap_or_else(|| format!("the functions are {}", names.join(", ")));
    let message = format!(
        "the robot `{}` has no function `{name}`",
        model.mechanism.name
    );
    Err(Problem::new(Code::FUNCTION_VARIANT, message)
        .help(help)
        .into())
}
