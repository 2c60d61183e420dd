//! Rows of the requested columns, one object at a time.

use overact::Code;

use super::{
    names::Step,
    records::{Fault, Records},
    values::{Value, Wanted},
};
use crate::{
    error::{Error, Problem},
    formats::stored::StoredRows,
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
    /// Line of the last object.
    line: usize,
    is_broken: bool,
    /// Whether a problem with a remedy was reported.
    is_helped: bool,
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
        self.wanted.read(&record, &mut self.found).map(|()| true)
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

impl StoredRows for Rows<'_> {
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
