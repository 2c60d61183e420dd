//! The table `[data]`: mapping of measured logs to the robot.

use crate::diagnostic::{Code, Diagnostic, Span};
use crate::experiments::experiment::position;
use crate::experiments::{signals, transmission};
use crate::expressions::dimension::Dimension;
use crate::robot::inventory::Inventory;
use crate::robot::model::actuators;
use crate::robot::warnings;
use crate::toml_text::reader::{Item, Table};

/// Mapping of measured logs to the robot.
#[derive(Debug, Clone, PartialEq)]
pub struct Data {
    /// Time of the samples.
    pub time: Clock,
    /// Columns of the actuators' positions.
    pub positions: Vec<String>,
    /// Columns of the actuators' torques, forces or drive signals.
    pub torques: Vec<String>,
    /// Columns of the actuators' measured velocities, in units of the positions per s; empty if
    /// there are none.
    pub velocities: Vec<String>,
    /// Factors from columns to rad or m, one per actuator.
    pub position_scale: Vec<f64>,
    /// Offset of the scaled positions, subtracted, rad or m, one per actuator.
    pub position_offset: Vec<f64>,
    /// Factors from columns to N m or N, one per actuator.
    pub torque_gain: Vec<Factor>,
    /// Rate of uniform times at which the log is resampled, Hz; `None` if its time is uniform.
    pub resample: Option<f64>,
    /// Matrix T of a log in other coordinates, θ = T q, one row per column of the log, where q are
    /// the positions of the actuators.
    ///
    /// Empty if the log has the actuators' own positions and torques.
    pub transmission: Vec<Vec<f64>>,
    /// Location of the table.
    pub span: Span,
}

/// Time of a log's samples.
#[derive(Debug, Clone, PartialEq)]
pub enum Clock {
    /// Column of the time, s.
    Column(String),
    /// No column: the samples have this frequency, Hz.
    Frequency(f64),
}

/// The factor of a column.
#[derive(Debug, Clone, PartialEq)]
pub enum Factor {
    /// A number, in SI units.
    Value(f64),
    /// The name of a variable in the log.
    Variable(String),
}
/// Reads `[data]`.
pub(crate) fn data(item: &Item<'_, '_>, robot: &Inventory<'_>) -> Option<Data> {
    let table = item.table("the table `[data]`")?;
    let count = robot.actuator_count();
    let listed = |item: Item<'_, '_>| {
        let names = item.strings()?;
        check_count(&item, names.len(), count)?;
        for element in item.list()? {
            warnings::column(&element, element.value.as_str().unwrap_or_default());
        }
        Some(names.into_iter().map(|name| name.value).collect::<Vec<_>>())
    };
    let columns = |key: &str| listed(table.require(key, "give one column for each actuator")?);
    let factors = |key: &str| {
        let item = table.get(key);
        item.map_or(Some(vec![Factor::Value(1.0); count]), |item| {
            let list = if item.value.is_array() {
                item.list()?
            } else {
                vec![item.clone(); count]
            };
            check_count(&item, list.len(), count)?;
            let factors: Vec<_> = list.iter().map(|item| factor(item, robot)).collect();
            factors.into_iter().collect()
        })
    };
    let time = clock(&table, robot);
    let resample = resample(&table, robot);
    let (positions, torques) = (columns("positions"), columns("torques"));
    let velocities = table.get("velocities").map_or(Some(Vec::new()), listed);
    let (position_scale, torque_gain) = (factors("position_scale"), factors("torque_gain"));
    let position_scale = position_scale.and_then(|scales| numbers(&table, &scales));
    let position_offset = offsets(&table, robot);
    let coordinates = table.get("coordinates");
    let is_of_motors = coordinates.as_ref().and_then(|item| {
        let choice = item.choice(&[("joints", false), ("motors", true)])?;
        Some(choice.value)
    });
    let transmission = match (&coordinates, is_of_motors) {
        (Some(item), Some(false)) if !robot.motors.is_empty() => {
            transmission::from_joints(item, robot)
        }
        _ if !robot.motors.is_empty() => Some(transmission::gears(robot)),
        (Some(item), Some(true)) => transmission::matrix(item, robot),
        _ => Some(Vec::new()),
    };
    check_drums(&table, robot, torque_gain.as_deref().unwrap_or_default());
    signals::check(&table, robot, is_of_motors == Some(true));
    table.finish();
    Some(Data {
        time: time?,
        positions: positions?,
        torques: torques?,
        velocities: velocities?,
        position_scale: position_scale?,
        position_offset: position_offset?,
        torque_gain: torque_gain?,
        resample: resample?,
        transmission: transmission?,
        span: table.span.clone(),
    })
}

