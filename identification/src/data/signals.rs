//! What a mapping asks of the files of a run: which columns are read, and how they become time, positions,
//! torques and velocities.

use super::{
    columns::{Columns, Found, Tables},
    expression::Expression,
    mapping::{Gain, Mapping, Time},
    problems::missing_columns,
    table::Table,
    turns::{Position, Rotation},
};
use crate::error::{Error, Problem};
use overact::Code;

/// A column or an expression of columns, and the factor to SI units.
#[derive(Debug, Clone, PartialEq)]
struct Signal {
    /// As the mapping writes it.
    text: String,
    expression: Expression,
    scale: f64,
}

impl Signal {
    const fn position(&self) -> Position<'_> {
        Position {
            text: self.text.as_str(),
            expression: &self.expression,
            scale: self.scale,
        }
    }

    fn value(&self, columns: &[f64]) -> f64 {
        self.expression.evaluate(columns) * self.scale
    }
}

/// What is read of the files.
#[derive(Debug, Clone, PartialEq)]
pub(super) struct Signals {
    /// Of each file the columns that are read, with the names by which they were asked for.
    columns: Vec<Vec<(usize, String)>>,
    /// The time in each file that has a column of it.
    times: Vec<Expression>,
    /// Positions, then torques, then velocities, if there are some.
    signals: Vec<Signal>,
}

impl Signals {
    /// Finds what the mapping asks for in the files of `run`.
    ///
    /// # Errors
    /// All columns that are not there, expressions that are none, or gains that are no numbers.
    pub(super) fn new(run: &str, tables: Tables<'_>, mapping: &Mapping) -> Result<Self, Error> {
        let gains = gains(run, tables.0, mapping)?;
        let mut columns = Columns::new(run, tables);
        let mut times = match &mapping.time {
            Time::Column(name) => columns.all(name),
            Time::Frequency(_) => Vec::new(),
        };
        let positions = mapping.positions.iter().zip(&mapping.position_scale);
        let torques = mapping.torques.iter().zip(&gains);
        let velocities = mapping.velocities.iter().zip(&mapping.position_scale);
        let mut signals: Vec<Signal> = positions
            .chain(torques)
            .chain(velocities)
            .map(|(text, scale)| Signal {
                text: text.clone(),
                expression: columns.ask(text),
                scale: *scale,
            })
            .collect();
        let Found { columns, places } = columns.finish()?;
        times.iter_mut().for_each(|time| time.renumber(&places));
        for signal in &mut signals {
            signal.expression.renumber(&places);
        }
        Ok(Self {
            columns,
            times,
            signals,
        })
    }

    /// The tables that have signals of the mapping, in the order in which it names them.
    ///
    /// # Errors
    /// All columns that are not there.
    pub(super) fn used(
        run: &str,
        tables: Tables<'_>,
        mapping: &Mapping,
    ) -> Result<Vec<usize>, Error> {
        let mut columns = Columns::new(run, tables);
        let signals = [&mapping.positions, &mapping.torques, &mapping.velocities];
        for text in signals.into_iter().flatten() {
            columns.ask(text);
        }
        let used = columns.tables();
        columns.finish().map(|_| used)
    }

    /// Of each file the columns that are read, with their names.
    pub(super) fn columns(&self) -> impl Iterator<Item = Vec<(usize, &str)>> {
        self.columns.iter().map(|own| named(own))
    }

    /// The files that have a column of the time, where several do: their numbers, and the places of these columns
    /// among those that are read of the file.
    pub(super) fn clocks(&self) -> Vec<(usize, usize)> {
        let place = |time: &Expression| {
            let &Expression::Column(mut place) = time else {
                return None;
            };
            for (file, own) in self.columns.iter().enumerate() {
                if place < own.len() {
                    return Some((file, place));
                }
                place -= own.len();
            }
            None
        };
        let clocks: Vec<_> = self.times.iter().filter_map(place).collect();
        if clocks.len() > 1 { clocks } else { Vec::new() }
    }

