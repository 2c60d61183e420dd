//! JSON Lines: one object per line, each a sample. Also one list of such objects.
//!
//! Numbers in nested objects and lists are columns `a.b` and `position[0]`. Strings that are
//! numbers count as numbers, and so do booleans. The file is read record by record.
//!
//! - `records`: splits the file into objects, in bounded memory;
//! - `parse`: parses an object;
//! - `names`: columns of an object;
//! - `values`: numbers of the requested columns of an object;
//! - `rows`: rows of the requested columns, with located problems.

mod names;
mod parse;
mod records;
mod rows;
mod values;

use overact::Code;

use self::{
    names::{Column, Names},
    records::{Fault, Form, Records},
    rows::Rows,
};
use crate::{
    bytes::byte_source::ByteSource,
    error::{Error, Problem},
    formats::table_file::{RowReader, TableFile},
    problems::{Existing, only, unreadable},
};

/// Number of objects that determine the columns.
const FIRST: usize = 100;

/// A file of JSON objects and its columns.
#[derive(Debug)]
pub(crate) struct JsonLines {
    /// The file as the caller named it.
    file: String,
    medium: ByteSource,
    form: Form,
    columns: Vec<Column>,
}

impl JsonLines {
    /// Opens a file and lists the columns of its first objects.
    ///
    /// # Errors
    /// A file that cannot be read, or has no object.
    pub(crate) fn open(file: String, medium: &ByteSource) -> Result<Self, Error> {
        let input = medium.open().map_err(|error| unreadable(&file, &error))?;
        let form = Form::of(input).map_err(|fault| fault.problem(&file))?;
        let input = medium.open().map_err(|error| unreadable(&file, &error))?;
        let mut records = Records::new(input, form);
        let (mut names, mut first) = (Names::default(), None);
        for _ in 0..FIRST {
            let read = records.next();
            let added = match &read {
                Ok(None) => break,
                Ok(Some(record)) => names.add(record),
                Err(fault) => Err(fault.clone()),
            };
            let is_broken = read.is_err();
            // Defects of single lines are reported when the rows are read.
            if let Err(fault) = added {
                first = first.or(Some(fault));
            }
            if is_broken || names.is_full() {
                break;
            }
        }
        let columns = names.columns(&file)?;
        match first {
            Some(fault) if columns.is_empty() => Err(fault.problem(&file).into()),
            _ => Ok(Self {
                file,
                medium: medium.clone(),
                form,
                columns,
            }),
        }
    }
}

impl TableFile for JsonLines {
    fn file(&self) -> &str {
        &self.file
    }

    fn what(&self) -> &'static str {
        "a file of JSON"
    }

    fn is_slow(&self) -> bool {
        true
    }

    fn columns(&self) -> usize {
        self.columns.len()
    }

    fn find(&self, name: &str) -> Result<Option<usize>, Problem> {
        let names = self.columns.iter().map(|own| own.name.as_str());
        only(&self.file, name, names)
    }

    fn existing(&self) -> Existing<'_> {
        Existing {
            names: self.columns.iter().map(|own| own.name.as_str()).collect(),
            columns: self.columns.len(),
            what: "key",
        }
    }

    fn rows<'a>(&'a self, wanted: &[(usize, &'a str)]) -> Result<Box<dyn RowReader + 'a>, Error> {
        let input = self.medium.open();
        let input = input.map_err(|error| unreadable(&self.file, &error))?;
        let paths = wanted.iter().map(|&(place, name)| {
            let column = &self.columns[place];
            (column.path.as_slice(), name)
        });
        let records = Records::new(input, self.form);
        Ok(Box::new(Rows::new(&self.file, records, paths.collect())))
    }
}

/// The problem of a defect in a file.
impl Fault {
    fn problem(&self, file: &str) -> Problem {
        let problem = Problem::new(Code::LOG_FORMAT, self.what.as_str());
        let problem = problem.file(file).line(self.line);
        match self.help {
            Some(help) => problem.help(help),
            None => problem,
        }
    }
}

#[cfg(test)]
mod tests;
