//! What is said of files that can't be used.

use overact::Code;
use std::path::Path;

use crate::error::{Problem, suggestion};

/// Cells that are reported one by one; a file of text would else fill the screen.
pub(super) const LARGEST_NUMBER_OF_PROBLEMS: usize = 20;

/// Problems of a file's lines, of which equal ones are told once: a column of words has one on every line.
#[derive(Default)]
pub(super) struct Collected {
    /// Each with the number of lines further down that have it, too.
    all: Vec<(Problem, usize)>,
}

impl Collected {
    pub(super) fn is_empty(&self) -> bool {
        self.all.is_empty()
    }

    /// How many different ones there are.
    pub(super) fn len(&self) -> usize {
        self.all.len()
    }

    pub(super) fn extend(&mut self, problems: impl IntoIterator<Item = Problem>) {
        for problem in problems {
            let is_same = |one: &Problem| {
                let place = |own: &Problem| (own.file.clone(), own.column.clone());
                one.code == problem.code
                    && one.message == problem.message
                    && place(one) == place(&problem)
                    && problem.line.is_some()
            };
            match self.all.iter_mut().find(|(one, _)| is_same(one)) {
                Some((_, more)) => *more += 1,
                None => self.all.push((problem, 0)),
            }
        }
    }

    /// What is said of them.
    pub(super) fn told(self) -> Vec<Problem> {
        let told = |(mut problem, more): (Problem, usize)| {
            match more {
                0 => {}
                1 => problem.message += ", here and in one line further down",
                _ => problem.message += &format!(", here and in {more} lines further down"),
            }
            problem
        };
        self.all.into_iter().map(told).collect()
    }
}

/// Names that are listed, at most.
const LARGEST_NUMBER_OF_NAMES: usize = 40;

/// Characters of a cell or a name that are shown, at most.
const LONGEST_SHOWN: usize = 40;

/// Characters of a library's reason that are shown, at most.
const LONGEST_REASON: usize = 200;

/// A piece of a file as it can be shown in a terminal: short, and without control characters.
pub(super) fn shown(piece: &str) -> String {
    let mut text: String = piece
        .chars()
        .take(LONGEST_SHOWN)
        .map(|c| if c.is_control() { '\u{fffd}' } else { c })
        .collect();
    if piece.chars().nth(LONGEST_SHOWN).is_some() {
        text.push('…');
    }
    text
}

/// What a library says of a file, as it can be shown in a terminal.
pub(super) fn legible(why: &str) -> String {
    let letters = why.chars().take(LONGEST_REASON);
    letters
        .map(|c| if c.is_control() { '\u{fffd}' } else { c })
        .collect()
}

/// The name by which a file is called in messages: as the caller gave it.
pub(super) fn display_name(path: &Path) -> String {
    path.display().to_string()
}

/// A file that can't be opened or read.
pub(super) fn unreadable(file: &str, error: &std::io::Error) -> Problem {
    let problem = Problem::new(
        Code::UNREADABLE_LOG,
        format!("the file can't be read: {error}"),
    )
    .file(file);
    if error.kind() == std::io::ErrorKind::NotFound {
        problem.help(not_found(file))
    } else {
        problem
    }
}

/// The way out where there is no file of a name: pieces of it may be files.
fn not_found(file: &str) -> String {
    if file == "-" {
        return String::from("standard input can't be joined with files: write it to a file first");
    }
    let pieces: Vec<&str> = file.split(['+', ',', ';', ' ']).map(str::trim).collect();
    let pieces: Vec<&str> = pieces
        .into_iter()
        .filter(|piece| !piece.is_empty())
        .collect();
    if pieces.len() > 1 && pieces.iter().all(|piece| Path::new(piece).exists()) {
        return format!(
            "files of one run are joined by `+` without blanks: `{}`; of several runs give each file with its own --data",
            pieces.join("+")
        );
    }
    String::from("check the path; it is taken from the folder in which the program was started")
}

