//! The columns of all files of a run, by the names that a mapping gives them.
//!
//! A column is called by its name, by its number through all files (`$1` is the first one of the first
//! file), or by `file2.NAME`, where several files have the name.

use super::{
    expression::Expression,
    problems::{legible, missing_columns, shown},
    table::Table,
};
use crate::error::{Error, Problem};
use overact::Code;

/// Where a column is: number of the file, place in it.
type Place = (usize, usize);

/// The columns that were asked for.
pub(super) struct Found {
    /// Those of each file, with the names by which they were asked for first.
    pub(super) columns: Vec<Vec<(usize, String)>>,
    /// Of each column, in the order in which they were found, its place among those of all files one after
    /// the other.
    pub(super) places: Vec<usize>,
}

/// The tables of a run, and the file of each, counted from 1: a file may have several.
pub(super) type Tables<'a> = (&'a [Table], &'a [usize]);

/// Columns that have been asked for so far.
pub(super) struct Columns<'a> {
    /// The run as the caller named it.
    run: &'a str,
    tables: &'a [Table],
    /// The file of each table, counted from 1.
    numbers: &'a [usize],
    /// Those that were found, each with the name by which it was asked for first.
    found: Vec<(Place, String)>,
    missing: Vec<String>,
    problems: Vec<Problem>,
}

impl<'a> Columns<'a> {
    /// No column has been asked for.
    pub(super) const fn new(run: &'a str, (tables, numbers): Tables<'a>) -> Self {
        Self {
            run,
            tables,
            numbers,
            found: Vec::new(),
            missing: Vec::new(),
            problems: Vec::new(),
        }
    }

    /// What a text of the mapping stands for: a column, or an expression of columns. What is wrong is kept
    /// for [`finish`](Self::finish).
    pub(super) fn ask(&mut self, text: &str) -> Expression {
        let nothing = Expression::Number(f64::NAN);
        match self.find(text) {
            Ok(Some(place)) => return self.column(place, text),
            Ok(None) => {}
            Err(problem) => {
                self.note(problem);
                return nothing;
            }
        }
        let parsed = Expression::parse(text, &mut |name| Ok(self.named(name)));
        match parsed {
            Ok(expression) => expression,
            // A name of several words is no attempt at an expression.
            Err(_) if !text.contains(['+', '-', '*', '/', '^', '(', ')', '$', '\'']) => {
                self.is_missing(text);
                nothing
            }
            Err(why) => {
                let message = format!(
                    "`{}` is neither a column nor an expression of columns: {why}",
                    shown(text)
                );
                let problem = Problem::new(Code::LOG_COLUMNS, message)
                    .file(self.run)
                    .column(text);
                let help = "put names with blanks or signs between single quotation marks: `'motor 1' / 50`";
                self.note(problem.help(help));
                nothing
            }
        }
    }

    /// All columns of this name, each in another file.
    pub(super) fn all(&mut self, name: &str) -> Vec<Expression> {
        let tables = self.tables.iter().enumerate();
        let places: Vec<Place> = tables
            .filter_map(|(file, table)| Some((file, table.find(name).ok()??)))
            .collect();
        match places.len() {
            0 | 1 => vec![self.ask(name)],
            _ => places
                .into_iter()
                .map(|place| self.column(place, name))
                .collect(),
        }
    }

    /// What a name in an expression stands for.
    fn named(&mut self, name: &str) -> Expression {
        let mut tables = self.tables.iter();
        if let Some([value]) = tables.find_map(|table| table.variable(name)) {
            return Expression::Number(*value);
        }
        match self.find(name) {
            Ok(Some(place)) => return self.column(place, name),
            Ok(None) => self.is_missing(name),
            Err(problem) => self.note(problem),
        }
        Expression::Number(f64::NAN)
    }

    /// Where a column is.
    fn find(&self, name: &str) -> Result<Option<Place>, Problem> {
        let mut places: Vec<Place> = Vec::new();
        for (file, table) in self.tables.iter().enumerate() {
            places.extend(table.find(name)?.map(|place| (file, place)));
        }
        self.is_one(name, &places)?;
        let place = match places.first() {
            Some(place) => Some(*place),
            None => self.numbered(name)?,
        };
        if let Some((file, place)) = place {
            self.tables[file].check(place)?;
        }
        Ok(place)
    }

