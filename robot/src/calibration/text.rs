//! Text of a calibrated description, with the author's comments and order.
//!
//! A shape of legs is described once and placed several times, but calibrated legs differ. A
//! changed length therefore becomes a sum of its expression and a variable of the leg, `d = "l_ab +
//! d_2_change"`. Each placement sets the variable. Encoder offsets are `position_offset` of the
//! table `[data]`.

use super::length::{LegLength, Length};
use crate::{
    error::{Error, Problem},
    robot::Robot,
};
use overact::Model;
use overact_codegen::diagnostic::Code;
use overact_identification::{CalibratedParameter, Calibration, Time};
use std::collections::BTreeMap;
use toml_edit::{Array, ArrayOfTables, DocumentMut, Item, Table, TableLike, Value, value};

/// Digits after the first significant digit of the standard deviation.
const DIGITS_BELOW: i32 = 1;

/// Largest number of decimals.
const DECIMALS: i32 = 15;

/// Writes the changes of a calibration into a robot's description.
///
/// `length` maps a parameter index to its length.
///
/// # Errors
/// A description of another form than this function reads, which does not happen.
pub(super) fn calibrated(
    robot: &Robot,
    calibration: &Calibration,
    length: &dyn Fn(usize) -> LegLength,
) -> Result<String, Error> {
    let source = robot.source();
    let problem = |what: &str| -> Error {
        let message = format!("the calibrated description can't be written: {what}");
        Problem::new(Code::NO_RESULT_TEXT, message)
            .file(source.name.as_str())
            .into()
    };
    let parsed = source.text.parse::<DocumentMut>();
    let mut document = parsed.map_err(|error| problem(error.message()))?;
    // For each length of a shape that changes in any leg, the change in each leg.
    let mut changed: BTreeMap<(String, String), Change> = BTreeMap::new();
    for one in calibration.lengths() {
        let own = length(one.index);
        let leg = &robot.description().legs[own.leg];
        let symbol = symbol(own.length, leg);
        let entry = changed.entry((leg.shape_name.clone(), symbol));
        let change = entry.or_insert_with(|| Change {
            length: own.length,
            of_legs: BTreeMap::new(),
        });
        let text = format!("{} m", rounded(one.change, one.standard_deviation));
        change.of_legs.insert(leg.name.value.clone(), text);
    }
    for ((shape, symbol), change) in &changed {
        change
            .write(&mut document, shape, symbol)
            .ok_or_else(|| problem(&format!("the leg `{shape}` has no {symbol}")))?;
    }
    if calibration.offsets().iter().any(|offset| *offset != 0.0) {
        offsets(&mut document, robot, calibration)
            .ok_or_else(|| problem("`[data]` is not a table"))?;
    }
    Ok(heading(calibration) + &document.to_string())
}

/// Comment that lists the changes.
fn heading(calibration: &Calibration) -> String {
    let line = |one: &CalibratedParameter| {
        format!(
            "#   {} {} {}, standard deviation {:.1e} {}\n",
            one.name,
            signed(one),
            one.unit,
            one.standard_deviation,
            one.unit
        )
    };
    let lines: String = calibration.estimated.iter().map(line).collect();
    format!("# Calibrated from the closure of the loops; added to the described values:\n{lines}\n")
}

fn signed(one: &CalibratedParameter) -> String {
    let number = rounded(one.change, one.standard_deviation);
    if one.change < 0.0 {
        number
    } else {
        format!("+{number}")
    }
}

/// Number with the digits that its standard deviation justifies.
fn rounded(value: f64, deviation: f64) -> String {
    let first = -deviation.log10().floor();
    let decimals = if first.is_finite() { first as i32 } else { 0 };
    let decimals = (decimals + DIGITS_BELOW).clamp(0, DECIMALS);
    format!("{value:.*}", decimals as usize)
}

/// Prefix of the variable's name, as `d_2` or `base_x`.
fn symbol(length: Length, leg: &overact_codegen::description::Leg) -> String {
    const AXES: [&str; 3] = ["x", "y", "z"];
    let joint = |joint: usize| leg.joints[joint].name.value.as_str();
    match length {
        Length::B(at) => format!("b_{}", joint(at)),
        Length::D(at) => format!("d_{}", joint(at)),
        Length::R(at) => format!("r_{}", joint(at)),
        Length::Base(axis) => format!("base_{}", AXES[axis]),
        Length::End(axis) => format!("end_{}", AXES[axis]),
    }
}

/// Change of a length in the legs of a shape, as expressions.
struct Change {
    length: Length,
    of_legs: BTreeMap<String, String>,
}

