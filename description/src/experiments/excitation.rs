//! The table `[excitation]`: limits of the search for exciting trajectories.

use crate::diagnostic::{Code, Span};
use crate::experiments::experiment;
use crate::experiments::per_actuator::{one_or_each, per_actuator};
use crate::expressions::dimension::Dimension;
use crate::robot::inventory::Inventory;
use crate::robot::model::JointKind;
use crate::toml_text::reader::Item;

/// Largest number of harmonics of a trajectory.
const HARMONICS: u64 = 30;

/// Largest number of runs in one search.
const RUNS: u64 = 20;

/// Limits and components of exciting trajectories; missing values follow from the rest of the
/// description.
#[derive(Debug, Clone, PartialEq)]
pub struct Excitation {
    /// Frequency of the first harmonic, Hz.
    pub fundamental: Option<f64>,
    /// Number of harmonics, from 1.
    pub harmonics: Option<usize>,
    /// Number of runs, from 1.
    pub runs: Option<usize>,
    /// Largest displacement of each of the r coordinates from home, m or rad; 0 fixes a coordinate.
    pub position: Option<Vec<f64>>,
    /// Largest displacement of each actuator from home, m or rad.
    pub travel: Option<Vec<f64>>,
    /// Largest speed of each actuator, m/s or rad/s.
    pub velocity: Option<Vec<f64>>,
    /// Largest acceleration of each actuator, m/s² or rad/s².
    pub acceleration: Option<Vec<f64>>,
    /// Largest condition number of J_p^inv, or of its part J_a of the kept actuators, at least 1.
    pub condition: Option<f64>,
    /// Location of the table.
    pub span: Span,
}

/// Reads the table.
pub(crate) fn read(item: &Item<'_, '_>, robot: &Inventory<'_>) -> Option<Excitation> {
    let table = item.table("the table `[excitation]`")?;
    let kinds = robot.actuator_kinds();
    let scope = robot.scope;
    let list = |key: &str, dimension: fn(JointKind) -> Dimension| {
        let item = table.get(key)?;
        let values = per_actuator(&item, &kinds, dimension, scope)?;
        moves(&item, !values.contains(&0.0)).then_some(values)
    };
    let count = |key: &str, most: u64| {
        let item = table.get(key)?;
        let value = item.integer(1)?;
        if value > most {
            let message = format!("`{key}`: expected at most {most}, found {value}");
            item.context.report(item.error(Code::OUT_OF_RANGE, message));
        }
        usize::try_from(value).ok()
    };
    let dimensions: Vec<Dimension> = robot.coordinates().into_iter().map(|c| c.1).collect();
    let position = table.get("position").and_then(|item| {
        let values = one_or_each(&item, &dimensions, "coordinate", scope)?;
        moves(&item, values.iter().any(|v| *v > 0.0)).then_some(values)
    });
    let condition = table.get("condition").and_then(|item| {
        let value = item.positive(Dimension::NONE, scope)?;
        if value < 1.0 {
            let error = item.error(
                Code::OUT_OF_RANGE,
                format!("a condition number can't be {value}"),
            );
            item.context
                .report(error.help("it is at least 1; 10 is far from singular"));
        }
        Some(value)
    });
    let excitation = Excitation {
        fundamental: table
            .get("fundamental")
            .and_then(|i| i.positive(Dimension::FREQUENCY, scope)),
        harmonics: count("harmonics", HARMONICS),
        runs: count("runs", RUNS),
        position,
        travel: list("travel", experiment::position),
        velocity: list("velocity", velocity),
        acceleration: list("acceleration", acceleration),
        condition,
        span: table.span.clone(),
    };
    table.finish();
    Some(excitation)
}

/// Reports limits that allow no motion.
fn moves(item: &Item<'_, '_>, moves: bool) -> bool {
    if !moves {
        let error = item.error(
            Code::OUT_OF_RANGE,
            format!("`{}`: a limit of 0 leaves no motion", item.key.value),
        );
        let help = "leave the key out if there is no limit";
        item.context.report(error.help(help));
    }
    moves
}

fn velocity(kind: JointKind) -> Dimension {
    match kind {
        JointKind::Prismatic => Dimension::SPEED,
        _ => Dimension::ANGULAR_SPEED,
    }
}

fn acceleration(kind: JointKind) -> Dimension {
    match kind {
        JointKind::Prismatic => Dimension::ACCELERATION,
        _ => Dimension::ANGULAR_ACCELERATION,
    }
}
