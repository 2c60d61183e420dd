//! What a mapping asks of a file: which columns are read, and how they become time, positions and torques.

use super::{
    mapping::{Gain, Mapping, Time},
    table::Table,
};
use crate::error::{Error, Problem};

/// A column that is read and its factor to SI units.
#[derive(Debug, Clone, PartialEq)]
struct Signal {
    /// Its place among the columns that are read.
    column: usize,
    scale: f64,
}

/// What is read of a file.
#[derive(Debug, Clone, PartialEq)]
pub(super) struct Signals {
    /// Columns that are read, each with the name by which it was asked for.
    columns: Vec<(usize, String)>,
    /// The time, where there is a column of it; then positions, then torques.
    signals: Vec<Signal>,
    has_time: bool,
}

impl Signals {
    /// Finds what the mapping asks for.
    ///
    /// # Errors
    /// All columns that are not there, or gains that are no numbers.
    pub(super) fn new(table: &Table, mapping: &Mapping) -> Result<Self, Error> {
        let gains = gains(table, mapping)?;
        let time = match &mapping.time {
            Time::Column(name) => Some((name, 1.0)),
            Time::Frequency(_) => None,
        };
        let positions = mapping.positions.iter().zip(&mapping.position_scale);
        let torques = mapping.torques.iter().zip(&gains);
        let all = positions.chain(torques).map(|(name, scale)| (name, *scale));
        let (mut missing, mut problems) = (Vec::new(), Vec::new());
        let (mut columns, mut signals): (Vec<(usize, String)>, Vec<Signal>) = Default::default();
        for (name, scale) in time.into_iter().chain(all) {
            match table.find(name) {
                Ok(Some(place)) => {
                    let known = columns.iter().position(|(other, _)| *other == place);
                    let column = known.unwrap_or(columns.len());
                    if known.is_none() {
                        columns.push((place, name.clone()));
                    }
                    signals.push(Signal { column, scale });
                }
                Ok(None) if missing.contains(&name.as_str()) => {}
                Ok(None) => missing.push(name.as_str()),
                Err(problem) if problems.contains(&problem) => {}
                Err(problem) => problems.push(problem),
            }
        }
        if !missing.is_empty() {
            problems.insert(0, table.missing(&missing));
        }
        Error::check(problems)?;
        Ok(Self {
            columns,
            signals,
            has_time: time.is_some(),
        })
    }

    /// The columns that are read, with their names.
    pub(super) fn columns(&self) -> Vec<(usize, &str)> {
        let columns = self.columns.iter();
        columns
            .map(|(place, name)| (*place, name.as_str()))
            .collect()
    }

    /// The time (s), if there is a column of it, and positions and torques in SI units, of the numbers in
    /// the columns that are read.
    pub(super) fn evaluate<'a>(
        &'a self,
        values: &'a [f64],
    ) -> (Option<f64>, impl Iterator<Item = f64> + 'a) {
        let (time, others) = self.signals.split_at(usize::from(self.has_time));
        let value = |signal: &Signal| values[signal.column] * signal.scale;
        (time.first().map(value), others.iter().map(value))
    }
}

/// The gains as numbers, read from the file where the mapping names them.
fn gains(table: &Table, mapping: &Mapping) -> Result<Vec<f64>, Error> {
    let mut problems = Vec::new();
    let mut gains = Vec::new();
    for gain in &mapping.torque_gain {
        match gain {
            Gain::Value(value) => gains.push(*value),
            Gain::Variable(name) => match table.variable(name) {
                Some([value]) if value.is_finite() && *value != 0.0 => gains.push(*value),
                Some(values) => problems.push(
                    Problem::new(format!(
                        "the torque gain `{name}` is not one finite number but {} numbers",
                        values.len()
                    ))
                    .file(table.file())
                    .column(name.as_str()),
                ),
                None => problems.push(table.missing_gain(name)),
            },
        }
    }
    Error::check(problems)?;
    Ok(gains)
}