impl Change {
    /// Writes the sum into the shape and the values into its placements.
    ///
    /// `None` if the shape is not the one that was read.
    fn write(&self, document: &mut DocumentMut, shape: &str, symbol: &str) -> Option<()> {
        let taken = names(document, shape);
        let plain = format!("{symbol}_change");
        let numbered = (2..).map(|number| format!("{plain}_{number}"));
        let mut free = std::iter::once(plain.clone()).chain(numbered);
        let variable = free.find(|name| !taken.contains(name))?;
        let leg = document
            .get_mut("leg")?
            .get_mut(shape)?
            .as_table_like_mut()?;
        leg.entry("variables")
            .or_insert(value(Array::new()))
            .as_array_mut()?
            .push(variable.as_str());
        let sum = |old: &Value| plus(old, &variable);
        match self.length {
            Length::B(at) | Length::D(at) | Length::R(at) => {
                let key = symbol.get(..1)?;
                let joint = nth(leg.get_mut("joint")?, at)?;
                let old = joint.get_mut(key)?.as_value_mut()?;
                *old = sum(old);
            }
            Length::Base(axis) => component(leg, "base", axis, &sum)?,
            Length::End(axis) => component(leg, "end", axis, &sum)?,
        }
        let places = document.get_mut("place")?;
        for at in 0..count(places) {
            let place = nth(places, at)?;
            let text = |key: &str| place.get(key)?.as_str().map(str::to_owned);
            if text("shape")? == shape {
                let own = self.of_legs.get(&text("name")?);
                place.insert(&variable, value(own.map_or("0 m", String::as_str)));
            }
        }
        Some(())
    }
}

/// Names that are not available for a variable of a shape.
fn names(document: &DocumentMut, shape: &str) -> Vec<String> {
    let constants = document.get("constants").and_then(Item::as_table_like);
    let constants = constants.into_iter().flat_map(TableLike::iter);
    let mut names: Vec<String> = constants.map(|(name, _)| name.to_owned()).collect();
    let leg = document.get("leg").and_then(|legs| legs.get(shape));
    let variables = leg.and_then(|leg| leg.get("variables")?.as_array());
    let variables = variables.into_iter().flat_map(Array::iter);
    names.extend(variables.filter_map(|one| one.as_str().map(str::to_owned)));
    names
}

/// Expression of a value plus a variable.
fn plus(old: &Value, variable: &str) -> Value {
    let written = match old {
        Value::String(text) => text.value().trim().to_owned(),
        other => other.clone().decorated("", "").to_string(),
    };
    let sum = match written.parse::<f64>() {
        Ok(0.0) => variable.to_owned(),
        _ => format!("{written} + {variable}"),
    };
    // Keep the surrounding text, such as a comment.
    let mut new = Value::from(sum);
    *new.decor_mut() = old.decor().clone();
    new
}

/// Adds to a coordinate of the point `at` of a leg's table; a missing point is created.
fn component(
    leg: &mut dyn TableLike,
    table: &str,
    axis: usize,
    sum: &dyn Fn(&Value) -> Value,
) -> Option<()> {
    let table = leg.entry(table).or_insert(Item::Table(Table::new()));
    let point = table.as_table_like_mut()?.entry("at");
    let point = point
        .or_insert(value(Array::from_iter([0, 0, 0])))
        .as_array_mut()?;
    let old = point.get_mut(axis)?;
    *old = sum(old);
    Some(())
}

/// Number of tables in a list, written inline or as an array of tables.
fn count(item: &Item) -> usize {
    let tables = item.as_array_of_tables().map(ArrayOfTables::len);
    tables
        .or_else(|| item.as_array().map(Array::len))
        .unwrap_or(0)
}

fn nth(item: &mut Item, at: usize) -> Option<&mut dyn TableLike> {
    match item {
        Item::ArrayOfTables(tables) => tables.get_mut(at).map(|table| table as &mut dyn TableLike),
        Item::Value(Value::Array(list)) => list
            .get_mut(at)?
            .as_inline_table_mut()
            .map(|table| table as &mut dyn TableLike),
        _ => None,
    }
}

/// Writes `position_offset`; without a `[data]` table, also the default columns.
fn offsets(document: &mut DocumentMut, robot: &Robot, calibration: &Calibration) -> Option<()> {
    let info = robot.model().info();
    let mapping = robot.mapping();
    let data = document.entry("data").or_insert(Item::Table(Table::new()));
    let data = data.as_table_like_mut()?;
    if data.is_empty() {
        match mapping.time {
            Time::Column(name) => data.insert("time", value(name)),
            Time::Frequency(frequency) => data.insert("sampling", value(frequency)),
        };
        data.insert("positions", value(Array::from_iter(mapping.positions)));
        data.insert("torques", value(Array::from_iter(mapping.torques)));
    }
    let before = mapping
        .position_offset
        .iter()
        .copied()
        .chain(std::iter::repeat(0.0));
    let changes = calibration.offsets();
    let smallest = calibration
        .estimated
        .iter()
        .map(|one| one.standard_deviation);
    let deviation = smallest.fold(f64::INFINITY, f64::min);
    let each = changes.iter().zip(before).zip(info.actuator_is_revolute);
    let text = each.map(|((change, before), revolute)| {
        let unit = if *revolute { "rad" } else { "m" };
        match change + before {
            0.0 => format!("0 {unit}"),
            sum => format!("{} {unit}", rounded(sum, deviation)),
        }
    });
    data.insert("position_offset", value(Array::from_iter(text)));
    Some(())
}
