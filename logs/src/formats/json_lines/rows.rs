//! Rows of the requested columns, one object at a time.

use overact::Code;

use super::{
    names::Step,
    records::{Fault, Records},
    values::{Value, Wanted},
};
use crate::{
    error::{Error, Problem},
    formats::{
        instant::{Instant, Midnights},
        table_file::RowReader,
    },
    problems::{quoted, shown},
};

/// The remaining rows of a file.
#[derive(Debug)]
pub(super) struct Rows<'a> {
    /// The file as the caller named it.
    file: &'a str,
    records: Records,
    /// Names of the requested columns, for messages.
    names: Vec<&'a str>,
    wanted: Wanted,
    found: Vec<Value>,
    times: Times,
    /// Line of the last object.
    line: usize,
    is_broken: bool,
    /// Whether a problem with a remedy was reported.
    is_helped: bool,
}

/// Dates and times of day among the values of the objects, which become seconds.
#[derive(Debug)]
struct Times {
    /// Midnight of the first date, s since 1970.
    origin: Option<i64>,
    /// Whether each requested column has times, once its first value is known.
    has_times: Vec<Option<bool>>,
    /// Times of day of each requested column.
    midnights: Vec<Midnights>,
}

impl Times {
    fn new(columns: usize) -> Self {
        Self {
            origin: None,
            has_times: vec![None; columns],
            midnights: vec![Midnights::default(); columns],
        }
    }

    /// Replaces dates and times of day in the values of an object by seconds.
    fn replace(&mut self, values: &mut [Value]) {
        let columns = self.has_times.iter_mut().zip(&mut self.midnights);
        for (value, (has_times, midnights)) in values.iter_mut().zip(columns) {
            let instant = match value {
                Value::Text(text) => Instant::parse(text),
                _ => None,
            };
            let has_times = *has_times.get_or_insert(instant.is_some());
            let Some(instant) = instant.filter(|_| has_times) else {
                continue;
            };
            *value = Value::Number(match instant.day {
                Some(day) => instant.since(*self.origin.get_or_insert(86_400 * day)),
                None => midnights.next(instant.since(0)),
            });
        }
    }
}

impl<'a> Rows<'a> {
    /// Starts at the first object; `requested` are paths of columns with names for messages.
    pub(super) fn new(
        file: &'a str,
        records: Records,
        requested: Vec<(&'a [Step], &'a str)>,
    ) -> Self {
        let mut wanted = Wanted::default();
        for (place, (path, _)) in requested.iter().enumerate() {
            wanted.add(path, place);
        }
        Self {
            file,
            records,
            wanted,
            found: vec![Value::Missing; requested.len()],
            times: Times::new(requested.len()),
            names: requested.into_iter().map(|(_, name)| name).collect(),
            line: 0,
            is_broken: false,
            is_helped: false,
        }
    }

    /// Reads the requested values of the next object; `false` at the end.
    fn advance(&mut self) -> Result<bool, Fault> {
        let record = self.records.next().inspect_err(|_| self.is_broken = true)?;
        let Some(record) = record else {
            return Ok(false);
        };
        self.line = record.line;
        self.wanted.read(&record, &mut self.found)?;
        self.times.replace(&mut self.found);
        Ok(true)
    }

    /// The problems of the values of an object.
    fn problems(&self) -> Vec<Problem> {
        let problem = |what: String| {
            let problem = Problem::new(Code::NOT_A_NUMBER, what);
            problem.file(self.file).line(self.line)
        };
        let is_missing = |value: &Value| *value == Value::Missing;
        if self.names.len() > 1 && self.found.iter().all(is_missing) {
            let names = quoted(self.names.iter().copied());
            return vec![problem(format!("the object has none of the keys {names}"))];
        }
        let all = self.names.iter().zip(&self.found);
        let problems = all.filter_map(|(name, value)| {
            let what = match value {
                Value::Number(number) if number.is_finite() => return None,
                Value::Number(number) => format!("is {number}, not a finite number"),
                Value::Missing => String::from("is missing"),
                Value::Null => String::from("is null, not a number"),
                Value::Text(text) => format!("is the text \"{}\", not a number", shown(text)),
                Value::Inner => String::from("is an object or a list, not a number"),
                Value::Twice => String::from("is given twice in the object"),
            };
            Some(problem(format!("`{}` {what}", shown(name))).column(*name))
        });
        problems.collect()
    }
}

impl RowReader for Rows<'_> {
    fn next(&mut self, values: &mut [f64]) -> Result<bool, Error> {
        if self.names.is_empty() || self.is_broken {
            return Ok(false);
        }
        match self.advance() {
            Ok(true) => {}
            Ok(false) => return Ok(false),
            Err(fault) => return Err(fault.problem(self.file).into()),
        }
        for (value, found) in values.iter_mut().zip(&self.found) {
            if let Value::Number(number) = found {
                *value = *number;
            }
        }
        let mut problems = self.problems();
        if let Some(first) = problems.first_mut()
            && !std::mem::replace(&mut self.is_helped, true)
        {
            let help = "each object needs all columns of the run: delete this one, or cut the log before or after it";
            *first = first.clone().help(help);
        }
        Error::check(problems)?;
        Ok(true)
    }

    fn line(&self) -> Option<usize> {
        Some(self.line)
    }

    fn is_broken(&self) -> bool {
        self.is_broken
    }

    fn bytes(&self) -> u64 {
        self.records.bytes()
    }
}