/// The time column, or the frequency of logs without one.
fn clock(table: &Table<'_, '_>, robot: &Inventory<'_>) -> Option<Clock> {
    let Some(sampling) = table.get("sampling") else {
        let help = "time = \"t\", the column of the time, or sampling = \"1 kHz\" if there is none";
        let column = table.require("time", help)?.string()?;
        return Some(Clock::Column(column.value));
    };
    if table.get("time").is_some() {
        let error = sampling.error(
            Code::CONTRADICTION,
            "`sampling` is for logs without a column of the time",
        );
        let help = "leave out one of `time` and `sampling`";
        table.context.report(error.help(help));
    }
    let frequency = sampling.positive(Dimension::FREQUENCY, robot.scope)?;
    Some(Clock::Frequency(frequency))
}

/// The rate of uniform times at which a log is resampled, if any.
fn resample(table: &Table<'_, '_>, robot: &Inventory<'_>) -> Option<Option<f64>> {
    let Some(item) = table.get("resample") else {
        return Some(None);
    };
    if table.get("sampling").is_some() {
        let error = item.error(
            Code::CONTRADICTION,
            "`resample` is for logs with a column of the time",
        );
        let help = "leave out `resample`: without such a column samples are uniform, and `decimation` keeps fewer";
        table.context.report(error.help(help));
    }
    Some(Some(item.positive(Dimension::FREQUENCY, robot.scope)?))
}

/// Factors as numbers: a log cannot contain the scale of positions.
fn numbers(table: &Table<'_, '_>, scales: &[Factor]) -> Option<Vec<f64>> {
    let number = |scale: &Factor| match scale {
        Factor::Value(value) => Some(*value),
        Factor::Variable(name) => {
            let message = format!("`position_scale`: `{name}` is neither a number nor a constant");
            let span = table.get("position_scale").map(|item| item.span);
            let span = span.unwrap_or(table.span.clone());
            table
                .context
                .report(Diagnostic::new(Code::SAME_NAME, message, span));
            None
        }
    };
    // All are read, so that each error is reported.
    let numbers: Vec<Option<f64>> = scales.iter().map(number).collect();
    numbers.into_iter().collect()
}

/// Offsets of the positions: one for all or a list; empty without the key.
fn offsets(table: &Table<'_, '_>, robot: &Inventory<'_>) -> Option<Vec<f64>> {
    let kinds = robot.actuator_kinds();
    let Some(item) = table.get("position_offset") else {
        return Some(vec![0.0; kinds.len()]);
    };
    let list = if item.value.is_array() {
        item.list()?
    } else {
        vec![item.clone(); kinds.len()]
    };
    check_count(&item, list.len(), kinds.len())?;
    // All are read, so that each error is reported.
    let each = list.iter().zip(kinds);
    let offsets: Vec<Option<f64>> = each
        .map(|(item, kind)| Some(item.number(position(kind), robot.scope)?.value.value()))
        .collect();
    offsets.into_iter().collect()
}

pub(crate) fn check_count(item: &Item<'_, '_>, found: usize, expected: usize) -> Option<()> {
    if found == expected {
        return Some(());
    }
    let message = format!(
        "`{}`: expected {expected} entries, one for each actuator, found {found}",
        item.key.value
    );
    item.context.report(item.error(Code::WRONG_COUNT, message));
    None
}

/// Reports gains that are variables of the log for cables with a drum, whose radius divides a number.
fn check_drums(table: &Table<'_, '_>, robot: &Inventory<'_>, gains: &[Factor]) {
    let drums = actuators(robot.legs).into_iter().map(|(leg, _)| {
        let cable = robot.legs.get(leg).and_then(|leg| leg.cable.as_ref());
        cable.is_some_and(|cable| cable.drum.is_some())
    });
    let is_wrong =
        |(gain, has_drum): (&Factor, bool)| has_drum && matches!(gain, Factor::Variable(_));
    if let (true, Some(item)) = (
        gains.iter().zip(drums).any(is_wrong),
        table.get("torque_gain"),
    ) {
        let message = "`torque_gain` of a cable with a `drum` must be a number";
        let help = "the drum's torque is divided by its radius: leave out `drum`, and let the variable be the factor to the tension";
        let error = item.error(Code::CONTRADICTION, message).help(help);
        table.context.report(error);
    }
}

/// Reads a factor: a bare identifier that is no constant is the name of a variable in the log.
///
/// The unit of a log is arbitrary, so a factor may have any dimension.
fn factor(item: &Item<'_, '_>, robot: &Inventory<'_>) -> Option<Factor> {
    if let Some(text) = item.value.as_str() {
        let text = text.trim();
        let letter = text.starts_with(|c: char| c.is_ascii_alphabetic() || c == '_');
        let word = crate::toml_text::scope::is_word(text);
        if letter && word && text != "pi" && !robot.scope.contains(text) {
            return Some(Factor::Variable(text.to_owned()));
        }
    }
    let value = item.evaluate(robot.scope)?.scalar.value();
    if value == 0.0 {
        item.context
            .report(item.error(Code::OUT_OF_RANGE, "a factor of 0 loses the signal"));
        return None;
    }
    Some(Factor::Value(value))
}
