//! Finds the columns of all files of a run by the names of a mapping.
//!
//! A column is named by its name, or by its number in all files: `$1` is the first one of the
//! first file. If several files have the name, it is `file2.NAME`.

use crate::{
    error::{Error, Problem, suggestion},
    formats::table::Table,
    mapping::expression::Expression,
    problems::{guesses, legible, missing_columns, no_columns, quoted, shown},
};
use overact::Code;

/// Position of a column: number of the table, index in it.
type Place = (usize, usize);

/// The requested columns.
pub(crate) struct RequestedColumns {
    /// Columns of each file, with the name of the first request.
    pub(crate) columns: Vec<Vec<(usize, String)>>,
    /// For each column in order of request, its index among the columns of all files.
    pub(crate) places: Vec<usize>,
}

/// Columns requested so far.
pub(crate) struct Columns<'a> {
    /// The run as the caller named it.
    run: &'a str,
    tables: &'a [Table],
    /// File of each table, counted from 1; a file may have several tables.
    numbers: &'a [usize],
    /// Columns found, each with the name of the first request.
    found: Vec<(Place, String)>,
    missing: Vec<String>,
    problems: Vec<Problem>,
}

impl<'a> Columns<'a> {
    /// No columns requested.
    pub(crate) const fn new(run: &'a str, tables: &'a [Table], numbers: &'a [usize]) -> Self {
        Self {
            run,
            tables,
            numbers,
            found: Vec::new(),
            missing: Vec::new(),
            problems: Vec::new(),
        }
    }

