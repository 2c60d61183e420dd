//! Arrays of a file as columns of samples: vectors, and columns of matrices.

use overact::Code;
use std::sync::Arc;

use crate::{
    error::{Error, Problem},
    formats::{
        structures::Object,
        table_file::{RowReader, TableFile},
    },
    problems::{Existing, shown},
};

/// An array in a caller's memory.
#[derive(Debug, Clone, Copy)]
pub struct Array<'a> {
    /// Name; columns of a matrix are called `name(:,2)`, counted from 1.
    pub name: &'a str,
    /// Rows and columns; samples run along the longer side.
    pub shape: (usize, usize),
    /// Values in column-major order.
    pub values: &'a [f64],
}

/// A vector, or a column of a matrix.
#[derive(Debug, Clone, PartialEq)]
struct Series {
    name: String,
    values: Arc<[f64]>,
}

/// All arrays of a file, in memory.
#[derive(Debug, Clone, PartialEq)]
pub(crate) struct Arrays {
    /// The file as the caller named it.
    file: String,
    /// Names of the arrays.
    names: Vec<String>,
    series: Vec<Series>,
    /// Texts that name an array, with its name.
    labels: Vec<(String, String)>,
    /// Objects of MATLAB's classes, which cannot be read.
    pub(crate) objects: Vec<Object>,
}

impl Arrays {
    /// No arrays.
    pub(crate) const fn new(file: String) -> Self {
        Self {
            file,
            names: Vec::new(),
            series: Vec::new(),
            labels: Vec::new(),
            objects: Vec::new(),
        }
    }

    /// Adds an array of `rows` × `columns` with column-major `values`.
    ///
    /// Samples run along its longer side.
    pub(crate) fn push(&mut self, name: &str, rows: usize, columns: usize, values: &[f64]) {
        self.names.push(name.to_owned());
        let mut add = |name: String, values: Arc<[f64]>| self.series.push(Series { name, values });
        if rows <= 1 || columns <= 1 {
            add(name.to_owned(), values.into());
        } else if rows >= columns {
            for (column, values) in values.chunks_exact(rows).enumerate() {
                add(format!("{name}(:,{})", column + 1), values.into());
            }
        } else {
            for row in 0..rows {
                let values = values.iter().skip(row).step_by(rows).copied().collect();
                add(format!("{name}({},:)", row + 1), values);
            }
        }
    }

    /// Adds a text that names the array `name`.
    pub(crate) fn label(&mut self, label: &str, name: &str) {
        self.names.push(label.to_owned());
        self.labels.push((label.to_owned(), name.to_owned()));
    }

    /// Arrays that a text names.
    fn labelled(&self, label: &str) -> impl Iterator<Item = &str> {
        let labels = self.labels.iter();
        labels.filter_map(move |(own, array)| (own == label).then_some(array.as_str()))
    }

    /// The problem of an object of a MATLAB class.
    fn unreadable(&self, object: &Object) -> Problem {
        let message = format!(
            "`{}` is an object of MATLAB's class `{}`, whose content only MATLAB can read",
            shown(&object.name),
            shown(&object.class)
        );
        let problem = Problem::new(Code::LOG_FORMAT, message).file(self.file.as_str());
        problem.help(
            "save arrays or structures: let Simulink log in the format `Structure With Time`, or write `t = x.Time; q = x.Data; save('log.mat', 't', 'q', '-v7')` for a timeseries x",
        )
    }

    /// Index of a vector, of a matrix column or of a matrix row.
    fn named(&self, name: &str) -> Option<usize> {
        let bare: String = name.chars().filter(|c| !c.is_whitespace()).collect();
        // Signals of two dimensions have samples along the third one; `s(1)` is `s`.
        let bare = bare.replace(",1,:)", ",:)");
        let single = bare.replace("(1).", ".");
        // A vector is a matrix of one column.
        let vector = bare
            .strip_suffix("(:,1)")
            .or_else(|| bare.strip_suffix("(1,:)"));
        let is = |name: &str| self.series.iter().position(|series| series.name == name);
        // A caller's name may contain blanks.
        is(name)
            .or_else(|| is(&bare))
            .or_else(|| vector.and_then(is))
            .or_else(|| is(&single))
    }
}

impl TableFile for Arrays {
    fn file(&self) -> &str {
        &self.file
    }

