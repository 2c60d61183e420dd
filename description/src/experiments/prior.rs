//! The table `[prior]`: prior knowledge of the parameters.

use crate::diagnostic::{Code, Diagnostic, did_you_mean};
use crate::experiments::experiment::{TrueParameter, parameters};
use crate::experiments::held::{self, HeldName};
use crate::robot::inventory::Inventory;
use crate::toml_text::reader::Item;
use overact_core::{Effect, StandardParameter};

/// Prior knowledge of the parameters.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct Prior {
    /// Values by name, SI units.
    pub values: Vec<(String, f64)>,
    /// Smallest and largest value by name, SI units.
    pub bounds: Vec<(String, [f64; 2])>,
    /// Parameters that are held at their values, by name, SI units.
    pub held: Vec<(String, f64)>,
}

/// Reads `[prior]`.
pub(crate) fn read(item: &Item<'_, '_>, robot: &Inventory<'_>) -> Option<Prior> {
    let table = item.table("the table `[prior]`")?;
    let held = table.get("held");
    let names = held.as_ref().map(|item| held::names(item, robot));
    let names = names.unwrap_or_default();
    let values = table
        .get("values")
        .map(|item| values(&item, robot, &names))
        .unwrap_or_default();
    let bounds = table.get("bounds").map(|item| bounds(&item, robot));
    table.finish();
    let held = held.map(|item| held::values(&item, &names, &values));
    let named = |one: TrueParameter| (one.name.value, one.value);
    Some(Prior {
        values: values.into_iter().map(named).collect(),
        bounds: bounds.unwrap_or_default(),
        held: held.unwrap_or_default(),
    })
}

/// Reads `[prior.values]`; parameters that cannot be negative are checked.
///
/// Those of `held` bodies may be zero.
fn values(item: &Item<'_, '_>, robot: &Inventory<'_>, held: &[HeldName]) -> Vec<TrueParameter> {
    let all = parameters(item, robot);
    for one in &all {
        if one.value == 0.0 && held.iter().any(|own| own.parameter == one.name.value) {
            continue;
        }
        let words = match one.symbol.effect() {
            _ if !one.symbol.is_nonnegative() => continue,
            Effect::Body if one.symbol == StandardParameter::M => "a body's mass",
            Effect::Body => "a body's moment of inertia",
            Effect::Rotor => "a rotor's inertia",
            Effect::Friction { .. } => "a coefficient of friction",
            Effect::Offset | Effect::Spring => continue,
        };
        if one.value <= 0.0 {
            let message = format!("{words} must be positive, but `{}` is not", one.name.value);
            let error = Diagnostic::new(Code::KNOWN, message, one.name.span.clone());
            let help = "leave out unknown values: the closest value that the data allow is used";
            item.context.report(error.help(help));
        }
    }
    all
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
            let error = Diagnostic::new(Code::KNOWN, message, name.span.clone()).help(help);
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
                let error = item.error(Code::KNOWN, format!("`{}` can't be bounded", name.value));
                let help = "masses, friction, rotor inertias and offsets can be";
                item.context.report(error.help(help));
            }
            [Some(_), Some(high)] if *high <= 0.0 && symbol.is_nonnegative() => {
                let error = item.error(
                    Code::KNOWN,
                    format!("these bounds exclude positive values of `{}`", name.value),
                );
                item.context.report(error.help("it can't be negative"));
            }
            [Some(low), Some(high)] if low < high => all.push((name.value.clone(), [*low, *high])),
            [Some(_), Some(_)] => {
                let error = item
                    .error(Code::KNOWN, "the smaller bound must be first")
                    .help("write [smallest, largest]");
                item.context.report(error);
            }
            [_, _] => {}
            _ => {
                let message = format!("{} numbers are not bounds", numbers.len());
                item.context.report(
                    item.error(Code::KNOWN, message)
                        .help("write [smallest, largest]"),
                );
            }
        }
    }
    all
}