    /// The columns that may hold a position within one turn, where these positions are of rotating joints.
    pub(super) fn rotations(&self, rotating: &[bool]) -> Vec<Rotation> {
        let names: Vec<&str> = self
            .columns
            .iter()
            .flatten()
            .map(|(_, name)| name.as_str())
            .collect();
        let of = |is_rotating: bool| -> Vec<Rotation> {
            let signals = self.signals.iter().zip(rotating);
            let own = signals.filter(|(_, rotating)| **rotating == is_rotating);
            own.flat_map(|(signal, _)| Rotation::of_columns(&signal.position(), &names))
                .collect()
        };
        let sliding = of(false);
        let mut all: Vec<Rotation> = Vec::new();
        for one in of(true) {
            let is_same = |other: &Rotation| other.column == one.column;
            if let Some(known) = all.iter_mut().find(|other| is_same(other)) {
                known.periods.extend(one.periods);
            } else if !sliding.iter().any(is_same) {
                all.push(one);
            }
        }
        all
    }

    /// The positions of rotating joints that are no linear functions of their columns, by their places.
    pub(super) fn rotating_values(&self, rotating: &[bool]) -> Vec<Rotation> {
        let width = self.columns.iter().map(Vec::len).sum();
        let own = self.signals.iter().zip(rotating).enumerate();
        own.filter(|(_, (_, rotating))| **rotating)
            .filter_map(|(place, (signal, _))| Rotation::of_value(&signal.position(), place, width))
            .collect()
    }

    /// The first of the times.
    pub(super) fn first_time(&self) -> Option<&Expression> {
        self.times.first()
    }

    /// The times of a row in all files that have one, s.
    pub(super) fn times<'a>(&'a self, columns: &'a [f64]) -> impl Iterator<Item = f64> + 'a {
        self.times.iter().map(|time| time.evaluate(columns))
    }

    /// Positions, torques and velocities in SI units, of the numbers in the columns that are read.
    pub(super) fn values<'a>(&'a self, columns: &'a [f64]) -> impl Iterator<Item = f64> + 'a {
        self.signals.iter().map(|signal| signal.value(columns))
    }

    /// The first signal that has a value that nothing measures, as the mapping writes it, with the value.
    pub(super) fn immeasurable(&self, columns: &[f64]) -> Option<(&str, f64)> {
        let all = self.signals.iter();
        let mut all = all.map(|signal| (signal.text.as_str(), signal.value(columns)));
        all.find(|(_, value)| !is_measurable(*value))
    }
}

/// The largest value of a position, velocity or torque that is taken for measured: beyond what a counter of 64 bits has.
const LARGEST: f64 = 1e20;

/// Whether a value can have been measured: a finite number that is not beyond anything.
pub(super) fn is_measurable(value: f64) -> bool {
    value.abs() <= LARGEST
}

/// Columns with their names, borrowed.
fn named(columns: &[(usize, String)]) -> Vec<(usize, &str)> {
    let columns = columns.iter();
    columns
        .map(|(place, name)| (*place, name.as_str()))
        .collect()
}

/// The gains as numbers, read from the files where the mapping names them.
fn gains(run: &str, tables: &[Table], mapping: &Mapping) -> Result<Vec<f64>, Error> {
    let mut problems = Vec::new();
    let mut gains = Vec::new();
    for gain in &mapping.torque_gain {
        let name = match gain {
            Gain::Value(value) => {
                gains.push(*value);
                continue;
            }
            Gain::Variable(name) => name,
        };
        let found = tables.iter().find_map(|table| table.variable(name));
        let problem = match found {
            Some([value]) if value.is_finite() && *value != 0.0 => {
                gains.push(*value);
                continue;
            }
            Some(values) => Problem::new(
                Code::DATA_TABLE,
                format!(
                    "the torque gain `{name}` is not one finite number but {} numbers",
                    values.len()
                ),
            )
            .file(run)
            .column(name.as_str()),
            None => missing_gain(run, tables, name),
        };
        problems.push(problem);
    }
    Error::check(problems)?;
    Ok(gains)
}

/// What is said of a gain that no file has.
fn missing_gain(run: &str, tables: &[Table], name: &str) -> Problem {
    let with_variables = tables.iter().find(|table| table.has_variables());
    match with_variables.map(Table::existing) {
        Some(mut existing) => {
            existing.what = "scalar variable";
            missing_columns(run, &[name], &existing)
        }
        None => Problem::new(
            Code::DATA_TABLE,
            format!(
                "the torque gain is the variable `{name}`, but {} has no variables",
                tables.first().map_or("the run", Table::what)
            ),
        )
        .file(run)
        .column(name)
        .help("give the gain as a number"),
    }
}