    /// Where a column is that is called by its number, or by that of its file.
    fn numbered(&self, name: &str) -> Result<Option<Place>, Problem> {
        if let Some(number) = name.strip_prefix('$') {
            let Some(mut left) = number.parse().ok().and_then(|k: usize| k.checked_sub(1)) else {
                return Ok(None);
            };
            for (file, table) in self.tables.iter().enumerate() {
                if left < table.columns() {
                    return Ok(Some((file, left)));
                }
                left -= table.columns();
            }
            return Ok(None);
        }
        let file = name
            .strip_prefix("file")
            .and_then(|rest| rest.split_once('.'));
        let Some((number, own)) = file else {
            return Ok(None);
        };
        let number = number.parse().ok();
        let mut places: Vec<Place> = Vec::new();
        for (table, of) in self.numbers.iter().enumerate() {
            if Some(*of) == number {
                places.extend(self.tables[table].find(own)?.map(|place| (table, place)));
            }
        }
        self.is_one(own, &places)?;
        Ok(places.first().copied())
    }

    /// Checks that a name has one place at most.
    fn is_one(&self, name: &str, places: &[Place]) -> Result<(), Problem> {
        let [first, second, ..] = *places else {
            return Ok(());
        };
        let numbers = [first, second].map(|(table, _)| self.numbers[table]);
        let (what, way, names) = if numbers[0] == numbers[1] {
            let full = |(table, _): Place| self.tables[table].full_name(name);
            ("topics of the file", "", [first, second].map(full))
        } else {
            let full = |number| format!("file{number}.{name}");
            let way = ", or by its number through all files";
            ("files", way, numbers.map(full))
        };
        let [one, other] = names.map(|full| legible(&full));
        let message = format!("several of the {what} have a column `{}`", shown(name));
        let problem = Problem::new(Code::SAME_COLUMN, message)
            .file(self.run)
            .column(name);
        Err(problem.help(format!("call it `{one}` or `{other}`{way}")))
    }

    /// The tables of which columns were found, in the order in which they were asked for.
    pub(super) fn tables(&self) -> Vec<usize> {
        let mut tables = Vec::new();
        for ((table, _), _) in &self.found {
            if !tables.contains(table) {
                tables.push(*table);
            }
        }
        tables
    }

    /// The column at a place.
    fn column(&mut self, place: Place, name: &str) -> Expression {
        let known = self.found.iter().position(|(other, _)| *other == place);
        Expression::Column(known.unwrap_or_else(|| {
            self.found.push((place, name.to_owned()));
            self.found.len() - 1
        }))
    }

    fn is_missing(&mut self, name: &str) {
        if !self.missing.iter().any(|other| other == name) {
            self.missing.push(name.to_owned());
        }
    }

    fn note(&mut self, problem: Problem) {
        if !self.problems.contains(&problem) {
            self.problems.push(problem);
        }
    }

    /// The columns that were asked for.
    ///
    /// # Errors
    /// All that was wrong.
    pub(super) fn finish(mut self) -> Result<Found, Error> {
        if !self.missing.is_empty() {
            let problem = self.missing();
            self.problems.insert(0, problem);
        }
        Error::check(self.problems)?;
        let mut columns: Vec<Vec<(usize, String)>> = vec![Vec::new(); self.tables.len()];
        let mut places = Vec::new();
        for ((file, place), name) in self.found {
            places.push((file, columns[file].len()));
            columns[file].push((place, name));
        }
        let start = |file: usize| columns[..file].iter().map(Vec::len).sum::<usize>();
        let places = places.into_iter().map(|(file, place)| start(file) + place);
        Ok(Found {
            places: places.collect(),
            columns,
        })
    }

    /// What is said of columns that are not there.
    fn missing(&self) -> Problem {
        let missing: Vec<&str> = self.missing.iter().map(String::as_str).collect();
        let files = self.tables.iter().map(Table::existing);
        let all = files.reduce(|mut all, own| {
            all.names.extend(own.names);
            all.columns += own.columns;
            all
        });
        let Some(existing) = all else {
            return Problem::new(Code::UNREADABLE_LOG, "the run has no file").file(self.run);
        };
        let problem = missing_columns(self.run, &missing, &existing);
        let mut matrices = self.tables.iter().flat_map(|table| {
            let first = |name: &&str| table.first_column(name);
            missing.iter().filter_map(first)
        });
        match matrices.next() {
            Some(first) => problem.help(format!(
                "of a matrix name the columns one by one, `{}` is the first",
                shown(first)
            )),
            None => problem,
        }
    }
}