    /// Resolves a text of the mapping to a column, or an expression of columns.
    ///
    /// Errors are collected for [`finish`](Self::finish).
    pub(crate) fn ask(&mut self, text: &str) -> Expression {
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
                match self.with_unit(text) {
                    Some(problem) => self.note(problem),
                    None => self.is_missing(text),
                }
                nothing
            }
            // Names may contain parentheses, as around a unit.
            Err(_) if self.is_near(text) && self.with_quotes(text).is_none() => {
                self.is_missing(text);
                nothing
            }
            Err(why) => {
                self.note(self.broken(text, &why));
                nothing
            }
        }
    }

    /// Whether a column has a similar name that contains parentheses.
    fn is_near(&self, text: &str) -> bool {
        let mut tables = self.tables.iter();
        text.ends_with([')', ']'])
            && tables.any(|table| {
                let names = table.existing().names.into_iter();
                suggestion(text, names.filter(|name| name.contains(['(', '[']))).is_some()
            })
    }

    /// The problem of a text that is no expression.
    fn broken(&self, text: &str, why: &str) -> Problem {
        let message = format!(
            "`{}` is neither a column nor an expression of columns: {why}",
            shown(text)
        );
        let problem = Problem::new(Code::LOG_COLUMNS, message)
            .file(self.run)
            .column(text);
        let quoted = self.with_quotes(text);
        problem.help(quoted.unwrap_or_else(|| way_out(text)))
    }

    /// Help for a column in an expression whose name has blanks or signs and no quotation marks.
    fn with_quotes(&self, text: &str) -> Option<String> {
        let names = self.tables.iter().flat_map(|table| table.existing().names);
        let needs_quotes = names.filter(|name| {
            let is_plain = |sign: char| sign.is_alphanumeric() || sign == '_' || sign == '.';
            !name.chars().all(is_plain) && !name.contains('\'') && text.contains(*name)
        });
        let name = needs_quotes.max_by_key(|name| name.len())?;
        let better = text.replacen(name, &format!("'{name}'"), 1);
        Expression::parse(&better, &mut |_| Ok(Expression::Number(f64::NAN))).ok()?;
        Some(format!(
            "put its name in single quotation marks: `{}`",
            shown(&better)
        ))
    }

    /// The problem of a column name followed by a unit.
    fn with_unit(&self, text: &str) -> Option<Problem> {
        let (name, unit) = text.trim().rsplit_once(char::is_whitespace)?;
        let name = name.trim();
        self.find(name).ok().flatten()?;
        let message = format!(
            "`{}`: `{}` is followed by `{}`",
            shown(text),
            shown(name),
            shown(unit)
        );
        let help = match unit {
            "deg" | "°" | "degrees" => {
                format!("write `{name} * pi/180`, or `position_scale = \"1 deg\"` in [data]")
            }
            _ => String::from(
                "give the unit of the columns as `position_scale` or `torque_gain` in [data], or multiply: `* 0.001`",
            ),
        };
        let problem = Problem::new(Code::LOG_COLUMNS, message).file(self.run);
        Some(problem.column(text).help(help))
    }

    /// All columns of this name, each in another file.
    pub(crate) fn all(&mut self, name: &str) -> Vec<Expression> {
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

    /// Resolves a name in an expression.
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

    /// Position of a column.
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

    /// Position of a column given by its number, or with the number of its file.
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

    /// Checks that a name is unique.
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
            let way = ", or by its number in all files";
            ("files", way, numbers.map(full))
        };
        let [one, other] = names.map(|full| legible(&full));
        let message = format!("several of the {what} have a column `{}`", shown(name));
        let problem = Problem::new(Code::SAME_COLUMN, message)
            .file(self.run)
            .column(name);
        Err(problem.help(format!("call it `{one}` or `{other}`{way}")))
    }

    /// Tables of the columns found, in order of request.
    pub(crate) fn tables(&self) -> Vec<usize> {
        let mut tables = Vec::new();
        for ((table, _), _) in &self.found {
            if !tables.contains(table) {
                tables.push(*table);
            }
        }
        tables
    }

    /// The column at a position.
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

    /// The requested columns.
    ///
    /// # Errors
    /// All problems so far.
    pub(crate) fn finish(mut self) -> Result<RequestedColumns, Error> {
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
        Ok(RequestedColumns {
            places: places.collect(),
            columns,
        })
    }

    /// The problem of missing columns.
    fn missing(&self) -> Problem {
        let missing: Vec<&str> = self.missing.iter().map(String::as_str).collect();
        let problem = match self.tables {
            [] => {
                return Problem::new(Code::UNREADABLE_LOG, "the run has no file").file(self.run);
            }
            [first, others @ ..] if self.numbers.iter().all(|number| *number == 1) => {
                let parts = others.iter().map(|table| table.existing());
                let existing = parts.fold(first.existing(), |mut all, own| {
                    all.names.extend(own.names);
                    all.columns += own.columns;
                    all
                });
                missing_columns(self.run, &missing, &existing, &self.used())
            }
            _ => self.missing_in_several(&missing),
        };
        let mut matrices = self.tables.iter().flat_map(|table| {
            let first = |name: &&str| table.first_column(name);
            missing.iter().filter_map(first)
        });
        if let Some(first) = matrices.next() {
            return problem.help(format!(
                "name the columns of a matrix one by one, `{}` is the first",
                shown(first)
            ));
        }
        let help = self
            .missing_file(&missing)
            .or_else(|| self.without_names(&missing))
            .or_else(|| self.one_column());
        match help {
            Some(help) => problem.help(help),
            None => problem,
        }
    }

    /// Names of the columns that were found.
    fn used(&self) -> Vec<&str> {
        let names = self.found.iter();
        names.map(|(_, name)| name.as_str()).collect()
    }

    /// The problem of columns missing in several files; lists the existing ones with their file.
    fn missing_in_several(&self, missing: &[&str]) -> Problem {
        let (mut bare, mut full, mut columns) = (Vec::new(), Vec::new(), 0);
        for (table, number) in self.tables.iter().zip(self.numbers) {
            let own = table.existing();
            columns += own.columns;
            bare.extend(own.names.iter().copied());
            let names = own.names.iter();
            full.extend(names.map(|name| format!("file{number}.{name}")));
        }
        let full: Vec<&str> = full.iter().map(String::as_str).collect();
        let all: Vec<&str> = full.iter().chain(&bare).copied().collect();
        let what = self.tables[0].existing().what;
        let existing = if full.is_empty() {
            format!("the files have {columns} columns, without names")
        } else {
            format!("the files have {}", quoted(full.iter().copied()))
        };
        let problem = no_columns(self.run, missing, what, &existing);
        if missing.iter().any(|name| name.starts_with('$')) {
            problem.help(format!(
                "columns have the numbers `$1` to `${columns}`; if others are in another file of this run, join both files, `a.csv+b.csv`"
            ))
        } else if let Some(guesses) = guesses(missing, &all, &self.used()) {
            problem.help(guesses)
        } else {
            problem.help("name the columns in the table [data]")
        }
    }

    /// Help for a name that refers to a missing file.
    fn missing_file(&self, missing: &[&str]) -> Option<String> {
        let files = self.numbers.iter().max().copied().unwrap_or(0);
        let of = |name: &&str| -> Option<usize> {
            let (number, _) = name.strip_prefix("file")?.split_once('.')?;
            number.parse().ok().filter(|number| *number > files)
        };
        let number = missing.iter().find_map(of)?;
        let s = if files == 1 { "" } else { "s" };
        Some(format!(
            "`file{number}` is number {number} of the files of a run that are joined, `--data a.csv+b.csv`; this run has {files} file{s}"
        ))
    }

    /// Help for a name in a file without names.
    fn without_names(&self, missing: &[&str]) -> Option<String> {
        let mut first = 1;
        for (table, number) in self.tables.iter().zip(self.numbers) {
            let own = table.existing();
            let prefix = format!("file{number}.");
            let is_asked = missing.iter().any(|name| name.starts_with(&prefix));
            if is_asked && own.names.is_empty() && own.columns > 0 {
                let last = first + own.columns - 1;
                let file = shown(table.file());
                return Some(format!(
                    "{file} has no names: its columns have the numbers `${first}` to `${last}` in all files"
                ));
            }
            first += own.columns;
        }
        None
    }

    /// Help for a text with a single column whose name contains separators.
    fn one_column(&self) -> Option<String> {
        let is_many = |name: &&str| name.contains([':', '|', '/', '!']);
        self.tables.iter().find_map(|table| {
            let own = table.existing();
            let name = own.names.iter().copied().find(is_many)?;
            (own.columns == 1).then(|| {
                format!(
                    "{} has one column only, `{}`: separate columns by commas, semicolons, tabs or blanks",
                    shown(table.file()),
                    shown(name)
                )
            })
        })
    }
}

/// Help for a text that is no expression.
fn way_out(text: &str) -> String {
    let angle = ["deg2rad(", "radians(", "rad("];
    let back = ["rad2deg(", "degrees(", "deg("];
    let has = |names: &[&str]| names.iter().any(|name| text.contains(name));
    if has(&angle) {
        return String::from(
            "write `* pi/180` after the column, or `position_scale = \"1 deg\"` in [data]",
        );
    }
    if has(&back) {
        return String::from("positions must be in rad; without a function write `* 180/pi`");
    }
    String::from("put names with blanks or signs in single quotation marks: `'motor 1' / 50`")
}