    fn what(&self) -> &'static str {
        "a file of arrays"
    }

    fn in_memory(&self) -> bool {
        true
    }

    fn has_variables(&self) -> bool {
        true
    }

    fn columns(&self) -> usize {
        self.series.len()
    }

    /// Finds a vector, a matrix column `name(:,2)` or a matrix row `name(2,:)`.
    ///
    /// The name may be the text that names a signal, if only one signal has it.
    fn find(&self, name: &str) -> Result<Option<usize>, Problem> {
        if let Some(place) = self.named(name) {
            return Ok(Some(place));
        }
        let index = name.rfind('(').filter(|_| name.ends_with(')'));
        let (label, column) = name.split_at(index.unwrap_or(name.len()));
        for (label, column) in [(name, ""), (label.trim(), column)] {
            let arrays: Vec<&str> = self.labelled(label).collect();
            match arrays[..] {
                [] => {}
                [array] => return Ok(self.named(&format!("{array}{column}"))),
                [first, second, ..] => {
                    return Err(ambiguous(&self.file, name, label, [first, second]));
                }
            }
        }
        let outer = name.split(['.', '(', '{']).next().unwrap_or_default();
        match self.objects.iter().find(|object| object.name == outer) {
            Some(object) => Err(self.unreadable(object).column(name)),
            None => Ok(None),
        }
    }

    fn variable(&self, name: &str) -> Option<&[f64]> {
        let place = self.find(name).ok().flatten()?;
        Some(&*self.series[place].values)
    }

    fn existing(&self) -> Existing<'_> {
        Existing {
            names: self.names.iter().map(String::as_str).collect(),
            columns: self.series.len(),
            what: "variable",
        }
    }

    fn first_column(&self, name: &str) -> Option<&str> {
        let array = self.labelled(name).next().unwrap_or(name);
        let names = self.series.iter().map(|series| series.name.as_str());
        let is_column = |own: &&str| {
            let index = own
                .strip_prefix(array)
                .filter(|index| index.starts_with('('));
            index.is_some_and(|index| !index.contains('.'))
        };
        { names }.find(is_column)
    }

    fn rows<'a>(&'a self, wanted: &[(usize, &'a str)]) -> Result<Box<dyn RowReader + 'a>, Error> {
        let columns: Vec<(&[f64], &str)> = wanted
            .iter()
            .map(|&(place, name)| (&*self.series[place].values, name))
            .collect();
        let mut problems = Vec::new();
        if let Some(((first, reference), others)) = columns.split_first() {
            for (values, name) in others.iter().filter(|(own, _)| own.len() != first.len()) {
                let message = format!(
                    "`{name}` has {} samples, but `{reference}` has {}",
                    values.len(),
                    first.len()
                );
                let problem = Problem::new(Code::LOG_SHAPE, message).file(self.file.as_str());
                problems.push(problem.column(*name));
            }
        }
        Error::check(problems)?;
        Ok(Box::new(Rows {
            file: &self.file,
            columns,
            next: 0,
        }))
    }
}

/// The problem of a column `name` with the text of several signals, `label`.
pub(crate) fn ambiguous(file: &str, name: &str, label: &str, paths: [&str; 2]) -> Problem {
    let message = format!("several signals are called `{}`", shown(label));
    let problem = Problem::new(Code::SAME_COLUMN, message);
    let help = format!(
        "give the path of the signal, `{}` or `{}`",
        paths[0], paths[1]
    );
    problem.file(file).column(name).help(help)
}

/// Series that are read row by row.
#[derive(Debug)]
struct Rows<'a> {
    file: &'a str,
    columns: Vec<(&'a [f64], &'a str)>,
    next: usize,
}

impl RowReader for Rows<'_> {
    fn next(&mut self, values: &mut [f64]) -> Result<bool, Error> {
        let sample = self.next;
        self.next += 1;
        let mut problems = Vec::new();
        for ((column, name), value) in self.columns.iter().zip(values) {
            let Some(found) = column.get(sample) else {
                return Ok(false);
            };
            if !found.is_finite() {
                let message = format!("`{name}`: sample {sample} is not a finite number");
                problems.push(
                    Problem::new(Code::NOT_A_NUMBER, message)
                        .file(self.file)
                        .column(*name),
                );
            }
            *value = *found;
        }
        Error::check(problems)?;
        Ok(!self.columns.is_empty())
    }

    fn bytes(&self) -> u64 {
        0
    }
}
