//! The table `[prior]`: what is believed of the parameters before data speak, and the parameters of a file
//! that an identification wrote.

use super::document::Description;
use super::experiment::{TrueParameter, parameters};
use super::inventory::Inventory;
use super::reader::{Context, Item, Table};
use super::scope::Scope;
use crate::diagnostic::{Diagnostic, Diagnostics, Source, did_you_mean};
use overact_core::StandardParameter;
use toml::de::DeTable;

/// What is believed of the parameters before data speak.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct Prior {
    /// Values by name, SI units.
    pub values: Vec<(String, f64)>,
    /// Smallest and largest value by name, SI units.
    pub bounds: Vec<(String, [f64; 2])>,
}

/// Reads `[prior]`.
pub(super) fn read(item: &Item<'_, '_>, robot: &Inventory<'_>) -> Option<Prior> {
    let table = item.table("the table `[prior]`")?;
    let values = table.get("values").map(|item| parameters(&item, robot));
    let bounds = table.get("bounds").map(|item| bounds(&item, robot));
    table.finish();
    let named = |one: TrueParameter| (one.name.value, one.value);
    Some(Prior {
        values: values.unwrap_or_default().into_iter().map(named).collect(),
        bounds: bounds.unwrap_or_default(),
    })
}

fn bounds(item: &Item<'_, '_>, robot: &Inventory<'_>) -> Vec<(String, [f64; 2])> {
    let Some(table) = item.table("the table `[prior.bounds]`") else {
        return Vec::new();
    };
    let known = robot.parameters();
    let mut all = Vec::new();
    for item in table.items() {
        let name = &item.key;
        let Some((_, _, symbol, dimension)) = known.iter().find(|(n, ..)| *n == name.value) else {
            let help = did_you_mean(&name.value, known.iter().map(|(n, ..)| n.as_str()));
            let message = format!("the robot has no parameter `{}`", name.value);
            let help = help.unwrap_or_else(|| {
                String::from("names are those of the parameters that `inspect` lists")
            });
            let error = Diagnostic::new(message, name.span.clone()).help(help);
            item.context.report(error);
            continue;
        };
        let Some(list) = item.list() else { continue };
        let numbers: Vec<Option<f64>> = list
            .iter()
            .map(|one| one.float(*dimension, robot.scope))
            .collect();
        match numbers.as_slice() {
            _ if symbol.is_inertial() && *symbol != StandardParameter::M => {
                let error = item.error(format!("`{}` can't be bounded", name.value));
                let help = "masses, friction, rotor inertias and offsets can be";
                item.context.report(error.help(help));
            }
            [Some(_), Some(high)] if *high <= 0.0 && *symbol != StandardParameter::Off => {
                let error = item.error(format!(
                    "these bounds leave no positive value of `{}`",
                    name.value
                ));
                item.context.report(error.help("it can't be negative"));
            }
            [Some(low), Some(high)] if low < high => all.push((name.value.clone(), [*low, *high])),
            [Some(_), Some(_)] => {
                let error = item
                    .error("the smaller bound comes first")
                    .help("write [smallest, largest]");
                item.context.report(error);
            }
            [_, _] => {}
            _ => {
                let message = format!("{} numbers are no bounds", numbers.len());
                item.context
                    .report(item.error(message).help("write [smallest, largest]"));
            }
        }
    }
    all
}

/// Reads a file with a table `[parameters]` of a robot's standard parameters, as an identification writes it.
///
/// # Errors
/// Everything that is wrong with it, and parameters of the robot (not those of its payload) that are missing.
pub fn parse_parameters(
    source: &Source,
    description: &Description,
) -> Result<Vec<TrueParameter>, Diagnostics> {
    let (document, syntax_errors) = DeTable::parse_recoverable(&source.text);
    if !syntax_errors.is_empty() {
        return Err(super::robot::syntax(&syntax_errors));
    }
    let context = Context::new(source);
    let table = Table::new(&context, document.get_ref(), 0..0, "the file");
    let scope = Scope::default();
    let robot = Inventory {
        platform: description.platform.as_ref(),
        legs: &description.legs,
        scope: &scope,
    };
    let item = table.require(
        "parameters",
        "a table `[parameters]` with a value for each parameter",
    );
    let found = item.map(|item| parameters(&item, &robot));
    table.finish();
    context.into_errors().into_result(found.unwrap_or_default())
}