/// Several names between marks of quotation.
pub(super) fn quoted<'a>(names: impl IntoIterator<Item = &'a str>) -> String {
    let all: Vec<String> = names
        .into_iter()
        .map(|name| format!("`{}`", shown(name)))
        .collect();
    match all.len().checked_sub(LARGEST_NUMBER_OF_NAMES) {
        Some(more) if more > 0 => format!(
            "{} and {more} more",
            all[..LARGEST_NUMBER_OF_NAMES].join(", ")
        ),
        _ => all.join(", "),
    }
}

/// The place of the column `name` among the `names` of a file's columns, if it is there.
///
/// # Errors
/// Two columns of one name: nobody knows which one is meant.
pub(super) fn only<'a>(
    file: &str,
    name: &str,
    names: impl Iterator<Item = &'a str>,
) -> Result<Option<usize>, Problem> {
    let mut places = names.enumerate().filter(|(_, own)| *own == name);
    let first = places.next().map(|(place, _)| place);
    match places.count() {
        0 => Ok(first),
        more => {
            let message = format!("the file has {} columns `{}`", more + 1, shown(name));
            let problem = Problem::new(Code::SAME_COLUMN, message)
                .file(file)
                .column(name);
            Err(problem.help(
                "give each column a name of its own, or call it by its number, `$1` the first one",
            ))
        }
    }
}

/// What a file has in the way of columns.
pub(super) struct Existing<'a> {
    pub(super) names: Vec<&'a str>,
    /// Number of columns, of which all or none have a name.
    pub(super) columns: usize,
    /// What a column is called in this format.
    pub(super) what: &'static str,
}

/// The error that names all columns that are missing and all that are there, in one file or several
/// that are joined.
pub(super) fn missing_columns(file: &str, missing: &[&str], existing: &Existing<'_>) -> Problem {
    let Existing {
        names,
        columns,
        what,
    } = existing;
    let problem = no_columns(
        file,
        (missing, what),
        &match (names.is_empty(), columns) {
            (false, _) => format!("the file has {}", quoted(names.iter().copied())),
            (true, 0) => String::from("the file has none"),
            (true, 1) => String::from("the file has one column, without a name"),
            (true, count) => format!("the file has {count} columns, without names"),
        },
    );
    if *columns > 0 && missing.iter().any(|name| name.starts_with('$')) {
        problem.help(format!(
            "the columns that can be called by number are `$1` to `${columns}`; where the others stand in another file of this run, give both as one, `a.csv+b.csv`"
        ))
    } else if let Some(guesses) = guesses(missing, names) {
        problem.help(guesses)
    } else if names.is_empty() && *columns > 0 {
        problem.help(
            "name the columns in the table [data] by their numbers: `$1` is the first one, `$2` the next",
        )
    } else {
        problem.help("name the columns in the table [data]")
    }
}

/// The error that names columns that are missing, and what there is in their place.
pub(super) fn no_columns(file: &str, (missing, what): (&[&str], &str), existing: &str) -> Problem {
    let (is, s) = match missing.len() {
        1 => ("is", ""),
        _ => ("are", "s"),
    };
    let names = quoted(missing.iter().copied());
    let message = format!("there {is} no {what}{s} {names}; {existing}");
    let problem = Problem::new(Code::LOG_COLUMNS, message).file(file);
    match missing.first() {
        Some(first) => problem.column(*first),
        None => problem,
    }
}

/// Names that may have been meant by those that are missing.
pub(super) fn guesses(missing: &[&str], names: &[&str]) -> Option<String> {
    let near = missing.iter().filter_map(|name| {
        let near = suggestion(name, names.iter().copied())?;
        Some(format!("`{}` for `{}`", shown(near), shown(name)))
    });
    let near: Vec<String> = near.collect();
    (!near.is_empty()).then(|| format!("did you mean {}?", near.join(", ")))
}
