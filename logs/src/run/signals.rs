//! Signals of a mapping: requested columns, and their conversion to time and SI units.

use crate::{
    error::{Error, Problem},
    formats::table::Table,
    mapping::{Gain, Mapping, Time, expression::Expression},
    problems::missing_columns,
    run::columns::{Columns, RequestedColumns},
    unwrapping::{Position, Rotation},
};
use overact::Code;

/// A column or an expression of columns, with the factor to SI units.
#[derive(Debug, Clone, PartialEq)]
struct Signal {
    /// Text in the mapping.
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

/// Requested columns and signals.
#[derive(Debug, Clone, PartialEq)]
pub(crate) struct Signals {
    /// For each file the requested columns, with the names of the request.
    columns: Vec<Vec<(usize, String)>>,
    /// Time in each file with a time column.
    times: Vec<Expression>,
    /// Positions, then torques, then velocities, if measured.
    signals: Vec<Signal>,
}

impl Signals {
    /// Finds the columns of the mapping in the tables of `run`, each with the number of its file.
    ///
    /// # Errors
    /// All missing columns, invalid expressions and gains that are no numbers.
    pub(crate) fn new(
        run: &str,
        tables: &[Table],
        numbers: &[usize],
        mapping: &Mapping,
    ) -> Result<Self, Error> {
        let gains = gains(run, tables, mapping)?;
        let mut columns = Columns::new(run, tables, numbers);
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
        let RequestedColumns { columns, places } = columns.finish()?;
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

    /// Tables that contain signals of the mapping, in its order.
    ///
    /// # Errors
    /// All missing columns.
    pub(crate) fn used(
        run: &str,
        tables: &[Table],
        numbers: &[usize],
        mapping: &Mapping,
    ) -> Result<Vec<usize>, Error> {
        let mut columns = Columns::new(run, tables, numbers);
        let signals = [&mapping.positions, &mapping.torques, &mapping.velocities];
        for text in signals.into_iter().flatten() {
            columns.ask(text);
        }
        let used = columns.tables();
        columns.finish().map(|_| used)
    }

    /// For each file the requested columns, with their names.
    pub(crate) fn columns(&self) -> impl Iterator<Item = Vec<(usize, &str)>> {
        self.columns.iter().map(|own| named(own))
    }

    /// Files with a time column, if several have one.
    ///
    /// Each with the index of this column among the requested ones of the file.
    pub(crate) fn clocks(&self) -> Vec<(usize, usize)> {
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

    /// Columns that may contain a wrapped angle of a rotating joint.
    pub(crate) fn rotations(&self, rotating: &[bool]) -> Vec<Rotation> {
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

    /// Positions of rotating joints that are nonlinear functions of their columns, by index.
    pub(crate) fn rotating_values(&self, rotating: &[bool]) -> Vec<Rotation> {
        let width = self.columns.iter().map(Vec::len).sum();
        let own = self.signals.iter().zip(rotating).enumerate();
        own.filter(|(_, (_, rotating))| **rotating)
            .filter_map(|(place, (signal, _))| Rotation::of_value(&signal.position(), place, width))
            .collect()
    }

    /// The first time signal.
    pub(crate) fn first_time(&self) -> Option<&Expression> {
        self.times.first()
    }

    /// Times of a row in all files with a time column, s.
    pub(crate) fn times<'a>(&'a self, columns: &'a [f64]) -> impl Iterator<Item = f64> + 'a {
        self.times.iter().map(|time| time.evaluate(columns))
    }

    /// Positions, torques and velocities in SI units, from the requested columns.
    pub(crate) fn values<'a>(&'a self, columns: &'a [f64]) -> impl Iterator<Item = f64> + 'a {
        self.signals.iter().map(|signal| signal.value(columns))
    }

    /// The first signal with an impossible value, as in the mapping, with the value.
    pub(crate) fn immeasurable(&self, columns: &[f64]) -> Option<(&str, f64)> {
        let all = self.signals.iter();
        let mut all = all.map(|signal| (signal.text.as_str(), signal.value(columns)));
        all.find(|(_, value)| !is_measurable(*value))
    }
}

/// Largest plausible value of a signal; larger than any 64-bit counter.
const LARGEST: f64 = 1e20;

/// Whether a value is finite and plausible.
pub(crate) fn is_measurable(value: f64) -> bool {
    value.abs() <= LARGEST
}

/// Borrows columns with their names.
fn named(columns: &[(usize, String)]) -> Vec<(usize, &str)> {
    let columns = columns.iter();
    columns
        .map(|(place, name)| (*place, name.as_str()))
        .collect()
}

/// Gains as numbers; named ones are read from the files.
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

/// The problem of a gain that no file contains.
fn missing_gain(run: &str, tables: &[Table], name: &str) -> Problem {
    let with_variables = tables.iter().find(|table| table.has_variables());
    match with_variables.map(|table| table.existing()) {
        Some(mut existing) => {
            existing.what = "scalar variable";
            missing_columns(run, &[name], &existing, &[])
        }
        None => Problem::new(
            Code::DATA_TABLE,
            format!(
                "the torque gain is the variable `{name}`, but {} has no variables",
                tables.first().map_or("the run", |table| table.what())
            ),
        )
        .file(run)
        .column(name)
        .help("give the gain as a number"),
    }
}
